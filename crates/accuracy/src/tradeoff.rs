//! Speed against error: every setting of the tracer timed and held against the truth, in one
//! interleaved run on one thread.

mod cost;
mod front;
mod reference;
mod setting;

pub use cost::ArithmeticCost;
pub use front::pareto_front;
pub use reference::{Reference, reference_rays_per_pixel};
pub use setting::{ARITHMETICS, EXACT, Setting};

use crate::metrics::{ImageDifference, rmse};
use cost::Parts;
use rayweave_contract::{Digest, Image, Strategy, Work};
use rayweave_core::{Formulas, Scene};
use rayweave_measure::compare::{Entry, Executor};
use rayweave_measure::statistics::{median, ratio_interval};
use rayweave_measure::{InProcessExecutor, Interval, Protocol};
use std::num::{NonZeroU32, NonZeroUsize};
use std::time::Instant;

/// What is studied, and how.
pub struct TradeoffExperiment<'a> {
    /// The scene, whose own sampling and anti-aliasing are of no consequence.
    pub scene: &'a Scene,
    /// Width and height of the images in pixels.
    pub size: (u32, u32),
    /// Renders what is timed, on the caller's thread.
    pub strategy: &'a dyn Strategy,
    /// How long to measure.
    pub protocol: Protocol,
}

/// What was found.
#[derive(Debug)]
pub struct TradeoffStudy {
    /// The truth.
    pub reference: Reference,
    /// A row a setting.
    pub rows: Vec<TradeoffRow>,
    /// What the arithmetics cost, on the whole scene and on each kind of primitive in it.
    pub costs: Vec<ArithmeticCost>,
    /// Rounds measured.
    pub rounds: usize,
    /// Whether every timed image was the first of its setting, bit for bit.
    pub repeatable: bool,
}

/// A setting, measured.
#[derive(Debug)]
pub struct TradeoffRow {
    /// The setting.
    pub setting: Setting,
    /// Times to render, one a round, in nanoseconds.
    pub samples_ns: Vec<u64>,
    /// Their median.
    pub median_ns: f64,
    /// The time of the lab report's own setting over this one's, within a round.
    pub speedup: Interval,
    /// From the truth.
    pub error: ImageDifference,
    /// Of that, what rounding did: root mean square from the same rays in the most exact
    /// arithmetic.
    pub arithmetic_rmse: f64,
    /// Of that, what too few rays did: the same with the scene's bounces and the most exact
    /// arithmetic.
    pub sampling_rmse: f64,
    /// Whether no other setting is faster and as exact, or more exact and as fast.
    pub in_front: bool,
}

impl TradeoffStudy {
    /// The row of the lab report's own setting.
    ///
    /// # Panics
    ///
    /// Never: it is among the settings of every scene.
    #[must_use]
    pub fn report_row(&self) -> &TradeoffRow {
        let deepest = self.rows[0].setting.max_reflections;
        let is_report = |row: &&TradeoffRow| row.setting == Setting::report(deepest);
        self.rows.iter().find(is_report).expect("among the settings")
    }

    /// The fastest setting whose PSNR is `psnr` dB or more.
    #[must_use]
    pub fn fastest_with(&self, psnr: f64) -> Option<&TradeoffRow> {
        fastest(self.rows.iter().filter(|row| row.error.psnr() >= psnr))
    }

    /// The same among those with robust formulas.
    #[must_use]
    pub fn fastest_robust(&self, psnr: f64) -> Option<&TradeoffRow> {
        let robust = |row: &&TradeoffRow| row.setting.arithmetic.formulas == Formulas::Robust;
        fastest(self.rows.iter().filter(robust).filter(|row| row.error.psnr() >= psnr))
    }

    /// The same among those that differ from the lab report's own in their density alone.
    #[must_use]
    pub fn fastest_report_like(&self, psnr: f64) -> Option<&TradeoffRow> {
        let own = self.report_row().setting;
        let like =
            |row: &&TradeoffRow| Setting { antialiasing: own.antialiasing, ..row.setting } == own;
        fastest(self.rows.iter().filter(like).filter(|row| row.error.psnr() >= psnr))
    }
}

fn fastest<'a>(rows: impl Iterator<Item = &'a TradeoffRow>) -> Option<&'a TradeoffRow> {
    rows.min_by(|a, b| a.median_ns.total_cmp(&b.median_ns))
}

/// One of the images that are timed.
struct Subject<'a> {
    scene: &'a Scene,
    setting: Setting,
    digest: Option<Digest>,
    samples_ns: Vec<u64>,
}

