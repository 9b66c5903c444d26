//! CSV from flat structures.

use serde::Serialize;

/// Returns a line of names, then one line for each structure.
pub(crate) fn text(lines: impl Iterator<Item = impl Serialize>) -> String {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    for line in lines {
        writer.serialize(line).expect("a flat structure is CSV, and memory accepts it");
    }
    let bytes = writer.into_inner().expect("memory accepts everything");
    String::from_utf8(bytes).expect("CSV of text is text")
}
