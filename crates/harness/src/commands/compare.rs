//! `rayweave compare`, and `rayweave` alone: the table.

use crate::child::Children;
use crate::input::Input;
use crate::interrupt::Interrupt;
use crate::options::{
    SceneOptions, SharingOption, TileOption, all_threads, chosen, distinct, left_out_line,
    parse_percent, parse_seconds, parse_threads, strategy_parser,
};
use crate::output::{PendingFile, distinct_files, named_twice};
use crate::watched::watched;
use crate::{Outcome, complain, print};
use clap::Args;
use rayweave_contract::Strategy;
use rayweave_core::{Arithmetic, Execution};
use rayweave_measure::compare::{CompareError, Comparison, Entry, Executor};
use rayweave_measure::machine::Machine;
use rayweave_measure::noise::Noise;
use rayweave_measure::{Load, Protocol};
use rayweave_report::compare::{Baseline, BothReport, Report, ScenesReport, Subject};
use std::fs;
use std::io;
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::{Path, PathBuf};
use std::time::Duration;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the report's scene, built in]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub options: Options,
}

#[derive(Args)]
pub struct Options {
    /// Strategies to time [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = strategy_parser())]
    strategy: Vec<&'static dyn Strategy>,
    /// Numbers of computing threads [default: what the machine and its quota allow]
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = parse_threads)]
    threads: Vec<NonZeroUsize>,
    #[command(flatten)]
    tile: TileOption,
    /// Measure until each speed-up is known so well: half of its interval, as a share of it; or
    /// until time is up
    #[arg(long, value_name = "PERCENT", value_parser = parse_percent)]
    precision_goal: Option<f64>,
    /// Begin no round after 8 that would end later than this; without this option 40 rounds are
    /// enough, or two and a half minutes
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    time_limit: Option<Duration>,
    /// Write the result as JSON, raw samples included
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the table as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Compare on several scenes beside each other: scene files, or `all` for those in
    /// scenes/loads, which separate the strategies. The time limit is for all together
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    scenes: Vec<PathBuf>,
    /// Write the table as Markdown
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Say what has changed since an earlier run of the same scene with the same settings, by the
    /// JSON that it wrote
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    #[command(flatten)]
    scene_options: SceneOptions,
}

/// Where `--scenes all` finds its scenes: each of them separates some strategies from others.
const LOADS: &str = "scenes/loads";

pub fn run(scene: Option<&Path>, options: &Options) -> Result<Outcome, String> {
    let scenes = scenes(scene, options)?;
    let single = options.scenes.is_empty() && options.scene_options.share_samples.single().is_ok();
    if options.baseline.is_some() && !single {
        return Err(
            "--baseline needs one table: a single scene, and --share-samples on or off".to_owned()
        );
    }
    let files = Files::create(&scenes, options)?;
    let baseline = options.baseline.as_deref().map(read_baseline).transpose()?;
    // All of them before the first is measured: a mistake in the last is told at once.
    let inputs = scenes.iter().map(|scene| load(scene.as_deref(), options));
    let inputs = inputs.collect::<Result<Vec<Input>, _>>()?;
    if let (Some(path), Some(baseline), [input]) = (&options.baseline, &baseline, &inputs[..]) {
        let tile = options.tile.of(input.width, input.height)?;
        let subject = subject(input, ways(options)[0], tile);
        baseline.check(&subject).map_err(|reason| no_baseline(path, &reason))?;
    }
    let measured = match measure_all(&scenes, inputs, options) {
        Ok(measured) => measured,
        Err(Unmeasured::Failed(reason)) => return Err(reason),
        Err(Unmeasured::Interrupted(reason)) => {
            complain(&reason);
            return Ok(Outcome::Interrupted);
        }
    };
    let first = &measured[0];
    let skipped = first.input.skipped_line().map(|line| line + "\n").unwrap_or_default();
    let left_out = left_out_line(&options.strategy);
    let below = format!("\n{}\n{skipped}{left_out}", first.input.arithmetic_line());
    if !options.scenes.is_empty() {
        let reports: Vec<Report<'_>> =
            measured.iter().map(|measured| measured.report(0, None)).collect();
        let loads: Vec<&Load> =
            measured.iter().filter_map(|measured| measured.load.as_ref()).collect();
        let not_measured =
            scenes[measured.len()..].iter().flatten().map(|path| path.display().to_string());
        let not_measured: Vec<String> = not_measured.collect();
        let all = ScenesReport { reports: &reports, loads: &loads, not_measured: &not_measured };
        print(&format!("{}\n{left_out}", all.table()))?;
        files.finish(&all.json(), &all.csv(), &all.markdown())?;
    } else if first.comparisons.len() == 2 {
        let both = BothReport { shared: first.report(0, None), unshared: first.report(1, None) };
        print(&format!("{}{below}", both.table()))?;
        files.finish(&both.json(), &both.csv(), &both.markdown())?;
    } else {
        let report = first.report(0, baseline.as_ref());
        print(&format!("{}{below}", report.table()))?;
        files.finish(&report.json(), &report.csv(), &report.markdown())?;
    }
    let comparisons = || measured.iter().flat_map(|measured| &measured.comparisons);
    let interrupted =
        measured.len() < scenes.len() || comparisons().any(|comparison| comparison.interrupted);
    let hold = comparisons().all(Comparison::holds);
    Ok(match (hold, interrupted) {
        (false, _) => Outcome::Failed,
        (true, true) => Outcome::Interrupted,
        (true, false) => Outcome::Held,
    })
}

