//! The command line: the program runs, and its output, files and exit status are checked.

mod program;

use program::{Run, expect_refusals, files_in, folder, rayweave, rayweave_json, repository, scene};
use std::fs;
use std::process::Command;

#[test]
fn strategies_lists_the_registry_in_its_order() {
    let text = rayweave(folder().path(), "strategies").expect_success();
    let names: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with(' '))
        .filter_map(|line| line.split(' ').next())
        .collect();
    let expected: Vec<&str> = rayweave_registry::STRATEGIES.iter().map(|s| s.name).collect();
    assert_eq!(names, expected);
}

#[test]
fn render_works_from_any_folder_and_names_the_image_after_the_scene() {
    let folder = folder();
    let text = rayweave(folder.path(), "render --size 20x10").expect_success();
    assert_eq!(files_in(folder.path()), ["report.png"]);
    assert!(text.contains("20 x 10") && text.contains("written to report.png"), "{text}");
    rayweave(folder.path(), &format!("render {} --size 20x10", scene("room.toml")))
        .expect_success();
    assert_eq!(files_in(folder.path()), ["report.png", "room.png"]);
}

#[test]
fn render_gives_the_same_file_with_every_strategy() {
    let folder = folder();
    let mut files = Vec::new();
    for strategy in rayweave_registry::available() {
        let name = strategy.name;
        for format in ["ppm", "exr", "png"] {
            let arguments =
                format!("render --size 33x21 --strategy {name} --threads 3 -o {name}.{format}");
            rayweave(folder.path(), &arguments).expect_success();
        }
        let read =
            |format| fs::read(folder.path().join(format!("{name}.{format}"))).expect("the image");
        assert!(read("ppm").starts_with(b"P6\n33 21 255\n"));
        assert!(read("exr").starts_with(&[0x76, 0x2f, 0x31, 0x01]));
        assert!(read("png").starts_with(b"\x89PNG"));
        files.push([read("ppm"), read("exr"), read("png")]);
    }
    assert!(files.iter().all(|file| *file == files[0]));
}

#[test]
fn render_replaces_an_image_and_leaves_nothing_beside_it() {
    let folder = folder();
    fs::write(folder.path().join("a.ppm"), "old").expect("written");
    rayweave(folder.path(), "render --size 8x8 --antialiasing 0 -o a.ppm").expect_success();
    assert_eq!(files_in(folder.path()), ["a.ppm"]);
    assert!(fs::read(folder.path().join("a.ppm")).expect("the image").starts_with(b"P6"));
}

#[cfg(unix)]
#[test]
fn an_image_is_an_ordinary_file_and_a_link_stays_a_link() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = folder();
    symlink("target.ppm", folder.path().join("link.ppm")).expect("a link");
    fs::write(folder.path().join("target.ppm"), "old").expect("written");
    rayweave(folder.path(), "render --size 4x4 -o link.ppm").expect_success();
    assert!(fs::symlink_metadata(folder.path().join("link.ppm")).expect("there").is_symlink());
    assert!(fs::read(folder.path().join("target.ppm")).expect("there").starts_with(b"P6"));
    rayweave(folder.path(), "render --size 4x4 -o new.ppm").expect_success();
    let mode = fs::metadata(folder.path().join("new.ppm")).expect("there").permissions().mode();
    assert_eq!(mode & 0o400, 0o400);
    assert_ne!(mode & 0o044, 0, "as readable for others as any file: {mode:o}");
}

#[test]
fn precision_is_chosen_by_the_scene_or_by_hand() {
    let folder = folder();
    let digest = |precision: &str| {
        let arguments = format!("render --size 40x40 --precision {precision} -o {precision}.ppm");
        let text = rayweave(folder.path(), &arguments).expect_success();
        text.split("digest ").nth(1).expect("a digest")[..16].to_owned()
    };
    assert_eq!(digest("auto"), digest("f32"));
    assert_ne!(digest("f64"), digest("f32"));
}

/// Catches an old name that no longer works, or that the help lists.
#[test]
fn old_names_still_work() {
    let folder = folder();
    for option in ["--stats", "--explain"] {
        let text = rayweave(folder.path(), &format!("render --size 4x4 {option} -o a.ppm"));
        let text = text.expect_success();
        assert!(text.contains("packets: ") && text.contains("prepared in "), "{option}: {text}");
    }
    let help = rayweave(folder.path(), "--help").expect_success();
    assert!(help.contains("\n  tradeoff ") && !help.contains("\n  error "), "{help}");
    let help = rayweave(folder.path(), "render --help").expect_success();
    assert!(help.contains("--stats") && !help.contains("--explain"), "{help}");
}

