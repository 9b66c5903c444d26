//! Checks that every strategy gives the reference's image, bit for bit.
//!
//! Every strategy is prepared for every number of threads and size of tile. The same renderer
//! renders every image twice, so its second rendering and images of other sizes are checked too.
//! The image is filled with a sentinel before each rendering to find pixels that are not written.
//! A [`Recorder`] around the work knows the tile and the thread of each pixel, and a [`Rendezvous`]
//! counts the computing threads.

use crate::catch_panic::catch_panic;
use crate::computing_threads::Rendezvous;
use crate::finding::{CheckedRender, Fault, Finding, PixelDifference};
use crate::recorder::{Recorder, TileRecord};
use crate::sentinel;
use rayweave_contract::{Image, ImageError, Plan, Renderer, Rgb, Strategy, Threads, Work};
use serde::Serialize;
use std::fmt;
use std::num::{NonZeroU32, NonZeroUsize};
use std::time::Duration;
use thiserror::Error;

/// The number of times that a renderer renders each image.
const REPETITIONS: usize = 2;

/// A work to check with, and the size of its image.
pub struct CheckCase<'a> {
    /// The name in findings.
    pub name: String,
    /// The width of the image in pixels.
    pub width: u32,
    /// The height of the image in pixels.
    pub height: u32,
    /// The work to render.
    pub work: Box<dyn Work + 'a>,
}

/// A check of every strategy with every number of threads, size of tile and case.
///
/// A strategy that starts no threads is checked with one thread.
#[derive(Clone, Copy)]
pub struct Check<'a> {
    /// The strategy that gives the right image.
    pub reference: Strategy<'a>,
    /// The strategies to check; the reference may be among them.
    pub strategies: &'a [Strategy<'a>],
    /// The works to render.
    pub cases: &'a [CheckCase<'a>],
    /// The numbers of computing threads.
    pub threads: &'a [NonZeroUsize],
    /// The sides of a tile in pixels.
    pub tiles: &'a [NonZeroU32],
    /// The time to wait for missing threads, usually
    /// [`TIMEOUT`](crate::computing_threads::TIMEOUT); `None` if the threads are counted already.
    pub timeout: Option<Duration>,
}

/// The progress of a check before each count of threads and each rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckProgress {
    /// The strategy that is being checked.
    pub strategy: &'static str,
    /// The number of computing threads.
    pub threads: usize,
    /// The number of renderings done; those left out after a failure count as done.
    pub done: usize,
    /// The number of all renderings.
    pub total: usize,
    /// True while the check waits for all threads to meet, for up to the timeout.
    pub is_counting: bool,
}

/// The result of a check.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// The combinations that were checked.
    pub checked: Vec<Checked>,
    /// The number of images that were compared with the reference.
    pub compared: usize,
    /// All findings, strategy by strategy; empty if all strategies agree.
    pub findings: Vec<Finding>,
}

/// The combinations of a [`Check`]: every strategy with every number of threads, tile and image.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Checked {
    /// The names of the strategies.
    pub strategies: Vec<&'static str>,
    /// The image of each case.
    #[serde(rename = "pictures")]
    pub images: Vec<CheckedImage>,
    /// The numbers of computing threads.
    pub threads: Vec<usize>,
    /// The sides of a tile in pixels.
    pub tiles: Vec<u32>,
}

/// The name of a case, and the size of its image in pixels.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct CheckedImage {
    /// The name of the work.
    pub scene: String,
    /// Width of the image.
    pub width: u32,
    /// Height of the image.
    pub height: u32,
}

/// An error that leaves nothing to check.
#[derive(Debug, Error)]
pub enum CheckError {
    /// A case has no possible image.
    #[error("{name}: {source}")]
    Image {
        /// The case.
        name: String,
        /// The reason.
        source: ImageError,
    },
    /// The reference failed.
    #[error("{name}: the reference failed: {message}")]
    Reference {
        /// The case.
        name: String,
        /// The strategy's message.
        message: String,
    },
}

impl Verdict {
    /// Returns whether all strategies agree with the reference.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.findings.is_empty()
    }
}

