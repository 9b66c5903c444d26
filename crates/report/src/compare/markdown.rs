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
    let disturbed = if report.noise.is_disturbing() { " **Disturbed by other programs.**" } else { "" };
    format!("{}\n\n{HEADER}{rows}\n{facts}.{disturbed}\n", super::table::heading(report))
}

fn line(row: &Row) -> String {
    let (name, threads) = (label(row).replace('|', "\\|"), row.threads);
    let Some(figures) = row.figures else {
        let reason = if row.error.is_some() { "failed" } else { "wrong picture" };
        return format!("| {name} | {threads} | {reason} | | | |\n");
    };
    let one_shot = figures.one_shot.map(|one_shot| milliseconds(one_shot.median_ns)).unwrap_or_default();
    format!(
        "| {name} | {threads} | {} | {} | {:.0} % | {one_shot} |\n",
        milliseconds(figures.median_ns),
        style::interval(figures.speedup),
        figures.efficiency * 100.0
    )
}
