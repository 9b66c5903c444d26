//! The list as CSV. Every line repeats what its record needs, so that it can be read alone.

use super::{Record, Results};
use crate::json;
use serde_json::Value;

/// The keys of ratios with an interval, which have three columns each.
const INTERVALS: [&str; 2] = ["speedup", "cold_speedup"];

/// The keys of the machine that each line repeats.
const MACHINE: [&str; 5] = ["cpu", "available_threads", "compiler", "profile", "commit"];

pub(super) fn text(results: &Results) -> String {
    let machine = json::value(&results.machine);
    let lines = results.results.iter().map(|record| cells(record, &machine));
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    for (number, line) in lines.enumerate() {
        let (names, values): (Vec<String>, Vec<String>) = line.into_iter().unzip();
        if number == 0 {
            writer.write_record(names).expect("memory accepts everything");
        }
        writer.write_record(values).expect("every record has the same keys");
    }
    let bytes = writer.into_inner().expect("memory accepts everything");
    String::from_utf8(bytes).expect("CSV of text is text")
}

/// Returns name and value of each column: the record's keys and some of the machine's. `samples_ns`
/// becomes the column `samples`, its length; the other lists are left out.
fn cells(record: &Record, machine: &Value) -> Vec<(String, String)> {
    let mut cells = Vec::new();
    for (key, value) in json::value(record).as_object().into_iter().flatten() {
        match value {
            Value::Array(list) if key == "samples_ns" => {
                cells.push(("samples".to_owned(), list.len().to_string()));
            }
            Value::Array(_) => {}
            interval if INTERVALS.contains(&&**key) => {
                for (suffix, end) in [("", "median"), ("_low", "low"), ("_high", "high")] {
                    cells.push((format!("{key}{suffix}"), cell(&interval[end])));
                }
            }
            value => cells.push((key.clone(), cell(value))),
        }
    }
    cells.extend(MACHINE.map(|key| (key.to_owned(), cell(&machine[key]))));
    cells
}

/// Returns a scalar as text, null as nothing.
fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
