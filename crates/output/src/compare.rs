//! The list of measurements of a comparison, and its views: table, JSON, CSV, Markdown, and the
//! changes since an earlier list.
//!
//! Several scenes, shared samples beside unshared ones, or several sizes of tiles are more records
//! in the list.

mod changes;
mod csv;
#[cfg(test)]
pub(crate) mod fixtures;
mod lessons;
mod markdown;
mod ranking;
mod scenes;
mod schema_1;
mod screen;
#[cfg(test)]
mod screen_tests;
mod table;
#[cfg(test)]
mod tests;
mod verdict;

pub use changes::{Change, comparable};
pub use table::column_names;
pub(crate) use table::complaint;

use crate::json;
use rayweave_contract::Digest;
use rayweave_measure::statistics::ratio_interval;
use rayweave_measure::{Interval, Machine, Measurement, Noise};
use serde::{Deserialize, Serialize};
use std::path::is_separator;

/// The schema number of the JSON. It changes when a key is removed or changes its meaning.
const SCHEMA: u32 = 2;

/// The scene's name in a [`Subject`] without a scene file.
pub const BUILT_IN_SCENE: &str = "report (built in)";

/// A scene with its settings. Times of equal subjects can be compared. All but the last four
/// settings change the image.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Subject {
    /// The scene file's path as it was given, or [`BUILT_IN_SCENE`].
    pub scene: String,
    /// Width of the image in pixels.
    pub width: u32,
    /// Height of the image in pixels.
    pub height: u32,
    /// Density of the samples; 0 is one ray a pixel.
    pub antialiasing: u32,
    /// Positions of the samples: "lattice" or "importance".
    pub sampling: String,
    /// True if samples of a lattice are traced only where pixels differ.
    pub adaptive: bool,
    /// The tracer's formulas: "robust" or "textbook".
    pub formulas: String,
    /// The tracer's number type: "f32" or "f64".
    pub precision: String,
    /// The number of rays that are followed side by side.
    pub lanes: usize,
    /// True if samples that neighbouring pixels of a tile have in common are traced once.
    pub share_samples: bool,
    /// The acceleration structure: "auto" or "none".
    pub accel: String,
    /// The side of a tile in pixels.
    pub tile: u32,
}

/// One measurement with everything that was measured around it: one entry of `results`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The scene and its settings.
    #[serde(flatten)]
    pub subject: Subject,
    /// The number of rounds that were measured.
    #[serde(default)]
    pub rounds: usize,
    /// True if the measurement was interrupted after these.
    #[serde(default)]
    pub interrupted: bool,
    /// True if [other programs](Noise::disturbed) make the times doubtful.
    #[serde(default)]
    pub disturbed: bool,
    /// The digest of the reference's image, in hexadecimal.
    pub reference_digest: String,
    /// The largest cost of `threads` equal ranges of tiles over the mean cost.
    pub imbalance: Option<f64>,
    /// The largest cost of a tile as a share of the whole.
    pub largest_tile: Option<f64>,
    /// The strategy, its samples and figures.
    #[serde(flatten)]
    pub measurement: Measurement,
}

/// A list of measurements with everything that they share. `--json` writes it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Results {
    schema: u32,
    /// The seed of the order within the rounds.
    #[serde(default)]
    pub seed: u64,
    /// The precision that was asked for: half of an interval as a share of its median.
    #[serde(default)]
    pub precision_goal: Option<f64>,
    /// The machine that ran the measurement.
    #[serde(default)]
    pub machine: Machine,
    /// Other activity on the machine meanwhile.
    #[serde(default)]
    pub noise: Noise,
    /// The reference's time without shared samples over its time with them, where both were
    /// measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sharing_speedup: Option<Interval>,
    /// The changes since an earlier list, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub changes: Option<Vec<Change>>,
    /// For each subject the reference, its control, then the strategies.
    pub results: Vec<Record>,
    /// The scenes that an interruption left out.
    #[serde(default)]
    pub not_measured: Vec<String>,
    /// The reasons to doubt the changes.
    #[serde(skip)]
    doubts: Vec<String>,
}

impl Results {
    /// Returns a list of `results` with the machine and its noise.
    #[must_use]
    pub fn new(machine: Machine, noise: Noise, results: Vec<Record>) -> Self {
        let mut list = Self {
            schema: SCHEMA,
            seed: 0,
            precision_goal: None,
            machine,
            noise,
            sharing_speedup: None,
            changes: None,
            results,
            not_measured: Vec::new(),
            doubts: Vec::new(),
        };
        list.sharing_speedup = list.computed_sharing_speedup();
        list
    }

