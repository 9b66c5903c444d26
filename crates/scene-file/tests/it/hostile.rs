//! Hostile input: deep, large, not a file, or random. It is refused in one line.

use std::fs::{self, File};
use std::path::Path;

use proptest::collection;
use proptest::prelude::*;
use proptest::sample::{self, Index};
use rayweave_scene_file::{
    MAX_BYTES, Position, REPORT_SCENE, SceneFileError, load, parse, path_text,
};

fn refusal(bytes: impl AsRef<[u8]>) -> SceneFileError {
    let error = parse(bytes.as_ref(), "x.toml").expect_err("malformed");
    assert_readable(&error);
    error
}

fn assert_readable(error: &SceneFileError) {
    let line = error.to_string();
    assert!(
        !line.chars().any(|c| c.is_control() || "\u{2028}\u{2029}\u{202e}".contains(c)),
        "{line:?}"
    );
    assert!(line.chars().count() < 1000, "{line}");
    assert!(line.starts_with(&error.file) && line.ends_with(&error.message), "{line}");
}

#[test]
fn an_error_has_all_its_pieces() {
    let text = REPORT_SCENE.replace("radius = 0.3\n", "radius = -1\n");
    let error = parse(text.as_bytes(), "scenes/room.toml").expect_err("a negative radius");
    let line = text.lines().position(|line| line == "radius = -1").expect("the line is there") + 1;
    let message = "expected a finite number above 0, found -1";
    let expected = SceneFileError {
        file: "scenes/room.toml".into(),
        position: Some(Position { line, column: 10 }),
        key: Some("sphere[2].radius".into()),
        message: message.into(),
    };
    assert_eq!(error, expected);
    let shown = format!("scenes/room.toml:{line}:10: sphere[2].radius: {message}");
    assert_eq!(error.to_string(), shown);
}

#[test]
fn deep_nesting_does_not_overflow_the_stack() {
    let deep = |text: &str| text.repeat(100_000);
    let limit = "not valid TOML: cannot recurse further; max recursion depth met, found ";
    for (text, message) in [
        (format!("a = {}", deep("[")), limit),
        (format!("a = {}{}", deep("["), deep("]")), limit),
        (format!("a = {}", deep("{a=")), limit),
        (format!("a = {}1{}", deep("{a="), deep("}")), limit),
        (format!("a = {}", deep("[{a=")), limit),
        (deep("["), "not valid TOML: "),
        (format!("{}a = 1", deep("a.")), "not valid TOML: recursion limit"),
        (format!("[{}a]", deep("a.")), "not valid TOML: recursion limit"),
        (format!("[[{}a]]", deep("a.")), "not valid TOML: recursion limit"),
        (format!("camera = {{ {}a = 1 }}", deep("a.")), "not valid TOML: recursion limit"),
    ] {
        let error = refusal(&text);
        assert!(error.message.starts_with(message), "{error}");
    }
    // As deep as TOML is read: still a value of the wrong type like any other.
    let deepest = format!("{}{}\n", "[".repeat(80), "]".repeat(80));
    let error = refusal(format!("sphere = {deepest}[camera]"));
    assert_eq!(error.key.as_deref(), Some("camera.position"));
    let error = refusal(REPORT_SCENE.replace("0.9\n", &deepest));
    assert_eq!(error.key.as_deref(), Some("sphere[0].radius"));
}

#[test]
fn long_input_does_not_make_a_long_message() {
    const LENGTH: usize = 1_000_000;
    for piece in "[ ] { \" ' \"\"\" a a. a=1\n [a]\n [[a]]\n # \\ - é".split(' ') {
        refusal(piece.repeat(LENGTH / piece.len()));
        refusal(format!("a = {}", piece.repeat(LENGTH / piece.len())));
        refusal(format!("a = \"{}", piece.repeat(LENGTH / piece.len())));
    }
    for byte in [0, 7, 0x1b, 0x7f, 0x80, 0xff] {
        refusal(vec![byte; LENGTH]);
    }
    let long = "x".repeat(LENGTH);
    let material = refusal(REPORT_SCENE.replace("\"blue\"", &format!("\"{long}\"")));
    assert_eq!(material.key.as_deref(), Some("sphere[0].material"));
    let key = refusal(REPORT_SCENE.replace("look_at", &long));
    assert_eq!(key.position.map(|position| position.column), Some(1));
    let digits = format!("antialiasing = {}", "9".repeat(LENGTH));
    let integer = refusal(REPORT_SCENE.replace("antialiasing = 2", &digits));
    assert!(integer.message.starts_with("expected an integer in 0..=32, found 999"), "{integer}");
    refusal(REPORT_SCENE.replace("material.red", &format!("material.{long}")));
}

#[test]
fn the_name_of_the_file_is_shown_without_its_control_characters() {
    let error = parse(b"", "a\nb\x1b[31m.toml").expect_err("an empty file");
    assert_eq!(error.to_string(), "a\\nb\\u{1b}[31m.toml:1:1: camera: missing, but required");
}

