//! What a sample of times says: median, its uncertainty, and what threads made of it.

use std::f64::consts::LN_2;

/// The most that a 95 % interval may miss at each end.
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

/// The lower quartile of `sample`, of up to four values the smallest; `None` when there is no sample. For times of which
/// the machine's own share is wanted: what disturbs only adds to them.
#[must_use]
pub fn lower_quartile(sample: &[f64]) -> Option<f64> {
    let mut sorted = sample.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sample.len().saturating_sub(1) / 4).copied()
}

/// The median of `sample` with its 95 % interval, which the sign test gives: from the `k`-th value
/// to the `k`-th last, for the largest `k` with a coverage of 95 % or more. `None` when there is no
/// sample.
///
/// Of fewer than 6 values it is the smallest and the largest, though these cover less: 93.75 % of 5,
/// and of `n` values 1 - 2 / 2^n.
///
/// The coverage is exact whatever the distribution, as long as the values of a sample are
/// independent. So it wants ratios within a round, not times: what slows a whole round down cancels
/// in the ratio.
///
/// Source: Hollander and Wolfe, "Nonparametric Statistical Methods", on the interval of the sign test.
#[must_use]
pub fn median_interval(sample: &[f64]) -> Option<Interval> {
    let mut sorted = sample.to_vec();
    let median = median_in_place(&mut sorted)?;
    let outside = outside(sorted.len());
    Some(Interval { median, low: sorted[outside], high: sorted[sorted.len() - 1 - outside] })
}

/// The median of `above` over `below`, measured in the same rounds, with its interval; `None` without a
/// round.
#[must_use]
pub fn ratio_interval(above: &[u64], below: &[u64]) -> Option<Interval> {
    // A clock too coarse for the rendering must not make a ratio of 0 / 0.
    let ratios = above.iter().zip(below).map(|(&a, &b)| a.max(1) as f64 / b.max(1) as f64);
    median_interval(&ratios.collect::<Vec<_>>())
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

/// How many of `n` values in order lie outside of the median's interval at each end.
///
/// The median is below the value with `k` others below it when at most `k` of the `n` are below the
/// median, which is a matter of tossing a coin `n` times.
fn outside(n: usize) -> usize {
    // As logarithms: 2^n has no `f64` from 1024 values on.
    let (mut ln_ways, mut tail) = (0.0, 0.0);
    let values = (0..n / 2).take_while(|&k| {
        tail += f64::exp(ln_ways - n as f64 * LN_2);
        ln_ways += f64::ln((n - k) as f64 / (k + 1) as f64);
        tail <= TAIL
    });
    values.last().unwrap_or(0)
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

    #[test]
    fn a_quarter_is_below_the_lower_quartile() {
        assert_eq!(lower_quartile(&[]), None);
        assert_eq!(lower_quartile(&[7.0, 3.0, 5.0, 9.0]), Some(3.0));
        assert_eq!(lower_quartile(&[5.0, 4.0, 3.0, 2.0, 1.0]), Some(2.0));
        assert_eq!(lower_quartile(&(1..=25).rev().map(f64::from).collect::<Vec<_>>()), Some(7.0));
    }

    /// The coverage of the interval that leaves out `outside` of `n` values at each end, in integers.
    fn coverage(n: u32, outside: u32) -> f64 {
        let ways = |k: u32| (0..k).fold(1, |ways, i| ways * u128::from(n - i) / u128::from(i + 1));
        1.0 - 2.0 * (0..=outside).map(ways).sum::<u128>() as f64 / (1u128 << n) as f64
    }

    #[test]
    fn interval_is_the_tightest_of_95_percent() {
        assert_eq!(coverage(11, 1), 1.0 - 2.0 * 12.0 / 2048.0);
        for n in 6..=100 {
            let outside = u32::try_from(outside(n as usize)).expect("a few");
            assert!(coverage(n, outside) >= 0.95, "{n} values without {outside} at each end");
            assert!(coverage(n, outside + 1) < 0.95, "{n} values without {outside} at each end");
        }
    }

    /// The ranks that the tables of textbooks have.
    #[test]
    fn interval_ends_at_order_statistics() {
        let ranks = [(1, 1, 1), (2, 1, 2), (5, 1, 5), (6, 1, 6), (8, 1, 8), (9, 2, 8), (11, 2, 10)];
        for (n, low, high) in ranks.into_iter().chain([(12, 3, 10), (17, 5, 13), (20, 6, 15), (40, 14, 27)]) {
            // From the largest to the smallest.
            let sample: Vec<f64> = (1..=n).rev().map(f64::from).collect();
            let median = f64::from(n + 1) / 2.0;
            let expected = Interval { median, low: f64::from(low), high: f64::from(high) };
            assert_eq!(median_interval(&sample), Some(expected), "{n} values");
        }
    }

    /// 10,000 tosses: 1.96 standard deviations of 50 are 98.
    #[test]
    fn interval_of_many_values() {
        assert_eq!(outside(10_000), 4901);
    }

    #[test]
    fn interval_of_equal_values_is_that_value() {
        let third = 1.0 / 3.0;
        let expected = Interval { median: third, low: third, high: third };
        assert_eq!(median_interval(&[third; 4]), Some(expected));
        assert_eq!(median_interval(&[third]), Some(expected));
        assert_eq!(median_interval(&[]), None);
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
