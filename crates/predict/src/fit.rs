//! Fits laws of speed-up by least squares.
//!
//! Gunther's universal scalability law gives the speed-up on `n` threads as
//! `C(n) = n / (1 + s (n - 1) + k n (n - 1))`; with `k = 0` it is Amdahl's law. Sources: Amdahl,
//! "Validity of the single processor approach to achieving large scale computing capabilities",
//! 1967; Gunther, "A simple capacity model of massively parallel transaction systems", 1993.

/// A law of speed-up with its fitted shares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Law {
    /// The serial share of the work: 0 to 1. Gunther's sigma, contention.
    pub serial: f64,
    /// The cost of each thread to each other thread, as a share of the work: 0 or more. Gunther's
    /// kappa, coherency; 0 in Amdahl's law.
    pub crosstalk: f64,
    /// The root mean square of the relative errors in time at the fitted points.
    pub error: f64,
}

impl Law {
    /// Returns the speed-up on `threads` threads.
    #[must_use]
    pub fn speedup(&self, threads: f64) -> f64 {
        threads / (1.0 + self.serial * (threads - 1.0) + self.crosstalk * threads * (threads - 1.0))
    }

    /// Returns the number of threads with the largest speed-up; `None` if it always grows.
    #[must_use]
    pub fn peak(&self) -> Option<f64> {
        (self.crosstalk > 0.0)
            .then(|| ((1.0 - self.serial).max(0.0) / self.crosstalk).sqrt().max(1.0))
    }
}

/// Fits Amdahl's law to `points`, each a number of threads and its speed-up over one thread. `None`
/// if there is no point of two threads or more.
#[must_use]
pub fn amdahl(points: &[(usize, f64)]) -> Option<Law> {
    let sums = Sums::of(points)?;
    Some(law(points, (sums.bs / sums.ss).clamp(0.0, 1.0), 0.0))
}

/// Fits Gunther's law to `points` as [`amdahl`] does. `None` if there are no points of two
/// different numbers of threads above one.
#[must_use]
pub fn usl(points: &[(usize, f64)]) -> Option<Law> {
    let Sums { ss, sk, kk, bs, bk } = Sums::of(points)?;
    let determinant = ss * kk - sk * sk;
    // With a single point the two columns are proportional.
    if determinant <= 1e-12 * ss * kk {
        return None;
    }
    let (serial, crosstalk) =
        ((bs * kk - bk * sk) / determinant, (bk * ss - bs * sk) / determinant);
    // If a share is out of bounds, the optimum is at the bound; the other share is fitted to the
    // rest.
    Some(if crosstalk < 0.0 {
        law(points, (bs / ss).clamp(0.0, 1.0), 0.0)
    } else if (0.0..=1.0).contains(&serial) {
        law(points, serial, crosstalk)
    } else {
        let serial = serial.clamp(0.0, 1.0);
        law(points, serial, ((bk - serial * sk) / kk).max(0.0))
    })
}

/// The sums of the normal equations. `n / C(n)` is linear in both shares. Each equation is weighted
/// with the inverse of its value, so that relative errors are minimised: 2 % at 1024 threads count
/// as much as at 2.
#[derive(Debug, Default)]
struct Sums {
    ss: f64,
    sk: f64,
    kk: f64,
    bs: f64,
    bk: f64,
}

impl Sums {
    fn of(points: &[(usize, f64)]) -> Option<Self> {
        let mut sums = Self::default();
        for &(threads, speedup) in points {
            let threads = threads as f64;
            let weight = speedup / threads;
            let serial = weight * (threads - 1.0);
            let (crosstalk, rest) = (serial * threads, 1.0 - weight);
            sums.ss += serial * serial;
            sums.sk += serial * crosstalk;
            sums.kk += crosstalk * crosstalk;
            sums.bs += rest * serial;
            sums.bk += rest * crosstalk;
        }
        (sums.ss > 0.0).then_some(sums)
    }
}

fn law(points: &[(usize, f64)], serial: f64, crosstalk: f64) -> Law {
    let law = Law { serial, crosstalk, error: 0.0 };
    let squares = points.iter().map(|&(threads, speedup)| {
        let error = speedup / law.speedup(threads as f64) - 1.0;
        error * error
    });
    Law { error: (squares.sum::<f64>() / points.len() as f64).sqrt(), ..law }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(speedup: impl Fn(f64) -> f64) -> Vec<(usize, f64)> {
        [1, 2, 4, 16, 64, 1024].map(|threads| (threads, speedup(threads as f64))).to_vec()
    }

    /// Catches wrong normal equations: points on a law give back its shares.
    #[test]
    fn the_shares_of_exact_points() {
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-9, "{a} is not {b}");
        let (serial, crosstalk) = (0.03, 0.0002);
        let law = usl(&points(|n| n / (1.0 + serial * (n - 1.0) + crosstalk * n * (n - 1.0))))
            .expect("a law");
        close(law.serial, serial);
        close(law.crosstalk, crosstalk);
        close(law.error, 0.0);
        close(law.peak().expect("a peak"), (0.97_f64 / 0.0002).sqrt());

        let law = amdahl(&points(|n| 1.0 / (0.1 + 0.9 / n))).expect("a law");
        close(law.serial, 0.1);
        close(law.speedup(9.0), 5.0);
        assert_eq!((law.crosstalk, law.peak()), (0.0, None));
    }

    /// Catches shares below 0, which would give a speed-up above `n`, and a serial share above 1.
    #[test]
    fn shares_are_kept_within_bounds() {
        let faster = points(|n| 1.1 * n);
        assert_eq!(amdahl(&faster).map(|law| law.serial), Some(0.0));
        assert_eq!(usl(&faster).map(|law| (law.serial, law.crosstalk)), Some((0.0, 0.0)));
        // Worse in the middle than at the end: an unbounded crosstalk would be negative.
        let dent = usl(&[(2, 1.2), (4, 2.0), (64, 60.0)]).expect("a law");
        assert!(dent.serial > 0.0 && dent.crosstalk == 0.0, "{dent:?}");
        // Perfect up to 4, then bad: an unbounded serial share would be negative.
        let cliff = usl(&[(2, 2.0), (4, 4.0), (64, 8.0)]).expect("a law");
        assert!(cliff.serial == 0.0 && cliff.crosstalk > 0.0, "{cliff:?}");
        // Threads that make everything slower.
        let slower = points(|n| 1.0 / n);
        assert_eq!(amdahl(&slower).map(|law| law.serial), Some(1.0));
        let law = usl(&slower).expect("a law");
        assert!(law.serial <= 1.0 && law.crosstalk > 0.9, "{law:?}");
    }

    #[test]
    fn too_few_points_give_no_law() {
        assert_eq!((amdahl(&[]), amdahl(&[(1, 1.0)])), (None, None));
        assert_eq!(usl(&[(1, 1.0), (2, 1.9)]), None);
        assert_eq!(amdahl(&[(2, 1.6)]).map(|law| (law.serial * 1e9).round()), Some(0.25e9));
    }
}
