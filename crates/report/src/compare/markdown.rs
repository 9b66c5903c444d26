//! The comparison for a README.

use super::Report;
use super::table::{label, milliseconds};
use crate::{machine, style};
use rayweave_measure::compare::Row;

const HEADER: &str = "| strategy | threads | median ms | speed-up [95 % interval] | efficiency | one shot ms |\n\
                      |---|--:|--:|--:|--:|--:|\n";

/// Ends with a newline.
pub(super) fn text(report: &Report<'_>) -> String {
    let rows: String = report.comparison.rows.iter().map(line).collect();
    let facts = machine::text(report.machine).replace('\n', "; ");
    let disturbed =
        if report.noise.is_disturbing() { " **Disturbed by other programs.**" } else { "" };
    format!("{}\n\n{HEADER}{rows}\n{facts}.{disturbed}\n", super::table::heading(report))
}

/// Of several scenes, by name: a table of `rows`, each with a strategy, threads and a cell a scene,
/// and sentences. Ends with a newline.
pub(super) fn summary(scenes: &[String], rows: &[Vec<String>], sentences: &[String]) -> String {
    let line = |cells: &[String]| {
        let cells: Vec<String> = cells.iter().map(|cell| escaped(cell)).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let header = line(&[&["strategy".to_owned(), "threads".to_owned()], scenes].concat());
    let rule = format!("|---|--:|{}\n", "--:|".repeat(scenes.len()));
    let rows: String = rows.iter().map(|row| line(row)).collect();
    let sentences: String = sentences.iter().map(|sentence| format!("- {sentence}\n")).collect();
    format!(
        "speed-up over the reference of the same scene [95 % interval]; the highest of a scene in bold\n\n\
         {header}{rule}{rows}\n{sentences}"
    )
}

/// As a cell of a table.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|")
}

fn line(row: &Row) -> String {
    let (name, threads) = (escaped(&label(row)), row.threads);
    let Some(figures) = row.figures else {
        let reason = if row.error.is_some() { "failed" } else { "wrong picture" };
        return format!("| {name} | {threads} | {reason} | | | |\n");
    };
    let one_shot =
        figures.one_shot.map(|one_shot| milliseconds(one_shot.median_ns)).unwrap_or_default();
    format!(
        "| {name} | {threads} | {} | {} | {:.0} % | {one_shot} |\n",
        milliseconds(figures.median_ns),
        style::interval(figures.speedup),
        figures.efficiency * 100.0
    )
}
