//! The way of results out of the program: a result that was measured is not lost because another
//! cannot be written.

use crate::files::PendingFile;

/// Writes a result to its file, if one was asked for.
pub fn write<C: AsRef<[u8]>>(
    file: Option<PendingFile>,
    contents: impl FnOnce() -> Result<C, String>,
) -> Result<(), String> {
    file.map_or(Ok(()), |file| file.finish(contents()?.as_ref()))
}

/// Returns all failures of `deliveries` as one, each on a line of its own. All of them were tried:
/// files come first, because a terminal may be gone.
pub fn all(deliveries: impl IntoIterator<Item = Result<(), String>>) -> Result<(), String> {
    let failures: Vec<String> = deliveries.into_iter().filter_map(Result::err).collect();
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\nerror: ")) }
}
