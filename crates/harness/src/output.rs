//! Files that appear whole or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// A file that will be there once it is whole. Until then an old one of this name stays, and if it
/// never is, nothing is left behind.
pub struct PendingFile {
    path: PathBuf,
    file: NamedTempFile,
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
        match new_file(&folder) {
            Ok(file) => Ok(Self { path: target, file }),
            Err(error) => cannot(path, &format!("{} in its folder", error.kind())),
        }
    }

    /// Gives the file its contents and its name.
    pub fn finish(mut self, contents: &[u8]) -> Result<(), String> {
        let written = self.file.write_all(contents).and_then(|()| self.file.as_file().sync_all());
        let kept = written.and_then(|()| self.file.persist(&self.path).map_err(|e| e.error));
        kept.map(drop).or_else(|error| cannot(&self.path, &error.to_string()))
    }
}

/// Whether no two of the files that are named are the same: neither two results, nor a result and what
/// it is computed from, which would be lost.
pub fn distinct_files(paths: &[&Option<PathBuf>]) -> Result<(), String> {
    let mut seen: Vec<PathBuf> = Vec::new();
    for path in paths.iter().filter_map(|path| path.as_deref()) {
        let file = place(path);
        if seen.contains(&file) {
            return Err(format!(
                "{}: is named twice: nothing may be written over what is read or written too",
                path.display()
            ));
        }
        seen.push(file);
    }
    Ok(())
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