#[cfg(unix)]
#[test]
fn the_text_of_a_path_is_printable() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    for (path, text) in [
        (b"scenes/r\xc3\xa4um \"1\".toml".as_slice(), "scenes/r\u{e4}um \"1\".toml"),
        // An accent of its own, and a vowel sign.
        (b"e\xcc\x81.toml", "e\u{301}.toml"),
        (b"a\n\x1b[31m\x7f.toml", "a\\n\\u{1b}[31m\\u{7f}.toml"),
        // Neither the reversal of text nor what XML does not allow.
        (b"a\xe2\x80\xae\xef\xbf\xbe", "a\\u{202e}\\u{fffe}"),
        (b"a\xff\n", "a\\xff\\n"),
    ] {
        assert_eq!(path_text(Path::new(OsStr::from_bytes(path))), text);
    }
}

#[test]
fn every_prefix_of_a_scene_is_a_scene_or_refused() {
    let text = REPORT_SCENE.as_bytes();
    for length in 0..text.len() {
        match parse(&text[..length], "x.toml") {
            Ok(file) => assert_eq!(file.scene.check(), Ok(())),
            Err(error) => assert_readable(&error),
        }
    }
}

/// The message of [`load`] without the path, which it begins with.
fn unloadable(path: &Path) -> String {
    let error = load(path).expect_err("not a scene");
    assert_readable(&error);
    assert_eq!((error.position, error.key), (None, None));
    error.message
}

#[test]
fn only_regular_files_of_limited_size_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(unloadable(folder.path()), "expected a file, found a folder");
    let missing = unloadable(&folder.path().join("missing.toml"));
    assert!(missing.starts_with("cannot be read: "), "{missing}");
    let inside = folder.path().join("file");
    fs::write(&inside, "").expect("a file");
    assert!(unloadable(&inside.join("scene.toml")).starts_with("cannot be read: "));
    // Sparse: it has a length, but takes no room.
    let large = folder.path().join("large.toml");
    File::create(&large).and_then(|file| file.set_len(MAX_BYTES + 1)).expect("a sparse file");
    assert_eq!(unloadable(&large), "larger than the 256 MiB that a file may have");
}

#[cfg(unix)]
#[test]
fn devices_pipes_and_sockets_are_not_waited_for() {
    let refused = "expected a regular file, found a device, pipe or socket";
    assert_eq!(unloadable(Path::new("/dev/zero")), refused);
    assert_eq!(unloadable(Path::new("/dev/null")), refused);
    let folder = tempfile::tempdir().expect("a folder");
    let socket = folder.path().join("socket");
    let _listener = std::os::unix::net::UnixListener::bind(&socket).expect("a socket");
    assert_eq!(unloadable(&socket), refused);
    let pipe = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo");
    assert!(made.success());
    assert_eq!(unloadable(&pipe), refused);
    // A link to a device is a device, a link to itself is nothing.
    let (link, itself) = (folder.path().join("link"), folder.path().join("itself"));
    std::os::unix::fs::symlink("/dev/zero", &link).expect("a link");
    std::os::unix::fs::symlink(&itself, &itself).expect("a link");
    assert_eq!(unloadable(&link), refused);
    assert!(unloadable(&itself).starts_with("cannot be read: "));
}

/// Generates what a mutation inserts: bytes, or pieces that bring the text near to sense.
fn piece() -> impl Strategy<Value = Vec<u8>> {
    let words: Vec<&str> = "|\n|=|[|]|[[|]]|{|}|\"|'|\"\"\"|#|,|.|\\|\\u|-|inf|nan|1e999|0x|\
        99999999999999999999|true|1979-05-27|[sphere]|[[camera]]|[[sphere]]\n|\r|\u{feff}|\
        radius = 0\n|material = 1\n|a.b.c = 1\n|[material.x]\n|\u{202e}|é"
        .split('|')
        .collect();
    prop_oneof![
        collection::vec(any::<u8>(), 0..4),
        sample::select(words).prop_map(|word| word.as_bytes().to_vec()),
    ]
}

proptest! {
    #[test]
    fn a_mutated_scene_is_a_scene_or_refused_in_one_line(
        mutations in collection::vec((any::<Index>(), 0..6_usize, piece()), 1..8)
    ) {
        let mut text = REPORT_SCENE.as_bytes().to_vec();
        for (at, removed, inserted) in mutations {
            let start = at.index(text.len() + 1);
            let end = text.len().min(start + removed);
            text.splice(start..end, inserted);
        }
        match parse(&text, "x.toml") {
            Ok(file) => prop_assert_eq!(file.scene.check(), Ok(())),
            Err(error) => {
                assert_readable(&error);
                if let Some(Position { line, column }) = error.position {
                    let lines: Vec<&[u8]> = text.split(|&byte| byte == b'\n').collect();
                    prop_assert!((1..=lines.len()).contains(&line), "{}", error);
                    prop_assert!((1..=lines[line - 1].len() + 1).contains(&column), "{}", error);
                }
            }
        }
    }
}