    /// Reads the JSON of a list, of this schema or the previous one.
    ///
    /// # Errors
    ///
    /// The text is not such a list, or has another schema.
    pub fn parse(text: &str) -> Result<Self, String> {
        let not_a_list = |e: serde_json::Error| format!("not the JSON of a comparison: {e}");
        let object: serde_json::Value = serde_json::from_str(text).map_err(not_a_list)?;
        let object = match object.get("schema") {
            None => return Err("not the JSON of a comparison: it has no schema".to_owned()),
            Some(schema) if schema == 1 => schema_1::upgraded(object).map_err(not_a_list)?,
            Some(schema) if *schema == SCHEMA => object,
            Some(theirs) => {
                return Err(format!(
                    "its schema is {theirs}, and this program reads 1 and {SCHEMA}: measure a new \
                     baseline"
                ));
            }
        };
        serde_json::from_value(object).map_err(not_a_list)
    }

    /// Returns the list as JSON, which docs/compare-json.md describes.
    #[must_use]
    pub fn json(&self) -> String {
        json::text(self)
    }

    /// Returns the list as CSV: a line of names, then a line for each record. A missing figure is
    /// empty.
    #[must_use]
    pub fn csv(&self) -> String {
        csv::text(self)
    }

    /// Returns the list as tables in Markdown, with the machine.
    #[must_use]
    pub fn markdown(&self) -> String {
        let tables: String = self.groups().map(|group| markdown::text(self, group)).collect();
        if self.has_scenes() { scenes::markdown(self) + &tables } else { tables }
    }

    /// Returns what a reader wants to know first, as plain text in lines of at most 80 columns:
    /// which strategies are fastest, a bar for each, and what the figures teach. `notes` come near
    /// the end. There is no newline at the end.
    #[must_use]
    pub fn screen(&self, notes: &[String]) -> String {
        screen::text(self, notes)
    }

    /// Returns the list as plain text without colours or a newline at the end: one table with these
    /// [columns](column_names) for each subject. Without names all columns are in it, and several
    /// scenes stand side by side in one table.
    #[must_use]
    pub fn table(&self, columns: &[String]) -> String {
        if self.has_scenes() && columns.is_empty() {
            scenes::text(self)
        } else {
            table::text(self, columns)
        }
    }

    /// Returns whether every strategy rendered the reference's image every time.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.results.iter().all(|record| record.measurement.passed())
    }

    /// Returns the records of each subject, the reference first.
    fn groups(&self) -> impl Iterator<Item = &[Record]> {
        self.results.chunk_by(|a, b| a.subject == b.subject)
    }

    /// Returns whether several scenes were asked for.
    fn has_scenes(&self) -> bool {
        let scene = |record: &Record| record.subject.scene.clone();
        self.results.chunk_by(|a, b| scene(a) == scene(b)).count() + self.not_measured.len() > 1
    }

    /// Computes the reference's time without shared samples over its time with them, round by
    /// round.
    fn computed_sharing_speedup(&self) -> Option<Interval> {
        let reference = |shared| {
            let group = self.groups().find(|group| group[0].subject.share_samples == shared)?;
            group[0].measurement.median_ns.map(|_| &group[0])
        };
        let (shared, unshared) = (reference(true)?, reference(false)?);
        let alike = Subject { share_samples: true, ..unshared.subject.clone() };
        let times = |record: &Record| record.measurement.samples_ns.clone();
        (alike == shared.subject).then(|| ratio_interval(&times(unshared), &times(shared)))?
    }
}

impl Subject {
    /// Returns whether pixels have a lattice of samples, which they may share.
    fn has_lattice(&self) -> bool {
        self.antialiasing > 0 && self.sampling == "lattice"
    }

    /// Returns whether pixels of a piece share samples.
    fn shares_samples(&self) -> bool {
        self.has_lattice() && (self.share_samples || self.adaptive)
    }
}

impl Record {
    /// Returns the name of the row in a table.
    fn label(&self) -> String {
        let control = if self.measurement.control { " (control)" } else { "" };
        format!("{}{control}", self.measurement.strategy)
    }

    /// Returns the share of the lanes that primary rays filled, if they were counted.
    fn lanes_in_use(&self) -> Option<f64> {
        let lanes = self.measurement.primary_packets? as f64 * self.subject.lanes as f64;
        (lanes > 0.0).then_some(self.measurement.primary_rays? as f64 / lanes)
    }
}

/// Returns the interval of the control's speed-up, which shows the error of a table.
fn control(group: &[Record]) -> Option<Interval> {
    group.iter().find(|record| record.measurement.control)?.measurement.speedup
}

/// Returns the first digits of a digest, enough for a table.
fn short(digest: &str) -> String {
    digest.parse::<Digest>().map_or_else(|_| digest.to_owned(), |digest| digest.short())
}

/// Returns the scene's file without its folder.
fn scene_file(scene: &str) -> &str {
    scene.rsplit(is_separator).next().unwrap_or_default()
}

/// Returns the scene's file without its folder and ending.
fn scene_name(record: &Record) -> &str {
    let file = scene_file(&record.subject.scene);
    file.strip_suffix(".toml").unwrap_or(file)
}