/// The scenes to compare on; `None` is the report's.
fn scenes(scene: Option<&Path>, options: &Options) -> Result<Vec<Option<PathBuf>>, String> {
    match &options.scenes[..] {
        [] => Ok(vec![scene.map(Path::to_owned)]),
        _ if options.scene_options.share_samples.single().is_err() => {
            Err("--scenes: choose --share-samples on or off".to_owned())
        }
        _ if scene.is_some() => Err("--scenes: name all scenes there, and none besides".to_owned()),
        [all] if all.as_os_str() == "all" => {
            let cannot = |e: io::Error| {
                format!(
                    "--scenes all: {LOADS} cannot be read: {e}; go to the repository's folder, or name files"
                )
            };
            let entries = fs::read_dir(LOADS).map_err(cannot)?;
            let mut files: Vec<PathBuf> =
                entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
            files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
            files.sort();
            if files.is_empty() {
                return Err(format!("--scenes all: there is no scene in {LOADS}"));
            }
            Ok(files.into_iter().map(Some).collect())
        }
        files => match named_twice(files.iter().map(PathBuf::as_path)) {
            Some(file) => Err(format!("--scenes: {} is named twice: name it once", file.display())),
            None => Ok(files.iter().cloned().map(Some).collect()),
        },
    }
}

/// The files that were asked for.
struct Files {
    json: Option<PendingFile>,
    csv: Option<PendingFile>,
    markdown: Option<PendingFile>,
}

impl Files {
    fn create(scenes: &[Option<PathBuf>], options: &Options) -> Result<Self, String> {
        let Options { json, csv, markdown, baseline, .. } = options;
        let named = [json, csv, markdown, baseline].into_iter().chain(scenes);
        distinct_files(&named.collect::<Vec<_>>())?;
        let create = |path: &Option<PathBuf>| path.as_deref().map(PendingFile::create).transpose();
        Ok(Self { json: create(json)?, csv: create(csv)?, markdown: create(markdown)? })
    }

    fn finish(self, json: &str, csv: &str, markdown: &str) -> Result<(), String> {
        let contents = [(self.json, json), (self.csv, csv), (self.markdown, markdown)];
        contents
            .into_iter()
            .try_for_each(|(file, text)| file.map_or(Ok(()), |file| file.finish(text.as_bytes())))
    }
}

fn read_baseline(path: &Path) -> Result<Baseline, String> {
    let text = fs::read_to_string(path).map_err(|e| no_baseline(path, &e.to_string()))?;
    Baseline::parse(&text).map_err(|reason| no_baseline(path, &reason))
}

fn no_baseline(path: &Path, reason: &str) -> String {
    format!("{}: cannot be a baseline: {reason}", path.display())
}

/// A scene, and a comparison for each way to compute its picture, measured in the same rounds.
struct Measured {
    input: Input,
    subjects: Vec<Subject>,
    comparisons: Vec<Comparison>,
    machine: Machine,
    noise: Noise,
    /// How the cost lies in the picture, if there are other scenes.
    load: Option<Load>,
}

impl Measured {
    fn report<'a>(&'a self, way: usize, baseline: Option<&'a Baseline>) -> Report<'a> {
        let (subject, comparison) = (&self.subjects[way], &self.comparisons[way]);
        Report { subject, comparison, machine: &self.machine, noise: &self.noise, baseline }
    }
}

/// Whether samples are shared, for each way to compute the picture.
fn ways(options: &Options) -> &'static [bool] {
    match options.scene_options.share_samples {
        SharingOption::On => &[true],
        SharingOption::Off => &[false],
        SharingOption::Both => &[true, false],
    }
}

/// A scene that can be measured as the options say.
fn load(scene: Option<&Path>, options: &Options) -> Result<Input, String> {
    let ways = ways(options);
    let input = Input::load_sharing(scene, &options.scene_options, ways[0])?;
    let settings = &input.scene.render;
    if ways.len() > 1 && (!settings.has_lattice() || settings.adaptive) {
        return Err(
            "--share-samples both: without a lattice, or with an adaptive one, there is no choice"
                .to_owned(),
        );
    }
    if let Some(path) = scene.filter(|path| !path.is_file()) {
        return Err(format!(
            "{}: is read anew for every sample, and this can be read only once: use a regular file",
            path.display()
        ));
    }
    input.picture()?;
    options.tile.of(input.width, input.height)?;
    Ok(input)
}

