//! Measures the cost of a strategy beside its work, on synthetic work: dispatch of a piece, the
//! smallest efficient task, the smallest image that is faster, and the first use.
//!
//! All strategies are measured in interleaved [rounds](crate::rounds), and every image is verified.

mod curve;

use crate::catch_panic::catch_panic;
use crate::rounds::Protocol;
use crate::statistics::{Interval, median, median_interval};
use crate::synthetic;
use crate::timed_image::{DispatchProbe, TimedImage};
use curve::{break_even, metg};
use rayweave_contract::{Granularity, Plan, Renderer, Strategy};
use std::num::{NonZeroU32, NonZeroUsize};
use std::time::Instant;
use thiserror::Error;

/// The pixels of the column of tasks. A task is one pixel, or a band for a strategy of bands.
pub const TASKS: u32 = 1024;

/// The cost of a pixel in the images of the break-even, in nanoseconds.
pub const PIXEL_NS: f64 = 100.0;

/// The largest side that is tried for the break-even.
pub const LARGEST_SIDE: u32 = 512;

/// The side of a tile in these images.
pub const TILE: NonZeroU32 = NonZeroU32::new(32).expect("32 is not 0");

/// The efficiency that defines the smallest task, as a share of the largest efficiency.
const LEAST_EFFICIENCY: f64 = 0.5;

/// The logarithm to base 2 of the steps of the largest task; the smallest has one step.
const LARGEST_TASK: u32 = 14;

/// The side of the image for the first use, in pixels.
const FIRST_SIDE: u32 = 64;

/// A measurement of overheads.
#[derive(Clone, Copy)]
pub struct Overhead<'a> {
    /// The strategy that break-even is relative to, and that steps are timed with.
    pub reference: Strategy<'a>,
    /// The strategies to measure; the reference may be among them.
    pub strategies: &'a [Strategy<'a>],
    /// The number of computing threads.
    pub threads: NonZeroUsize,
    /// The number of rounds and the time for them.
    pub protocol: Protocol,
}

/// The overheads of some strategies.
#[derive(Clone, Debug, PartialEq)]
pub struct OverheadStudy {
    /// The rows, one for each strategy, in their order.
    pub rows: Vec<OverheadRow>,
    /// The time of a step of the synthetic work, in nanoseconds.
    pub step_ns: f64,
    /// The number of rounds measured.
    pub rounds: usize,
}

/// The overheads of one strategy.
#[derive(Clone, Debug, PartialEq)]
pub struct OverheadRow {
    /// The strategy's name.
    pub strategy: &'static str,
    /// The granularity of its pieces.
    pub granularity: Granularity,
    /// The number of computing threads.
    pub threads: usize,
    /// The figures, or the reason why there are none.
    pub figures: Result<OverheadFigures, Failure>,
}

/// The cost of a strategy beside its work; times in nanoseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverheadFigures {
    /// The dispatch of a piece on one thread; `None` for bands, of which there are as many as
    /// threads.
    pub dispatch_one: Option<Interval>,
    /// The dispatch of a piece on all threads, in wall time.
    pub dispatch_all: Option<Interval>,
    /// The minimum effective task granularity: the time of the smallest task that leaves half of
    /// the largest efficiency. `None` if the smallest task that was tried, of one step, does.
    /// Source: Slaughter et al., "Task Bench", 2020.
    pub metg: Option<f64>,
    /// The side in pixels of the smallest square image from which on the strategy is faster than
    /// the reference; `None` if it never is, up to [`LARGEST_SIDE`].
    pub break_even: Option<f64>,
    /// The time to prepare the strategy.
    pub prepare: Interval,
    /// The time of the first rendering of a small image after that.
    pub first: Interval,
    /// The time of a later rendering of the same image.
    pub later: Interval,
}

/// The reason why a strategy has no figures.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Failure {
    /// The strategy is not available here, or could not start its threads.
    #[error("{0}")]
    Preparing(String),
    /// The strategy failed, or gave a wrong image.
    #[error("{0}")]
    Rendering(String),
}

/// An error that leaves nothing to measure.
#[derive(Debug, Error)]
pub enum OverheadError {
    /// The reference failed, which steps are timed with.
    #[error("the reference failed: {0}")]
    Reference(String),
}

impl OverheadStudy {
    /// Returns whether every image of synthetic work was right. A strategy that is not available
    /// renders none.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.rows.iter().all(|row| !matches!(row.figures, Err(Failure::Rendering(_))))
    }
}

