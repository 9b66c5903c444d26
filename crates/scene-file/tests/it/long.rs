//! Long scenes are read in parts. It must not show, neither in the scene nor in a message.

use std::fmt::Write as _;

use rayweave_scene_file::{REPORT_SCENE, SceneFile, parse, report_scene};

/// Enough for many parts.
const ENTRIES: usize = 10_000;

const LATE: &str = "[material.late]\ncolor = [0, 0, 0]\n";

/// The lab report's scene and many more entries, whose material is missing.
fn long() -> String {
    format!("{REPORT_SCENE}{}", entries())
}

fn entries() -> String {
    let mut text = String::new();
    for i in 0..ENTRIES {
        let kind =
            ["[[light]]", "[[sphere]]\nradius = 1\nmaterial = 'late'\n", "[[plane]] # odd"][i % 3];
        let place = ["position", "center", "material = 'late'\nnormal = [0, 1, 0]\npoint"][i % 3];
        write!(text, "\n{kind}\n{place} = [ # [[sphere]]\n  0,\n  {i},\n0]\n").expect("a string");
    }
    text
}

/// Returns the message that refuses `text`.
fn refusal(text: &str) -> String {
    parse(text.as_bytes(), "a.toml").expect_err("a fault").to_string()
}

fn sound(text: &str) -> SceneFile {
    let file = parse(text.as_bytes(), "a.toml").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(file.scene.check(), Ok(()));
    file
}

#[test]
fn every_entry_arrives_in_the_order_of_the_file() {
    let (report, scene) = (report_scene().scene, sound(&format!("{}{LATE}", long())).scene);
    let numbers = |kind: usize| (kind..ENTRIES).step_by(3).map(|i| i as f64);
    let (lights, spheres, planes) = (
        &scene.lights[report.lights.len()..],
        &scene.spheres[report.spheres.len()..],
        &scene.planes[report.planes.len()..],
    );
    assert!(lights.iter().map(|light| light.position.y).eq(numbers(0)));
    assert!(spheres.iter().map(|sphere| sphere.center.y).eq(numbers(1)));
    assert!(planes.iter().map(|plane| plane.point.y).eq(numbers(2)));

    // By name: blue, floor, green, late, magenta, red. A material may come after all that it is
    // for.
    assert_eq!(scene.materials.len(), report.materials.len() + 1);
    assert!(spheres.iter().all(|sphere| sphere.material == 3));
    assert!(planes.iter().all(|plane| plane.material == 3));
    let own = |index: usize| scene.materials[scene.spheres[index].material];
    for (index, sphere) in report.spheres.iter().enumerate() {
        assert_eq!(own(index), report.materials[sphere.material]);
    }
    assert_eq!((scene.camera, scene.render), (report.camera, report.render));
}

#[test]
fn a_header_within_a_string_is_text() {
    let mut text = String::from(REPORT_SCENE);
    let sphere = "center = [0, 0, 0]\nradius = 1\nmaterial = \"\"\"\n[[sphere]]\n[[light]]\n\"\"\"";
    for _ in 0..ENTRIES {
        write!(text, "\n[[sphere]]\n{sphere}\n").expect("a string");
    }
    let file =
        sound(&format!("{text}[material.\"[[sphere]]\\n[[light]]\\n\"]\ncolor = [0, 0, 0]\n"));
    assert_eq!(file.scene.spheres.len(), 3 + ENTRIES);
    assert_eq!(file.scene.lights.len(), 1);
}

#[test]
fn an_error_reads_as_in_a_short_scene() {
    let text = format!("{}{LATE}", long());
    let spheres = sound(&text).scene.spheres.len();
    // The number of the first line behind the text.
    let line = text.lines().count() + 1;
    let sphere = "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial =";
    let twice = "not valid TOML: duplicate key, found";
    let unknown = "expected the name of a material, found 'lat'; did you mean `late`?";
    let string = "expected a string, found the integer 5";
    let open = "unclosed array, expected `]`, found the end of the file";
    for (end, line, column, message) in [
        ("[camera]\n".to_owned(), line, 2, format!("{twice} `camera`")),
        ("[image]\n".to_owned(), line, 2, format!("{twice} `image`")),
        (LATE.to_owned(), line, 11, format!("{twice} `late`")),
        ("[[lamp]]\n".to_owned(), line, 3, "lamp: unknown key; known: ".to_owned()),
        ("[sphere]\n".to_owned(), line, 2, format!("{twice} `sphere`")),
        (
            format!("{sphere} 'lat'\n"),
            line + 3,
            12,
            format!("sphere[{spheres}].material: {unknown}"),
        ),
        (
            format!("{sphere} 'late'\n{sphere} 5\n"),
            line + 7,
            12,
            format!("sphere[{}].material: {string}", spheres + 1),
        ),
        (format!("{sphere} 'late'\nradius = 2\n"), line + 4, 1, format!("{twice} `radius`")),
        (
            format!("{sphere} 'late'\n[[sphere]]\ncenter = [0, 0"),
            line + 5,
            15,
            format!("not valid TOML: {open}"),
        ),
    ] {
        let error = refusal(&format!("{text}{end}"));
        assert!(error.starts_with(&format!("a.toml:{line}:{column}: {message}")), "{error}");
    }
}

