//! The options that several commands share, and the parsers of their values.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use rayweave_contract::Strategy;
use rayweave_core::scene::MAX_ANTIALIASING;
use rayweave_core::{Acceleration, Formulas, Lanes, Sampling};
use rayweave_registry::STRATEGIES;
use serde::{Deserialize, Serialize};
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::Path;
use std::thread::available_parallelism;
use std::time::Duration;

/// The largest number of threads.
const MAX_THREADS: usize = 1024;

/// The longest time limit: a week.
const MAX_SECONDS: u64 = 7 * 24 * 3600;

/// The largest number of tiles of an image. They take less than 1 GiB.
const MAX_TILES: u64 = 1 << 24;

/// The options that choose the image and its computation.
#[derive(Args, Clone, Copy, Debug, Serialize, Deserialize)]
pub struct SceneOptions {
    /// Size of the image in pixels, each 1..=65535 [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<(u32, u32)>,
    /// Density of samples: 0 is one ray a pixel; N is (2 N + 1)^2 rays on the lattice, or
    /// N^2 + (N + 1)^2 by importance [default: the scene's]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(0..=i64::from(MAX_ANTIALIASING))
    )]
    pub antialiasing: Option<u32>,
    /// Positions of the samples around a pixel
    #[arg(long, value_enum, default_value_t)]
    pub sampling: SamplingOption,
    /// Number type of the tracer
    #[arg(long, value_enum, default_value_t)]
    pub precision: PrecisionOption,
    /// Formulas of the tracer
    #[arg(long, value_enum, default_value_t)]
    pub formulas: FormulasOption,
    /// Rays in a packet with f32; with f64 half as many [default: auto; 1 with --equal-work on]
    #[arg(long, value_enum)]
    pub lanes: Option<LanesOption>,
    /// Trace the samples that neighbouring pixels of a tile have in common only once [default: on;
    /// off with --equal-work on]
    #[arg(long, value_enum)]
    pub share_samples: Option<SharingOption>,
    /// Interpolate lattice samples where the pixels around them look alike: faster, but it changes
    /// the image
    #[arg(long, value_enum, default_value_t)]
    pub adaptive: SwitchOption,
    /// Let rays skip primitives that they cannot hit; the image is the same
    #[arg(long, alias = "search", value_enum, default_value_t)]
    pub accel: AccelerationOption,
}

/// The size of the built-in scene's image where strategies are compared: with all of them, two
/// threads compute the default rounds of it in a minute.
const BUILT_IN_SIZE: (u32, u32) = (250, 250);

/// The options of the commands that compare threading.
#[derive(Args)]
#[command(mut_arg("size", |size| size.help(
    "Size of the image in pixels, each 1..=65535 [default: the scene's; 250x250 for the built-in \
     scene]"
)))]
pub struct WorkOptions {
    /// Give all strategies the same work, so that only threading differs: samples are not shared,
    /// and rays are followed one by one. --share-samples and --lanes each lift their part. Off:
    /// compute as `render` does
    #[arg(long, value_enum, default_value = "on")]
    equal_work: SwitchOption,
    #[command(flatten)]
    scene: SceneOptions,
}

/// The positions of the samples around a pixel.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, ValueEnum)]
pub enum SamplingOption {
    /// A square lattice, weighted by the filter; scene files mean this
    #[default]
    Lattice,
    /// Equal weights, as dense as the filter is high: half the rays for the same error
    Importance,
}

/// The number type of the tracer.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, ValueEnum)]
pub enum PrecisionOption {
    /// f32, or f64 if the scene needs it
    #[default]
    Auto,
    /// Single precision, 24 bits
    F32,
    /// Double precision, 53 bits
    F64,
}

/// The formulas of the tracer.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, ValueEnum)]
pub enum FormulasOption {
    /// The lab report's formulas with its mistakes corrected, for comparison
    Textbook,
    /// Formulas that stay accurate on hard input
    #[default]
    Robust,
}

/// The number of rays in a packet.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, ValueEnum)]
pub enum LanesOption {
    /// Fill a register of this machine; one by one if mirrors scatter neighbouring rays
    #[default]
    Auto,
    /// One by one
    #[value(name = "1")]
    One,
    /// Fill 256 bits
    #[value(name = "8")]
    Wide256,
    /// Fill 512 bits
    #[value(name = "16")]
    Wide512,
}

