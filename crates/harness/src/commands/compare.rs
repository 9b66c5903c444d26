//! `rayweave compare`, and `rayweave` alone: times all strategies side by side.

use crate::deliver;
use crate::files::{PendingFile, distinct_files, named_twice};
use crate::input::Input;
use crate::interrupt::Interrupt;
use crate::options::{
    SceneOptions, SharingOption, TileOption, WorkOptions, all_threads, chosen, distinct,
    left_out_line, parse_percent, parse_seconds, parse_threads, strategy_parser,
};
use crate::progress::Share;
use crate::subprocess::{Job, SubprocessExecutor};
use crate::with_noise::with_noise;
use crate::{Outcome, complain, print};
use clap::Args;
use clap::builder::PossibleValuesParser;
use rayweave_contract::{Strategy, Tile, Work};
use rayweave_core::{Acceleration, Arithmetic, Execution};
use rayweave_measure::compare::{CompareError, CompareProgress, Comparison, Entry, Executor};
use rayweave_measure::noise::NoiseMonitor;
use rayweave_measure::{Machine, Measurement, Protocol, TileCosts};
use rayweave_output::compare::{Record, Results, Subject, column_names, comparable};
use std::fs;
use std::io;
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::{Path, PathBuf};
use std::process;
use std::time::Duration;

#[derive(Args)]
pub struct Arguments {
    /// Scene file [default: the lab report's scene, which is built in]
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub options: Options,
}

#[derive(Args)]
pub struct Options {
    /// Strategies to time [default: all]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = strategy_parser())]
    strategy: Vec<Strategy<'static>>,
    /// Numbers of computing threads [default: all that the machine and its quota allow]
    #[arg(long, value_name = "N,...", value_delimiter = ',', value_parser = parse_threads)]
    threads: Vec<NonZeroUsize>,
    #[command(flatten)]
    tile: TileOption,
    /// Measure until every speed-up is known to +-PERCENT (half of its 95 % interval), or until the
    /// time limit is reached
    #[arg(long, value_name = "PERCENT", value_parser = parse_percent)]
    precision_goal: Option<f64>,
    /// Start no round that would end later than this, after at least 8 rounds [default: 40 rounds
    /// or 60 seconds, whichever comes first]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    time_limit: Option<Duration>,
    /// Write the result as JSON, raw samples included
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the table as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Compare on several scenes side by side: scene files, or `all` for those in scenes/loads,
    /// which separate the strategies. All scenes share the time limit
    #[arg(long, value_name = "FILE,...", value_delimiter = ',')]
    scenes: Vec<PathBuf>,
    /// Write the table as Markdown
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Show the changes since an earlier run with the same scenes and settings. FILE is the JSON
    /// that it wrote
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Print the table with all columns
    #[arg(long, conflicts_with = "columns")]
    full: bool,
    /// Print the table with these columns
    #[arg(
        long,
        value_name = "NAME,...",
        value_delimiter = ',',
        value_parser = PossibleValuesParser::new(column_names())
    )]
    columns: Vec<String>,
    #[command(flatten)]
    work: WorkOptions,
}

impl Options {
    /// Returns whether to share samples, for each way to compute the image.
    fn ways(&self) -> &'static [bool] {
        self.work.of_scene(None).ways_to_share()
    }
}

/// The folder of `--scenes all`. Each of its scenes separates some strategies from others.
const LOADS: &str = "scenes/loads";

pub fn run(scene: Option<&Path>, options: &Options) -> Result<Outcome, String> {
    let scenes = scenes(scene, options)?;
    let files = Files::create(&scenes, options)?;
    let baseline = options.baseline.as_deref().map(read_baseline).transpose()?;
    // Load all scenes before the first is measured, to report a mistake in the last one at once.
    let loaded = scenes.into_iter().map(|scene| load(scene, options));
    let loaded = loaded.collect::<Result<Vec<Loaded>, _>>()?;
    if let Some((path, baseline)) = options.baseline.as_deref().zip(baseline.as_ref()) {
        let subjects = loaded.iter().flat_map(|loaded| loaded.subjects.clone());
        comparable(baseline, &subjects.collect::<Vec<_>>())
            .map_err(|reason| no_baseline(path, &reason))?;
    }
    let (measured, machine, noise) = with_noise(|bar| measure_all(&loaded, options, bar));
    let records = match measured {
        Ok(records) => records,
        Err(Unmeasured::Failed(reason)) => return Err(reason),
        Err(Unmeasured::Interrupted(reason)) => {
            complain(&reason);
            return Ok(Outcome::Interrupted);
        }
    };
    let mut results = Results::new(machine, noise, records);
    (results.seed, results.precision_goal) = (Protocol::default().seed, options.precision_goal);
    let measured = |name: &String| results.results.iter().any(|r| r.subject.scene == *name);
    let names = loaded.iter().map(|loaded| &loaded.input.name);
    results.not_measured = names.filter(|name| !measured(name)).cloned().collect();
    if let Some(baseline) = &baseline {
        results = results.compared_with(baseline);
    }
    let Files { json, csv, markdown } = files;
    deliver::all([
        deliver::write(json, || Ok(results.json())),
        deliver::write(csv, || Ok(results.csv())),
        deliver::write(markdown, || Ok(results.markdown())),
        print(&view(&results, &loaded, options)),
    ])?;
    let interrupted =
        !results.not_measured.is_empty() || results.results.iter().any(|r| r.interrupted);
    Ok(match (results.passed(), interrupted) {
        (false, _) => Outcome::Failed,
        (true, true) => Outcome::Interrupted,
        (true, false) => Outcome::Passed,
    })
}

