//! Files that appear whole or not at all.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use tempfile::Builder;

/// Whether [`write`] has a chance, asked before hours of rendering.
pub fn check_writable(path: &Path) -> Result<(), String> {
    let cannot = |reason: &str| Err(format!("{}: cannot be written: {reason}", path.display()));
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => return cannot("it is a folder"),
        // To replace a device or a pipe by a file is not what anyone means.
        Ok(metadata) if !metadata.is_file() => return cannot("it is not a regular file"),
        _ => {}
    }
    let folder = folder_of(path);
    if folder.is_dir() { Ok(()) } else { cannot(&format!("there is no folder {}", folder.display())) }
}

/// Writes `bytes` beside `path` and renames the result: nobody ever sees half a file, and an old
/// file stays until the new one is whole.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    check_writable(path)?;
    let cannot = |e: std::io::Error| format!("{}: cannot be written: {e}", path.display());
    // A link stays a link: what it points to is replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let mut file = new_file(&folder_of(&target)).map_err(cannot)?;
    file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(cannot)?;
    file.persist(&target).map_err(|e| cannot(e.error))?;
    Ok(())
}

fn new_file(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
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
