//! Meshes: which triangles an OBJ file stands for, and with which message it is refused.

use std::fs;
use std::path::Path;

use rayweave_core::scene::Triangle;
use rayweave_scene_file::{
    MAX_BYTES, MAX_MESH_TRIANGLES, SceneFile, SceneFileError, load, parse, report_scene,
};
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

/// Four corners of a square, on which the faces of most tests stand.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// The lines of a mesh in a scene file.
fn mesh(path: &str, material: &str) -> String {
    format!("[[mesh]]\npath = '{path}'\nmaterial = '{material}'\n")
}

/// A folder with these files in it.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (path, contents) in files {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().expect("below the folder")).expect("a folder");
        fs::write(path, contents).expect("a file");
    }
    folder
}

/// What comes of a scene of one mesh, and its error without the path of the folder.
fn of_obj(obj: impl AsRef<[u8]>) -> Result<SceneFile, String> {
    let scene = format!("{SCENE}{}", mesh("a.obj", "red"));
    let folder = folder(&[("a.toml", scene.as_bytes()), ("a.obj", obj.as_ref())]);
    loaded(folder.path())
}

fn loaded(folder: &Path) -> Result<SceneFile, String> {
    load(&folder.join("a.toml")).map_err(|error| below(folder, &error))
}

fn below(folder: &Path, error: &SceneFileError) -> String {
    let error = error.to_string();
    let folder = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
    error.strip_prefix(&folder).unwrap_or_else(|| panic!("{error}")).to_owned()
}

/// The corners of each triangle, all whole numbers, as `x,y,z`.
fn corners(triangles: &[Triangle]) -> Vec<String> {
    let corner = |v: glam::DVec3| format!("{},{},{}", v.x, v.y, v.z);
    triangles.iter().map(|triangle| triangle.vertices.map(corner).join(" ")).collect()
}

/// The triangles of an OBJ file, none of which is skipped.
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
    for face in ["1/7 2/8 3/9", "1//7 2//8 3//9", "1/7/7 2/8/8 3/9/9", "1/ 2 3//x", "+1 02 3"] {
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
fn what_is_not_of_the_contract_is_ignored() {
    let plain = triangles(format!("{SQUARE}f 1 2 3\n"));
    for obj in [
        "# v 5 5 5\n\n \t\nv 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0 # f 1 2 3\nf 1 2 3# 9\n",
        "mtllib a.mtl\no name\ng a b\ns off\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nl 1 9\np 0\n",
        "vn 9 9 9\nvt 9 9\nvp 9\nv 0 0 0\nvn nan\nv 1 0 0 nan x\nv 1 1 0\nfo 1 2\nF 1 2\nV 1\ncstype bezier\nf 1 2 3\n",
        "  v\t0  0 0 \r\n\tv 1.0 0e3 -0\r\nv +1. 1 .0\r\n f 1\t2  3 \r\n\r\n",
        "\u{feff}v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3",
    ] {
        assert_eq!(
            triangles(obj).iter().map(|t| t.replace("-0", "0")).collect::<Vec<_>>(),
            plain,
            "{obj}"
        );
    }
    // Names and comments in any encoding.
    let latin = [b"g caf\xe9 # \xff\n".as_slice(), SQUARE.as_bytes(), b"f 1 2 3 # \xe9\n"].concat();
    assert_eq!(triangles(latin), plain);
}

#[test]
fn numbers_are_kept_as_exactly_as_those_of_a_scene() {
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
fn a_fault_is_told_with_the_line_and_column_of_the_obj_file() {
    let vertex = "expected `v` and three numbers, found";
    let face = "expected `f` and three corners or more, found";
    let of_four = "expected the number of one of the 4 vertices above, found";
    for (line, message) in [
        ("v 1 2", format!("a.obj:5:1: {vertex} `v 1 2`")),
        ("  v 1 2 # 3", format!("a.obj:5:3: {vertex} `v 1 2`")),
        ("v", format!("a.obj:5:1: {vertex} `v`")),
        ("v 1 x 3", "a.obj:5:5: expected a finite number, found `x`".into()),
        ("v 1 2 nan", "a.obj:5:7: expected a finite number, found `nan`".into()),
        ("v inf 2 3", "a.obj:5:3: expected a finite number, found `inf`".into()),
        ("v 1 -1e999 3", "a.obj:5:5: expected a finite number, found `-1e999`".into()),
        ("v 1,5 2 3", "a.obj:5:3: expected a finite number, found `1,5`".into()),
        ("f", format!("a.obj:5:1: {face} `f`")),
        ("f 1 2", format!("a.obj:5:1: {face} `f 1 2`")),
        ("f 1 2 # 3", format!("a.obj:5:1: {face} `f 1 2`")),
        ("f 1 2 5", format!("a.obj:5:7: {of_four} `5`")),
        ("f 1 2 3 5/1", format!("a.obj:5:9: {of_four} `5/1`")),
        ("f 0 1 2", format!("a.obj:5:3: {of_four} `0`")),
        ("f 1 -5 2", format!("a.obj:5:5: {of_four} `-5`")),
        ("f 1 2 x", format!("a.obj:5:7: {of_four} `x`")),
        ("f 1 2 1.0", format!("a.obj:5:7: {of_four} `1.0`")),
        ("f 1 2 /3", format!("a.obj:5:7: {of_four} `/3`")),
        ("f 1 2 99999999999999999999", format!("a.obj:5:7: {of_four} `99999999999999999999`")),
        ("f 1 2 -9223372036854775808", format!("a.obj:5:7: {of_four} `-9223372036854775808`")),
        ("f 1 2 \\", format!("a.obj:5:7: {of_four} `\\`")),
    ] {
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
fn a_mesh_without_a_triangle_is_a_fault_of_the_scene_file() {
    let message = "a.toml:13:8: mesh[0].path: expected an OBJ file with a triangle that has an area, found 'a.obj'";
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
    assert_eq!(
        loaded(folder.path()).expect_err("no file"),
        "a.obj: expected a file, found a folder"
    );
}

#[test]
fn few_bytes_cannot_stand_for_any_number_of_triangles() {
    let fan = |triangles: usize| format!("{SQUARE}f 1 2{}\n", " 3 2".repeat(triangles / 2));
    assert_eq!(
        of_obj(fan(MAX_MESH_TRIANGLES)).expect("sound").scene.triangles.len(),
        MAX_MESH_TRIANGLES
    );
    let error = of_obj(fan(MAX_MESH_TRIANGLES + 2)).expect_err("more than may be");
    assert_eq!(
        error,
        "a.obj:5:1: more than the 8388608 triangles that the meshes of a scene may have"
    );
}

#[test]
fn text_alone_has_no_meshes() {
    let text = format!("{SCENE}{}", mesh("a.obj", "red"));
    let error = parse(text.as_bytes(), "a.toml").expect_err("no folder").to_string();
    assert!(error.starts_with("a.toml:13:8: mesh[0].path: "), "{error}");
    assert!(error.ends_with("; a scene that is not read from a file has no meshes"), "{error}");
}
