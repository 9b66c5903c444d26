//! Finds where a measured curve crosses a level, by interpolation between its points.

/// Returns the smallest work from which on the efficiency stays at `share` of the largest one or
/// above; `None` if it does at the first point. The `points` are (work, efficiency) in ascending
/// order. Between them the efficiency is linear in the logarithm of the work.
pub(super) fn metg(points: &[(f64, f64)], share: f64) -> Option<f64> {
    let peak = points.iter().map(|point| point.1).fold(0.0, f64::max);
    last_crossing(points, share * peak).filter(|work| *work > points[0].0)
}

/// Returns the smallest side from which on the speed-up stays above 1; `None` if it is not above 1
/// at the last point. The `points` are (side, speed-up) in ascending order.
pub(super) fn break_even(points: &[(f64, f64)]) -> Option<f64> {
    last_crossing(points, 1.0)
}

/// Returns the place from which on a curve stays at `level` or above: its first place if it always
/// does, `None` if it does not at the end.
fn last_crossing(points: &[(f64, f64)], level: f64) -> Option<f64> {
    let from = points.iter().rposition(|point| point.1 < level).map_or(0, |below| below + 1);
    let &(right, above) = points.get(from)?;
    let Some(&(left, below)) = from.checked_sub(1).and_then(|before| points.get(before)) else {
        return Some(right);
    };
    Some(left * (right / left).powf((level - below) / (above - below)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_crossing_counts() {
        // Above, below again, and above for good between 4 and 16: half-way in the logarithm.
        let points = [(1.0, 1.2), (2.0, 0.9), (4.0, 0.8), (16.0, 1.2)];
        let side = break_even(&points).expect("a crossing");
        assert!((side - 8.0).abs() < 1e-12, "{side}");
        assert_eq!(break_even(&points[..3]), None, "slower at the end");
        assert_eq!(break_even(&points[3..]), Some(16.0), "always faster");
    }

    #[test]
    fn half_of_the_largest_efficiency() {
        // The peak is 0.8 and not at the end: its half, 0.4, is reached half-way between 2 and 8.
        let points = [(1.0, 0.1), (2.0, 0.2), (8.0, 0.6), (32.0, 0.8), (128.0, 0.7)];
        let work = metg(&points, 0.5).expect("a crossing");
        assert!((work - 4.0).abs() < 1e-12, "{work}");
        assert_eq!(metg(&[(1.0, 0.5), (2.0, 0.9)], 0.5), None, "the smallest does");
    }
}