/// The ways to share samples.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, ValueEnum)]
pub enum SharingOption {
    /// Share samples within a tile
    #[default]
    On,
    /// Trace all samples of each pixel
    Off,
    /// Measure both ways in the same rounds; `compare` only
    Both,
}

/// A setting that is on or off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
pub enum SwitchOption {
    /// Enable it
    On,
    /// Disable it
    #[default]
    Off,
}

/// The way a ray finds the primitives that it tries.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, ValueEnum)]
pub enum AccelerationOption {
    /// The one that suits the scene: a BVH among many primitives, cones and spheres among few
    #[default]
    Auto,
    /// Nothing: every ray tries every primitive
    #[value(alias = "exhaustive")]
    None,
}

/// The size of the tiles.
#[derive(Args)]
pub struct TileOption {
    /// Side of a tile in pixels, for strategies whose pieces are tiles
    #[arg(long, value_name = "N", value_parser = parse_tile, default_value = "32")]
    tile: NonZeroU32,
}

impl From<FormulasOption> for Formulas {
    fn from(option: FormulasOption) -> Self {
        match option {
            FormulasOption::Textbook => Self::Textbook,
            FormulasOption::Robust => Self::Robust,
        }
    }
}

impl LanesOption {
    /// Returns the requested number, or `auto`.
    pub fn or(self, auto: Lanes) -> Lanes {
        match self {
            Self::Auto => auto,
            Self::One => Lanes::One,
            Self::Wide256 => Lanes::Wide256,
            Self::Wide512 => Lanes::Wide512,
        }
    }
}

impl From<AccelerationOption> for Acceleration {
    fn from(option: AccelerationOption) -> Self {
        match option {
            AccelerationOption::Auto => Self::Auto,
            AccelerationOption::None => Self::None,
        }
    }
}

impl WorkOptions {
    /// Returns the options of the scene at `path`, or of the built-in scene, those not named
    /// resolved.
    pub fn of_scene(&self, path: Option<&Path>) -> SceneOptions {
        let size = self.scene.size.or(path.is_none().then_some(BUILT_IN_SIZE));
        let options = SceneOptions { size, ..self.scene };
        if self.equal_work == SwitchOption::Off {
            return options;
        }
        SceneOptions {
            lanes: options.lanes.or(Some(LanesOption::One)),
            share_samples: options.share_samples.or(Some(SharingOption::Off)),
            ..options
        }
    }
}

impl SceneOptions {
    /// Returns whether to share samples, for each way to compute the image.
    pub fn ways_to_share(&self) -> &'static [bool] {
        match self.share_samples.unwrap_or_default() {
            SharingOption::On => &[true],
            SharingOption::Off => &[false],
            SharingOption::Both => &[true, false],
        }
    }

    /// Returns whether to share samples, for commands that do not take `both`.
    pub fn only_way_to_share(&self) -> Result<bool, String> {
        match self.ways_to_share() {
            [way] => Ok(*way),
            _ => {
                Err("--share-samples both: only `compare` measures both, use on or off".to_owned())
            }
        }
    }
}

impl From<SamplingOption> for Sampling {
    fn from(option: SamplingOption) -> Self {
        match option {
            SamplingOption::Lattice => Self::Lattice,
            SamplingOption::Importance => Self::Importance,
        }
    }
}

impl TileOption {
    /// Returns the side of a tile in an image of this size.
    pub fn of(&self, width: u32, height: u32) -> Result<NonZeroU32, String> {
        checked_tile(self.tile, width, height)
    }
}

/// Returns `tile` if memory is enough for the tiles of an image of this size.
pub fn checked_tile(tile: NonZeroU32, width: u32, height: u32) -> Result<NonZeroU32, String> {
    let tiles = u64::from(width.div_ceil(tile.get())) * u64::from(height.div_ceil(tile.get()));
    if tiles <= MAX_TILES {
        return Ok(tile);
    }
    Err(format!(
        "--tile {tile} cuts {width} x {height} pixels into {tiles} tiles: use a larger one, for at \
         most {MAX_TILES} tiles"
    ))
}

/// Returns clap's parser of strategy names, which suggests a similar name after a mistake.
pub fn strategy_parser() -> impl TypedValueParser<Value = Strategy<'static>> {
    let names = STRATEGIES.iter().map(|strategy| strategy.name);
    PossibleValuesParser::new(names).try_map(|name| {
        let strategy =
            rayweave_registry::find(&name).ok_or_else(|| "there is no such strategy".to_owned())?;
        strategy
            .unavailable
            .map_or(Ok(strategy), |reason| Err(format!("unavailable here: {reason}")))
    })
}

