//! Every scene in `malformed/` is refused with the message beside it.

use std::fs;
use std::path::{Path, PathBuf};

use rayweave_scene_file::parse;

/// Returns the files of a folder whose names have this ending.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("the folder can be read").path());
    paths.filter(|path| path.extension().is_some_and(|found| found == ending)).collect()
}

#[test]
fn every_malformed_scene_is_refused_with_its_message() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/malformed");
    let scenes = files(&folder, "toml");
    assert!(scenes.len() >= 127, "{} scenes", scenes.len());
    assert_eq!(files(&folder, "expected").len(), scenes.len(), "a message without its scene");

    let mut mismatches = String::new();
    for path in scenes {
        let expected = fs::read_to_string(path.with_extension("expected"));
        let expected = expected.expect("every scene has its message");
        let name = path.file_name().expect("a name").to_str().expect("ASCII");
        let found = match parse(&fs::read(&path).expect("the scene can be read"), name) {
            Ok(_) => format!("{name}: no error\n"),
            Err(error) => format!("{error}\n"),
        };
        if found != expected {
            mismatches += &format!("expected {expected}found    {found}\n");
        }
    }
    assert!(mismatches.is_empty(), "\n{mismatches}");
}