#[test]
fn check_holds_and_says_so() {
    let folder = folder();
    let (text, json) = rayweave_json(folder.path(), "check --size 31x17 --threads 1,3 --tile 5");
    assert!(text.contains("all identical"), "{text}");
    assert_eq!(json["holds"], true);
    assert!(json["findings"].as_array().expect("a list").is_empty());
    assert!(json["compared"].as_u64().expect("a number") > 0);
    let (awkward, full) = (&json["checked"][0], &json["checked"][1]);
    assert_eq!(
        awkward["pictures"][3],
        serde_json::json!({"scene": "report (built in)", "width": 7, "height": 3})
    );
    let given = serde_json::json!([{"scene": "report (built in)", "width": 31, "height": 17}]);
    assert_eq!((&full["pictures"], &full["tiles"]), (&given, &serde_json::json!([5])));
    assert_eq!(
        (&full["threads"], &awkward["threads"]),
        (&serde_json::json!([1, 3]), &serde_json::json!([1, 3]))
    );
    assert!(
        full["strategies"].as_array().expect("a list").contains(&"tile-queue".into()),
        "{full}"
    );
}

#[test]
fn triangles_without_area_are_reported() {
    let folder = folder();
    let text = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n\
                focal_length = 1.0\nscreen_width = 1.0\n[material.grey]\ncolor = [0.5, 0.5, 0.5]\n\
                [[mesh]]\npath = \"mesh.obj\"\nmaterial = \"grey\"\n";
    fs::write(folder.path().join("mesh.toml"), text).expect("written");
    let run = |faces: &str| {
        let mesh = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\n{faces}");
        fs::write(folder.path().join("mesh.obj"), mesh).expect("written");
        let small = "mesh.toml --size 4x4 --antialiasing 0";
        let rendered =
            rayweave(folder.path(), &format!("render {small} -o a.ppm")).expect_success();
        let compared = rayweave(
            folder.path(),
            &format!("compare {small} --strategy sequential --time-limit 1"),
        )
        .expect_success();
        (rendered, compared)
    };
    for (faces, told) in [
        ("f 1 2 3\n", None),
        ("f 1 2 3\nf 1 2 4\n", Some("1 triangle without area left out")),
        ("f 1 2 3\nf 1 2 4\nf 1 1 2\n", Some("2 triangles without area left out")),
    ] {
        let (rendered, compared) = run(faces);
        for text in [rendered, compared] {
            let line = text.lines().find(|line| line.contains("without area"));
            assert_eq!(line, told, "{text}");
        }
    }
}

#[test]
fn requests_that_cannot_be_met_are_refused_before_any_work() {
    let folder = folder();
    fs::create_dir(folder.path().join("folder.png")).expect("a folder");
    let cases = [
        ("render --size 0x10", "1..=65535"),
        ("render --size 65536x1", "1..=65535"),
        ("render --size 10", "640x480"),
        ("render --size 65535x65535", "limit"),
        ("render --antialiasing 33", "0..=32"),
        ("render --antialiasing -1", "'-1'"),
        ("render --threads 0", "1..=1024"),
        ("render --threads 1025", "1..=1024"),
        ("render --tile 0", "0"),
        ("render --strategy nope", "sequential"),
        ("compare --strategy sequential,nope", "nope"),
        ("compare --strategy tile-qeue", "a similar value exists: 'tile-queue'"),
        ("render --precision f16", "f32"),
        ("render --lanes 3", "auto"),
        ("render --share-samples maybe", "both"),
        ("render --share-samples both", "only `compare`"),
        ("check --share-samples both --json a.json", "only `compare`"),
        ("render --adaptive on --sampling importance", "use --sampling lattice"),
        ("predict --strategy sequential", "name one that starts threads"),
        ("render -o a.jpg", ".png, .ppm or .exr"),
        ("render -o a", ".png, .ppm or .exr"),
        ("render -o missing/a.png", "no folder missing"),
        ("render -o folder.png", "folder.png: cannot be written: it is a folder"),
        ("compare --json missing/a.json", "no folder missing"),
        ("compare --csv folder.png", "it is a folder"),
        ("compare --time-limit 0", "1..=604800"),
        ("compare --time-limit soon", "1..=604800"),
        ("explain --time-limit 0", "1..=604800"),
        ("predict --time-limit 0", "1..=604800"),
        ("compare --precision-goal 0%", "0.001..=100"),
        ("compare --precision-goal much", "as in 1%"),
        ("compare --size 65535x65535", "limit"),
        ("check --json missing/a.json", "no folder missing"),
        ("render missing.toml", "missing.toml: cannot be read"),
        ("render folder.png", "folder.png"),
        ("compar", "compar"),
    ];
    expect_refusals(folder.path(), "", &cases);
    assert_eq!(files_in(folder.path()), ["folder.png"]);
}

