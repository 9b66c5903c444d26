//! Medians, their confidence intervals, and measures of speed-up.
//!
//! Intervals come from the bootstrap, as METHODOLOGY.md justifies: percentiles of the medians of
//! resamples, which are drawn with a fixed seed.

use crate::random::SplitMix64;
use serde::{Deserialize, Serialize};
use std::f64::consts::SQRT_2;

/// The number of resamples. With 8 values 11 of them lie outside at each end of an interval.
const RESAMPLES: usize = 2000;

/// The seed of the resamples: the same sample always has the same interval.
const SEED: u64 = 1;

/// The confidence level of intervals where no other is named.
const LEVEL: f64 = 0.95;

/// A median and the ends of its confidence interval, of 95 % if nothing else is said, all in the
/// unit of the sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// The median of the sample.
    pub median: f64,
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Interval {
    /// Returns the interval that is a single value.
    #[must_use]
    pub fn exactly(value: f64) -> Self {
        Self { median: value, low: value, high: value }
    }

    /// Returns whether the interval contains `value`; its ends belong to it.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// Returns half of the width, as a share of the median.
    #[must_use]
    pub fn relative_half_width(&self) -> f64 {
        (self.high - self.low) / 2.0 / self.median
    }
}

/// Returns the middle of `sample`, or the mean of its middle two; `None` if it is empty.
#[must_use]
pub fn median(sample: &[f64]) -> Option<f64> {
    median_in_place(&mut sample.to_vec())
}

/// Returns the lower quartile of `sample`, the smallest of up to four values; `None` if it is
/// empty. Use it for times without interference, which only adds to them.
#[must_use]
pub fn lower_quartile(sample: &[f64]) -> Option<f64> {
    let mut sorted = sample.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sample.len().saturating_sub(1) / 4).copied()
}

/// The smallest number of values for an interval.
pub const LEAST_VALUES: usize = 6;

/// Returns the median of `sample` with its 95 % interval; `None` if the sample is empty.
///
/// It is an expanded percentile interval of the bootstrap, because plain percentiles are too narrow
/// for few values. No interval of fewer than [`LEAST_VALUES`] values covers 95 %; it then reaches
/// from about the smallest to about the largest value.
///
/// The values must be independent. So use ratios within a round, not times: a slow round affects
/// both times of a ratio alike.
///
/// Source: Efron, "Bootstrap methods: another look at the jackknife", 1979; expanded after
/// Hesterberg, "What teachers should know about the bootstrap", The American Statistician 69 (4),
/// 2015.
#[must_use]
pub fn median_interval(sample: &[f64]) -> Option<Interval> {
    let median = median(sample)?;
    Some(resampled_interval(median, sample, LEVEL))
}

/// Returns the median of `above` over that of `below` with its interval, for samples that are not
/// paired; `None` if either is empty. See [`median_interval`].
#[must_use]
pub fn median_ratio_interval(above: &[f64], below: &[f64]) -> Option<Interval> {
    let ratio = median(above)? / median(below)?;
    let mut random = SplitMix64::new(SEED);
    // The smaller sample decides how much the percentiles are expanded.
    let values = above.len().min(below.len());
    let resampled = || resampled_median(above, &mut random) / resampled_median(below, &mut random);
    Some(interval(ratio, values, LEVEL, resampled))
}

/// Returns the median of `above` over `below`, measured in the same rounds, with its interval;
/// `None` if there is no round.
#[must_use]
pub fn ratio_interval(above: &[u64], below: &[u64]) -> Option<Interval> {
    median_interval(&ratios(above, below))
}

/// Returns the same with an interval of confidence level `level`, for one of several comparisons.
///
/// Few values allow no higher level than that of the range from the smallest to the largest: 99.2 %
/// for 8 values.
#[must_use]
pub fn ratio_interval_of_level(above: &[u64], below: &[u64], level: f64) -> Option<Interval> {
    let ratios = ratios(above, below);
    Some(resampled_interval(median(&ratios)?, &ratios, level))
}

/// Returns `above` over `below`, round by round.
#[must_use]
pub fn ratios(above: &[u64], below: &[u64]) -> Vec<f64> {
    // A coarse clock must not give a ratio of 0 / 0.
    above.iter().zip(below).map(|(&a, &b)| a.max(1) as f64 / b.max(1) as f64).collect()
}

/// Returns the interval of confidence level `level` around the median of `sample`.
fn resampled_interval(median: f64, sample: &[f64], level: f64) -> Interval {
    let mut random = SplitMix64::new(SEED);
    interval(median, sample.len(), level, || resampled_median(sample, &mut random))
}

