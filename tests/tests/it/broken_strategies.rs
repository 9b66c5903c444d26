//! Deliberately broken strategies: `check` catches each and names the right pixel. The name of a
//! test says what its strategy does wrong.

use crate::gradient::{Gradient, PATIENCE, Panics, threads, tile};
use rayweave_contract::{
    Granularity, Image, Output, Plan, Policy, Prepare, Rect, RenderError, Rgb, Scheduling,
    Strategy, Threads, Tile, Work, render_tile, renderer,
};
use rayweave_measure::{Check, CheckCase, Fault, Finding};
use rayweave_registry::reference;
use std::panic::resume_unwind;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

type Rendered = Result<(), RenderError>;

/// Returns a strategy that renders in its own, wrong way.
fn broken_strategy<'a>(prepare: &'a Prepare<'a>) -> Strategy<'a> {
    let scheduling = Scheduling::Dynamic { chunk: 1 };
    Strategy {
        name: "broken",
        summary: "wrong in one way",
        threads: Threads::PerRender,
        policy: Policy::new(Granularity::Tile, scheduling, Output::InPlace),
        unavailable: None,
        prepare,
    }
}

/// Renders right, to be broken: the thread "share `i % threads`" computes tile `i`.
fn share_out(threads: usize, work: &dyn Work, tiles: Vec<Tile<'_>>) -> Result<(), RenderError> {
    let mut shares: Vec<Vec<Tile<'_>>> = (0..threads).map(|_| Vec::new()).collect();
    for (index, tile) in tiles.into_iter().enumerate() {
        shares[index % threads].push(tile);
    }
    thread::scope(|scope| {
        for (index, mut share) in shares.into_iter().enumerate() {
            let thread = thread::Builder::new().name(format!("share {index}"));
            let compute = move || share.iter_mut().try_for_each(|tile| render_tile(work, tile));
            thread.spawn_scoped(scope, compute).expect("a thread");
        }
    });
    Ok(())
}

fn right(plan: Plan, work: &dyn Work, image: &mut Image) -> Result<(), RenderError> {
    share_out(plan.threads.get(), work, image.tiles(plan.tile))
}

/// A timeout for strategies that lack threads, for which each check would wait.
const IMPATIENCE: Duration = Duration::from_millis(200);

/// Checks 20 x 12 pixels, which are three by two tiles, the last column and row smaller.
fn findings(
    broken: impl Fn(Plan, &dyn Work, &mut Image) -> Rendered + Send + Sync + 'static,
) -> Vec<Finding> {
    findings_at((20, 12), PATIENCE, broken)
}

/// Checks an image of this size with two threads and tiles of 8.
fn findings_at(
    (width, height): (u32, u32),
    timeout: Duration,
    broken: impl Fn(Plan, &dyn Work, &mut Image) -> Rendered + Send + Sync + 'static,
) -> Vec<Finding> {
    let cases =
        [CheckCase { name: "gradient".to_owned(), width, height, work: Box::new(Gradient) }];
    let broken = Arc::new(broken);
    let prepare = |plan| {
        let broken = Arc::clone(&broken);
        renderer(move |work, image| broken(plan, work, image))
    };
    let check = Check {
        reference: reference(),
        strategies: &[broken_strategy(&prepare)],
        cases: &cases,
        threads: &[threads(2)],
        tiles: &[tile(8)],
        timeout: Some(timeout),
    };
    check.run(|_| {}).expect("a reference image").findings
}

/// The tile that a pixel was computed in, and the name of the thread.
type By = (Rect, Option<String>);

/// Returns the only finding, which has to be a difference: the number of pixels, the first of them,
/// the colour found there, the tile and the thread that computed it.
#[track_caller]
fn the_difference(findings: &[Finding]) -> (usize, (u32, u32), Option<Rgb>, Option<By>) {
    let [
        Finding {
            strategy: "broken",
            threads: 2,
            render: Some(render),
            fault: Fault::Different(found),
        },
    ] = findings
    else {
        panic!("not a single difference: {findings:#?}");
    };
    assert_eq!((render.scene.as_str(), render.tile, render.repetition), ("gradient", 8, 1));
    assert_eq!(found.expected, Gradient::color(found.x, found.y));
    let computation =
        found.computation.clone().map(|computation| (computation.tile, computation.thread.name));
    (found.pixels, (found.x, found.y), found.found, computation)
}