impl Overhead<'_> {
    /// Measures all strategies. `progress` gets the share that is done, between timed spans.
    ///
    /// # Errors
    ///
    /// The reference fails. If another strategy fails, its row has the reason.
    pub fn run(&self, mut progress: impl FnMut(&str, f64)) -> Result<OverheadStudy, OverheadError> {
        let begin = Instant::now();
        let mut workloads = Workloads::new(self.reference).map_err(OverheadError::Reference)?;
        let strategies: Vec<Strategy<'_>> =
            std::iter::once(self.reference).chain(self.strategies.iter().copied()).collect();
        let mut samples: Vec<Result<Samples, Failure>> =
            vec![Ok(Samples::default()); strategies.len()];
        let mut rounds = self.protocol.rounds(strategies.len());
        while let Some(slot) = rounds.next(begin.elapsed()) {
            let strategy = strategies[slot.entry];
            progress(strategy.name, slot.fraction);
            // Without the reference there are no figures.
            if samples[0].is_err() {
                break;
            }
            let so_far = &mut samples[slot.entry];
            let measured =
                if so_far.is_ok() { self.measure(strategy, &mut workloads) } else { continue };
            match (so_far.as_mut(), measured) {
                // The warm-up is not a sample.
                (Ok(samples), Ok(round)) if slot.round.is_some() => samples.rounds.push(round),
                (_, Err(error)) => *so_far = Err(error),
                _ => {}
            }
        }
        let mut samples = samples.into_iter();
        let reference = samples.next().unwrap_or_else(|| Ok(Samples::default()));
        let reference =
            reference.map_err(|failure| OverheadError::Reference(failure.to_string()))?;
        let rows = samples.zip(self.strategies).map(|(samples, &strategy)| OverheadRow {
            strategy: strategy.name,
            granularity: strategy.policy.granularity,
            threads: self.threads_of(strategy).get(),
            figures: samples
                .map(|samples| self.figures(strategy, &samples, &reference, workloads.step_ns)),
        });
        Ok(OverheadStudy {
            rows: rows.collect(),
            step_ns: workloads.step_ns,
            rounds: rounds.completed(),
        })
    }

    fn threads_of(&self, strategy: Strategy<'_>) -> NonZeroUsize {
        strategy.threads.computing_threads(self.threads)
    }

    /// Measures everything once for one strategy.
    fn measure(&self, strategy: Strategy<'_>, workloads: &mut Workloads) -> Result<Round, Failure> {
        let threads = self.threads_of(strategy);
        let failed = |error| Failure::Rendering(format!("{}: {error}", strategy.name));
        let times = |workloads: &mut [TimedImage], renderer: &mut Renderer| {
            workloads
                .iter_mut()
                .map(|image| image.time(renderer).map_err(failed))
                .collect::<Result<Vec<_>, _>>()
        };
        let mut one = of_pixels(strategy, NonZeroUsize::MIN).map_err(Failure::Preparing)?;
        let dispatch_one = DispatchProbe::slope(workloads.probe.time(&mut one).map_err(failed)?);
        let mut renderer = of_pixels(strategy, threads).map_err(Failure::Preparing)?;
        let dispatch_all =
            DispatchProbe::slope(workloads.probe.time(&mut renderer).map_err(failed)?);
        let tasks = times(&mut workloads.tasks, &mut renderer)?;
        // Otherwise the threads would exist already: OpenMP keeps one pool for each calling thread.
        drop((one, renderer));
        let begin = Instant::now();
        let mut renderer = catch_panic(|| strategy.prepare(Plan { threads, tile: TILE }))
            .map_err(Failure::Preparing)?;
        let prepare = begin.elapsed().as_nanos() as f64;
        // The second time is neither the first nor later.
        let uses = (0..3).map(|_| workloads.first.time(&mut renderer).map_err(failed));
        let uses = uses.collect::<Result<Vec<_>, _>>()?;
        let (first, later) = (uses[0], uses[2]);
        let squares = times(&mut workloads.squares, &mut renderer)?;
        Ok(Round { dispatch_one, dispatch_all, tasks, squares, prepare, first, later })
    }

    fn figures(
        &self,
        strategy: Strategy<'_>,
        samples: &Samples,
        reference: &Samples,
        step_ns: f64,
    ) -> OverheadFigures {
        let is_band = strategy.policy.granularity == Granularity::Band;
        let threads = self.threads_of(strategy).get();
        let interval = |of: fn(&Round) -> f64| {
            let none = Interval::exactly(0.0);
            median_interval(&samples.of(of)).unwrap_or(none)
        };
        let tasks_a_piece = if is_band { f64::from(TASKS) / threads as f64 } else { 1.0 };
        let tasks: Vec<(f64, f64)> = (0..=LARGEST_TASK)
            .map(|power| {
                let work = f64::from(1_u32 << power) * step_ns;
                let time = samples.median(|round| round.tasks[power as usize]);
                (work * tasks_a_piece, work * f64::from(TASKS) / (threads as f64 * time))
            })
            .collect();
        let ratios: Vec<(f64, f64)> = sides()
            .enumerate()
            .map(|(index, side)| {
                let rounds = reference.rounds.iter().zip(&samples.rounds);
                let ratios = rounds.map(|(base, own)| base.squares[index] / own.squares[index]);
                (f64::from(side), median(&ratios.collect::<Vec<_>>()).unwrap_or(0.0))
            })
            .collect();
        let is_reference = strategy.name == self.reference.name;
        OverheadFigures {
            dispatch_one: (!is_band).then(|| interval(|round| round.dispatch_one)),
            dispatch_all: (!is_band).then(|| interval(|round| round.dispatch_all)),
            metg: metg(&tasks, LEAST_EFFICIENCY),
            break_even: break_even(&ratios).filter(|_| !is_reference),
            prepare: interval(|round| round.prepare),
            first: interval(|round| round.first),
            later: interval(|round| round.later),
        }
    }
}

