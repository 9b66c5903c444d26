//! `rayweave compare`, and `rayweave sample`, which it starts: output, files and exit status.

mod program;

use program::{expect_refusals, folder, json, rayweave, rayweave_json, repository};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Runs `sample` with a job of `parent` for `scene`, which is JSON.
fn sample(folder: &Path, parent: u32, scene: &str, count_rays: bool) -> program::Run {
    let image = r#""size":[9,7],"antialiasing":1,"sampling":"Importance","precision":"F64""#;
    let execution = r#""formulas":"Textbook","lanes":"One","share_samples":"Off","adaptive":"Off""#;
    let accel = r#""accel":"None""#;
    let job = format!(
        r#"{{"parent":{parent},"scene":{scene},"options":{{{image},{execution},{accel}}},"tile":4,"#
    ) + &format!(r#""strategy":"tile-queue","threads":2,"count_rays":{count_rays}}}"#);
    rayweave(folder, &format!("sample {job}"))
}

/// Returns the answer of `sample` to a job of this process.
fn answer(folder: &Path, scene: &str, count_rays: bool) -> Value {
    let answer = sample(folder, std::process::id(), scene, count_rays).expect_success();
    serde_json::from_str(&answer).expect("a line of JSON")
}

/// Catches a sample that goes on although nobody waits for it any more.
#[cfg(target_os = "linux")]
#[test]
fn a_sample_without_its_parent_ends() {
    let message = sample(folder().path(), 1, "null", false).expect_refusal();
    assert_eq!(message, "error: the process that asked for this sample has ended\n");
}

/// Catches an option that does not reach the process of a sample.
#[test]
fn a_sample_renders_as_the_comparison_says() {
    let folder = folder();
    let options = "--size 9x7 --antialiasing 1 --sampling importance --precision f64 \
                   --formulas textbook --lanes 1 --share-samples off --adaptive off \
                   --accel none";
    let rendered = rayweave(folder.path(), &format!("render {options} -o a.ppm")).expect_success();
    let digest = rendered.split("digest ").nth(1).expect("a digest")[..16].to_owned();
    let compare = format!("compare {options} --strategy tile-queue --threads 2 --time-limit 1");
    let (_, object) = rayweave_json(folder.path(), &compare);
    let expected = &object["results"][0]["reference_digest"];
    assert!(
        expected.as_str().is_some_and(|whole| whole.starts_with(&digest)),
        "{digest}: {object}"
    );

    let sample = answer(folder.path(), "null", false)["Ok"].take();
    assert_eq!((&sample["digest"], &sample["cold_digest"]), (expected, expected));
    assert!(sample["cold_ns"].as_u64() > sample["prepare_ns"].as_u64(), "{sample}");
    assert!(sample["render_ns"].as_u64() > Some(0) && sample["primary_rays"].is_null(), "{sample}");
    assert_eq!(sample["cpu_ns"].is_u64(), cfg!(unix));

    let counted = answer(folder.path(), "null", true)["Ok"].take();
    assert_eq!(counted["primary_rays"], 9 * 7 * 5);
    assert!(counted["cold_ns"].is_null(), "{counted}");
}

#[cfg(unix)]
#[test]
fn a_sample_that_fails_says_why_and_is_listed_nowhere() {
    let folder = folder();
    let scene = format!(r#"{{"Unix":{:?}}}"#, b"missing.toml").replace(' ', "");
    let answer = answer(folder.path(), &scene, false);
    let reason = answer["Err"].as_str().expect("a reason");
    assert!(reason.starts_with("missing.toml: cannot be read"), "{reason}");
    let refused = rayweave(folder.path(), "sample {}").expect_refusal();
    assert!(refused.contains("not a job in JSON: missing field"), "{refused}");
    let help = rayweave(folder.path(), "--help").expect_success();
    assert!(help.contains("compare") && !help.contains("sample of a comparison"), "{help}");
}

#[test]
fn a_scene_may_be_called_like_an_option() {
    let folder = folder();
    fs::copy(program::scene("lab.toml"), folder.path().join("--help.toml")).expect("copied");
    let small = "--size 4x4 --antialiasing 0 --strategy sequential --time-limit 1";
    let text = rayweave(folder.path(), &format!("compare {small} -- --help.toml")).expect_success();
    assert!(text.contains("--help.toml, 4 x 4 pixels with one ray each; 1 strategy, "), "{text}");
}

/// Catches ignored limits: 40 rounds although the goal needs more, or more although it is met.
#[test]
fn rounds_follow_the_goal_and_the_limit() {
    let folder = folder();
    let run = |options: &str| {
        let small = "compare --size 4x4 --antialiasing 0 --strategy sequential";
        let (text, object) = rayweave_json(folder.path(), &format!("{small} {options}"));
        let rounds = object["results"][0]["rounds"].as_u64().expect("a number");
        (text, rounds, object["precision_goal"].clone())
    };
    let (text, rounds, goal) = run("--precision-goal 100% --time-limit 600");
    assert!(
        rounds < 40 && text.contains("goal: each speed-up is known to +-100.000 % or better."),
        "{text}"
    );
    assert_eq!(goal, Value::from(1.0));
    let (text, rounds, goal) = run("--precision-goal 0.001 --time-limit 1");
    assert!(rounds >= 8 && text.contains("not known to +-0.001 %"), "{text}");
    assert_eq!(goal, Value::from(0.00001));
    let (text, _, goal) = run("--time-limit 1");
    assert!(!text.contains("goal:") && goal.is_null(), "{text}");
}

#[test]
fn noise_is_reported() {
    let folder = folder();
    let arguments = "compare --size 4x4 --strategy sequential --time-limit 1 --full";
    let (text, object) = rayweave_json(folder.path(), arguments);
    assert!(text.contains("\nnoise: "), "{text}");
    let noise = &object["noise"];
    assert!(noise["wall_s"].as_f64() > Some(0.0) && noise["disturbed"].is_boolean(), "{noise}");
    if cfg!(target_os = "linux") {
        assert!(
            noise["foreign_cpu_s"].is_f64() && noise["involuntary_switches"].is_u64(),
            "{noise}"
        );
    }
}

#[test]
fn compare_writes_what_other_programs_read() {
    let folder = folder();
    let arguments =
        "compare --size 24x16 --antialiasing 1 --threads 1,2 --time-limit 1 --csv a.csv";
    let (table, object) = rayweave_json(folder.path(), arguments);
    assert_eq!(object["schema"], 2);
    let results = object["results"].as_array().expect("a list");
    let first = &results[0];
    assert_eq!((&first["width"], &first["height"]), (&Value::from(24), &Value::from(16)));
    assert!(first["scene"].is_string() && object["machine"].is_object());
    // The reference, its control, and the other strategies with one and with two threads.
    assert_eq!(results.len(), 2 + 2 * (rayweave_registry::available().len() - 1));
    let digest = &results[0]["digest"];
    for result in results {
        assert_eq!(result["identical"], true);
        assert_eq!(&result["digest"], digest);
        for key in ["samples_ns", "prepare_samples_ns", "cold_samples_ns"] {
            let samples = &result[key];
            let samples = samples.as_array().expect("a list");
            assert!(samples.len() >= 8 && samples.iter().all(Value::is_u64));
        }
        assert!(result["cold_ns"].is_u64() && result["cold_speedup"]["median"].is_f64());
        assert!(result["median_ns"].is_number());
        let [low, median, high] =
            ["low", "median", "high"].map(|key| result["speedup"][key].as_f64().expect("a number"));
        assert!(low <= median && median <= high);
        let name = result["strategy"].as_str().expect("a name");
        assert!(name == "sequential" || table.contains(&format!("\n  {name} ")), "{table}");
    }
    let csv = fs::read_to_string(folder.path().join("a.csv")).expect("the file");
    assert_eq!(csv.lines().count(), 1 + results.len());
}

/// Returns the list of results.
fn results(object: &Value) -> Vec<Value> {
    object["results"].as_array().expect("a list").clone()
}

/// Returns the number of shared samples: a lattice of density `density` with its margin in each
/// tile of `sides`.
fn lattice_points(density: u64, sides: &[(u64, u64)]) -> u64 {
    let points = |side: u64| density * (side + 1) + 1;
    sides.iter().map(|&(width, height)| points(width) * points(height)).sum()
}

/// Returns the rays of a strategy and the redundant ones, which are equal in all of its results.
fn rays(results: &[Value], strategy: &str) -> (u64, u64) {
    let results = results.iter();
    let mut found: Vec<(u64, u64)> = results
        .filter(|result| result["strategy"] == strategy)
        .map(|result| {
            ["primary_rays", "redundant_rays"].map(|key| result[key].as_u64().expect("a number"))
        })
        .map(<(u64, u64)>::from)
        .collect();
    found.dedup();
    assert_eq!(found.len(), 1, "{strategy}: {found:?}");
    found[0]
}

#[test]
fn compare_counts_the_rays_of_the_tiles_that_each_strategy_cuts() {
    let folder = folder();
    let run = |options: &str| {
        let arguments = format!(
            "compare --size 24x16 --threads 2 --tile 10 --equal-work off {options} --time-limit 1 \
             --full"
        );
        let (table, object) = rayweave_json(folder.path(), &arguments);
        (table, results(&object))
    };

    let (table, object) = run("--antialiasing 2");
    let needed = lattice_points(2, &[(24, 16)]);
    // Two rows of tiles, 10 and 6 pixels high, each of 10, 10 and 4 pixels.
    let tiles = [(10, 10), (10, 10), (4, 10), (10, 6), (10, 6), (4, 6)];
    let by_tiles = (lattice_points(2, &tiles), lattice_points(2, &tiles) - needed);
    assert_eq!(rays(&object, "sequential"), by_tiles);
    assert_eq!(rays(&object, "tile-queue"), by_tiles);
    let by_pixels = (24 * 16 * 25, 24 * 16 * 25 - needed);
    assert_eq!(rays(&object, "rayon-pixels"), by_pixels);
    assert_eq!(rays(&object, "mutex-image"), by_pixels);
    assert!(
        table.contains("  5.6/px +21.3 %  ") && table.contains("  25.0/px +438 %  "),
        "{table}"
    );

    for (options, a_pixel) in [
        ("--antialiasing 2 --share-samples off", 25),
        ("--antialiasing 2 --sampling importance", 13),
        ("--antialiasing 0", 1),
    ] {
        let (_, object) = run(options);
        for strategy in rayweave_registry::available() {
            assert_eq!(rays(&object, strategy.name), (24 * 16 * a_pixel, 0), "{options}");
        }
    }
}

#[test]
fn compare_does_not_count_adaptive_samples() {
    let folder = folder();
    let arguments = "compare --size 8x8 --antialiasing 2 --adaptive on --strategy sequential \
                     --time-limit 1 --full";
    let (table, object) = rayweave_json(folder.path(), arguments);
    assert!(table.contains("up to 25 rays each") && !table.contains("/px"), "{table}");
    let first = &object["results"][0];
    assert_eq!((&first["adaptive"], first.get("primary_rays")), (&true.into(), Some(&Value::Null)));
}

#[test]
fn compare_says_how_the_image_is_computed() {
    let folder = folder();
    let run = |options: &str| {
        let small = "compare --size 8x8 --threads 1 --strategy sequential --time-limit 1 --full \
             --equal-work off";
        let (table, object) = rayweave_json(folder.path(), &format!("{small} {options}"));
        let line =
            table.lines().find(|line| line.starts_with("computed: ")).expect("the line").to_owned();
        let first = &object["results"][0];
        (line, ["lanes", "share_samples", "accel"].map(|key| first[key].clone()))
    };
    let (line, keys) = run("--antialiasing 1 --lanes 8 --precision f32");
    assert_eq!(line, "computed: 8 rays side by side, samples shared, acceleration auto");
    assert_eq!(keys, [Value::from(8), Value::from(true), Value::from("auto")]);
    let (line, keys) =
        run("--antialiasing 1 --lanes 8 --precision f64 --share-samples off --search exhaustive");
    assert_eq!(line, "computed: 4 rays side by side, samples not shared, acceleration none");
    assert_eq!(keys, [Value::from(4), Value::from(false), Value::from("none")]);
    // Mirrors scatter neighbouring rays there.
    let imbalance = repository().join("scenes/imbalance.toml");
    let (line, _) = run(&format!("{} --antialiasing 1", imbalance.display()));
    assert_eq!(line, "computed: rays one by one, samples shared, acceleration auto");
}

#[test]
fn compare_measures_both_ways_to_share_samples() {
    let folder = folder();
    let arguments = "compare --size 24x16 --antialiasing 2 --threads 2 --share-samples both \
                     --time-limit 1 --csv a.csv";
    let (text, object) = rayweave_json(folder.path(), arguments);
    let place = |part: &str| text.find(part).unwrap_or_else(|| panic!("{part}: {text}"));
    let (shared, unshared) = (place("Samples shared."), place("Samples not shared."));
    assert!(shared < unshared && unshared < place("Sharing samples makes sequential "), "{text}");
    assert_eq!(text.matches("Equal work: ").count(), 1, "{text}");

    let all = results(&object);
    let (with, without) = all.split_at(all.len() / 2);
    assert_eq!(with.len(), 2 + rayweave_registry::available().len() - 1);
    assert!(with.iter().all(|result| result["share_samples"] == true));
    assert!(without.iter().all(|result| result["share_samples"] == false));
    // The same image, in the same rounds.
    for key in ["reference_digest", "rounds"] {
        assert!(all.iter().all(|result| result[key] == all[0][key]), "{key}");
    }
    assert!(object["sharing_speedup"]["median"].as_f64().expect("a number") > 0.0);
    assert_eq!(rays(without, "tile-queue"), (24 * 16 * 25, 0));
    let tile = lattice_points(2, &[(24, 16)]);
    assert_eq!(rays(with, "tile-queue"), (tile, 0), "one tile is the whole image");
    let csv = fs::read_to_string(folder.path().join("a.csv")).expect("the file");
    assert_eq!(csv.lines().count(), 1 + all.len());
}

#[test]
fn without_a_command_it_compares() {
    let folder = folder();
    let strategy = rayweave_registry::recommended().name;
    let table = rayweave(
        folder.path(),
        &format!("--size 16x16 --threads 2 --strategy {strategy} --time-limit 1"),
    )
    .expect_success();
    assert!(table.contains(strategy) && table.contains("thread against itself"), "{table}");
}

#[test]
fn a_baseline_says_what_has_changed() {
    let folder = folder();
    let small =
        "compare --size 4x4 --antialiasing 0 --strategy tile-queue --threads 1 --time-limit 1";
    rayweave(folder.path(), &format!("{small} --json old.json --markdown old.md")).expect_success();
    let text = rayweave(folder.path(), &format!("{small} --baseline old.json --json new.json"))
        .expect_success();
    assert!(
        text.contains("changes since the baseline") && !text.contains("ANOTHER IMAGE"),
        "{text}"
    );
    let changes = &json(&folder.path().join("new.json"))["changes"];
    assert!(changes[1]["time"]["low"].as_f64() > Some(0.0) && changes[2].is_null(), "{changes}");
    let markdown = fs::read_to_string(folder.path().join("old.md")).expect("the file");
    assert!(markdown.contains("\n| tile-queue | 1 | "), "{markdown}");

    let cases = [
        ("--baseline missing.json", "missing.json: cannot be read: "),
        ("--baseline old.md", "old.md: cannot be a baseline: not the JSON of a comparison"),
        ("--baseline old.json --json old.json", "old.json: is named twice"),
        (
            "--baseline old.json --share-samples on --json new.json",
            "old.json: cannot be a baseline: share_samples was false and is true now: use",
        ),
        (
            "--baseline old.json --tile 2 --json new.json",
            "old.json: cannot be a baseline: tile was 32 and is 2 now: use the same scene and",
        ),
    ];
    expect_refusals(folder.path(), small, &cases);
}

#[test]
fn scenes_stand_beside_each_other() {
    let folder = folder();
    let small = "compare --size 8x8 --strategy tile-queue --threads 2 --time-limit 1";
    let text = rayweave(
        &repository(),
        "compare --size 8x8 --strategy tile-queue --time-limit 1 --scenes all",
    )
    .expect_success();
    for scene in ["balanced", "columns", "corner", "free", "tile"] {
        assert!(
            text.lines().any(|line| line.starts_with(&format!("{scene}: "))),
            "{scene}: {text}"
        );
    }
    let two = format!("{},{}", program::scene("lab.toml"), program::scene("loads/free.toml"));
    let (_, object) = rayweave_json(folder.path(), &format!("{small} --scenes {two}"));
    let results = results(&object);
    let scene = |number: usize| results[number]["scene"].as_str().expect("a path");
    // Each has the reference, its control and the queue.
    assert!(results.len() == 6 && scene(0).ends_with("lab.toml"));
    assert!(scene(3).ends_with("free.toml") && results[5]["largest_tile"] == 1.0);

    let cases = [
        ("--scenes all", "go to the repository's folder"),
        ("--scenes missing.toml", "missing.toml: cannot be read"),
        ("a.toml --scenes b.toml", "--scenes must name all scenes"),
        ("--scenes a.toml --share-samples both", "on or off"),
        ("--scenes a.json --json a.json", "no input or result is overwritten"),
        ("--scenes a.toml,./a.toml", "./a.toml is named twice: name it once"),
    ];
    expect_refusals(folder.path(), small, &cases);
}