/// Returns the requested strategies, each once, or else all that are available here.
pub fn chosen(asked_for: &[Strategy<'static>]) -> Vec<Strategy<'static>> {
    if asked_for.is_empty() {
        rayweave_registry::available()
    } else {
        distinct(asked_for, |s| s.name)
    }
}

/// Returns a line on strategies that are unavailable here, if one of them is missing.
pub fn left_out_line(asked_for: &[Strategy<'static>]) -> Option<String> {
    let unavailable = STRATEGIES.iter().filter(|strategy| strategy.unavailable.is_some());
    let names: Vec<&str> = unavailable.map(|strategy| strategy.name).collect();
    (!names.is_empty() && asked_for.is_empty()).then(|| {
        format!(
            "left out because unavailable here: {} (`rayweave strategies` shows the reason)",
            names.join(", ")
        )
    })
}

/// Parses the side of a tile for clap.
fn parse_tile(text: &str) -> Result<NonZeroU32, String> {
    text.parse().map_err(|_| "expected an integer of 1 or more".to_owned())
}

/// Parses a number of threads for clap.
pub fn parse_threads(text: &str) -> Result<NonZeroUsize, String> {
    let threads = text.parse().ok().filter(|threads| (1..=MAX_THREADS).contains(threads));
    threads
        .and_then(NonZeroUsize::new)
        .ok_or_else(|| format!("expected an integer in 1..={MAX_THREADS}"))
}

/// Parses a number of threads for clap, or a range, which stands for its ends and the powers of two
/// between them.
pub fn parse_thread_counts(text: &str) -> Result<Vec<NonZeroUsize>, String> {
    let Some((first, last)) = text.split_once("..") else { return Ok(vec![parse_threads(text)?]) };
    let (first, last) = (parse_threads(first)?, parse_threads(last)?);
    if first > last {
        return Err(format!(
            "the range is empty: expected its smaller end first, as in {last}..{first}"
        ));
    }
    let powers = (0..usize::BITS).filter_map(|power| NonZeroUsize::new(1_usize << power));
    let between = powers.filter(|power| (first..last).contains(power));
    Ok(distinct(&[first].into_iter().chain(between).chain([last]).collect::<Vec<_>>(), |threads| {
        *threads
    }))
}

/// Returns each value once, in the order given.
pub fn distinct<T: Clone, K: PartialEq>(values: &[T], key: impl Fn(&T) -> K) -> Vec<T> {
    let mut distinct: Vec<T> = Vec::new();
    for value in values {
        if !distinct.iter().any(|known| key(known) == key(value)) {
            distinct.push(value.clone());
        }
    }
    distinct
}

/// Returns the number of threads that the machine and this process's quota allow.
pub fn all_threads() -> NonZeroUsize {
    available_parallelism().unwrap_or(NonZeroUsize::MIN)
}

/// Parses the size of an image for clap.
pub fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let side =
        |text: &str| text.parse().ok().filter(|side| (1..=u32::from(u16::MAX)).contains(side));
    text.split_once('x').and_then(|(width, height)| Some((side(width)?, side(height)?))).ok_or_else(
        || "expected WIDTHxHEIGHT, each an integer in 1..=65535, as in 640x480".to_owned(),
    )
}

/// Parses a time of a second or more for clap.
pub fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().filter(|seconds| (1..=MAX_SECONDS).contains(seconds));
    seconds
        .map(Duration::from_secs)
        .ok_or_else(|| format!("expected whole seconds in 1..={MAX_SECONDS}"))
}

/// Parses a share in percent for clap, with or without the sign.
pub fn parse_percent(text: &str) -> Result<f64, String> {
    let number = text.strip_suffix('%').unwrap_or(text).trim_end();
    let percent = number.parse().ok().filter(|percent| (0.001..=100.0).contains(percent));
    percent
        .map(|percent: f64| percent / 100.0)
        .ok_or_else(|| "expected a percentage in 0.001..=100, as in 1%".to_owned())
}

/// Parses a peak signal-to-noise ratio for clap.
pub fn parse_psnr(text: &str) -> Result<f64, String> {
    let psnr = text.parse().ok().filter(|psnr| (0.0..=200.0).contains(psnr));
    psnr.ok_or_else(|| "expected a number of decibels in 0..=200".to_owned())
}
