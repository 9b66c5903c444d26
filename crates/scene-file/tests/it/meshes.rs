//! Meshes: the triangles that an OBJ file stands for, and the messages that refuse it.

use std::fs;
use std::path::Path;

use rayweave_core::scene::Triangle;
use rayweave_scene_file::{MAX_BYTES, MAX_MESH_TRIANGLES, SceneFile, load, parse, report_scene};
use tempfile::TempDir;

const SCENE: &str = r#"
[camera]
position = [0.0, 0.0, 2.0]
look_at = [0.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
focal_length = 2.0
screen_width = 2.4
[material.blue]
color = [0.0, 0.0, 1.0]
[material.red]
color = [1.0, 0.0, 0.0]
"#;

/// The vertices of a square, for the faces of most tests.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// Returns the lines of a mesh in a scene file.
fn mesh(path: &str, material: &str) -> String {
    format!("[[mesh]]\npath = '{path}'\nmaterial = '{material}'\n")
}

/// Makes a folder with these files in it.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (path, contents) in files {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().expect("below the folder")).expect("a folder");
        fs::write(path, contents).expect("a file");
    }
    folder
}

/// Reads a scene of one mesh. Its error is without the path of the folder.
fn of_obj(obj: impl AsRef<[u8]>) -> Result<SceneFile, String> {
    let scene = format!("{SCENE}{}", mesh("a.obj", "red"));
    let folder = folder(&[("a.toml", scene.as_bytes()), ("a.obj", obj.as_ref())]);
    loaded(folder.path())
}

fn loaded(folder: &Path) -> Result<SceneFile, String> {
    load(&folder.join("a.toml")).map_err(|error| {
        let error = error.to_string();
        let folder = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
        error.strip_prefix(&folder).unwrap_or_else(|| panic!("{error}")).to_owned()
    })
}

/// Shows the corners of each triangle, all whole numbers, as `x,y,z`.
fn corners(triangles: &[Triangle]) -> Vec<String> {
    let corner = |v: glam::DVec3| format!("{},{},{}", v.x, v.y, v.z);
    triangles.iter().map(|triangle| triangle.vertices.map(corner).join(" ")).collect()
}

/// Shows the triangles of an OBJ file, none of which is skipped.
fn triangles(obj: impl AsRef<[u8]>) -> Vec<String> {
    let file = of_obj(obj).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(file.scene.check(), Ok(()));
    assert_eq!(file.skipped_triangles, 0);
    corners(&file.scene.triangles)
}

#[test]
fn a_polygon_is_a_fan_around_its_first_corner() {
    assert_eq!(triangles(format!("{SQUARE}f 1 2 3\n")), ["0,0,0 1,0,0 1,1,0"]);
    assert_eq!(triangles(format!("{SQUARE}f 2 3 4 1")), ["1,0,0 1,1,0 0,1,0", "1,0,0 0,1,0 0,0,0"]);
    let pentagon = "v 0 0 0\nv 2 0 0\nv 3 2 0\nv 1 3 0\nv -1 2 0\nf 1 2 3 4 5\n";
    assert_eq!(
        triangles(pentagon),
        ["0,0,0 2,0,0 3,2,0", "0,0,0 3,2,0 1,3,0", "0,0,0 1,3,0 -1,2,0"]
    );
}

