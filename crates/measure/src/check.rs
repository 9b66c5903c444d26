//! Proof that strategies agree: each against the reference, bit for bit.
//!
//! Every strategy is prepared for every number of threads and size of tile, and the renderer so
//! prepared renders every image twice: it has to draw the same image again, and to be the same
//! after images of other sizes. Before each rendering the image is poisoned, so that a pixel
//! that nobody writes shows itself, and a [`Recorder`] around the work knows who computed what.
//! That as many threads compute as were asked for, a [`Rendezvous`] shows.

use crate::catch_panic::catch_panic;
use crate::computing_threads::Rendezvous;
use crate::finding::{CheckedRender, Fault, Finding, ImageDifference};
use crate::recorder::{Recorder, TileRecord};
use crate::sentinel;
use rayweave_contract::{Image, ImageError, Plan, Renderer, Rgb, Strategy, Threads, Work};
use std::fmt;
use std::num::{NonZeroU32, NonZeroUsize};
use std::time::Duration;
use thiserror::Error;

/// The times that a renderer draws each image.
const REPETITIONS: usize = 2;

/// A work and the size of the image that is made of it.
pub struct CheckCase<'a> {
    /// What findings call it.
    pub name: String,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// What is rendered.
    pub work: Box<dyn Work + 'a>,
}

/// What is checked: every strategy with every number of threads, size of tile and case.
///
/// A strategy that starts no threads is checked as the one thread that it is.
#[derive(Clone, Copy)]
pub struct Check<'a> {
    /// What gives the right image.
    pub reference: &'a dyn Strategy,
    /// What has to give the same; the reference may be among them.
    pub strategies: &'a [&'a dyn Strategy],
    /// What is rendered.
    pub cases: &'a [CheckCase<'a>],
    /// Numbers of computing threads.
    pub threads: &'a [NonZeroUsize],
    /// Sides of a tile, in pixels.
    pub tiles: &'a [NonZeroU32],
    /// How long a strategy with too few threads is waited for; usually
    /// [`TIMEOUT`](crate::computing_threads::TIMEOUT).
    pub timeout: Duration,
}

/// How far a check is; told before each rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckProgress {
    /// The strategy that is being checked.
    pub strategy: &'static str,
    /// For so many computing threads.
    pub threads: usize,
    /// Renderings done; what is left out after a failure counts as done.
    pub done: usize,
    /// Renderings altogether.
    pub total: usize,
}

/// What a check found.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// What was checked.
    pub checked: Vec<Checked>,
    /// The number of images that were compared with the reference.
    pub compared: usize,
    /// Everything that is wrong, strategy by strategy; empty when all agree.
    pub findings: Vec<Finding>,
}

/// What a [`Check`] was: every strategy with every number of threads, size of tile and image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checked {
    /// Of the strategies.
    pub strategies: Vec<&'static str>,
    /// Name, width and height of each case.
    pub images: Vec<(String, u32, u32)>,
    /// Numbers of computing threads.
    pub threads: Vec<usize>,
    /// Sides of a tile, in pixels.
    pub tiles: Vec<u32>,
}

/// Why nothing could be checked.
#[derive(Debug, Error)]
pub enum CheckError {
    /// A case whose image cannot be.
    #[error("{name}: {source}")]
    Image {
        /// The case.
        name: String,
        /// The reason.
        source: ImageError,
    },
    /// The reference gave no image to compare with.
    #[error("{name}: the reference failed: {message}")]
    Reference {
        /// The case.
        name: String,
        /// The strategy's message.
        message: String,
    },
}

impl Verdict {
    /// Whether all strategies agree with the reference.
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
            |strategy: &&dyn Strategy| self.threads_of(*strategy).len() * self.tiles.len();
        let total = self.strategies.iter().map(settings).sum::<usize>() * pairs.len() * REPETITIONS;