impl TradeoffExperiment<'_> {
    /// Renders the truth, then measures every setting in interleaved rounds. The warm-up gives the
    /// errors, the rounds the times. `render` gives the image of a work, untimed; `progress` is
    /// told what share is done, between the timed spans.
    ///
    /// # Errors
    ///
    /// A scene that is not sound, an image that cannot be, and whatever the strategy says.
    pub fn run(
        &self,
        render: impl FnMut(&dyn Work) -> Result<Image, String>,
        mut progress: impl FnMut(f64),
    ) -> Result<TradeoffStudy, String> {
        let begin = Instant::now();
        let reference = Reference::new(self.scene, self.size, render)?;
        let settings = Setting::all(self.scene);
        let parts = Parts::of(self.scene);
        let mut subjects: Vec<Subject<'_>> =
            settings.iter().map(|&s| Subject::new(self.scene, s)).collect();
        subjects.extend(parts.subjects());

        let mut errors: Vec<Errors> = Vec::new();
        let mut exact = None;
        let mut repeatable = true;
        let mut schedule = self.protocol.schedule(subjects.len());
        while let Some(turn) = schedule.next(begin.elapsed()) {
            progress(turn.fraction);
            let subject = &mut subjects[turn.entry];
            let Timed { image, digest, nanoseconds } =
                timed(self.strategy, &subject.setting, subject.scene, self.size)?;
            if turn.round.is_some() {
                subject.samples_ns.push(nanoseconds);
                repeatable &= subject.digest == Some(digest);
                continue;
            }
            subject.digest = Some(digest);
            if turn.entry < settings.len() {
                // Of settings that differ in the arithmetic the most exact one comes first.
                if subject.setting.arithmetic == EXACT {
                    exact = Some(image.clone());
                }
                let exact = exact.as_ref().unwrap_or(&image);
                errors.push(Errors {
                    all: ImageDifference::between(&reference.image, &image),
                    arithmetic: rmse(exact, &image),
                });
            }
        }
        let times: Vec<&[u64]> = subjects.iter().map(|subject| &subject.samples_ns[..]).collect();
        let costs = parts.costs(&settings, &times);
        Ok(TradeoffStudy {
            reference,
            rows: rows(&settings, &times, &errors),
            costs,
            rounds: schedule.rounds(),
            repeatable,
        })
    }
}

impl<'a> Subject<'a> {
    fn new(scene: &'a Scene, setting: Setting) -> Self {
        Self { scene, setting, digest: None, samples_ns: Vec::new() }
    }
}

/// An image, and how long it took.
pub struct Timed {
    /// What was rendered.
    pub image: Image,
    /// Of the image.
    pub digest: Digest,
    /// To render it.
    pub nanoseconds: u64,
}

/// Renders `scene` with `setting` once, by `strategy` with one thread.
///
/// # Errors
///
/// A scene that is not sound, an image that cannot be, and whatever the strategy says.
pub fn timed(
    strategy: &dyn Strategy,
    setting: &Setting,
    scene: &Scene,
    size: (u32, u32),
) -> Result<Timed, String> {
    let work = setting.work(scene, size).map_err(|e| e.to_string())?;
    let executor = InProcessExecutor::new(&*work, size.0, size.1, NonZeroU32::MAX);
    let mut executor = executor.map_err(|e| e.to_string())?;
    let sample = executor.render(&Entry { strategy, threads: NonZeroUsize::MIN })?;
    let (digest, nanoseconds) = (sample.digest, sample.render_ns);
    Ok(Timed { image: executor.into_image(), digest, nanoseconds })
}

/// How far a setting's image is off.
struct Errors {
    all: ImageDifference,
    arithmetic: f64,
}

fn rows(settings: &[Setting], times: &[&[u64]], errors: &[Errors]) -> Vec<TradeoffRow> {
    let place =
        |wanted: Setting| settings.iter().position(|s| *s == wanted).expect("among the settings");
    let deepest = settings[0].max_reflections;
    let report = times[place(Setting::report(deepest))];
    let medians: Vec<f64> =
        times.iter().take(settings.len()).map(|times| median_ns(times)).collect();
    // To the tenth of a decibel: less is no reason to call one better.
    let decibels = |errors: &Errors| -(10.0 * errors.all.psnr()).round();
    let points: Vec<(f64, f64)> =
        medians.iter().zip(errors).map(|(&t, e)| (t, decibels(e))).collect();
    let front = pareto_front(&points);
    let row = |(i, setting): (usize, &Setting)| {
        let unlimited = place(Setting { arithmetic: EXACT, max_reflections: deepest, ..*setting });
        TradeoffRow {
            setting: *setting,
            samples_ns: times[i].to_vec(),
            median_ns: medians[i],
            speedup: ratio(report, times[i]),
            error: errors[i].all,
            arithmetic_rmse: errors[i].arithmetic,
            sampling_rmse: errors[unlimited].all.rmse,
            in_front: front[i],
        }
    };
    settings.iter().enumerate().map(row).collect()
}

fn median_ns(samples: &[u64]) -> f64 {
    median(&samples.iter().map(|&ns| ns as f64).collect::<Vec<_>>()).unwrap_or(f64::NAN)
}

/// As [`ratio_interval`]; of NaN without a round.
fn ratio(above: &[u64], below: &[u64]) -> Interval {
    let none = Interval { median: f64::NAN, low: f64::NAN, high: f64::NAN };
    ratio_interval(above, below).unwrap_or(none)
}