#[test]
fn a_material_of_another_part_is_not_defined_again() {
    let text = format!("{}{LATE}{}", long(), entries());
    let line = text.lines().count() + 1;
    sound(&format!("{text}[material.later]\ncolor = [0, 0, 0]\n"));
    let expected = format!("a.toml:{line}:11: not valid TOML: duplicate key, found `late`");
    assert_eq!(refusal(&format!("{text}{LATE}")), expected);
}

/// TOML lets a table be defined once, and tables within it be added later.
#[test]
fn the_table_of_materials_is_defined_once() {
    let camera = "[camera]\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n\
                  focal_length = 2\nscreen_width = 2\n";
    let header = "[material]\nother = { color = [0, 0, 0] }\n";
    let dotted = "material.late.color = [0, 0, 0]\n";
    for (first, later, sound_again) in [
        (format!("{camera}[material]\n{}", dotted.replace("material.", "")), header, false),
        (format!("{dotted}{camera}"), header, false),
        (format!("{camera}{LATE}[material]\n"), "[ material ]\n", false),
        (format!("{camera}{LATE}"), header, true),
        (format!("{camera}[material]\n{LATE}"), "[material.other]\ncolor = [0, 0, 0]\n", true),
    ] {
        // In one part, and in two.
        for entries in ["", &entries()] {
            let text = format!("{first}{entries}{later}");
            if sound_again {
                sound(&text);
            } else {
                let error = refusal(&text);
                let line = format!("{first}{entries}").lines().count() + 1;
                assert!(error.starts_with(&format!("a.toml:{line}:")), "{error}");
                assert!(error.ends_with("duplicate key, found `material`"), "{error}");
            }
        }
        if sound_again && later == header {
            let twice = format!("{first}{}{later}{}[material]\n", entries(), entries());
            assert!(refusal(&twice).ends_with("duplicate key, found `material`"));
        }
    }
}

#[test]
fn headers_do_not_add_to_inline_values() {
    let camera = "[camera]\nposition = [0, 0, 2]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\n\
                  focal_length = 2\nscreen_width = 2\n";
    let other = "[material.other]\ncolor = [0, 0, 0]\n";
    let late = "material = { late = { color = [0, 0, 0] } }\n";
    sound(&format!("{late}{camera}{}", entries()));
    for (inline, key) in [
        (format!("{late}sphere = []\n"), "sphere"),
        (format!("{late}light = [{{ position = [0, 0, 0] }}]\n"), "light"),
        (late.to_owned(), "material"),
    ] {
        // Only in a later part: the first has no header of this key.
        let text = format!("{inline}{camera}{}{}{other}", "# long\n".repeat(10_000), entries());
        let expected = format!("not valid TOML: duplicate key, found `{key}`");
        let error = refusal(&text);
        assert!(error.ends_with(&expected), "{error}");
    }
}

/// The same fault in many places, of which one is at the end of a part, where what follows counts.
#[test]
fn the_end_of_a_part_is_not_the_end_of_the_file() {
    let text = format!("{LATE}{}", long());
    let ends = text.match_indices("\n0]\n").filter(|(at, _)| (8_000..9_000).contains(at));
    for (at, end) in ends {
        let broken = format!("{}\n0\n{}", &text[..at], &text[at + end.len()..]);
        let line = broken[..at].matches('\n').count() + 4;
        let error = refusal(&broken);
        let expected =
            "not valid TOML: missing comma between array elements, expected `,`, found `[[";
        assert!(error.starts_with(&format!("a.toml:{line}:1: {expected}")), "{error}");
    }
}
