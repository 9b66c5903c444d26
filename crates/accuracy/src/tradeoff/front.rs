//! The Pareto front of time and error: the settings that are worth choosing.

/// Returns for each of `points`, given as time and error, whether it lies on the Pareto front: no
/// other point is at most equal in both and less in one. Equal points lie on it together; a point
/// with a NaN never does.
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

    /// Catches a comparison that is wrongly strict, or wrongly not.
    #[test]
    fn points_that_no_other_dominates_are_in_front() {
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
