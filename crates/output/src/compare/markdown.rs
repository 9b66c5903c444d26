//! The list as tables in Markdown.

use super::table::{computed, heading, milliseconds};
use super::{Record, Results};
use crate::{machine, style};

const HEADER: &str = "| strategy | threads | median ms | speed-up [95 % interval] | efficiency | \
                      cold ms |\n\
                      |---|--:|--:|--:|--:|--:|\n";

/// Returns the table of one subject. It ends with a newline.
pub(super) fn text(results: &Results, group: &[Record]) -> String {
    let rows: String = group.iter().map(line).collect();
    let facts = machine::text(&results.machine).replace('\n', "; ");
    let disturbed = if group[0].disturbed { " **Disturbed by other programs.**" } else { "" };
    let again = if group[0].subject == results.results[0].subject { "" } else { "\n" };
    let (heading, computed) = (heading(group), computed(&group[0].subject));
    format!("{again}{heading}; {computed}\n\n{HEADER}{rows}\n{facts}.{disturbed}\n")
}

/// Returns a table of `rows`, each with a strategy, threads and a cell a scene, and `sentences`
/// below it. It ends with a newline.
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
        "speed-up over the reference of the same scene [95 % interval]; the highest of a scene in \
         bold\n\n{header}{rule}{rows}\n{sentences}"
    )
}

/// Returns `text` as a cell of a table.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|")
}

fn line(record: &Record) -> String {
    let (name, row) = (escaped(&record.label()), &record.measurement);
    let threads = row.threads;
    let (Some(median), Some(speedup), Some(efficiency)) =
        (row.median_ns, row.speedup, row.efficiency)
    else {
        let reason = if row.error.is_some() { "failed" } else { "wrong image" };
        return format!("| {name} | {threads} | {reason} | | | |\n");
    };
    let cold = row.cold_ns.map(milliseconds).unwrap_or_default();
    format!(
        "| {name} | {threads} | {} | {} | {:.0} % | {cold} |\n",
        milliseconds(median),
        style::interval(speedup),
        efficiency * 100.0
    )
}