#[test]
fn the_strategy_to_break_is_right() {
    assert_eq!(findings(right), []);
}

#[test]
fn drops_a_row() {
    let found = findings(|plan, work, image| {
        let width = image.width() as usize;
        let rows = image.pixels_mut().chunks_mut(width).enumerate();
        let rows = rows.filter(|(y, _)| *y != 6);
        let rows = rows.map(|(y, row)| Tile::row(0, y as u32, row)).collect();
        share_out(plan.threads.get(), work, rows)
    });
    assert_eq!(the_difference(&found), (20, (0, 6), None, None));
}

#[test]
fn swaps_two_tiles() {
    let found = findings(|plan, work, image| {
        right(plan, work, image)?;
        let mut tiles = image.tiles(plan.tile);
        if let [_, first, .., second, _, _] = tiles.as_mut_slice() {
            // The second and fourth of six; they have the first four rows in common.
            for ((_, a), (_, b)) in first.rows().zip(second.rows()) {
                a.swap_with_slice(b);
            }
        }
        Ok(())
    });
    let rect = Rect { x: 8, y: 0, width: 8, height: 8 };
    let by = Some((rect, Some("share 1".to_owned())));
    assert_eq!(the_difference(&found), (64, (8, 0), Some(Gradient::color(0, 8)), by));
}

#[test]
fn writes_a_pixel_twice_with_a_torn_value() {
    let found = findings(|plan, work, image| {
        right(plan, work, image)?;
        if image.width() == 20 {
            let mut color = [0.0; 3];
            render_tile(work, &mut Tile::pixel(5, 9, &mut color))?;
            let [red, _, blue] = color;
            image.pixels_mut()[9 * 20 + 5] = [red, color[0], blue];
        }
        Ok(())
    });
    let [different, twice, third_thread] = found.as_slice() else {
        panic!("{found:#?}");
    };
    assert_eq!(third_thread.fault, Fault::TooManyThreads { expected: 2, found: 3 });
    let Fault::NotOnce { pixels: 1, x: 5, y: 9, computations } = &twice.fault else {
        panic!("{twice:#?}");
    };
    let pixel = Rect { x: 5, y: 9, width: 1, height: 1 };
    let tiles: Vec<Rect> = computations.iter().map(|computation| computation.tile).collect();
    assert_eq!(tiles, [Rect { x: 0, y: 8, width: 8, height: 4 }, pixel]);

    let [red, _, blue] = Gradient::color(5, 9);
    let (pixels, first, color, by) = the_difference(std::slice::from_ref(different));
    assert_eq!((pixels, first, color), (1, (5, 9), Some([red, red, blue])));
    assert_eq!(by.map(|(tile, _)| tile), Some(pixel), "the last to compute it");
}

#[test]
fn computes_a_tile_twice_with_the_same_result() {
    let found = findings(|plan, work, image| {
        right(plan, work, image)?;
        let tiles = image.tiles(plan.tile);
        if tiles.len() == 6 {
            share_out(1, work, tiles.into_iter().skip(5).collect())
        } else {
            Ok(())
        }
    });
    let [Finding { fault: Fault::NotOnce { pixels, x, y, computations }, .. }, third_thread] =
        found.as_slice()
    else {
        panic!("{found:#?}");
    };
    assert_eq!(third_thread.fault, Fault::TooManyThreads { expected: 2, found: 3 });
    assert_eq!((*pixels, *x, *y), (16, 16, 8));
    let names: Vec<_> = computations.iter().filter_map(|c| c.thread.name.as_deref()).collect();
    assert_eq!(names, ["share 1", "share 0"]);
}

#[test]
fn stops_early() {
    let found = findings(|plan, work, image| {
        let mut tiles = image.tiles(plan.tile);
        tiles.pop();
        share_out(plan.threads.get(), work, tiles)
    });
    assert_eq!(the_difference(&found), (16, (16, 8), None, None));
}