#[test]
fn each_malformed_scene_gives_one_message_and_no_image() {
    let corpus = repository().join("crates/scene-file/tests/malformed");
    let folder = folder();
    let scenes: Vec<String> =
        files_in(&corpus).into_iter().filter(|name| name.ends_with(".toml")).collect();
    assert!(scenes.len() >= 40, "{} malformed scenes", scenes.len());
    for name in scenes {
        let expected =
            fs::read_to_string(corpus.join(&name).with_extension("expected")).expect("beside it");
        fs::copy(corpus.join(&name), folder.path().join(&name)).expect("copied");
        let message = rayweave(folder.path(), &format!("render {name} -o a.png")).expect_refusal();
        assert_eq!(message, format!("error: {}\n", expected.trim_end()));
        fs::remove_file(folder.path().join(&name)).expect("removed");
    }
    assert!(files_in(folder.path()).is_empty());
}

/// Catches a rendering on fewer threads than requested, and a setting that changes their number.
#[test]
fn openmp_has_the_threads_asked_for_or_none() {
    let strategy = rayweave_registry::find("openmp-static").expect("a strategy");
    if strategy.unavailable.is_some() {
        return;
    }
    let folder = folder();
    let run = |variable: &str, value: &str, arguments: &str| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_rayweave"));
        program.args(arguments.split(' ')).env(variable, value).current_dir(folder.path());
        Run::of(program.output().expect("the program starts"))
    };
    let message = run("OMP_THREAD_LIMIT", "2", "render --strategy openmp-static --threads 3")
        .expect_refusal();
    assert!(
        message.starts_with("error: openmp-static: cannot start 3 threads: OpenMP gave 2 "),
        "{message}"
    );
    let check = "check --size 16x16 --tile 4 --threads 3 \
                 --strategy openmp-static,openmp-dynamic,openmp-guided";
    for (variable, value) in
        [("OMP_NUM_THREADS", "1"), ("OMP_DYNAMIC", "true"), ("OMP_WAIT_POLICY", "active")]
    {
        let text = run(variable, value, check).expect_success();
        assert!(text.contains("all identical"), "{variable}: {text}");
    }
}

/// Runs as a user who may start only a few threads.
#[cfg(target_os = "linux")]
#[test]
fn threads_that_cannot_be_started_are_an_error_that_names_the_strategy() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    // The limit does not hold for root, so root runs a copy of the program as nobody.
    let program = folder.path().join("rayweave");
    fs::copy(env!("CARGO_BIN_EXE_rayweave"), &program).expect("copied");
    fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o777)).expect("permitted");
    let run = |arguments: &str| {
        let command = format!(
            "nobody=; if [ $(id -u) = 0 ]; then nobody='setpriv --reuid 65534 --clear-groups'; fi; \
             exec prlimit --nproc=12 $nobody ./rayweave {arguments}"
        );
        let output = Command::new("sh").args(["-c", &command]).current_dir(folder.path()).output();
        Run::of(output.expect("a shell"))
    };
    let parallel = rayweave_registry::available()
        .into_iter()
        .filter(|strategy| strategy.threads != rayweave_contract::Threads::None);
    for strategy in parallel {
        let name = strategy.name;
        // The image is large enough to keep a dozen threads busy until the next one is started.
        let size = "--size 200x200 --threads 1000";
        let message = run(&format!("render {size} --strategy {name} -o a.png")).expect_refusal();
        assert!(
            message.starts_with(&format!("error: {name}: cannot start 1000 threads")),
            "{message}"
        );
    }
    // In a check it is a finding, and the check goes on.
    let name = rayweave_registry::recommended().name;
    let check = run(&format!("check --size 32x32 --threads 1000 --strategy {name}"));
    assert_eq!(check.status, 1, "{}", check.stderr);
    assert!(check.stdout.contains("cannot start 1000 threads"), "{}", check.stdout);
    // In a comparison it ends its row, and the rest is measured.
    let compare =
        run(&format!("compare --size 32x32 --threads 1000,1 --strategy {name} --time-limit 1"));
    assert_eq!(compare.status, 1, "{}", compare.stderr);
    let complaint =
        format!("{name}, 1000 threads: failed after 0 samples: {name}: cannot start 1000 threads");
    assert!(compare.stdout.replace('\n', " ").contains(&complaint), "{}", compare.stdout);
    assert!(compare.stdout.contains("thread against itself"), "{}", compare.stdout);
    assert_eq!(files_in(folder.path()), ["rayweave"]);
}
