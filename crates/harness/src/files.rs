//! Result files, which are written as a whole or not at all.

use std::collections::HashSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// A file that gets its contents later. Until then an old file of this name stays, and there is no
/// temporary file that a killed program would leave behind.
pub struct PendingFile {
    path: PathBuf,
}

impl PendingFile {
    /// Checks that `path` can be written, before hours of computing.
    pub fn create(path: &Path) -> Result<Self, String> {
        match fs::metadata(path) {
            Ok(metadata) if metadata.is_dir() => return cannot(path, "it is a folder"),
            // A device or a pipe must not be replaced by a file.
            Ok(metadata) if !metadata.is_file() => return cannot(path, "it is not a regular file"),
            _ => {}
        }
        // A link stays a link: its target is replaced.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let folder = folder_of(&target);
        if !folder.is_dir() {
            return cannot(path, &format!("there is no folder {}", folder.display()));
        }
        // Remove the trial file at once, because a killed program could not.
        match new_file(&folder).and_then(NamedTempFile::close) {
            Ok(()) => Ok(Self { path: target }),
            Err(error) => cannot(path, &format!("{} in its folder", error.kind())),
        }
    }

    /// Writes the file.
    pub fn finish(self, contents: &[u8]) -> Result<(), String> {
        self.replace(contents).or_else(|error| cannot(&self.path, &error.to_string()))
    }

    fn replace(&self, contents: &[u8]) -> io::Result<()> {
        let mut file = new_file(&folder_of(&self.path))?;
        file.write_all(contents)?;
        file.as_file().sync_all()?;
        file.persist(&self.path)?;
        Ok(())
    }
}

/// Checks that no file is named twice, so that no result overwrites another result or an input.
pub fn distinct_files(paths: &[&Option<PathBuf>]) -> Result<(), String> {
    named_twice(paths.iter().filter_map(|path| path.as_deref())).map_or(Ok(()), |path| {
        Err(format!(
            "{}: is named twice: use another file, so that no input or result is overwritten",
            path.display()
        ))
    })
}

/// Returns the first path to a file that an earlier path leads to.
pub fn named_twice<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Option<&'a Path> {
    let mut seen = HashSet::new();
    paths.into_iter().find(|path| !seen.insert(place(path)))
}

/// Returns the same path for every way to name a file, even if it does not exist yet.
fn place(path: &Path) -> PathBuf {
    let folder = || Some(fs::canonicalize(folder_of(path)).ok()?.join(path.file_name()?));
    fs::canonicalize(path).ok().or_else(folder).unwrap_or_else(|| path.to_owned())
}

fn cannot<T>(path: &Path, reason: &str) -> Result<T, String> {
    Err(format!("{}: cannot be written: {reason}", path.display()))
}

fn new_file(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(".rayweave-");
    // Temporary files are private by default, but this one becomes an ordinary file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a temporary file that an interrupted program would leave behind.
    #[test]
    fn the_folder_is_empty_until_the_file_is_complete() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let path = folder.path().join("a.json");
        let files = || fs::read_dir(folder.path()).expect("the folder").count();
        let pending = PendingFile::create(&path).expect("can be written");
        assert_eq!(files(), 0);
        pending.finish(b"first").expect("written");

        let pending = PendingFile::create(&path).expect("can be written");
        assert_eq!((files(), fs::read(&path).expect("the old one")), (1, b"first".to_vec()));
        pending.finish(b"second").expect("written");
        assert_eq!((files(), fs::read(&path).expect("the new one")), (1, b"second".to_vec()));
    }

    #[test]
    fn a_folder_that_vanishes_is_reported() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let path = folder.path().join("a.json");
        let pending = PendingFile::create(&path).expect("can be written");
        folder.close().expect("removed");
        let error = pending.finish(b"late").expect_err("nowhere to write");
        assert!(error.starts_with(&format!("{}: cannot be written: ", path.display())), "{error}");
    }
}
