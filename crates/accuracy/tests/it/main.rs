//! The integration tests, in one program because each program is linked separately.

mod corpus;
mod families;
mod json_format;
mod kernel;
mod kernel_guarantees;
mod oracle;
mod shadows;
mod ties;

/// Returns the items as a file of JSON lines.
fn written<T: serde::Serialize>(items: &[T]) -> String {
    let mut written = Vec::new();
    rayweave_accuracy::json_lines::write(&mut written, items).expect("a vector takes everything");
    String::from_utf8(written).expect("JSON is text")
}