        let verdict = Verdict { checked: vec![self.checked()], compared: 0, findings: Vec::new() };
        let mut run = Run { pairs: &pairs, verdict, done: 0, total, progress: &mut progress };
        for &strategy in self.strategies {
            for &threads in self.threads_of(strategy) {
                let plans = self.tiles.iter().map(|&tile| Plan { threads, tile });
                // Up to the first wrong number: each of too few would wait for the timeout again.
                let _ =
                    plans.clone().all(|plan| run.threads_are_right(strategy, plan, self.timeout));
                plans.for_each(|plan| run.render_all(strategy, plan));
            }
        }
        Ok(run.verdict)
    }

    fn checked(&self) -> Checked {
        Checked {
            strategies: self.strategies.iter().map(|strategy| strategy.name()).collect(),
            images: self
                .cases
                .iter()
                .map(|case| (case.name.clone(), case.width, case.height))
                .collect(),
            threads: self.threads.iter().map(|threads| threads.get()).collect(),
            tiles: self.tiles.iter().map(|tile| tile.get()).collect(),
        }
    }

    /// The numbers of threads that make a difference to `strategy`.
    fn threads_of(&self, strategy: &dyn Strategy) -> &'a [NonZeroUsize] {
        match strategy.threads() {
            Threads::None => &[NonZeroUsize::MIN],
            Threads::Pool | Threads::PerRender => self.threads,
        }
    }

    fn reference_image(&self, case: &CheckCase<'_>) -> Result<Image, CheckError> {
        // Black, where every other image starts as poison: what the reference fails to write
        // differs.
        let mut image = Image::new(case.width, case.height)
            .map_err(|source| CheckError::Image { name: case.name.clone(), source })?;
        let tile = self.tiles.first().copied().unwrap_or(NonZeroU32::MIN);
        let plan = Plan { threads: NonZeroUsize::MIN, tile };
        catch_panic(|| self.reference.prepare(plan)?.render(&*case.work, &mut image))
            .map_err(|message| CheckError::Reference { name: case.name.clone(), message })?;
        Ok(image)
    }
}

/// A check under way.
struct Run<'a> {
    /// Each case with the reference's image of it.
    pairs: &'a [(&'a CheckCase<'a>, Image)],
    verdict: Verdict,
    done: usize,
    total: usize,
    progress: &'a mut dyn FnMut(CheckProgress),
}

impl Run<'_> {
    fn threads_are_right(
        &mut self,
        strategy: &dyn Strategy,
        plan: Plan,
        timeout: Duration,
    ) -> bool {
        let rendezvous = Rendezvous::of(plan);
        let fault = match rendezvous.computing_threads(strategy, timeout) {
            Ok(found) if found == plan.threads.get() => return true,
            Ok(found) => Fault::Threads { expected: plan.threads.get(), found },
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

    fn render_all(&mut self, strategy: &dyn Strategy, plan: Plan) {
        let mut renderer = match catch_panic(|| strategy.prepare(plan)) {
            Ok(renderer) => renderer,
            Err(message) => {
                self.done += self.pairs.len() * REPETITIONS;
                return self.found(strategy, plan.threads, None, Fault::Failed(message));
            }
        };
        for (case, expected) in self.pairs {
            for repetition in 0..REPETITIONS {
                (self.progress)(CheckProgress {
                    strategy: strategy.name(),
                    threads: plan.threads.get(),
                    done: self.done + repetition,
                    total: self.total,
                });
                self.verdict.compared += 1;
                let faults =
                    render_and_compare(&mut *renderer, plan.threads, &*case.work, expected);
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
                // What is wrong already need not be shown to be wrong again.
                break;
            }
            self.done += REPETITIONS;
        }
    }

    fn found(
        &mut self,
        strategy: &dyn Strategy,
        threads: NonZeroUsize,
        render: Option<CheckedRender>,
        fault: Fault,
    ) {
        let (strategy, threads) = (strategy.name(), threads.get());
        self.verdict.findings.push(Finding { strategy, threads, render, fault });
    }
}

/// Renders into a poisoned image and says what is wrong with it, if anything.
fn render_and_compare(
    renderer: &mut dyn Renderer,
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

/// Fewer than were asked for prove nothing: a thread may find all the work done.
fn too_many_threads(expected: usize, found: usize) -> Option<Fault> {
    (found > expected).then_some(Fault::Threads { expected, found })
}

fn difference(expected: &Image, found: &Image, record: &TileRecord) -> Option<Fault> {
    let pairs = expected.pixels().iter().zip(found.pixels());
    let mut differing =
        pairs.enumerate().filter(|(_, (expected, found))| !same_bits(**expected, **found));
    let (index, (&expected, &color)) = differing.next()?;
    let (x, y) = found.position(index);
    Some(Fault::Different(ImageDifference {
        pixels: 1 + differing.count(),
        x,
        y,
        expected,
        found: (!sentinel::untouched(color)).then_some(color),
        computation: record.of_pixel(x, y).pop(),
    }))
}

/// Pixels computed several times, or written without being computed. Those that were not written
/// either are a difference already.
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