#[test]
fn computes_but_does_not_store() {
    let found = findings(|plan, work, image| {
        let mut elsewhere = image.clone();
        right(plan, work, &mut elsewhere)?;
        let pixels = image.pixels().len();
        image.pixels_mut()[..pixels - 3].copy_from_slice(&elsewhere.pixels()[..pixels - 3]);
        Ok(())
    });
    let by = (Rect { x: 16, y: 8, width: 4, height: 4 }, Some("share 1".to_owned()));
    assert_eq!(the_difference(&found), (3, (17, 11), None, Some(by)));
}

#[test]
fn computes_with_another_number_of_threads() {
    type Count = fn(Plan, &Image) -> usize;
    let cases: [(Count, Duration, &[usize]); 5] = [
        (|_, _| 1, IMPATIENCE, &[1]),
        // Once while its threads are counted, once for the image.
        (|plan, _| plan.threads.get() + 1, PATIENCE, &[3, 3]),
        (|plan, _| if plan.tile.get() > 1 { 1 } else { plan.threads.get() }, IMPATIENCE, &[1]),
        // There are four tiles to meet over, so no more than four threads meet; the image has six.
        (|plan, _| if plan.tile.get() > 1 { 6 } else { plan.threads.get() }, PATIENCE, &[4, 6]),
        // Right whenever its threads are counted: only the image's own threads give it away.
        (|plan, image| plan.threads.get() + usize::from(image.width() == 20), PATIENCE, &[3]),
    ];
    for (i, (count, timeout, found)) in cases.into_iter().enumerate() {
        let findings = findings_at((20, 12), timeout, move |plan, work, image| {
            share_out(count(plan, image), work, image.tiles(plan.tile))
        });
        let expected: Vec<_> = found.iter().map(|&found| wrong_number(2, found)).collect();
        assert_eq!(faults(&findings), expected.iter().collect::<Vec<_>>(), "case {i}");
        let place = findings[0].render.as_ref().map(|render| render.scene.as_str());
        match i {
            2 => assert_eq!(
                findings[0].to_string(),
                "broken, 2 threads, rendezvous 8x32, tiles of 8: \
                 computing threads: expected 2, found 1: only one thread was inside the work at \
                 any time within 0.2 s (a lock held while computing?)"
            ),
            4 => assert_eq!(place, Some("gradient")),
            _ => {}
        }
    }
}

#[test]
fn joins_one_thread_before_the_next() {
    let found = findings_at((20, 12), IMPATIENCE, |plan, work, image| {
        let mut tiles = image.tiles(plan.tile);
        let share = tiles.len().div_ceil(plan.threads.get());
        for tiles in tiles.chunks_mut(share) {
            let compute = || tiles.iter_mut().try_for_each(|tile| render_tile(work, tile));
            thread::scope(|scope| scope.spawn(compute).join()).expect("no panic")?;
        }
        Ok(())
    });
    assert_eq!(faults(&found), [&wrong_number(2, 1)]);
}

#[test]
fn computes_with_a_lock_held() {
    let lock = Mutex::new(());
    let found = findings_at((20, 12), IMPATIENCE, move |plan, work, image| {
        share_out(plan.threads.get(), &Locked { work, lock: &lock }, image.tiles(plan.tile))
    });
    assert_eq!(faults(&found), [&wrong_number(2, 1)]);
}

/// A work that only one thread at a time computes.
struct Locked<'a> {
    work: &'a dyn Work,
    lock: &'a Mutex<()>,
}

impl Work for Locked<'_> {
    fn render(&self, tile: &mut Tile<'_>) {
        let _held = self.lock.lock();
        self.work.render(tile);
    }
}

/// Catches a check that waits for a strategy with too few threads more than once.
#[test]
fn is_waited_for_once() {
    let alone =
        |plan: Plan| renderer(move |work, image| share_out(1, work, image.tiles(plan.tile)));
    let check = Check {
        reference: reference(),
        strategies: &[broken_strategy(&alone)],
        cases: &[],
        threads: &[threads(1), threads(2), threads(3)],
        tiles: &[tile(1), tile(8)],
        timeout: Some(IMPATIENCE),
    };
    let mut counted = Vec::new();
    let verdict = check.run(|progress| {
        assert!(progress.is_counting, "there is no image to render");
        counted.push(progress.threads);
    });
    let found = verdict.expect("a reference image").findings;
    assert_eq!(faults(&found), [&wrong_number(2, 1)]);
    assert_eq!(counted, [1, 1, 2]);

    let not_counted = Check { timeout: None, ..check }.run(|_| panic!("nothing to do"));
    assert_eq!(not_counted.expect("a reference image").findings, []);
}

