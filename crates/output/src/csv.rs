//! What all CSV here has in common.

use serde::Serialize;

/// A line of names, then one line for each of our own flat structures.
pub(crate) fn text(lines: impl Iterator<Item = impl Serialize>) -> String {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    for line in lines {
        writer.serialize(line).expect("flat structures are CSV, and memory takes them");
    }
    let bytes = writer.into_inner().expect("memory takes everything");
    String::from_utf8(bytes).expect("text in, text out")
}
