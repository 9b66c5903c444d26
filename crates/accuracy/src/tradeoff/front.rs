//! Which settings are worth choosing.

/// For each of `points`, of time and error, whether no other one is as fast and as exact, and
/// better in one of the two (Pareto). Of equal points all are; one with a NaN never is.
#[must_use]
pub fn pareto_front(points: &[(f64, f64)]) -> Vec<bool> {
    let dominates = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    points
        .iter()
        .map(|point| {
            let measured = !point.0.is_nan() && !point.1.is_nan();
            measured && !points.iter().any(|other| dominates(other, point))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a comparison that is strict where it should not be, or the reverse.
    #[test]
    fn what_is_worse_in_nothing_is_in_front() {
        let points = [
            (1.0, 9.0),
            (2.0, 5.0),
            // As fast as the one before, less exact.
            (2.0, 6.0),
            // As exact, slower.
            (3.0, 5.0),
            (4.0, 1.0),
            (4.0, 1.0),
            (f64::NAN, 0.0),
            (0.0, f64::NAN),
        ];
        assert_eq!(pareto_front(&points), [true, true, false, false, true, true, false, false]);
    }
}