#[test]
fn triangles_come_after_the_scenes_own_mesh_by_mesh_face_by_face() {
    let triangle =
        "[[triangle]]\nvertices = [[9, 0, 0], [9, 1, 0], [9, 0, 1]]\nmaterial = 'blue'\n";
    let (first, second) = (mesh("deep/er/first.obj", "red"), mesh("second.obj", "blue"));
    let scene = format!("{SCENE}{first}{second}{triangle}");
    let folder = folder(&[
        ("a.toml", scene.as_bytes()),
        ("deep/er/first.obj", b"v 1 0 0\nv 1 1 0\nv 1 0 1\nv 1 1 1\nf 4 3 2\nf 1 2 3\n"),
        ("second.obj", b"v 2 0 0\nv 2 1 0\nv 2 0 1\nf 1 2 3\n"),
    ]);
    let file = loaded(folder.path()).unwrap_or_else(|error| panic!("{error}"));
    let expected =
        ["9,0,0 9,1,0 9,0,1", "1,1,1 1,0,1 1,1,0", "1,0,0 1,1,0 1,0,1", "2,0,0 2,1,0 2,0,1"];
    assert_eq!(corners(&file.scene.triangles), expected);
    let materials: Vec<usize> =
        file.scene.triangles.iter().map(|triangle| triangle.material).collect();
    assert_eq!(materials, [0, 1, 1, 0]);
}

#[test]
fn a_file_may_be_of_more_than_one_mesh() {
    let scene = format!("{SCENE}{}{}", mesh("a.obj", "red"), mesh("./a.obj", "blue"));
    let folder =
        folder(&[("a.toml", scene.as_bytes()), ("a.obj", format!("{SQUARE}f 1 2 3").as_bytes())]);
    let triangles = loaded(folder.path()).unwrap_or_else(|error| panic!("{error}")).scene.triangles;
    assert_eq!(triangles.iter().map(|triangle| triangle.material).collect::<Vec<_>>(), [1, 0]);
    assert_eq!(triangles[0].vertices, triangles[1].vertices);
}

#[test]
fn a_corner_is_the_number_of_a_vertex_whatever_is_behind_its_slash() {
    let plain = triangles(format!("{SQUARE}f 1 2 3\n"));
    for face in ["1/7 2/8 3/9", "1//7 2//8 3//9", "1/7/7 2/8/8 3/9/9", "1/-1 2 3//-2", "+1 02 3"] {
        assert_eq!(triangles(format!("{SQUARE}f {face}\n")), plain, "{face}");
    }
}

#[test]
fn a_negative_corner_counts_from_the_line_up() {
    assert_eq!(triangles(format!("{SQUARE}f -4 -3/1 -2//-1\n")), ["0,0,0 1,0,0 1,1,0"]);
    assert_eq!(triangles(format!("{SQUARE}f 1 -3 -1\n")), ["0,0,0 1,0,0 0,1,0"]);
    // The same face in two places is two faces.
    let twice = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 5\nf -3 -2 -1\nf 1 2 3";
    assert_eq!(triangles(twice), ["0,0,0 1,0,0 0,1,0", "1,0,0 0,1,0 0,0,5", "0,0,0 1,0,0 0,1,0"]);
}

#[test]
fn other_lines_and_words_are_ignored() {
    let plain = triangles(format!("{SQUARE}f 1 2 3\n"));
    for obj in [
        "# v 5 5 5\n\n \t\nv 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0 # f 1 2 3\nf 1 2 3 #9\n",
        "mtllib a.mtl\no name\ng a b\ns off\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\n\
         f 1 2 3\nl 1 9\np 0\n",
        "vn 9 9 9\nvt 9 9\nvp 9\nv 0 0 0\nvn nan\nv 1 0 0 nan x\nv 1 1 0\nfo 1 2\nF 1 2\n\
         V 1\ncstype bezier\nf 1 2 3\n",
        "  v\t0  0 0 \r\n\tv 1.0 0e3 -0\r\nv +1. 1 .0\r\n f 1\t2  3 \r\n\r\n",
        "\u{feff}v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3",
    ] {
        let found: Vec<String> = triangles(obj).iter().map(|t| t.replace("-0", "0")).collect();
        assert_eq!(found, plain, "{obj}");
    }
    // Names and comments in any encoding.
    let latin = [b"g caf\xe9 # \xff\n".as_slice(), SQUARE.as_bytes(), b"f 1 2 3 # \xe9\n"].concat();
    assert_eq!(triangles(latin), plain);
}