/// The times of one strategy in one round, in nanoseconds.
#[derive(Clone, Debug)]
struct Round {
    dispatch_one: f64,
    dispatch_all: f64,
    /// The column's times, by the power of two of its steps.
    tasks: Vec<f64>,
    /// The squares' times, by [`sides`].
    squares: Vec<f64>,
    prepare: f64,
    first: f64,
    later: f64,
}

#[derive(Clone, Debug, Default)]
struct Samples {
    rounds: Vec<Round>,
}

impl Samples {
    fn of(&self, of: impl Fn(&Round) -> f64) -> Vec<f64> {
        self.rounds.iter().map(of).collect()
    }

    fn median(&self, of: impl Fn(&Round) -> f64) -> f64 {
        median(&self.of(of)).unwrap_or(0.0)
    }
}

/// Returns the sides of the squares, in pixels.
fn sides() -> impl Iterator<Item = u32> {
    (0..).map(|power| 1 << power).take_while(|side| *side <= LARGEST_SIDE)
}

/// The images to render, made once for all rounds.
struct Workloads {
    step_ns: f64,
    probe: DispatchProbe,
    /// The columns of tasks, by the power of two of their steps.
    tasks: Vec<TimedImage>,
    /// The squares, by [`sides`].
    squares: Vec<TimedImage>,
    /// The image of the first use, with next to no work.
    first: TimedImage,
}

impl Workloads {
    fn new(reference: Strategy<'_>) -> Result<Self, String> {
        let step_ns = step(reference)?;
        let steps = (PIXEL_NS / step_ns).round() as u32;
        Ok(Self {
            step_ns,
            probe: DispatchProbe::new()?,
            tasks: (0..=LARGEST_TASK)
                .map(|power| TimedImage::column(TASKS, 1 << power))
                .collect::<Result<_, _>>()?,
            squares: sides()
                .map(|side| TimedImage::new(synthetic::even(steps), side, side))
                .collect::<Result<_, _>>()?,
            first: TimedImage::new(synthetic::even(0), FIRST_SIDE, FIRST_SIDE)?,
        })
    }
}

/// Prepares `strategy` with tiles of one pixel.
pub(crate) fn of_pixels(strategy: Strategy<'_>, threads: NonZeroUsize) -> Result<Renderer, String> {
    catch_panic(|| strategy.prepare(Plan { threads, tile: NonZeroU32::MIN }))
}

/// Returns the nanoseconds of a step of synthetic work on one thread of `reference`.
pub(crate) fn step(reference: Strategy<'_>) -> Result<f64, String> {
    const STEPS: u32 = 1 << 10;
    let mut renderer = of_pixels(reference, NonZeroUsize::MIN)?;
    let (mut none, mut many) = (TimedImage::column(TASKS, 0)?, TimedImage::column(TASKS, STEPS)?);
    let times = (0..9).map(|_| Ok(many.time(&mut renderer)? - none.time(&mut renderer)?));
    let time = median(&times.collect::<Result<Vec<_>, String>>()?).unwrap_or(0.0);
    // A coarse clock must not give a step of no time.
    Ok(time.max(1.0) / f64::from(TASKS) / f64::from(STEPS))
}
