//! Random points, the same in every run.

use glam::DVec3;

/// Returns points in the unit cube, 1 excluded: a linear congruential generator (Knuth,
/// The Art of Computer Programming 2, 1981, 3.3.4).
pub(crate) fn random_points() -> impl FnMut() -> DVec3 {
    let mut state = 1_u64;
    let mut number = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    move || DVec3::new(number(), number(), number())
}