impl<'a> Check<'a> {
    /// Checks everything, and goes on after a finding.
    ///
    /// # Errors
    ///
    /// There is no reference image to compare with.
    pub fn run(&self, mut progress: impl FnMut(CheckProgress)) -> Result<Verdict, CheckError> {
        let mut pairs = Vec::with_capacity(self.cases.len());
        for case in self.cases {
            pairs.push((case, self.reference_image(case)?));
        }
        let settings =
            |strategy: &Strategy<'_>| self.threads_of(*strategy).len() * self.tiles.len();
        let total = self.strategies.iter().map(settings).sum::<usize>() * pairs.len() * REPETITIONS;

        let verdict = Verdict { checked: vec![self.checked()], compared: 0, findings: Vec::new() };
        let mut run = Run { pairs: &pairs, verdict, done: 0, total, progress: &mut progress };
        for &strategy in self.strategies {
            // Set until the first wrong number: each further count would wait for as long again.
            let mut timeout = self.timeout;
            for &threads in self.threads_of(strategy) {
                let plans = self.tiles.iter().map(|&tile| Plan { threads, tile });
                for plan in plans.clone() {
                    timeout = timeout.filter(|&time| run.threads_are_right(strategy, plan, time));
                }
                plans.for_each(|plan| run.render_all(strategy, plan));
            }
        }
        Ok(run.verdict)
    }

    fn checked(&self) -> Checked {
        Checked {
            strategies: self.strategies.iter().map(|strategy| strategy.name).collect(),
            images: self
                .cases
                .iter()
                .map(|case| CheckedImage {
                    scene: case.name.clone(),
                    width: case.width,
                    height: case.height,
                })
                .collect(),
            threads: self.threads.iter().map(|threads| threads.get()).collect(),
            tiles: self.tiles.iter().map(|tile| tile.get()).collect(),
        }
    }

    /// Returns the numbers of threads to check `strategy` with.
    fn threads_of(&self, strategy: Strategy<'_>) -> &'a [NonZeroUsize] {
        match strategy.threads {
            Threads::None => &[NonZeroUsize::MIN],
            Threads::Pool | Threads::PerRender => self.threads,
        }
    }

    fn reference_image(&self, case: &CheckCase<'_>) -> Result<Image, CheckError> {
        // Black, where every other image starts as the sentinel: pixels that the reference does
        // not write differ.
        let mut image = Image::new(case.width, case.height)
            .map_err(|source| CheckError::Image { name: case.name.clone(), source })?;
        let tile = self.tiles.first().copied().unwrap_or(NonZeroU32::MIN);
        let plan = Plan { threads: NonZeroUsize::MIN, tile };
        catch_panic(|| self.reference.prepare(plan)?.render(&*case.work, &mut image))
            .map_err(|message| CheckError::Reference { name: case.name.clone(), message })?;
        Ok(image)
    }
}

/// The state of a running check.
struct Run<'a> {
    /// The cases, each with the reference's image.
    pairs: &'a [(&'a CheckCase<'a>, Image)],
    verdict: Verdict,
    done: usize,
    total: usize,
    progress: &'a mut dyn FnMut(CheckProgress),
}