/// Returns the results as text for a terminal.
fn view(results: &Results, loaded: &[Loaded], options: &Options) -> String {
    // These lines concern a single scene.
    let input = if let [Loaded { input, .. }] = loaded { Some(input) } else { None };
    let skipped = input.and_then(Input::skipped_line);
    let left_out = left_out_line(&options.strategy);
    let is_table = options.full || !options.columns.is_empty();
    let arithmetic = input.filter(|_| is_table).map(Input::arithmetic_line);
    let notes = arithmetic.into_iter().chain(skipped).chain(left_out);
    if is_table {
        let lines = std::iter::once(results.table(&options.columns)).chain(notes);
        lines.map(|line| line + "\n").collect()
    } else {
        results.screen(&notes.collect::<Vec<_>>()) + "\n"
    }
}

/// Returns the scenes to compare on. `None` is the lab report's.
fn scenes(scene: Option<&Path>, options: &Options) -> Result<Vec<Option<PathBuf>>, String> {
    match &options.scenes[..] {
        [] => Ok(vec![scene.map(Path::to_owned)]),
        _ if options.ways().len() > 1 => {
            Err("--scenes cannot show both ways of sharing: use --share-samples on or off"
                .to_owned())
        }
        _ if scene.is_some() => {
            Err("--scenes must name all scenes: remove the other scene file".to_owned())
        }
        [all] if all.as_os_str() == "all" => {
            let cannot = |e: io::Error| {
                format!(
                    "--scenes all: {LOADS} cannot be read: {e}; go to the repository's folder, or \
                     name files"
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

/// The files to write.
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
}

fn read_baseline(path: &Path) -> Result<Results, String> {
    let name = path.display().to_string();
    let bytes = rayweave_scene_file::bytes_of(path, &name).map_err(|e| e.to_string())?;
    let text = String::from_utf8(bytes).map_err(|e| no_baseline(path, &e.to_string()))?;
    Results::parse(&text).map_err(|reason| no_baseline(path, &reason))
}

fn no_baseline(path: &Path, reason: &str) -> String {
    format!("{}: cannot be a baseline: {reason}", path.display())
}

/// A scene that can be measured with the options.
struct Loaded {
    /// The scene file; the lab report's scene without one.
    path: Option<PathBuf>,
    input: Input,
    tile: NonZeroU32,
    /// One for each way to share samples.
    subjects: Vec<Subject>,
}

/// Loads a scene and checks that it can be measured with these options.
fn load(path: Option<PathBuf>, options: &Options) -> Result<Loaded, String> {
    let (scene, ways) = (path.as_deref(), options.ways());
    let input = Input::load_sharing(scene, &options.work.of_scene(scene), ways[0])?;
    let settings = &input.scene.render;
    if ways.len() > 1 && (!settings.has_lattice() || settings.adaptive) {
        return Err(
            "--share-samples both needs a full lattice: use --sampling lattice, --adaptive off and \
             --antialiasing 1 or more"
                .to_owned(),
        );
    }
    if let Some(path) = scene.filter(|path| !path.is_file()) {
        return Err(format!(
            "{}: cannot be read again for every sample: use a regular file",
            path.display()
        ));
    }
    input.image()?;
    let tile = options.tile.of(input.width, input.height)?;
    let subjects = ways.iter().map(|&share_samples| subject(&input, share_samples, tile)).collect();
    Ok(Loaded { path, input, tile, subjects })
}

/// The reason why a scene has no figures.
enum Unmeasured {
    Interrupted(String),
    Failed(String),
}

impl From<String> for Unmeasured {
    fn from(reason: String) -> Self {
        Self::Failed(reason)
    }
}

/// Measures on one scene after the other until an interruption. The first scene is always measured.
fn measure_all(
    scenes: &[Loaded],
    options: &Options,
    bar: &Share,
) -> Result<Vec<Record>, Unmeasured> {
    let (mut all, interrupt) = (Vec::new(), Interrupt::watch());
    for (number, scene) in scenes.iter().enumerate() {
        if !all.is_empty() && interrupt.happened() {
            break;
        }
        let show = |fraction: f64, message: String| {
            bar.show((number as f64 + fraction) / scenes.len() as f64, message);
        };
        match measure(scene, options, scenes.len(), &interrupt, show) {
            Ok(records) => all.extend(records),
            // Show the scenes that were measured.
            Err(Unmeasured::Interrupted(_)) if !all.is_empty() => break,
            Err(unmeasured) => return Err(unmeasured),
        }
    }
    Ok(all)
}

/// Measures on one of `scenes` scenes. Returns a record for each row and each way to share samples.
fn measure(
    Loaded { path, input, tile, subjects }: &Loaded,
    options: &Options,
    scenes: usize,
    interrupt: &Interrupt,
    show: impl Fn(f64, String),
) -> Result<Vec<Record>, Unmeasured> {
    let executors = options.ways().iter().map(|&way| {
        let share_samples = Some(if way { SharingOption::On } else { SharingOption::Off });
        let job = Job {
            parent: process::id(),
            scene: path.as_ref().map(Into::into),
            options: SceneOptions { share_samples, ..options.work.of_scene(path.as_deref()) },
            tile: *tile,
            strategy: String::new(),
            threads: NonZeroUsize::MIN,
            count_rays: false,
        };
        SubprocessExecutor::new(job, interrupt)
    });
    let mut executors = executors.collect::<Result<Vec<SubprocessExecutor>, _>>()?;
    let mut executors: Vec<&mut dyn Executor> =
        executors.iter_mut().map(|executor| executor as &mut dyn Executor).collect();

    let monitor = NoiseMonitor::start();
    let comparisons = protocol(options, subjects.len(), scenes).run_together(
        rayweave_registry::reference(),
        &entries(options),
        &mut executors,
        // The bar is drawn only here, between the timed spans.
        |at| show(at.fraction, message(at)),
    );
    let comparisons = comparisons.map_err(|error| match error {
        CompareError::Interrupted(_) => Unmeasured::Interrupted(error.to_string()),
        CompareError::Reference(_) => Unmeasured::Failed(error.to_string()),
    })?;
    let disturbed = monitor.finish(Machine::here().logical_cores).disturbed;
    show(1.0, "costs of the tiles".to_owned());
    let costs = tile_costs(input, *tile, interrupt)?;
    let records = subjects.iter().zip(comparisons).flat_map(|(subject, comparison)| {
        let Comparison { rows, digest, rounds, interrupted } = comparison;
        let costs = &costs;
        let record = move |measurement: Measurement| Record {
            subject: subject.clone(),
            rounds,
            interrupted,
            disturbed,
            reference_digest: digest.to_string(),
            imbalance: costs.as_ref().map(|costs| costs.imbalance(measurement.threads)),
            largest_tile: costs.as_ref().map(TileCosts::max_share),
            measurement,
        };
        rows.into_iter().map(record)
    });
    Ok(records.collect())
}

/// Returns a line on what is measured next.
fn message(CompareProgress { strategy, threads, rounds, .. }: CompareProgress) -> String {
    format!("rounds: {rounds}; {strategy}, threads: {threads}")
}

/// Work that is left undone after an interruption.
struct InterruptibleWork<'a>(&'a dyn Work, &'a Interrupt);

impl Work for InterruptibleWork<'_> {
    fn render(&self, tile: &mut Tile<'_>) {
        if !self.1.happened() {
            self.0.render(tile);
        }
    }
}

/// Measures the cost of each tile, unless there is an interruption.
fn tile_costs(
    input: &Input,
    tile: NonZeroU32,
    interrupt: &Interrupt,
) -> Result<Option<TileCosts>, String> {
    let work = input.work(input.width, input.height)?;
    let work = InterruptibleWork(&*work, interrupt);
    let costs = TileCosts::of(&work, input.width, input.height, tile).map_err(|e| e.to_string())?;
    Ok((!interrupt.happened()).then_some(costs))
}

/// Returns the strategies and numbers of threads that are compared with the reference.
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

/// Returns the protocol for one of `scenes` scenes with `ways` ways to share samples.
fn protocol(options: &Options, ways: usize, scenes: usize) -> Protocol {
    let default = Protocol::default();
    // A time limit or a precision goal replaces the limit on rounds.
    let asked = options.time_limit.is_some() || options.precision_goal.is_some();
    Protocol {
        max_rounds: if asked { Protocol::MOST_ROUNDS } else { default.max_rounds },
        // Each way gets as much time as it would get alone.
        budget: options.time_limit.unwrap_or(default.budget * ways as u32) / scenes as u32,
        goal: options.precision_goal,
        ..default
    }
}

/// Returns the subject of a scene with this way to share samples.
fn subject(input: &Input, share_samples: bool, tile: NonZeroU32) -> Subject {
    let Arithmetic { formulas, precision } = input.scene.render.arithmetic;
    let Execution { lanes, acceleration, .. } = input.execution;
    let accel = match acceleration {
        Acceleration::Auto => "auto",
        Acceleration::None => "none",
    };
    Subject {
        scene: input.name.clone(),
        width: input.width,
        height: input.height,
        antialiasing: input.scene.render.antialiasing,
        sampling: input.scene.render.sampling.to_string(),
        adaptive: input.scene.render.adaptive,
        formulas: formulas.to_string(),
        precision: precision.to_string(),
        lanes: lanes.count(precision),
        share_samples,
        accel: accel.to_owned(),
        tile: tile.get(),
    }
}