#[test]
fn is_wrong_by_one_ulp_in_one_pixel() {
    let found = findings(|plan, work, image| {
        right(plan, work, image)?;
        if let Some(color) = image.pixels_mut().get_mut(7 * 20 + 13) {
            color[1] = color[1].next_up();
        }
        Ok(())
    });
    let [red, green, blue] = Gradient::color(13, 7);
    let by = (Rect { x: 8, y: 0, width: 8, height: 8 }, Some("share 1".to_owned()));
    assert_eq!(the_difference(&found), (1, (13, 7), Some([red, green.next_up(), blue]), Some(by)));
}

#[test]
fn turns_zero_negative() {
    let found = findings(|plan, work, image| {
        right(plan, work, image)?;
        // Equal as numbers: 0 is the blue of the first pixel.
        image.pixels_mut()[0][2] = -0.0;
        Ok(())
    });
    let (pixels, first, color, _) = the_difference(&found);
    assert_eq!((pixels, first), (1, (0, 0)));
    assert!(color.is_some_and(|[_, _, blue]| blue.to_bits() == (-0.0f32).to_bits()));
}

#[test]
fn leaves_the_last_column_of_odd_widths() {
    let forgetful = |plan: Plan, work: &dyn Work, image: &mut Image| {
        let width = image.width() as usize;
        let rows = image.pixels_mut().chunks_mut(width).enumerate();
        let rows = rows.map(|(y, row)| Tile::row(0, y as u32, &mut row[..width / 2 * 2])).collect();
        share_out(plan.threads.get(), work, rows)
    };
    assert_eq!(findings(forgetful), []);
    let found = findings_at((7, 3), PATIENCE, forgetful);
    assert_eq!(the_difference(&found), (3, (6, 0), None, None));
}

#[test]
fn returns_an_error() {
    let found = findings_at((20, 12), IMPATIENCE, |_, work, image| {
        // A work that panics, as a strategy sees it.
        let panics = Panics { work, x: 3, y: 1 };
        image.tiles(tile(2)).iter_mut().try_for_each(|tile| render_tile(&panics, tile))
    });
    // Once while its threads are counted, once for the image.
    let message = "broken: the work panicked in the tile 2x2 at (2, 0): injected".to_owned();
    assert_eq!(faults(&found), [&Fault::Failed(message.clone()), &Fault::Failed(message)]);
}

#[test]
fn lets_a_panic_through() {
    let found = findings(|_, _, _| resume_unwind(Box::new("out of luck")));
    let message = "the strategy panicked: out of luck".to_owned();
    assert_eq!(faults(&found), [&Fault::Failed(message.clone()), &Fault::Failed(message)]);
}

#[test]
fn replaces_the_image_by_a_smaller_one() {
    let found = findings(|plan, work, image| {
        right(plan, work, image)?;
        *image = Image::new(3, 2).expect("an image");
        Ok(())
    });
    let message = "the image was replaced by one of 3x2".to_owned();
    assert_eq!(faults(&found), [&Fault::Failed(message)]);
}

#[test]
fn does_not_compute_the_second_time() {
    let memory = Mutex::new(None);
    let found = findings(move |plan, work, image| {
        let mut memory = memory.lock().expect("no panic");
        match &*memory {
            Some(first) if image.width() == 20 => image.clone_from(first),
            _ => {
                right(plan, work, image)?;
                *memory = (image.width() == 20).then(|| image.clone());
            }
        }
        Ok(())
    });
    assert_eq!(
        faults(&found),
        [&Fault::NotOnce { pixels: 240, x: 0, y: 0, computations: Vec::new() }]
    );
    assert_eq!(found[0].render.as_ref().map(|render| render.repetition), Some(2));
}

/// Returns the fault of `found` threads, waited for with [`IMPATIENCE`].
fn wrong_number(expected: usize, found: usize) -> Fault {
    if found > expected {
        return Fault::TooManyThreads { expected, found };
    }
    Fault::TooFewThreads { expected, found, waited: IMPATIENCE }
}

fn faults(findings: &[Finding]) -> Vec<&Fault> {
    findings.iter().map(|finding| &finding.fault).collect()
}
