//! `rayweave tradeoff` and `rayweave intersect`: their output, files and exit status.

mod program;

use program::{files_in, folder, rayweave, rayweave_json, repository, scene};
use serde_json::Value;
use std::fs;

/// Catches a missing setting, a format that others cannot read, and an image that is not written.
#[test]
fn tradeoff_writes_every_setting() {
    let folder = folder();
    let arguments = "tradeoff --size 6x4 --target-psnr 30 --csv a.csv --svg a.svg --pictures p";
    let (table, object) = rayweave_json(folder.path(), arguments);
    assert_eq!((&object["schema"], &object["width"]), (&Value::from(1), &Value::from(6)));
    let results = object["results"].as_array().expect("a list");
    // Four arithmetics, seven densities of the lattice and six of the other sampling, bounces 4, 1,
    // 0; five of them adaptive too, with all bounces.
    assert_eq!(results.len(), 4 * (13 * 3 + 5));
    let rounds = object["rounds"].as_u64().expect("a number") as usize;
    assert!(rounds >= 6);
    assert!(results.iter().all(|r| r["samples_ns"].as_array().is_some_and(|s| s.len() == rounds)));
    let csv = fs::read_to_string(folder.path().join("a.csv")).expect("the file");
    assert_eq!(csv.lines().count(), 1 + results.len());
    let svg = fs::read_to_string(folder.path().join("a.svg")).expect("the file");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for text in ["textbook f32", "textbook f64", "robust f32", "robust f64", "\n289\n"] {
        assert!(svg.contains(text), "{text}");
    }
    // The reference, and an image and a difference for each of the front and the lab report's.
    let on_front = results.iter().filter(|r| r["pareto"] == true).count();
    let pictures = files_in(&folder.path().join("p"));
    assert!(
        (1 + 2 * on_front..=3 + 2 * on_front).contains(&pictures.len()),
        "{on_front}: {pictures:?}"
    );
    assert!(pictures.contains(&"textbook-f32-25-lattice-rays-4-bounces-difference.png".to_owned()));
    for text in ["For 30 dB choose ", "whole scene", "cylinders", "Every timed image was verified."]
    {
        assert!(table.contains(text), "{text} in {table}");
    }
}

