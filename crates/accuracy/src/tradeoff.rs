//! Speed against error: times every setting of the tracer and compares its image with a reference,
//! in one interleaved run on one thread.

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

/// A study of one scene: its inputs and how to measure.
pub struct TradeoffExperiment<'a> {
    /// The scene; its own sampling and anti-aliasing have no effect.
    pub scene: &'a Scene,
    /// The width and height of the images in pixels.
    pub size: (u32, u32),
    /// The strategy that renders the timed images, on the caller's thread.
    pub strategy: Strategy<'a>,
    /// The number of rounds and the time budget.
    pub protocol: Protocol,
}

/// The results of a study.
#[derive(Debug)]
pub struct TradeoffStudy {
    /// The reference, which counts as the truth.
    pub reference: Reference,
    /// One row per setting.
    pub rows: Vec<TradeoffRow>,
    /// The cost of the arithmetics, on the whole scene and on each kind of primitive in it.
    pub costs: Vec<ArithmeticCost>,
    /// The number of measured rounds.
    pub rounds: usize,
    /// True if every timed image equalled the first one of its setting, bit for bit.
    pub repeatable: bool,
}

/// The measurements of one setting.
#[derive(Debug)]
pub struct TradeoffRow {
    /// The setting.
    pub setting: Setting,
    /// The times to render in nanoseconds, one per round.
    pub samples_ns: Vec<u64>,
    /// The median of these times.
    pub median_ns: f64,
    /// The ratio of the time of the lab report's own setting to this time, within a round.
    pub speedup: Interval,
    /// The difference from the reference.
    pub error: ImageDifference,
    /// The part that rounding causes: the root mean square difference from the same rays in the
    /// most exact arithmetic.
    pub arithmetic_rmse: f64,
    /// The part that too few rays cause: the root mean square error of this setting with all
    /// bounces of the scene, in the most exact arithmetic.
    pub sampling_rmse: f64,
    /// True if the setting is on the Pareto front: see [`pareto_front`].
    pub in_front: bool,
}

impl TradeoffStudy {
    /// Returns the row of the lab report's own setting.
    ///
    /// # Panics
    ///
    /// Never, because every study includes this setting.
    #[must_use]
    pub fn report_row(&self) -> &TradeoffRow {
        let deepest = self.rows[0].setting.max_reflections;
        let is_report = |row: &&TradeoffRow| row.setting == Setting::report(deepest);
        self.rows.iter().find(is_report).expect("among the settings")
    }

    /// Returns the fastest setting with a PSNR of `psnr` dB or more.
    #[must_use]
    pub fn fastest_with(&self, psnr: f64) -> Option<&TradeoffRow> {
        self.fastest(psnr, |_| true)
    }

    /// Returns the fastest such setting with robust formulas.
    #[must_use]
    pub fn fastest_robust(&self, psnr: f64) -> Option<&TradeoffRow> {
        self.fastest(psnr, |setting| setting.arithmetic.formulas == Formulas::Robust)
    }

    /// Returns the fastest such setting that differs from the lab report's own only in its density.
    #[must_use]
    pub fn fastest_report_like(&self, psnr: f64) -> Option<&TradeoffRow> {
        let own = self.report_row().setting;
        self.fastest(psnr, |&setting| Setting { antialiasing: own.antialiasing, ..setting } == own)
    }

    fn fastest(&self, psnr: f64, wanted: impl Fn(&Setting) -> bool) -> Option<&TradeoffRow> {
        let good = |row: &&TradeoffRow| row.error.psnr() >= psnr && wanted(&row.setting);
        self.rows.iter().filter(good).min_by(|a, b| a.median_ns.total_cmp(&b.median_ns))
    }
}

/// A timed image, with its first digest and the times measured so far.
struct Subject<'a> {
    scene: &'a Scene,
    setting: Setting,
    digest: Option<Digest>,
    samples_ns: Vec<u64>,
}

impl TradeoffExperiment<'_> {
    /// Renders the reference, then measures every setting in interleaved rounds. The warm-up yields
    /// the errors, the rounds yield the times. `render` turns a work into an image, untimed.
    /// `progress` receives the completed fraction, between the timed spans.
    ///
    /// # Errors
    ///
    /// An invalid scene, an impossible image size, and errors of `render` or the strategy.
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
        let mut rounds = self.protocol.rounds(subjects.len());
        while let Some(slot) = rounds.next(begin.elapsed()) {
            progress(slot.fraction);
            let subject = &mut subjects[slot.entry];
            let Timed { image, digest, nanoseconds } =
                timed(self.strategy, &subject.setting, subject.scene, self.size)?;
            if slot.round.is_some() {
                subject.samples_ns.push(nanoseconds);
                repeatable &= subject.digest == Some(digest);
                continue;
            }
            subject.digest = Some(digest);
            if slot.entry < settings.len() {
                // The most exact arithmetic comes first among settings that are otherwise equal.
                if subject.setting.arithmetic == EXACT {
                    exact = Some(image.clone());
                }
                let exact = exact.as_ref().unwrap_or(&image);
                errors.push(Errors {
                    all: ImageDifference::between(&reference.image, &image),
                    arithmetic: rmse(exact.pixels(), &image),
                });
            }
        }
        let times: Vec<&[u64]> = subjects.iter().map(|subject| &subject.samples_ns[..]).collect();
        let costs = parts.costs(&settings, &times);
        Ok(TradeoffStudy {
            reference,
            rows: rows(&settings, &times, &errors),
            costs,
            rounds: rounds.completed(),
            repeatable,
        })
    }
}

impl<'a> Subject<'a> {
    fn new(scene: &'a Scene, setting: Setting) -> Self {
        Self { scene, setting, digest: None, samples_ns: Vec::new() }
    }
}

/// An image and the time to render it.
pub struct Timed {
    /// The image.
    pub image: Image,
    /// The digest of the image.
    pub digest: Digest,
    /// The time to render it.
    pub nanoseconds: u64,
}

/// Renders `scene` with `setting` once, by `strategy` with one thread.
///
/// # Errors
///
/// An invalid scene, an impossible image size, and errors of the strategy.
pub fn timed(
    strategy: Strategy<'_>,
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

/// The errors of a setting's image: from the reference, and from the most exact arithmetic.
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
    // Differences below a tenth of a decibel do not count.
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

/// Returns [`ratio_interval`], or NaN without a round.
fn ratio(above: &[u64], below: &[u64]) -> Interval {
    let none = Interval { median: f64::NAN, low: f64::NAN, high: f64::NAN };
    ratio_interval(above, below).unwrap_or(none)
}
