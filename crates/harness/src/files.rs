//! Result files: written as a whole or not at all, and never over another file of the run.

use rayweave_scene_file::path_text;
use std::collections::HashSet;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use tempfile::{Builder, NamedTempFile};

/// A file that gets its contents later. Until then an old file of this name stays, and there is no
/// temporary file that a killed program would leave behind.
pub struct PendingFile {
    path: PathBuf,
}

/// The use of a file in this run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    Read,
    Write,
}

/// Every file of this run that was claimed, and its use.
static CLAIMED: Mutex<Vec<(PathBuf, Use)>> = Mutex::new(Vec::new());

/// Claims a file for a use, before any work. Refuses a file that is written and has another use,
/// so that no result overwrites an input, such as a mesh of the scene, or another result.
pub fn claim(path: &Path, new: Use) -> Result<(), String> {
    let claim = (place(path), new);
    let mut claimed = CLAIMED.lock().unwrap_or_else(PoisonError::into_inner);
    if claimed.iter().any(|(place, old)| *place == claim.0 && (*old, new) != (Use::Read, Use::Read))
    {
        return Err(used_twice(path));
    }
    claimed.push(claim);
    Ok(())
}

impl PendingFile {
    /// Claims `path` and checks that it can be written, before hours of computing.
    pub fn create(path: &Path) -> Result<Self, String> {
        let target = target(path).or_else(|reason| cannot(path, &reason))?;
        claim(path, Use::Write)?;
        let folder = folder_of(&target);
        if !folder.is_dir() {
            return cannot(path, &format!("there is no folder {}", path_text(&folder)));
        }
        remove_leftovers(&folder);
        // Remove the trial file at once, because a killed program could not.
        match new_file(&folder).and_then(NamedTempFile::close) {
            Ok(()) => Ok(Self { path: target }),
            Err(error) => cannot(path, &format!("{} in its folder", error.kind())),
        }
    }

    /// Writes the file.
    pub fn finish(self, contents: &[u8]) -> Result<(), String> {
        self.finish_with(|file| file.write_all(contents))
    }

