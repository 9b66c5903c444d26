//! Catches an example that computes something else than the others, or is not in the manifest.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

#[test]
fn all_examples_have_the_same_checksum() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = folder.read_dir().expect("the examples").map(|entry| entry.expect("one").path());
    let sources = files.filter(|path| path.extension().is_some_and(|ending| ending == "rs"));
    let names = sources.map(|path| path.file_stem().expect("a name").display().to_string());

    // `cargo test` has built them.
    let test = std::env::current_exe().expect("the test's own path");
    let built = test.ancestors().nth(2).expect("target/debug/deps/test").join("examples");
    let mut checksums = BTreeMap::<String, Vec<String>>::new();
    for name in names.filter(|name| name != "checksums") {
        let output = Command::new(built.join(&name)).output().unwrap_or_else(|e| {
            panic!("{name}: {e}: an example of the manifest, built by `cargo build --examples`?")
        });
        let text = String::from_utf8(output.stdout).expect("text");
        let (_, checksum) = text.trim_end().split_once(" s, checksum ").expect("a checksum");
        checksums.entry(checksum.to_owned()).or_default().push(name);
    }
    assert_eq!(checksums.len(), 1, "one checksum: {checksums:#?}");
    assert_eq!(checksums.values().map(Vec::len).sum::<usize>(), 7);
}
