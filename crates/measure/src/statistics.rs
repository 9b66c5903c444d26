//! What a sample of times says: median, its uncertainty, and what threads made of it.

use crate::random::SplitMix64;

/// Resamples of a bootstrap: enough that another seed moves an end of the interval by less than
/// the spacing of the sample.
const RESAMPLES: usize = 2000;

/// Share of the resamples outside a 95 % interval at each end.
const TAIL: f64 = 0.025;

/// A median and the ends of its 95 % confidence interval, all in the unit of the sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Of the sample itself.
    pub median: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether `value` is in it, the ends included.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }
}

/// The middle of `sample`, or the mean of its middle two; `None` when there is no sample.
#[must_use]
pub fn median(sample: &[f64]) -> Option<f64> {
    median_in_place(&mut sample.to_vec())
}

/// The median of `sample` with its 95 % interval by the percentile bootstrap (Efron 1979), the same
/// for the same seed; `None` when there is no sample.
///
/// It assumes nothing of the distribution but that the values of a sample are independent, and so
/// wants ratios within a round, not times: what slows a whole round down cancels in the ratio.
#[must_use]
pub fn median_interval(sample: &[f64], seed: u64) -> Option<Interval> {
    let middle = median(sample)?;
    let mut random = SplitMix64::new(seed);
    let mut resample = vec![0.0; sample.len()];
    let mut medians: Vec<f64> = (0..RESAMPLES)
        .filter_map(|_| {
            resample.fill_with(|| sample[random.below(sample.len())]);
            median_in_place(&mut resample)
        })
        .collect();
    medians.sort_unstable_by(f64::total_cmp);
    let tail = (TAIL * RESAMPLES as f64) as usize;
    Some(Interval { median: middle, low: medians[tail], high: medians[RESAMPLES - 1 - tail] })
}

/// How much of `threads` threads a speed-up uses: 1 is all of it.
#[must_use]
pub fn efficiency(speedup: f64, threads: usize) -> f64 {
    speedup / threads as f64
}

/// The serial fraction that explains a speed-up on `threads` threads: 0 is perfectly parallel, 1
/// not at all, negative is faster than linear. `None` for one thread, which says nothing of it.
///
/// Source: Karp and Flatt, "Measuring parallel processor performance", CACM 33 (5), 1990.
#[must_use]
pub fn karp_flatt(speedup: f64, threads: usize) -> Option<f64> {
    let inverse = 1.0 / threads as f64;
    (threads > 1).then(|| (1.0 / speedup - inverse) / (1.0 - inverse))
}

fn median_in_place(sample: &mut [f64]) -> Option<f64> {
    sample.sort_unstable_by(f64::total_cmp);
    let upper = *sample.get(sample.len() / 2)?;
    let lower = sample[(sample.len() - 1) / 2];
    // The mean of two equal values is that value, bit for bit, only when it is not computed.
    Some(if lower == upper { upper } else { f64::midpoint(lower, upper) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn median_of_odd_even_and_no_sample() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[4.0, 1.0, 3.0, 2.0]), Some(2.5));
        assert_eq!(median(&[]), None);
    }

    /// The bootstrap's own distribution is known: the median of 11 draws from 1..=11 is at most k
    /// when 6 or more draws are, a binomial tail.
    #[test]
    fn interval_ends_where_the_binomial_tails_do() {
        let at_most = |k: f64| -> f64 {
            let p = k / 11.0;
            let choose = [462.0, 330.0, 165.0, 55.0, 11.0, 1.0];
            (6..=11).zip(choose).map(|(n, ways)| ways * p.powi(n) * (1.0 - p).powi(11 - n)).sum()
        };
        // The 2.5 % point is at 3 and, mirrored, the 97.5 % point at 9: clear of both by over 0.01.
        assert!(at_most(2.0) < 0.015 && at_most(3.0) > 0.035);

        let sample: Vec<f64> = (1..=11).map(f64::from).collect();
        for seed in 0..20 {
            let interval = median_interval(&sample, seed).expect("a sample");
            assert_eq!(interval, Interval { median: 6.0, low: 3.0, high: 9.0 }, "seed {seed}");
        }
    }

    #[test]
    fn interval_follows_from_the_seed_alone() {
        let mut random = SplitMix64::new(7);
        let sample: Vec<f64> = (0..40).map(|_| random.next_u64() as f64).collect();
        assert_eq!(median_interval(&sample, 3), median_interval(&sample, 3));
        assert_ne!(median_interval(&sample, 3), median_interval(&sample, 4));
    }

    #[test]
    fn interval_of_equal_values_is_that_value() {
        let third = 1.0 / 3.0;
        let expected = Interval { median: third, low: third, high: third };
        assert_eq!(median_interval(&[third; 4], 1), Some(expected));
        assert_eq!(median_interval(&[third], 1), Some(expected));
        assert_eq!(median_interval(&[], 1), None);
    }

    /// 5.67 s on one thread, 1.60 s on five.
    #[test]
    fn speedup_of_the_report() {
        let speedup: f64 = 5.67 / 1.60;
        assert!((speedup - 3.544).abs() < 5e-4);
        assert!((efficiency(speedup, 5) - 0.709).abs() < 5e-4);
        assert!((karp_flatt(speedup, 5).expect("several threads") - 0.103).abs() < 5e-4);
    }

    #[test]
    fn serial_fraction_of_the_extremes() {
        assert_eq!(karp_flatt(1.0, 1), None);
        assert_eq!(karp_flatt(1.0, 4), Some(1.0));
        assert_eq!(karp_flatt(4.0, 4), Some(0.0));
        assert!(karp_flatt(5.0, 4).expect("several threads") < 0.0);
    }
}