impl Run<'_> {
    fn threads_are_right(&mut self, strategy: Strategy<'_>, plan: Plan, timeout: Duration) -> bool {
        self.tell(strategy, plan.threads, self.done, true);
        let rendezvous = Rendezvous::of(plan);
        let expected = plan.threads.get();
        let fault = match rendezvous.computing_threads(strategy, timeout) {
            Ok(found) if found == expected => return true,
            Ok(found) if found > expected => Fault::TooManyThreads { expected, found },
            Ok(found) => Fault::TooFewThreads { expected, found, waited: timeout },
            Err(error) => Fault::Failed(error.to_string()),
        };
        let render = CheckedRender {
            scene: "rendezvous".to_owned(),
            width: rendezvous.width,
            height: rendezvous.height,
            tile: rendezvous.plan.tile.get(),
            repetition: 1,
        };
        self.found(strategy, plan.threads, Some(render), fault);
        false
    }

    fn render_all(&mut self, strategy: Strategy<'_>, plan: Plan) {
        let mut renderer = match catch_panic(|| strategy.prepare(plan)) {
            Ok(renderer) => renderer,
            Err(message) => {
                self.done += self.pairs.len() * REPETITIONS;
                return self.found(strategy, plan.threads, None, Fault::Failed(message));
            }
        };
        for (case, expected) in self.pairs {
            for repetition in 0..REPETITIONS {
                self.tell(strategy, plan.threads, self.done + repetition, false);
                self.verdict.compared += 1;
                let faults = render_and_compare(&mut renderer, plan.threads, &*case.work, expected);
                if faults.is_empty() {
                    continue;
                }
                let render = CheckedRender {
                    scene: case.name.clone(),
                    width: case.width,
                    height: case.height,
                    tile: plan.tile.get(),
                    repetition: repetition + 1,
                };
                for fault in faults {
                    self.found(strategy, plan.threads, Some(render.clone()), fault);
                }
                // A second rendering would only repeat the findings.
                break;
            }
            self.done += REPETITIONS;
        }
    }

    fn tell(
        &mut self,
        strategy: Strategy<'_>,
        threads: NonZeroUsize,
        done: usize,
        is_counting: bool,
    ) {
        let (strategy, threads, total) = (strategy.name, threads.get(), self.total);
        (self.progress)(CheckProgress { strategy, threads, done, total, is_counting });
    }

    fn found(
        &mut self,
        strategy: Strategy<'_>,
        threads: NonZeroUsize,
        render: Option<CheckedRender>,
        fault: Fault,
    ) {
        let (strategy, threads) = (strategy.name, threads.get());
        self.verdict.findings.push(Finding { strategy, threads, render, fault });
    }
}

/// Renders into an image filled with the sentinel and returns the faults.
fn render_and_compare(
    renderer: &mut Renderer,
    threads: NonZeroUsize,
    work: &dyn Work,
    expected: &Image,
) -> Vec<Fault> {
    let mut found = expected.clone();
    sentinel::fill(&mut found);
    let recorder = Recorder::new(work);
    if let Err(message) = catch_panic(|| renderer.render(&recorder, &mut found)) {
        return vec![Fault::Failed(message)];
    }
    if (found.width(), found.height()) != (expected.width(), expected.height()) {
        let message =
            format!("the image was replaced by one of {}x{}", found.width(), found.height());
        return vec![Fault::Failed(message)];
    }
    let record = recorder.finish();
    let faults = [
        difference(expected, &found, &record),
        not_once(&found, &record),
        too_many_threads(threads.get(), record.threads()),
    ];
    faults.into_iter().flatten().collect()
}

/// Returns a fault if there are more threads than expected. Fewer are none: a thread may come when
/// the others have done all the work.
fn too_many_threads(expected: usize, found: usize) -> Option<Fault> {
    (found > expected).then_some(Fault::TooManyThreads { expected, found })
}

fn difference(expected: &Image, found: &Image, record: &TileRecord) -> Option<Fault> {
    let pairs = expected.pixels().iter().zip(found.pixels());
    let mut differing =
        pairs.enumerate().filter(|(_, (expected, found))| !same_bits(**expected, **found));
    let (index, (&expected, &color)) = differing.next()?;
    let (x, y) = found.position(index);
    Some(Fault::Different(PixelDifference {
        pixels: 1 + differing.count(),
        x,
        y,
        expected,
        found: (!sentinel::untouched(color)).then_some(color),
        computation: record.of_pixel(x, y).pop(),
    }))
}

/// Returns a fault if pixels were computed several times, or written without being computed. Pixels
/// that were not written either are a difference already.
fn not_once(found: &Image, record: &TileRecord) -> Option<Fault> {
    let times = record.times_computed(found.width(), found.height());
    let mut wrong =
        times.iter().zip(found.pixels()).enumerate().filter(|(_, (times, color))| match **times {
            0 => !sentinel::untouched(**color),
            1 => false,
            _ => true,
        });
    let (index, _) = wrong.next()?;
    let (x, y) = found.position(index);
    Some(Fault::NotOnce { pixels: 1 + wrong.count(), x, y, computations: record.of_pixel(x, y) })
}

fn same_bits(a: Rgb, b: Rgb) -> bool {
    a.map(f32::to_bits) == b.map(f32::to_bits)
}

impl fmt::Debug for CheckCase<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "CheckCase({}, {}x{})", self.name, self.width, self.height)
    }
}