    /// Writes the file piece by piece.
    pub fn finish_with(
        self,
        write: impl FnOnce(&mut Buffered<'_>) -> io::Result<()>,
    ) -> Result<(), String> {
        self.replace(write).or_else(|error| cannot(&self.path, &error.to_string()))
    }

    fn replace(&self, write: impl FnOnce(&mut Buffered<'_>) -> io::Result<()>) -> io::Result<()> {
        let mut file = new_file(&folder_of(&self.path))?;
        let mut buffer = BufWriter::new(&mut file);
        write(&mut buffer)?;
        buffer.flush()?;
        drop(buffer);
        match fs::metadata(&self.path) {
            Ok(old) => file.as_file().set_permissions(old.permissions())?,
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
        file.as_file().sync_all()?;
        file.persist(&self.path)?;
        Ok(())
    }
}

/// A file that is being written.
type Buffered<'a> = BufWriter<&'a mut NamedTempFile>;

/// Returns the file that writing to `path` replaces: a link stays a link. It may not exist yet.
/// Refuses what is no regular file or must not be replaced.
fn target(path: &Path) -> Result<PathBuf, String> {
    let metadata = match fs::metadata(path) {
        Ok(metadata) => metadata,
        Err(error) if error.kind() == ErrorKind::NotFound => {
            return match fs::read_link(path) {
                Ok(target) => {
                    Err(format!("it is a link to {}, which is missing", path_text(&target)))
                }
                Err(_) => Ok(path.to_owned()),
            };
        }
        // A link in a circle, or one that may not be followed: nothing is known of its target.
        Err(error) => return Err(error.to_string()),
    };
    if metadata.is_dir() {
        return Err("it is a folder".to_owned());
    }
    // A device or a pipe must not be replaced by a file.
    if !metadata.is_file() {
        return Err("it is not a regular file".to_owned());
    }
    // Opening does not fail for the superuser, but the mode says what its owner wants.
    if metadata.permissions().readonly() {
        return Err("it is read-only".to_owned());
    }
    File::options().write(true).open(path).map_err(|error| error.to_string())?;
    fs::canonicalize(path).map_err(|error| error.to_string())
}

/// Checks that no file is named twice, so that no result overwrites another result or an input.
pub fn distinct_files(paths: &[&Option<PathBuf>]) -> Result<(), String> {
    named_twice(paths.iter().filter_map(|path| path.as_deref()))
        .map_or(Ok(()), |path| Err(used_twice(path)))
}

fn used_twice(path: &Path) -> String {
    format!(
        "{}: is named twice: use another file, so that no input or result is overwritten",
        path_text(path)
    )
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
    Err(format!("{}: cannot be written: {reason}", path_text(path)))
}

/// The beginning and the end of the name of each temporary file.
const TEMPORARY: (&str, &str) = (".rayweave-", ".tmp");

/// Creates a temporary file. Its lock says that it is in use.
fn new_file(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(TEMPORARY.0).suffix(TEMPORARY.1);
    // Temporary files are private by default, but this one becomes an ordinary file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    loop {
        let file = builder.tempfile_in(folder)?;
        // Not every file system has locks. Without them nothing is a leftover.
        let _ = file.as_file().lock();
        // Another run may have taken it for a leftover before it was locked.
        if file.path().exists() {
            return Ok(file);
        }
    }
}

/// Removes the temporary files of runs that were killed while they wrote. As far as that fails,
/// they stay.
fn remove_leftovers(folder: &Path) {
    let is_ours = |name: &OsStr| {
        let (prefix, suffix) = TEMPORARY;
        let random = name.to_str().and_then(|name| name.strip_prefix(prefix)?.strip_suffix(suffix));
        random.is_some_and(|random| {
            random.len() == 6 && random.bytes().all(|byte| byte.is_ascii_alphanumeric())
        })
    };
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.filter_map(Result::ok).filter(|entry| is_ours(&entry.file_name())) {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        // A run that still writes its file holds the lock.
        if is_file && File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(entry.path());
        }
    }
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
        for (path, old) in [(&path, None), (&folder.path().join("b.json"), Some(b"old"))] {
            if let Some(old) = old {
                fs::write(path, old).expect("an old file");
            }
            let before = files();
            let pending = PendingFile::create(path).expect("can be written");
            assert_eq!((files(), fs::read(path).ok()), (before, old.map(|old| old.to_vec())));
            pending.finish(b"new").expect("written");
            assert_eq!(fs::read(path).expect("the new file"), b"new");
        }
        assert_eq!(files(), 2);
    }

    #[test]
    fn a_file_has_one_use_unless_it_is_only_read() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        fs::write(path("mesh.obj"), "").expect("written");
        claim(&path("mesh.obj"), Use::Read).expect("an input");
        claim(&path("./mesh.obj"), Use::Read).expect("an input of two meshes");
        PendingFile::create(&path("a.json")).expect("an output");
        for name in ["mesh.obj", "./mesh.obj", "a.json", "./a.json"] {
            let error = PendingFile::create(&path(name)).err().expect("a second use");
            assert!(error.contains(&format!("{name}: is named twice: ")), "{error}");
        }
        assert!(claim(&path("a.json"), Use::Read).is_err());
        assert!(files_in(folder.path()).iter().eq(["mesh.obj"]));
    }

    #[test]
    fn only_what_a_killed_run_left_is_removed() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let names = [".rayweave-a1B2c3.tmp", ".rayweave-notes.tmp", ".rayweave-a1B2c3", "a.tmp"];
        for name in names {
            fs::write(folder.path().join(name), "").expect("written");
        }
        let in_use = new_file(folder.path()).expect("of a run that goes on");
        PendingFile::create(&folder.path().join("a.json")).expect("can be written");
        assert!(in_use.path().exists());
        in_use.close().expect("removed");
        assert!(files_in(folder.path()).iter().eq(&[names[2], names[1], names[3]]));
    }

    fn files_in(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the folder");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("text"))
            .collect();
        names.sort();
        names
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
