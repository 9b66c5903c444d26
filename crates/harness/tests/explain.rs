//! `rayweave explain`: its output, files and exit status.

mod program;

use program::{expect_refusals, files_in, folder, json, rayweave, rayweave_json};
use std::fs;

const CAUSES: [&str; 6] =
    ["redundant", "slowdown", "dispatch", "contention", "imbalance", "serial"];

/// Catches a time breakdown that leaves something out and so does not add up.
#[test]
fn explain_writes_what_it_measured_of_every_strategy() {
    let folder = folder();
    let names: Vec<&str> =
        rayweave_registry::available().iter().map(|strategy| strategy.name).collect();
    let arguments = format!(
        "explain --size 40x30 --threads 2 --tile 8 --time-limit 2 --strategy {} \
         --trace a.trace.json --pictures drawn",
        names.join(",")
    );
    let (text, object) = rayweave_json(folder.path(), &arguments);
    let results = object["results"].as_array().expect("a list");
    assert_eq!(
        results.iter().map(|result| result["strategy"].as_str()).collect::<Vec<_>>().len(),
        names.len()
    );
    for (result, name) in results.iter().zip(&names) {
        assert_eq!(result["strategy"], **name);
        let number = |key: &str| result[key].as_f64().unwrap_or_else(|| panic!("{name}: {key}"));
        let losses: f64 =
            CAUSES.iter().filter_map(|cause| result["losses_ns"][cause].as_f64()).sum();
        let (lost, rest) = (number("lost_ns"), number("unexplained_ns"));
        assert!((losses + rest - lost).abs() <= 1.0, "{name}: {losses} and {rest} of {lost}");
        let threads = result["threads_recorded"].as_array().expect("a list");
        let pixels: u64 = threads.iter().filter_map(|thread| thread["pixels"].as_u64()).sum();
        assert_eq!(pixels, 40 * 30, "{name}");
        // It has one thread although two are requested.
        let threads = if *name == "sequential" { "1 thread" } else { "2 threads" };
        assert!(text.contains(&format!("{name} on {threads}: ")), "{text}");
    }
    assert!(text.contains("imbalance") && text.contains("explained: "), "{text}");
    assert!(text.contains("\nnoise: ") && object["noise"]["wall_s"].as_f64() > Some(0.0), "{text}");

    let trace = json(&folder.path().join("a.trace.json"));
    let events = trace["traceEvents"].as_array().expect("a list");
    let processes = events.iter().filter(|event| event["name"] == "process_name").count();
    assert_eq!(processes, names.len());
    let mut expected: Vec<String> = names
        .iter()
        .flat_map(|name| {
            ["cost.svg", "threads.png", "timeline.svg"].map(|what| format!("{name}-{what}"))
        })
        .collect();
    expected.sort();
    assert_eq!(files_in(&folder.path().join("drawn")), expected);
    let owners = fs::read(folder.path().join("drawn").join(format!("{}-threads.png", names[0])));
    // Width and height are at byte 16 in big-endian order.
    let owners = owners.expect("the image");
    assert_eq!((&owners[1..4], &owners[16..24]), (&b"PNG"[..], &[0, 0, 0, 40, 0, 0, 0, 30][..]));
}

#[test]
fn without_a_strategy_the_recommended_one_is_explained() {
    let text = rayweave(folder().path(), "explain --size 16x16").expect_success();
    let name = rayweave_registry::recommended().name;
    assert_eq!(text.matches("explained: ").count(), 1, "{text}");
    assert!(text.contains(&format!("\n{name} on ")), "{text}");
}

#[test]
fn requests_that_cannot_be_met_are_refused_before_any_work() {
    let folder = folder();
    fs::write(folder.path().join("file"), "").expect("written");
    let cases = [
        ("explain --size 4097x2048", "use a smaller --size"),
        ("explain --strategy nope", "sequential"),
        ("explain --threads 1,2", "1..=1024"),
        ("explain --json a.json --trace a.json", "named twice"),
        ("explain --trace missing/a.json", "no folder missing"),
        ("explain --pictures file", "file: cannot be made"),
        ("explain --share-samples both", "only `compare`"),
    ];
    expect_refusals(folder.path(), "", &cases);
    assert_eq!(files_in(folder.path()), ["file"]);
}