/// Why there is no figure of a scene.
enum Unmeasured {
    Interrupted(String),
    Failed(String),
}

impl From<String> for Unmeasured {
    fn from(reason: String) -> Self {
        Self::Failed(reason)
    }
}

/// Measures on one scene after the other, until it is interrupted: on one of them at least.
fn measure_all(
    scenes: &[Option<PathBuf>],
    inputs: Vec<Input>,
    options: &Options,
) -> Result<Vec<Measured>, Unmeasured> {
    let (mut all, interrupt) = (Vec::new(), Interrupt::watch());
    for (scene, input) in scenes.iter().zip(inputs) {
        if !all.is_empty() && interrupt.happened() {
            break;
        }
        match measure(scene.as_deref(), input, options, scenes.len(), &interrupt) {
            Ok(measured) => all.push(measured),
            // What was measured before is worth showing.
            Err(Unmeasured::Interrupted(_)) if !all.is_empty() => break,
            Err(unmeasured) => return Err(unmeasured),
        }
    }
    Ok(all)
}

/// Measures on one of `scenes` scenes.
fn measure(
    scene: Option<&Path>,
    input: Input,
    options: &Options,
    scenes: usize,
    interrupt: &Interrupt,
) -> Result<Measured, Unmeasured> {
    let ways = ways(options);
    let tile = options.tile.of(input.width, input.height)?;
    let children =
        ways.iter().map(|&way| Children::new(scene, &options.scene_options, way, tile, interrupt));
    let mut children = children.collect::<Result<Vec<Children>, _>>()?;
    let mut executors: Vec<&mut dyn Executor> =
        children.iter_mut().map(|children| children as &mut dyn Executor).collect();

    let load = (!options.scenes.is_empty()).then(|| load_of(&input, tile)).transpose()?;
    let reference = rayweave_registry::reference();
    let protocol = protocol(options, ways.len(), scenes);
    let (comparisons, machine, noise) = watched(|bar| {
        protocol.run_together(reference, &entries(options), &mut executors, |progress| {
            // Drawn here and nowhere else: between the timed spans.
            bar.show(
                progress.fraction,
                format!("{}, threads: {}", progress.strategy, progress.threads),
            );
        })
    });
    let comparisons = comparisons.map_err(|error| match error {
        CompareError::Interrupted(_) => Unmeasured::Interrupted(error.to_string()),
        CompareError::Reference(_) => Unmeasured::Failed(error.to_string()),
    })?;
    let subjects = ways.iter().map(|&share_samples| subject(&input, share_samples, tile)).collect();
    Ok(Measured { input, subjects, comparisons, machine, noise, load })
}

/// How the cost lies in the picture.
fn load_of(input: &Input, tile: NonZeroU32) -> Result<Load, String> {
    let work = input.work(input.width, input.height)?;
    Load::of(&*work, input.width, input.height, tile).map_err(|e| e.to_string())
}

/// What is compared with the reference.
fn entries(options: &Options) -> Vec<Entry<'static>> {
    let strategies = chosen(&options.strategy);
    let threads = if options.threads.is_empty() {
        vec![all_threads()]
    } else {
        distinct(&options.threads, |n| *n)
    };
    let pairs = strategies.iter().flat_map(|&strategy| threads.iter().map(move |&n| (strategy, n)));
    pairs.map(|(strategy, threads)| Entry { strategy, threads }).collect()
}

/// How long to measure `ways` ways to compute the picture of one of `scenes` scenes.
fn protocol(options: &Options, ways: usize, scenes: usize) -> Protocol {
    let default = Protocol::default();
    // Who says when it is enough wants no other end.
    let asked = options.time_limit.is_some() || options.precision_goal.is_some();
    Protocol {
        max_rounds: if asked { usize::MAX } else { default.max_rounds },
        // Each way gets the time that it would have had alone.
        budget: options.time_limit.unwrap_or(default.budget * ways as u32) / scenes as u32,
        goal: options.precision_goal,
        ..default
    }
}

fn subject(input: &Input, share_samples: bool, tile: NonZeroU32) -> Subject {
    let Execution { arithmetic: Arithmetic { formulas, precision }, lanes, search, .. } =
        input.execution;
    Subject {
        scene: input.name.clone(),
        width: input.width,
        height: input.height,
        tile: tile.get(),
        antialiasing: input.scene.render.antialiasing,
        sampling: input.scene.render.sampling,
        adaptive: input.scene.render.adaptive,
        formulas,
        precision: precision.to_string(),
        lanes: lanes.count(precision),
        share_samples,
        search,
    }
}