/// Returns the interval of confidence level `level` around `estimate`, which is from `values`
/// values, by resampling.
fn interval(
    estimate: f64,
    values: usize,
    level: f64,
    mut resampled: impl FnMut() -> f64,
) -> Interval {
    let mut estimates: Vec<f64> = std::iter::repeat_with(&mut resampled).take(RESAMPLES).collect();
    estimates.sort_unstable_by(f64::total_cmp);
    let outside = (tail(values, level) * RESAMPLES as f64).floor() as usize;
    Interval { median: estimate, low: estimates[outside], high: estimates[RESAMPLES - 1 - outside] }
}

/// Returns the share of the resamples outside of the interval at each end; 2.5 % for many values
/// and a level of 95 %. It is the tail of the normal distribution beyond Student's point times the
/// root of n / (n - 1).
fn tail(values: usize, level: f64) -> f64 {
    let freedom = values.saturating_sub(1).max(1) as f64;
    let far = student(freedom, level) * (1.0 + 1.0 / freedom).sqrt();
    normal_tail(far)
}

/// Returns the share of the normal distribution above a point.
fn normal_tail(point: f64) -> f64 {
    libm::erfc(point / SQRT_2) / 2.0
}

/// Returns the point above which Student's distribution has half of what `level` leaves out. For
/// 95 % the error is below 0.01 from 5 degrees of freedom on.
///
/// Source: Abramowitz and Stegun, "Handbook of Mathematical Functions", 26.7.5.
fn student(freedom: f64, level: f64) -> f64 {
    let z = normal_point((1.0 - level) / 2.0);
    let [z3, z5, z7] = [3, 5, 7].map(|power| z.powi(power));
    let first = (z3 + z) / 4.0;
    let second = (5.0 * z5 + 16.0 * z3 + 3.0 * z) / 96.0;
    let third = (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / 384.0;
    z + (first + (second + third / freedom) / freedom) / freedom
}

/// Returns the point above which the normal distribution has this share, by bisection.
fn normal_point(share: f64) -> f64 {
    let (mut low, mut high) = (0.0, 10.0);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        *(if normal_tail(middle) > share { &mut low } else { &mut high }) = middle;
    }
    low
}

/// Returns the median of a resample: as many values as `sample` has, drawn with replacement.
fn resampled_median(sample: &[f64], random: &mut SplitMix64) -> f64 {
    let mut resample: Vec<f64> =
        sample.iter().map(|_| sample[random.below(sample.len())]).collect();
    median_in_place(&mut resample).unwrap_or(f64::NAN)
}

/// Returns the share of `threads` threads that a speed-up uses: 1 is perfect.
#[must_use]
pub fn efficiency(speedup: f64, threads: usize) -> f64 {
    speedup / threads as f64
}

/// Returns the serial fraction that explains a speed-up on `threads` threads: 0 is perfectly
/// parallel, 1 is serial, below 0 is faster than linear. `None` for one thread.
///
/// Source: Karp and Flatt, "Measuring parallel processor performance", CACM 33 (5), 1990.
#[must_use]
pub fn karp_flatt(speedup: f64, threads: usize) -> Option<f64> {
    let inverse = 1.0 / threads as f64;
    (threads > 1).then(|| (1.0 / speedup - inverse) / (1.0 - inverse))
}