#[test]
fn numbers_are_as_exact_as_those_of_a_scene() {
    let file =
        of_obj("v 0.1 1e-3 123456789.123456789\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("sound");
    assert_eq!(file.scene.triangles[0].vertices[0], [0.1, 0.001, 123_456_789.123_456_79].into());
}

#[test]
fn triangles_without_area_are_skipped_and_counted() {
    // Of the fan 1 2 5 3 4, where 5 is in the middle of 1 and 2, the first triangle alone is flat.
    let file =
        of_obj(format!("{SQUARE}v 0.5 0 0\nf 1 2 5 3 4\nf 1 1 2\nf 1 2 1\n")).expect("sound");
    assert_eq!(corners(&file.scene.triangles), ["0,0,0 0.5,0,0 1,1,0", "0,0,0 1,1,0 0,1,0"]);
    assert_eq!(file.skipped_triangles, 3);
    assert_eq!(report_scene().skipped_triangles, 0);
}

#[test]
fn an_error_has_the_line_and_column_of_the_obj_file() {
    let vertex = "expected `v` and three numbers, found";
    let number = "expected a finite number, found";
    let face = "expected `f` and three corners or more, found";
    let corner = "expected the number of one of the 4 vertices above, found";
    let form = "expected a corner as in `1`, `1/2`, `1//3` or `1/2/3`, found";
    for (line, column, expected, found) in [
        ("v 1 2", 1, vertex, "v 1 2"),
        ("  v 1 2 # 3", 3, vertex, "v 1 2"),
        ("v", 1, vertex, "v"),
        ("v 1 x 3", 5, number, "x"),
        ("v 1 2 nan", 7, number, "nan"),
        ("v inf 2 3", 3, number, "inf"),
        ("v 1 -1e999 3", 5, number, "-1e999"),
        ("v 1,5 2 3", 3, number, "1,5"),
        ("f", 1, face, "f"),
        ("f 1 2", 1, face, "f 1 2"),
        ("f 1 2 # 3", 1, face, "f 1 2"),
        ("f 1 2 5", 7, corner, "5"),
        ("f 1 2 3 5/1", 9, corner, "5/1"),
        ("f 0 1 2", 3, corner, "0"),
        ("f 1 -5 2", 5, corner, "-5"),
        ("f 1 2 x", 7, corner, "x"),
        ("f 1 2 1.0", 7, corner, "1.0"),
        ("f 1 2 /3", 7, corner, "/3"),
        ("f 1 2 99999999999999999999", 7, corner, "99999999999999999999"),
        ("f 1 2 -9223372036854775808", 7, corner, "-9223372036854775808"),
        ("f 1 2 3# 9", 7, corner, "3#"),
        ("v 1 2 -1.#IND", 7, number, "-1.#IND"),
        ("v 1.#QNAN 2 3", 3, number, "1.#QNAN"),
        ("f 1 2 \\ 3", 7, corner, "\\"),
        ("f 1/x/! 2 3", 3, form, "1/x/!"),
        ("f 1 2/ 3", 5, form, "2/"),
        ("f 1 2// 3", 5, form, "2//"),
        ("f 1 2 3/1/", 7, form, "3/1/"),
        ("f 1 2 3/1/1/1", 7, form, "3/1/1/1"),
        ("f 1 2 3//x", 7, form, "3//x"),
        ("f 1 2 3/1.5", 7, form, "3/1.5"),
    ] {
        let message = format!("a.obj:5:{column}: {expected} `{found}`");
        // What comes below the line is no help: not the vertices, and not the sound face.
        let found = of_obj(format!("{SQUARE}{line}\nv 2 2 2\nf 1 2 3\n")).expect_err(line);
        assert_eq!(found, message);
        let found = of_obj(format!("{SQUARE}{line}").replace('\n', "\r\n")).expect_err(line);
        assert_eq!(found, message);
    }
    let error = of_obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").expect_err("no vertex above");
    assert_eq!(error, "a.obj:1:3: expected the number of one of the 0 vertices above, found `1`");
    let error = of_obj(b"g caf\xe9\nv 1 2 \xe9\x1b[31m\n").expect_err("no number");
    assert_eq!(error, "a.obj:2:7: expected a finite number, found `\u{fffd}\\u{1b}[31m`");
}

#[test]
fn a_backslash_at_the_end_of_a_line_continues_it() {
    let plain = triangles(format!("{SQUARE}f 1 2 3\n"));
    for obj in [
        "v 0 0 0\nv \\\n1 0 \\\n0\nv 1 1 0\nf 1 2 \\\n3\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1\\\n2\\\n\\\n   3\n",
        "\\\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3 \\\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 \\\n3 # 4 \\\nusemtl red",
        // The next line belongs to a statement that is ignored.
        "v 0 0 0\nv 1 0 0\ncurv 0 1 \\\nv 5 5 5\nv 1 1 0\nf 1 2 3\n",
        // But a path in a comment continues nothing.
        "# C:\\models\\\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
    ] {
        assert_eq!(triangles(obj), plain, "{obj}");
        assert_eq!(triangles(obj.replace('\n', "\r\n")), plain, "{obj}");
    }
    for (lines, place, message) in [
        (
            "f 1 2 \\\n 9\nf 1 2 3",
            "6:2",
            "expected the number of one of the 4 vertices above, found `9`",
        ),
        (
            "f 1 \\\n 2 \\\n\nf 1 2 3",
            "5:1",
            "expected `f` and three corners or more, found `f 1 2`",
        ),
        ("v 1 \\\n\\\n2\\\nx", "8:1", "expected a finite number, found `x`"),
        ("v 1 \\\n2 3\nv x", "7:3", "expected a finite number, found `x`"),
        ("f 1 2 \\", "5:7", "expected the number of one of the 4 vertices above, found `\\`"),
    ] {
        let error = of_obj(format!("{SQUARE}{lines}")).expect_err(lines);
        assert_eq!(error, format!("a.obj:{place}: {message}"));
        let error = of_obj(format!("{SQUARE}{lines}").replace('\n', "\r\n")).expect_err(lines);
        assert_eq!(error, format!("a.obj:{place}: {message}"));
    }
}

#[test]
fn a_hash_within_a_word_begins_no_comment() {
    // A comment would not be continued.
    let obj = format!("usemtl a#b \\\nv 9 9 9\n{SQUARE}g f#1\nf 1 2 3\n");
    assert_eq!(triangles(obj), triangles(format!("{SQUARE}f 1 2 3\n")));
}

#[test]
fn a_file_that_is_no_text_of_lines_says_what_it_is() {
    let obj = format!("{SQUARE}f 1 2 3\n");
    let utf_16 = |mark: &str, bytes: fn(u16) -> [u8; 2]| {
        format!("{mark}{obj}").encode_utf16().flat_map(bytes).collect::<Vec<u8>>()
    };
    let unicode = "UTF-16: save it as UTF-8";
    for (bytes, found) in [
        (utf_16("\u{feff}", u16::to_le_bytes), unicode),
        (utf_16("\u{feff}", u16::to_be_bytes), unicode),
        (utf_16("", u16::to_le_bytes), unicode),
        (utf_16("", u16::to_be_bytes), unicode),
        (b"\x1f\x8b\x08\0\0\0\0\0".to_vec(), "a file compressed by gzip: decompress it"),
        (b"PK\x03\x04\x14\0".to_vec(), "a zip archive: unpack it"),
    ] {
        let error = of_obj(bytes).expect_err(found);
        assert_eq!(error, format!("a.obj: expected an OBJ file in ASCII or UTF-8, found {found}"));
    }
    let message = "a line that ends with a carriage return alone: end lines with LF or CRLF";
    let error = of_obj(obj.replace('\n', "\r")).expect_err("CR only");
    assert_eq!(error, format!("a.obj:1:8: {message}"));
    // Else the second vertex would be lost.
    let error = of_obj("v 0 0 0\nv 1 0 0\rv 1 1 0\nf 1 2 1\n").expect_err("one CR");
    assert_eq!(error, format!("a.obj:2:8: {message}"));
    assert_eq!(triangles(format!("{SQUARE}f 1 2 3\r\r\n\r")).len(), 1);
}

#[test]
fn a_scene_names_the_files_of_its_meshes() {
    let scene = format!("{SCENE}{}{}", mesh("b.obj", "red"), mesh("./a.obj", "blue"));
    let obj = format!("{SQUARE}f 1 2 3");
    let folder = folder(&[
        ("a.toml", scene.as_bytes()),
        ("a.obj", obj.as_bytes()),
        ("b.obj", obj.as_bytes()),
    ]);
    let file = loaded(folder.path()).expect("sound");
    assert_eq!(file.meshes, [folder.path().join("b.obj"), folder.path().join("a.obj")]);
}

#[test]
fn a_mesh_without_a_triangle_is_a_fault_of_the_scene_file() {
    let message = "a.toml:13:8: mesh[0].path: expected an OBJ file with a triangle that has an \
                   area, found 'a.obj'";
    for obj in ["", "# nothing\n", SQUARE, "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"] {
        assert_eq!(of_obj(obj).expect_err("no triangle"), message);
    }
    // Neither does one mesh stand in for another.
    let scene = format!("{SCENE}{}{}", mesh("full.obj", "red"), mesh("empty.obj", "red"));
    let full = format!("{SQUARE}f 1 2 3\n");
    let folder =
        folder(&[("a.toml", scene.as_bytes()), ("full.obj", full.as_bytes()), ("empty.obj", b"")]);
    let error = loaded(folder.path()).expect_err("no triangle");
    assert!(error.starts_with("a.toml:16:8: mesh[1].path: expected an OBJ file"), "{error}");
}

#[test]
fn a_mesh_that_cannot_be_read_is_named() {
    let scene = format!("{SCENE}{}", mesh("a.obj", "red"));
    let folder = folder(&[("a.toml", scene.as_bytes())]);
    let missing = loaded(folder.path()).expect_err("no mesh");
    assert!(missing.starts_with("a.obj: cannot be read: "), "{missing}");
    let path = folder.path().join("a.obj");
    let file = fs::File::create(&path).and_then(|file| file.set_len(MAX_BYTES + 1));
    file.expect("a sparse file");
    let large = loaded(folder.path()).expect_err("a large mesh");
    assert_eq!(large, "a.obj: larger than the 256 MiB that a file may have");
    fs::remove_file(&path).and_then(|()| fs::create_dir(&path)).expect("a folder");
    let no_file = loaded(folder.path()).expect_err("no file");
    assert_eq!(no_file, "a.obj: expected a file, found a folder");
}

#[test]
fn few_bytes_cannot_stand_for_any_number_of_triangles() {
    let fan = |triangles: usize| format!("{SQUARE}f 1 2{}\n", " 3 2".repeat(triangles / 2));
    let most = of_obj(fan(MAX_MESH_TRIANGLES)).expect("sound").scene.triangles;
    assert_eq!(most.len(), MAX_MESH_TRIANGLES);
    let error = of_obj(fan(MAX_MESH_TRIANGLES + 2)).expect_err("more than may be");
    let limit = "more than the 8388608 triangles that the meshes of a scene may have";
    assert_eq!(error, format!("a.obj:5:1: {limit}"));
}

#[test]
fn text_alone_has_no_meshes() {
    let text = format!("{SCENE}{}", mesh("a.obj", "red"));
    let error = parse(text.as_bytes(), "a.toml").expect_err("no folder").to_string();
    assert!(error.starts_with("a.toml:13:8: mesh[0].path: "), "{error}");
    assert!(error.ends_with("; a scene that is not read from a file has no meshes"), "{error}");
}
