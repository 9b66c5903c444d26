//! `rayweave overhead` and `rayweave predict`: their output, files and exit status.

mod program;

use program::{expect_refusals, files_in, folder, rayweave_json, scene};
use rayweave_contract::Threads;
use serde_json::Value;
use std::fs;

fn results(object: &Value) -> &[Value] {
    object["results"].as_array().expect("a list")
}

fn is_positive(value: &Value) -> bool {
    value.as_f64().is_some_and(|value| value > 0.0)
}

#[test]
fn overhead_has_a_row_a_strategy() {
    let folder = folder();
    let strategies = ["sequential", rayweave_registry::recommended().name];
    let arguments =
        format!("overhead --strategy {} --threads 2 --time-limit 1", strategies.join(","));
    let (table, object) = rayweave_json(folder.path(), &arguments);
    for word in strategies.iter().chain(&["METG(50 %)", "break-even", "ns a piece", "machine: "]) {
        assert!(table.contains(word), "{word}: {table}");
    }

    assert_eq!(object["schema"], 1);
    assert!(object["rounds"].as_u64().expect("a number") >= 6);
    assert!(is_positive(&object["step_ns"]) && object["machine"]["compiler"].is_string());
    let [reference, recommended] = results(&object) else { panic!("{object}") };
    for (row, name, threads) in [(reference, strategies[0], 1), (recommended, strategies[1], 2)] {
        assert_eq!((&row["strategy"], &row["threads"]), (&name.into(), &threads.into()));
        for key in ["prepare_ns", "first_ns", "later_ns", "dispatch_one_ns", "dispatch_all_ns"] {
            let [low, median, high] =
                ["low", "median", "high"].map(|end| row[key][end].as_f64().expect("a number"));
            assert!(low <= median && median <= high, "{key}: {row}");
        }
        assert!(row["error"].is_null());
    }
    // The reference never breaks even with itself. On a busy machine even the shortest piece may
    // reach half of the best efficiency: then there is no shortest one.
    assert!(reference["break_even_side"].is_null());
    let metg = recommended.get("metg_ns").expect("a key");
    assert!(metg.is_null() || is_positive(metg), "{recommended}");
}

#[test]
fn predict_goes_beyond_the_threads_that_are_here() {
    let folder = folder();
    let name = rayweave_registry::recommended().name;
    let arguments = format!(
        "predict {} --size 40x30 --tile 4 --time-limit 2 --antialiasing 0 --threads 1..8,100 \
         --strategy {name} --svg a.svg",
        scene("room.toml")
    );
    let (text, object) = rayweave_json(folder.path(), &arguments);
    for word in [name, "Amdahl", "USL", "within 5 %", "assumed: ", "\nnoise: ", "arithmetic: "] {
        assert!(text.contains(word), "{word}: {text}");
    }
    assert!(fs::read_to_string(folder.path().join("a.svg")).expect("the plot").contains(name));

    assert_eq!(
        (&object["schema"], &object["width"], &object["tile"]),
        (&1.into(), &40.into(), &4.into())
    );
    assert!(object["scene"].as_str().expect("text").ends_with("room.toml"));
    let threads: Vec<u64> =
        results(&object).iter().filter_map(|row| row["threads"].as_u64()).collect();
    assert_eq!(threads, [1, 2, 4, 8, 100]);
    let here = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    for row in results(&object) {
        assert!(is_positive(&row["predicted"]), "{row}");
        let is_here = row["threads"].as_u64().expect("a number") <= here;
        assert_eq!(is_here, row["measured"]["median"].is_number(), "{row}");
        assert_eq!(is_here, row["difference"].is_number(), "{row}");
    }
    let law = &object["laws"][0];
    assert_eq!(law["strategy"], name);
    for (law, keys) in
        [(&law["amdahl"], &["serial", "error"][..]), (&law["usl"], &["sigma", "kappa", "error"])]
    {
        assert!(
            keys.iter().all(|key| law[key].as_f64().is_some_and(|share| share >= 0.0)),
            "{law}"
        );
    }
    assert!(is_positive(&law["overheads"]["start_ns"]), "{law}");
    assert!(is_positive(&object["noise"]["wall_s"]), "{}", object["noise"]);
    assert_eq!(object["assumptions"].as_array().map(Vec::len), Some(5));
}

/// Catches a strategy whose policy cannot be simulated, or whose pieces are not timed.
#[test]
fn predict_takes_every_strategy_that_starts_threads() {
    let folder = folder();
    let arguments = "predict --size 12x9 --time-limit 2 --antialiasing 1 --threads 1,3";
    let (_, object) = rayweave_json(folder.path(), arguments);
    let parallel = rayweave_registry::STRATEGIES.iter().filter(|s| s.threads != Threads::None);
    let unavailable = object["unavailable"].as_array().expect("a list").len();
    assert_eq!(results(&object).len(), 2 * (parallel.count() - unavailable));
    assert!(results(&object).iter().all(|row| is_positive(&row["predicted"])));
}

#[test]
fn requests_that_cannot_be_met_are_refused() {
    let folder = folder();
    fs::create_dir(folder.path().join("folder")).expect("a folder");
    let cases = [
        ("predict --threads 0..4", "1..=1024"),
        ("predict --threads 1..1025", "1..=1024"),
        ("predict --threads 8..2", "2..8"),
        ("predict --threads many", "1..=1024"),
        ("predict --strategy nope", "sequential"),
        ("predict missing.toml", "missing.toml: cannot be read"),
        ("predict --svg folder", "it is a folder"),
        ("predict --json a.json --svg a.json", "named twice"),
        ("predict --tile 0", "0"),
        (
            "predict --size 4097x2048",
            "too many to record each: use a smaller --size, of at most 8388608 pixels",
        ),
        ("overhead --threads 1025", "1..=1024"),
        ("overhead --strategy nope", "sequential"),
        ("overhead --json missing/a.json", "no folder missing"),
    ];
    expect_refusals(folder.path(), "", &cases);
    assert_eq!(files_in(folder.path()), ["folder"]);
}
