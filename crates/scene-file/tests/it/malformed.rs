//! Every scene in `malformed/` is refused with the message beside it.

use std::fs;
use std::path::PathBuf;

use rayweave_scene_file::parse;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/malformed")
}

/// The names of the cases, without their endings.
fn cases() -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder())
        .expect("the folder is there")
        .map(|entry| entry.expect("the folder can be read").path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .map(|path| path.file_stem().expect("a name").to_str().expect("ASCII").to_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn every_malformed_scene_is_refused_with_its_message() {
    let mut mismatches = String::new();
    for case in cases() {
        let file = format!("{case}.toml");
        let bytes = fs::read(folder().join(&file)).expect("the case can be read");
        let expected = fs::read_to_string(folder().join(format!("{case}.expected")));
        let expected = expected.expect("every case has its message");
        let found = match parse(&bytes, &file) {
            Ok(_) => format!("{file}: no error\n"),
            Err(error) => format!("{error}\n"),
        };
        if found != expected {
            mismatches.push_str(&format!("expected {expected}found    {found}\n"));
        }
    }
    assert!(mismatches.is_empty(), "\n{mismatches}");
}

#[test]
fn no_message_is_without_its_scene() {
    let messages = fs::read_dir(folder()).expect("the folder is there").filter(|entry| {
        entry
            .as_ref()
            .is_ok_and(|entry| entry.path().extension().is_some_and(|ending| ending == "expected"))
    });
    assert_eq!(messages.count(), cases().len());
    assert!(cases().len() >= 45);
}