fn median_in_place(sample: &mut [f64]) -> Option<f64> {
    let middle = sample.len() / 2;
    if sample.is_empty() {
        return None;
    }
    let even = sample.len().is_multiple_of(2);
    let (below, &mut upper, _) = sample.select_nth_unstable_by(middle, f64::total_cmp);
    let lower = below.iter().copied().max_by(f64::total_cmp).filter(|_| even).unwrap_or(upper);
    // Do not compute the mean of two equal values: it may differ from them in the last bit.
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

    /// Compares with the tables of textbooks, and with tails worked out for few values.
    #[test]
    fn tails_are_expanded_by_student() {
        for (freedom, expected) in
            [(5.0, 2.571), (7.0, 2.365), (9.0, 2.262), (19.0, 2.093), (39.0, 2.023)]
        {
            let point = student(freedom, 0.95);
            assert!((point - expected).abs() < 0.01, "{freedom}: {point}");
        }
        for (freedom, expected) in [(9.0, 3.250), (39.0, 2.708)] {
            let point = student(freedom, 0.99);
            assert!((point - expected).abs() < 0.01, "{freedom}: {point}");
        }
        // Normal tails beyond 2.571 sqrt(6 / 5), 2.365 sqrt(8 / 7) and 2.023 sqrt(40 / 39).
        for (values, expected) in [(6, 0.0025), (8, 0.0058), (40, 0.0203)] {
            let tail = tail(values, 0.95);
            assert!((tail - expected).abs() < 2e-4, "{values}: {tail}");
        }
        assert!(tail(1, 0.95) < 1e-9 && (tail(1_000_000, 0.95) - 0.025).abs() < 1e-6);
        assert!((tail(1_000_000, 0.998) - 0.001).abs() < 1e-6);
    }

    /// Returns the time of a rendering that takes 1 with a deviation of 1 %. One in seven is
    /// disturbed: it takes 15 % longer on average, and sometimes much longer.
    fn noisy(random: &mut SplitMix64) -> f64 {
        let normal: f64 = (0..12).map(|_| random.fraction()).sum::<f64>() - 6.0;
        let disturbed =
            if random.below(7) == 0 { -0.15 * (1.0 - random.fraction()).ln() } else { 0.0 };
        (0.01 * normal).exp() + disturbed
    }

    /// Catches percentiles that are not expanded, which cover 92 % at 8 values, and intervals that
    /// are too wide. With 1000 trials three standard deviations of a coverage of 95 % are 2.1 %.
    #[test]
    fn intervals_cover_95_percent() {
        for (values, widest) in [(8, 0.15), (12, 0.045), (20, 0.03), (40, 0.02)] {
            let mut random = SplitMix64::new(values as u64);
            let (mut covered, mut widths) = (0, Vec::new());
            for _ in 0..1000 {
                let ratios: Vec<f64> =
                    (0..values).map(|_| noisy(&mut random) / noisy(&mut random)).collect();
                let interval = median_interval(&ratios).expect("values");
                covered += usize::from(interval.contains(1.0));
                widths.push(interval.high - interval.low);
            }
            assert!((935..=990).contains(&covered), "{values} values: {covered} of 1000");
            let width = median(&widths).expect("widths");
            assert!(width < widest, "{values} values: {width}");
        }
    }

    /// Catches a level that is ignored. With 1000 trials three standard deviations of a coverage of
    /// 99.5 % are 0.7 %.
    #[test]
    fn a_higher_level_covers_more() {
        let mut random = SplitMix64::new(3);
        let mut covered = 0;
        for _ in 0..1000 {
            let [above, below] = [(); 2]
                .map(|()| (0..20).map(|_| (1e9 * noisy(&mut random)) as u64).collect::<Vec<_>>());
            let interval = ratio_interval_of_level(&above, &below, 0.995).expect("values");
            covered += usize::from(interval.contains(1.0));
        }
        assert!((988..1000).contains(&covered), "{covered} of 1000");
        let (above, below) = ([1, 3, 2, 5, 4, 7, 6, 9], [2; 8]);
        let expected = ratio_interval(&above, &below);
        assert_eq!(ratio_interval_of_level(&above, &below, LEVEL), expected);
    }

    /// Catches a ratio of paired values, and one that is upside down.
    #[test]
    fn ratio_of_independent_samples() {
        let mut random = SplitMix64::new(5);
        let mut covered = 0;
        for _ in 0..1000 {
            let above: Vec<f64> = (0..12).map(|_| 1.5 * noisy(&mut random)).collect();
            let below: Vec<f64> = (0..20).map(|_| noisy(&mut random)).collect();
            let interval = median_ratio_interval(&above, &below).expect("values");
            covered += usize::from(interval.contains(1.5));
        }
        assert!((935..=995).contains(&covered), "{covered} of 1000");
        assert_eq!(median_ratio_interval(&[], &[1.0]), None);
        assert_eq!(median_ratio_interval(&[1.0], &[]), None);
    }

    #[test]
    fn the_same_sample_has_the_same_interval() {
        let sample = [1.0, 3.0, 2.0, 5.0, 4.0, 7.0, 6.0, 9.0];
        assert_eq!(median_interval(&sample), median_interval(&sample));
        let Interval { median, low, high } = median_interval(&sample).expect("values");
        assert!(low < median && median < high && median == 4.5, "{low} {median} {high}");
        let half = Interval { median: 2.0, low: 1.9, high: 2.3 }.relative_half_width();
        assert!((half - 0.1).abs() < 1e-12);
    }

    #[test]
    fn interval_of_equal_values_is_that_value() {
        let third = 1.0 / 3.0;
        let expected = Interval::exactly(third);
        assert_eq!(median_interval(&[third; 4]), Some(expected));
        assert_eq!(median_interval(&[third]), Some(expected));
        assert_eq!(median_interval(&[]), None);
    }

    /// Uses the figures of the lab report: 5.67 s on one thread, 1.60 s on five.
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
