//! The default output of `rayweave compare`: its width, its columns, equal work, and its image.

mod program;

use program::{expect_refusals, folder, rayweave, rayweave_json, scene};
use serde_json::Value;
use std::fs;

/// Catches a line that a terminal of 80 columns folds, and a hint at something that is not there.
#[test]
fn the_first_screen_fits_80_columns() {
    let folder = folder();
    let long = "a-scene-with-a-long-name-".repeat(5) + ".toml";
    fs::copy(scene("lab.toml"), folder.path().join(&long)).expect("copied");
    for options in [
        "--threads 1,2,64 --strategy scoped-bands,row-counter,mutex-rows".to_owned(),
        format!("compare {long} --threads 2"),
        format!("compare --scenes {long},{} --threads 2", scene("lab.toml")),
        "compare --share-samples both --lanes 8 --antialiasing 1 --threads 2".to_owned(),
        "compare --equal-work off --threads 3 --precision-goal 1%".to_owned(),
    ] {
        let run = rayweave(folder.path(), &format!("{options} --size 8x8 --time-limit 1"));
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{}", run.stdout);
        let longest = run.stdout.lines().max_by_key(|line| line.chars().count());
        assert!(longest.is_some_and(|line| line.chars().count() <= 80), "{}", run.stdout);
    }
    for hint in ["explain --strategy tile-queue --size 8x8 --time-limit 1", "strategies"] {
        rayweave(folder.path(), hint).expect_success();
    }
}

#[test]
fn columns_are_chosen_by_their_names() {
    let folder = folder();
    let small = "compare --size 8x8 --threads 2 --strategy tile-queue --time-limit 1";
    let run =
        |options: &str| rayweave(folder.path(), &format!("{small} {options}")).expect_success();
    let text = run("--columns strategy,lanes --lanes 16 --antialiasing 0 --tile 1");
    let row = text.lines().find(|line| line.starts_with("tile-queue")).expect("the row");
    assert_eq!(row.split_whitespace().collect::<Vec<_>>(), ["tile-queue", "6", "%"], "{text}");
    let text = run("--full");
    let heading = text.lines().find(|line| line.starts_with("strategy ")).expect("the heading");
    assert!(heading.contains("efficiency") && heading.contains("lanes"), "{text}");
    assert!(text.contains("\nnoise: ") && text.contains("\narithmetic: "), "{text}");
    let cases = [
        ("--columns nope", "[possible values: strategy, threads, median, cold, speed-up,"),
        ("--columns rays --full", "cannot be used with"),
    ];
    expect_refusals(folder.path(), small, &cases);
}

/// Catches strategies that are compared on unequal work though nobody asked for it, and an option
/// that lifts more than its own part.
#[test]
fn the_work_is_equal_unless_options_say_otherwise() {
    let folder = folder();
    let run = |command: &str, options: &str| {
        let small = "--size 8x8 --antialiasing 1 --threads 2 --strategy tile-queue --time-limit 1";
        let (text, object) = rayweave_json(folder.path(), &format!("{command} {small} {options}"));
        (text, ["lanes", "share_samples"].map(|key| object["results"][0][key].clone()))
    };
    let (_, auto) = run("compare", "--equal-work off");
    assert_eq!((auto[0].as_u64() > Some(1), &auto[1]), (true, &Value::from(true)));
    for (options, expected) in [
        ("", [Value::from(1), Value::from(false)]),
        ("--equal-work on --share-samples on", [Value::from(1), Value::from(true)]),
        ("--lanes 8", [Value::from(8), Value::from(false)]),
        ("--lanes auto", [auto[0].clone(), Value::from(false)]),
    ] {
        let (text, keys) = run("compare", options);
        assert_eq!(keys, expected, "{options}: {text}");
        assert_eq!(text.contains("Equal work: "), options.is_empty(), "{options}: {text}");
    }
    // A pixel has 9 rays; with shared samples the only tile has 10 x 10 lattice points.
    let rays = |options: &str| {
        let small = "explain --size 8x8 --antialiasing 1 --threads 2 --strategy tile-queue";
        let (_, object) =
            rayweave_json(folder.path(), &format!("{small} --time-limit 1 {options}"));
        let threads = object["results"][0]["threads_recorded"].as_array().expect("a list").clone();
        threads.iter().filter_map(|thread| thread["primary_rays"].as_u64()).sum::<u64>()
    };
    assert_eq!((rays(""), rays("--equal-work off")), (64 * 9, 10 * 10));
}

/// Catches a default image that takes minutes, a scene file whose own size is ignored, and an
/// explanation of another image than the one that was compared.
#[test]
fn the_built_in_scene_is_compared_explained_and_predicted_at_one_size() {
    let folder = folder();
    let size = |command: &str| {
        let fast = "--antialiasing 0 --time-limit 1";
        let (_, object) = rayweave_json(folder.path(), &format!("{command} {fast}"));
        let measured = if command.starts_with("compare") { &object["results"][0] } else { &object };
        ["width", "height"].map(|key| measured[key].as_u64())
    };
    let help = |command: &str| {
        let text = rayweave(folder.path(), &format!("{command} --help")).expect_success();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let lab = scene("lab.toml");
    for (command, strategy) in
        [("compare", "sequential"), ("explain", "tile-queue"), ("predict", "tile-queue")]
    {
        let size = |file: &str| {
            size(&format!("{command} {file} --strategy {strategy}").replace("  ", " "))
        };
        assert_eq!(size(""), [Some(250); 2], "{command}");
        assert_eq!(size(&lab), [Some(500); 2], "{command}");
        let help = help(command);
        assert!(help.contains("the scene's; 250x250 for the built-in scene"), "{help}");
    }
    let off = "compare --equal-work off --strategy sequential";
    assert_eq!(size(off), [Some(250); 2], "equal work or not");
    let help = help("render");
    assert!(help.contains("[default: the scene's]") && !help.contains("250x250"), "{help}");
}
