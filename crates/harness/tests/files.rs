//! The files that the program writes: which it refuses to, and what it leaves of those before.
#![cfg(unix)]

mod program;

use program::{Run, expect_refusals, files_in, folder, rayweave};
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

const CAMERA: &str = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n\
                      focal_length = 1.0\nscreen_width = 1.0\n[material.grey]\n\
                      color = [0.5, 0.5, 0.5]\n";

/// Writes a scene of one mesh in the folder `meshes`.
fn mesh_scene(path: &Path) {
    let folder = path.parent().expect("a folder");
    fs::create_dir_all(folder.join("meshes")).expect("a folder");
    fs::write(folder.join("meshes/a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        .expect("written");
    let mesh = "[[mesh]]\npath = 'meshes/a.obj'\nmaterial = 'grey'\n";
    fs::write(path, format!("{CAMERA}{mesh}")).expect("written");
}

/// The number of users that ran a command so far.
static USERS: AtomicU32 = AtomicU32::new(0);

/// Runs a command of the shell in which `$rayweave` is the program. Its user is never the
/// superuser, for whom no limit and no mode holds, and has no other process that counts.
fn as_nobody(folder: &Path, command: &str) -> Run {
    let program = folder.join("rayweave");
    fs::copy(env!("CARGO_BIN_EXE_rayweave"), &program).expect("copied");
    fs::set_permissions(folder, PermissionsExt::from_mode(0o777)).expect("permitted");
    let user = 20_000 + (std::process::id() + USERS.fetch_add(1, Relaxed)) % 40_000;
    let script = format!(
        "nobody=; if [ $(id -u) = 0 ]; then nobody='setpriv --reuid {user} --clear-groups'; fi; \
         rayweave=\"$nobody ./rayweave\"; {command}"
    );
    let output = Command::new("sh").args(["-c", &script]).current_dir(folder).output();
    fs::remove_file(&program).expect("removed");
    Run::of(output.expect("a shell"))
}

#[test]
fn a_mesh_of_the_scene_is_not_overwritten() {
    let folder = folder();
    mesh_scene(&folder.path().join("a.toml"));
    symlink("meshes/a.obj", folder.path().join("link.json")).expect("a link");
    let mesh = fs::read(folder.path().join("meshes/a.obj")).expect("the mesh");
    let twice = "a.obj: is named twice: use another file";
    expect_refusals(
        folder.path(),
        "",
        &[
            ("check a.toml --json meshes/a.obj", twice),
            ("check a.toml --json meshes/../meshes/a.obj", twice),
            ("check a.toml --json link.json", twice),
            ("compare a.toml --csv meshes/a.obj", twice),
            ("explain a.toml --trace meshes/a.obj", twice),
            ("predict a.toml --svg meshes/a.obj", twice),
            ("tradeoff a.toml --csv meshes/a.obj", twice),
        ],
    );
    assert_eq!(fs::read(folder.path().join("meshes/a.obj")).expect("the mesh"), mesh);
    assert_eq!(files_in(&folder.path().join("meshes")), ["a.obj"]);
}

#[test]
fn a_picture_overwrites_no_other_file_of_the_run() {
    let folder = folder();
    mesh_scene(&folder.path().join("out/sequential-cost.svg"));
    let cases = [
        ("explain --json out/sequential-timeline.svg", "timeline.svg: is named twice: "),
        ("explain --trace out/./sequential-threads.png", "threads.png: is named twice: "),
        ("explain out/sequential-cost.svg", "cost.svg: is named twice: "),
        ("tradeoff --json out/reference.png", "reference.png: is named twice: "),
    ]
    .map(|(arguments, expected)| {
        let strategy = if arguments.starts_with("explain") { "--strategy sequential" } else { "" };
        (format!("{arguments} {strategy} --pictures out"), expected)
    });
    let cases = cases.each_ref().map(|(arguments, expected)| (arguments.as_str(), *expected));
    expect_refusals(folder.path(), "", &cases);
    assert_eq!(files_in(&folder.path().join("out")), ["meshes", "sequential-cost.svg"]);
}

#[test]
fn a_file_that_is_replaced_keeps_its_mode() {
    let folder = folder();
    let path = folder.path().join("a.ppm");
    let mode = || fs::metadata(&path).expect("there").permissions().mode() & 0o7777;
    for expected in [0o600, 0o664] {
        fs::write(&path, "old").expect("written");
        fs::set_permissions(&path, PermissionsExt::from_mode(expected)).expect("permitted");
        rayweave(folder.path(), "render --size 4x4 -o a.ppm").expect_success();
        assert_eq!(mode(), expected);
        assert!(fs::read(&path).expect("the image").starts_with(b"P6"));
    }
    fs::write(&path, "old").expect("written");
    fs::set_permissions(&path, PermissionsExt::from_mode(0o444)).expect("permitted");
    let message = rayweave(folder.path(), "render --size 4x4 -o a.ppm").expect_refusal();
    assert_eq!(message, "error: a.ppm: cannot be written: it is read-only\n");
    assert_eq!((mode(), fs::read(&path).expect("the old file")), (0o444, b"old".to_vec()));
}

#[test]
fn a_link_that_leads_nowhere_is_refused() {
    let folder = folder();
    symlink("missing.ppm", folder.path().join("dangling.ppm")).expect("a link");
    symlink("b.ppm", folder.path().join("a.ppm")).expect("a link");
    symlink("a.ppm", folder.path().join("b.ppm")).expect("a link");
    let missing = "dangling.ppm: cannot be written: it is a link to missing.ppm, which is missing";
    expect_refusals(
        folder.path(),
        "render --size 4x4 -o",
        &[("dangling.ppm", missing), ("a.ppm", "a.ppm: cannot be written: ")],
    );
    // Nor is one whose target cannot be seen taken for a new file.
    fs::create_dir(folder.path().join("closed")).expect("a folder");
    fs::write(folder.path().join("closed/c.ppm"), "old").expect("written");
    fs::set_permissions(folder.path().join("closed"), PermissionsExt::from_mode(0o0))
        .expect("closed");
    symlink("closed/c.ppm", folder.path().join("c.ppm")).expect("a link");
    let message = as_nobody(folder.path(), "$rayweave render --size 4x4 -o c.ppm").expect_refusal();
    assert!(message.starts_with("error: c.ppm: cannot be written: Permission denied"), "{message}");
    fs::set_permissions(folder.path().join("closed"), PermissionsExt::from_mode(0o700))
        .expect("open");
    assert_eq!(files_in(folder.path()), ["a.ppm", "b.ppm", "c.ppm", "closed", "dangling.ppm"]);
    for name in ["a.ppm", "b.ppm", "c.ppm", "dangling.ppm"] {
        assert!(fs::symlink_metadata(folder.path().join(name)).expect("there").is_symlink());
    }
}

#[test]
fn the_temporary_file_of_a_killed_run_is_removed() {
    let folder = folder();
    fs::write(folder.path().join(".rayweave-a1B2c3.tmp"), "half").expect("written");
    rayweave(folder.path(), "render --size 4x4 -o a.ppm").expect_success();
    assert_eq!(files_in(folder.path()), ["a.ppm"]);
}

#[test]
fn pixels_that_are_not_finite_are_counted() {
    let folder = folder();
    let light = "[[light]]\nposition = [0, 0, 5]\npower = 1.7e308\n";
    let plane = "[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = 'grey'\n";
    fs::write(folder.path().join("a.toml"), format!("{CAMERA}{light}{light}{plane}"))
        .expect("written");
    let run = rayweave(folder.path(), "render a.toml --size 5x3 -o a.exr");
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert_eq!(
        run.stderr,
        "warning: 15 of 15 pixels are infinite or NaN, the first at (0, 0): use less power of the \
         lights and smaller factors of the materials\n"
    );
    assert!(run.stdout.ends_with("written to a.exr\n"), "{}", run.stdout);
}

#[test]
fn control_characters_of_a_name_reach_no_output() {
    let folder = folder();
    let name = "e\u{1b}[31m.toml";
    mesh_scene(&folder.path().join(name));
    let run = |arguments: &[&str]| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_rayweave"));
        program.args(arguments).current_dir(folder.path());
        Run::of(program.output().expect("the program starts"))
    };
    let text = run(&["render", name, "--size", "4x4"]).expect_success();
    assert!(text.starts_with("e\\u{1b}[31m.toml, 4 x 4 pixels"), "{text}");
    assert!(text.ends_with("written to e\\u{1b}[31m.png\n"), "{text}");
    let message = run(&["render", name, "-o", "a\nb/c.png"]).expect_refusal();
    assert_eq!(message, "error: a\\nb/c.png: cannot be written: there is no folder a\\nb\n");
    let compare = ["compare", name, "--size", "4x4", "--strategy", "sequential"];
    let outputs = ["--time-limit", "1", "--csv", "a.csv", "--markdown", "a.md", "--json", "a.json"];
    let text = run(&[compare.as_slice(), &outputs].concat()).expect_success();
    let read = |name| fs::read_to_string(folder.path().join(name)).expect("the file");
    for text in [text, read("a.csv"), read("a.md"), read("a.json")] {
        assert!(!text.contains('\u{1b}') && text.contains("u{1b}[31m.toml"), "{text}");
    }
}

/// Catches an image that is encoded in memory, and a bar that needs a thread without a terminal.
#[cfg(target_os = "linux")]
#[test]
fn rendering_takes_one_thread_and_little_more_memory_than_the_image() {
    let folder = folder();
    for format in ["ppm", "png", "exr"] {
        // The image takes 48 MB.
        let text = as_nobody(
            folder.path(),
            &format!(
                "timeout 60 prlimit --nproc=1 --as=100000000 $rayweave render --size 2000x2000 \
                 --antialiasing 0 --strategy sequential -o a.{format}"
            ),
        );
        assert!(text.expect_success().contains("2000 x 2000 pixels"));
    }
    // A check starts no thread to draw a bar that nobody sees.
    let check = as_nobody(
        folder.path(),
        "timeout 60 prlimit --nproc=1 $rayweave check --size 4x4 --strategy sequential",
    );
    assert!(check.expect_success().contains("all identical"));
    // Too little memory is an error before the work, not an abort after it.
    let message = as_nobody(
        folder.path(),
        "prlimit --as=100000000 $rayweave render --size 65535x40 --antialiasing 0 \
         --strategy sequential -o b.exr",
    )
    .expect_refusal();
    let expected = "no memory to write an image of 65535 x 40 pixels: choose a smaller size";
    assert_eq!(message, format!("error: {expected}\n"));
    assert_eq!(files_in(folder.path()), ["a.exr", "a.png", "a.ppm"]);
}
