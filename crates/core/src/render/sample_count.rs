//! The numbers of primary rays and packets of a tile, computed without tracing any.

use crate::execution::Execution;
use crate::render::tracer::{BLOCK, block, for_each_run};
use crate::scene::RenderSettings;
use std::ops::Range;

/// Returns the number of primary rays that the tracer follows for a tile of `width` x `height`
/// pixels.
///
/// On a lattice of density `s`, a tile that shares its samples takes `(s (width + 1) + 1) (s
/// (height + 1) + 1)` rays: `s` steps a pixel, and half a pixel more on each side, because the
/// filter reaches into the neighbours. Each tile traces the points on its border for itself, so
/// smaller tiles need more rays. The fewest come from one tile for the whole image, the most from
/// one tile for each pixel, as if nothing were shared.
///
/// Without sharing, it is [`RenderSettings::rays_per_pixel`] for each pixel. So it is where no two
/// pixels have a sample in common: with one ray a pixel, or with [importance
/// sampling](crate::Sampling::Importance).
///
/// Returns `None` for an [adaptive](RenderSettings::adaptive) lattice, where the number depends on
/// the scene. Reflected rays and shadow rays are not counted, because their number always depends
/// on the scene.
#[must_use]
pub fn primary_rays(
    width: u32,
    height: u32,
    settings: &RenderSettings,
    share_samples: bool,
) -> Option<u64> {
    if !settings.has_lattice() || (!share_samples && !settings.adaptive) {
        return Some(u64::from(width) * u64::from(height) * u64::from(settings.rays_per_pixel()));
    }
    // A tile without pixels has no lattice, not even beyond its border.
    let points =
        |pixels| if pixels == 0 { 0 } else { lattice_points(pixels, settings.antialiasing) };
    (!settings.adaptive).then(|| points(width) * points(height))
}

/// Returns the number of packets in which the tracer follows the [primary rays](primary_rays) of a
/// tile of `width` x `height` pixels. A packet is not always full: a single pixel with one sample
/// uses one lane.
///
/// Returns `None` for an [adaptive](RenderSettings::adaptive) lattice.
#[must_use]
pub fn primary_packets(
    width: u32,
    height: u32,
    settings: &RenderSettings,
    execution: Execution,
) -> Option<u64> {
    let lanes = execution.lanes.count(settings.arithmetic.precision);
    if settings.has_lattice() && (settings.adaptive || execution.share_samples) {
        let points = |pixels| lattice_points(pixels, settings.antialiasing) as usize;
        // A strip of the lattice is traced at once.
        let strip = |rows: Range<usize>| (points(width) * rows.len()).div_ceil(lanes) as u64;
        let has_pixels = width > 0 && height > 0;
        let packets = || if has_pixels { strips(points(height), BLOCK, strip) } else { 0 };
        return (!settings.adaptive).then(packets);
    }
    let samples = settings.rays_per_pixel() as usize;
    let (side, runs_a_batch) = block(samples);
    let strip = |rows: Range<usize>| {
        let mut runs = Vec::new();
        for_each_run(width as usize, rows, side, |columns, _| runs.push(columns.len() * samples));
        let batches = runs.chunks(runs_a_batch);
        batches.map(|batch| batch.iter().sum::<usize>().div_ceil(lanes) as u64).sum()
    };
    Some(strips(height as usize, side, strip))
}

/// Returns the sum of `packets` over the strips of `height` rows, in which strips of equal height
/// count alike.
fn strips(height: usize, strip: usize, packets: impl Fn(Range<usize>) -> u64) -> u64 {
    let of = |rows: usize| if rows == 0 { 0 } else { packets(0..rows) };
    (height / strip) as u64 * of(strip) + of(height % strip)
}

/// Returns the number of lattice points along `pixels` pixels, 1 or more, with `density` steps
/// each.
pub(crate) fn lattice_points(pixels: u32, density: u32) -> u64 {
    u64::from(density) * (u64::from(pixels) + 1) + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::filter::Filter;
    use crate::scene::Sampling;
    use std::collections::BTreeSet;

    fn settings(antialiasing: u32, sampling: Sampling) -> RenderSettings {
        RenderSettings { antialiasing, sampling, ..RenderSettings::default() }
    }

    /// Catches a step or an edge too many: all pixels' samples, each position once.
    #[test]
    fn a_shared_tile_takes_each_position_of_its_pixels_samples_once() {
        for density in [1, 2, 3, 5, 32] {
            let settings = settings(density, Sampling::Lattice);
            let filter = Filter::<f64>::new(&settings);
            let samples: Vec<(f64, f64)> =
                (0..filter.positions().len()).map(|i| filter.positions().load(i)).collect();
            for (width, height) in [(1, 1), (1, 4), (3, 1), (5, 3)] {
                let mut positions = BTreeSet::new();
                for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
                    // Whole numbers of half lattice steps, `2 s` of them a pixel.
                    let centre = |pixel: u32| i64::from(2 * density * pixel);
                    positions.extend(
                        samples.iter().map(|&(a, b)| (centre(x) + a as i64, centre(y) + b as i64)),
                    );
                }
                let found = primary_rays(width, height, &settings, true);
                assert_eq!(found, Some(positions.len() as u64), "{width} x {height} at {density}");
            }
        }
    }

    #[test]
    fn nothing_shared_is_every_pixel_s_own_samples() {
        assert_eq!(primary_rays(7, 3, &settings(2, Sampling::Lattice), false), Some(21 * 25));
        for share_samples in [false, true] {
            assert_eq!(
                primary_rays(7, 3, &settings(0, Sampling::Lattice), share_samples),
                Some(21)
            );
            assert_eq!(
                primary_rays(7, 3, &settings(2, Sampling::Importance), share_samples),
                Some(21 * 13)
            );
            assert_eq!(primary_rays(0, 3, &settings(2, Sampling::Lattice), share_samples), Some(0));
        }
    }

    /// Catches an overflow: the largest image at the highest density.
    #[test]
    fn the_largest_image_can_be_counted() {
        let settings = settings(32, Sampling::Lattice);
        assert_eq!(primary_rays(65535, 65535, &settings, true), Some(2_097_153 * 2_097_153));
        assert_eq!(primary_rays(65535, 65535, &settings, false), Some(65535 * 65535 * 4225));
    }

    /// Catches a count of rays that adaptive sampling may not trace.
    #[test]
    fn an_adaptive_lattice_is_not_counted_and_other_samples_are() {
        let count = |antialiasing, sampling| {
            let settings = RenderSettings { adaptive: true, ..settings(antialiasing, sampling) };
            [false, true].map(|share_samples| primary_rays(7, 3, &settings, share_samples))
        };
        assert_eq!(count(2, Sampling::Lattice), [None, None]);
        assert_eq!(count(0, Sampling::Lattice), [Some(21), Some(21)]);
        assert_eq!(count(2, Sampling::Importance), [Some(21 * 13), Some(21 * 13)]);
    }
}