/// Catches depths or kinds of primitives that are tried although the scene has none.
#[test]
fn tradeoff_tries_what_the_scene_has() {
    let folder = folder();
    let plain = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n\
                 focal_length = 1\nscreen_width = 1\n[material.a]\ncolor = [1, 1, 1]\n\
                 [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"a\"\n";
    fs::write(folder.path().join("ball.toml"), plain).expect("written");
    // `error` is the command's old name, which still works.
    let (table, object) = rayweave_json(folder.path(), "error ball.toml --size 5x5");
    assert_eq!(object["results"].as_array().map(Vec::len), Some(4 * (13 + 5)));
    let parts: Vec<&Value> =
        object["costs"].as_array().expect("a list").iter().map(|c| &c["part"]).collect();
    assert_eq!(parts, ["whole scene", "spheres"]);
    assert!(!table.contains("planes"), "{table}");
}

/// Catches a line number that is off, a status other than 2, a file left behind.
#[test]
fn malformed_cases_are_named_by_their_line() {
    let folder = folder();
    let corpus = repository().join("crates/accuracy/corpus/hard-cases.jsonl");
    let text = fs::read_to_string(corpus).expect("the corpus");
    let first = text.lines().next().expect("a case");
    fs::write(folder.path().join("bad.jsonl"), format!("{first}\n\n{{\"id\": 3}}\n"))
        .expect("written");
    let message = rayweave(folder.path(), "intersect bad.jsonl --json out.jsonl").expect_refusal();
    assert!(message.starts_with("error: bad.jsonl: line 3, column "), "{message}");
    let message = rayweave(folder.path(), "intersect none.jsonl").expect_refusal();
    assert!(message.starts_with("error: none.jsonl: cannot be read"), "{message}");
    let hit = text.lines().find(|line| line.contains(r#""hit":true"#)).expect("a hit");
    let mut far: Value = serde_json::from_str(hit).expect("JSON");
    far["expect"]["t"] = "1000".into();
    for (name, text, status, problem) in [
        ("twice.jsonl", format!("{first}\n{first}\n"), 2, "is used twice"),
        ("empty.jsonl", "\n".to_owned(), 2, "there is no case in it"),
        // Some editors begin a file with a byte order mark.
        ("mark.jsonl", format!("\u{feff}{first}\n"), 0, ""),
        ("far.jsonl", far.to_string(), 1, "0 wrong, 1 far off"),
    ] {
        fs::write(folder.path().join(name), text).expect("written");
        let run = rayweave(folder.path(), &format!("intersect {name}"));
        assert_eq!(run.status, status, "{name}: {}", run.stderr);
        assert!(run.stderr.contains(problem), "{name}: {}", run.stderr);
        fs::remove_file(folder.path().join(name)).expect("removed");
    }
    if cfg!(unix) {
        let message = rayweave(folder.path(), "intersect /dev/zero").expect_refusal();
        assert!(message.contains("expected a regular file"), "{message}");
    }
    // The last two would overwrite their input.
    for arguments in [
        "tradeoff --target-psnr NaN",
        "tradeoff --size 3",
        "tradeoff --json a --csv a",
        "tradeoff no.toml --pictures p",
        "intersect bad.jsonl --json ./bad.jsonl",
        "tradeoff bad.jsonl --svg bad.jsonl",
    ] {
        rayweave(folder.path(), arguments).expect_refusal();
    }
    assert_eq!(files_in(folder.path()), ["bad.jsonl"]);
}

/// Catches results of other cases, a missing score, and a status that hides a wrong answer: the
/// textbook formulas leak where the robust ones do not.
#[test]
fn intersect_answers_each_case_and_scores_them() {
    let folder = folder();
    let corpus = repository().join("crates/accuracy/corpus/hard-cases.jsonl").display().to_string();
    let ids = |text: &str| -> Vec<String> {
        let value = |line: &str| serde_json::from_str::<Value>(line).expect("JSON");
        text.lines().map(|line| value(line)["id"].as_str().expect("an id").to_owned()).collect()
    };
    let cases = ids(&fs::read_to_string(&corpus).expect("the corpus"));
    for precision in ["f32", "f64"] {
        let run = rayweave(folder.path(), &format!("intersect {corpus} --precision {precision}"));
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert_eq!(ids(&run.stdout), cases);
        assert!(
            run.stderr.contains(": 0 wrong, 0 far off, 0 leaks, 0 not finite"),
            "{}",
            run.stderr
        );
        assert!(run.stderr.contains("a ray"), "no time: {}", run.stderr);
    }
    let run = rayweave(
        folder.path(),
        &format!("intersect {corpus} --formulas textbook --json out.jsonl"),
    );
    assert_eq!((run.status, run.stderr.as_str()), (1, ""));
    assert!(run.stdout.contains("mesh_edge"), "{}", run.stdout);
    let written = fs::read_to_string(folder.path().join("out.jsonl")).expect("the results");
    assert_eq!(ids(&written), cases);
}

/// Catches an option that is parsed and not used.
#[test]
fn sampling_changes_the_image() {
    let folder = folder();
    let digest = |options: &str| {
        let room = scene("room.toml");
        let text =
            rayweave(folder.path(), &format!("render {room} --size 20x20 -o a.ppm {options}"));
        text.expect_success().split("digest ").nth(1).expect("a digest")[..16].to_owned()
    };
    assert_eq!(digest(""), digest("--sampling lattice"));
    assert_ne!(digest(""), digest("--sampling importance"));
    // One ray a pixel is one ray a pixel.
    assert_eq!(digest("--antialiasing 0"), digest("--antialiasing 0 --sampling importance"));
}
