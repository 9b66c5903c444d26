//! Files that appear whole or not at all.

use std::collections::HashSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// A file that will be there once it is whole. Until then an old one of this name stays, and
/// nothing lies beside it, so that a program that is killed while it computes leaves nothing
/// behind.
pub struct PendingFile {
    path: PathBuf,
}

impl PendingFile {
    /// Finds out whether `path` can be written, before hours of computing.
    pub fn create(path: &Path) -> Result<Self, String> {
        match fs::metadata(path) {
            Ok(metadata) if metadata.is_dir() => return cannot(path, "it is a folder"),
            // To replace a device or a pipe by a file is not what anyone means.
            Ok(metadata) if !metadata.is_file() => return cannot(path, "it is not a regular file"),
            _ => {}
        }
        // A link stays a link: what it points to is replaced.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let folder = folder_of(&target);
        if !folder.is_dir() {
            return cannot(path, &format!("there is no folder {}", folder.display()));
        }
        // Removed at once: nobody is left to do it when the program is killed.
        match new_file(&folder).and_then(NamedTempFile::close) {
            Ok(()) => Ok(Self { path: target }),
            Err(error) => cannot(path, &format!("{} in its folder", error.kind())),
        }
    }

    /// Gives the file its contents and its name.
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

/// Whether no two of the files that are named are the same: neither two results, nor a result and
/// what it is computed from, which would be lost.
pub fn distinct_files(paths: &[&Option<PathBuf>]) -> Result<(), String> {
    named_twice(paths.iter().filter_map(|path| path.as_deref())).map_or(Ok(()), |path| {
        Err(format!(
            "{}: is named twice: nothing may be written over what is read or written too",
            path.display()
        ))
    })
}

/// The first of these files that was named before.
pub fn named_twice<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Option<&'a Path> {
    let mut seen = HashSet::new();
    paths.into_iter().find(|path| !seen.insert(place(path)))
}

/// The same for every way to name a file, whether it is there or not yet.
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
    // A temporary file is private by default; this one becomes an ordinary file.
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

    /// Catches a temporary file that an interrupted program would leave there.
    #[test]
    fn nothing_lies_in_the_folder_until_the_file_is_whole() {
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
    fn a_folder_that_is_gone_in_the_meantime_is_told() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let path = folder.path().join("a.json");
        let pending = PendingFile::create(&path).expect("can be written");
        folder.close().expect("removed");
        let error = pending.finish(b"late").expect_err("nowhere to write");
        assert!(error.starts_with(&format!("{}: cannot be written: ", path.display())), "{error}");
    }
}
