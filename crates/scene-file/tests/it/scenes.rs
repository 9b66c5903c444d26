//! Sound scene files: their contents, and the defaults where they are silent.

use std::path::PathBuf;

use glam::{DVec3, dvec3};
use rayweave_core::Scene;
use rayweave_core::scene::{
    Camera, Cylinder, Light, Material, Plane, RenderSettings, Sphere, Triangle,
};
use rayweave_scene_file::{
    ImageSize, REPORT_SCENE, SceneFile, SceneFileError, load, parse, report_scene,
};

const CAMERA: &str = "
[camera]
position = [0.0, 0.0, 2.0]
look_at = [0.0, 0.0, 0.0]
up = [0.0, 1.0, 0.0]
focal_length = 2.0
screen_width = 2.4
";

/// Returns the example of the image model without its mesh: a file of every other kind of entry.
/// All optional keys are spelled out with their defaults.
fn everything() -> String {
    let model = include_str!("../../../../docs/MODEL.md");
    let (_, example) = model.split_once("```toml\n").expect("an example");
    let (example, _) = example.split_once("```").expect("its end");
    let (above, mesh) = example.split_once("[[mesh]]").expect("a mesh");
    let (_, below) = mesh.split_once("[[cylinder]]").expect("an entry below the mesh");
    format!("{above}[[cylinder]]{below}")
}

fn read(text: &str) -> Result<SceneFile, SceneFileError> {
    parse(text.as_bytes(), "test.toml")
}

fn sound(text: &str) -> SceneFile {
    read(text).unwrap_or_else(|error| panic!("{error}"))
}

/// The camera of [`everything`], of [`CAMERA`] and of the lab report's scene.
fn camera() -> Camera {
    Camera {
        position: dvec3(0.0, 0.0, 2.0),
        look_at: DVec3::ZERO,
        up: DVec3::Y,
        focal_length: 2.0,
        screen_width: 2.4,
    }
}

/// The light of [`everything`] and of the lab report's scene.
fn light() -> Light {
    Light { position: dvec3(-15.0, 10.0, 10.0), color: DVec3::ONE, power: 1.0 }
}

/// The settings of [`everything`] and of the lab report's scene, which are the model's defaults.
fn render() -> RenderSettings {
    let default = RenderSettings::default();
    RenderSettings { background: DVec3::ZERO, max_reflections: 4, antialiasing: 2, ..default }
}

fn plane(material: usize) -> Plane {
    Plane { point: dvec3(0.0, -1.0, 0.0), normal: DVec3::Y, material }
}

fn cylinder(material: usize) -> Cylinder {
    let (bottom, top) = (dvec3(1.0, -1.0, -5.0), dvec3(1.0, 2.0, -5.0));
    Cylinder { bottom, top, radius: 0.316_227_766_016_837_94, material }
}

#[test]
fn every_key_arrives_where_it_belongs() {
    let red = Material {
        color: DVec3::X,
        ambient: 0.1,
        diffuse: 0.6,
        specular: 0.4,
        shininess: 2,
        reflection: 0.0,
    };
    let scene = Scene {
        camera: camera(),
        render: render(),
        lights: vec![light()],
        materials: vec![red],
        planes: vec![plane(0)],
        spheres: vec![Sphere { center: DVec3::ZERO, radius: 1.0, material: 0 }],
        triangles: vec![Triangle { vertices: [DVec3::ZERO, DVec3::X, DVec3::Y], material: 0 }],
        cylinders: vec![cylinder(0)],
    };
    let image = ImageSize { width: 500, height: 500 };
    assert_eq!(
        sound(&everything()),
        SceneFile { image, scene, skipped_triangles: 0, meshes: Vec::new() }
    );
}

#[test]
fn optional_keys_have_the_defaults_of_the_model() {
    // Keys that are stated with their defaults may go without any effect.
    let everything = everything();
    let optional: Vec<&str> = "[image]|width|height|[render]|background|max_reflections|\
        antialiasing|power|ambient|diffuse|specular|shininess|reflection|color = [1.0, 1.0, 1.0]"
        .split('|')
        .collect();
    let silent: Vec<&str> = everything
        .lines()
        .filter(|line| !optional.iter().any(|key| line.starts_with(key)))
        .collect();
    assert_eq!(silent.len(), everything.lines().count() - optional.len());
    assert_eq!(sound(&silent.join("\n")), sound(&everything));

    // All the rest but the camera may be absent altogether.
    let scene = Scene {
        camera: camera(),
        render: RenderSettings::default(),
        lights: vec![],
        materials: vec![],
        planes: vec![],
        spheres: vec![],
        triangles: vec![],
        cylinders: vec![],
    };
    let image = ImageSize::default();
    assert_eq!(sound(CAMERA), SceneFile { image, scene, skipped_triangles: 0, meshes: Vec::new() });
}

#[test]
fn stated_values_win_over_defaults() {
    let SceneFile { image, scene, .. } = sound(&format!(
        "{CAMERA}
        [image]
        width = 65535
        height = 1
        [render]
        background = [0.25, 0.5, 1]
        max_reflections = 64
        antialiasing = 0
        [[light]]
        position = [1, 2, 3]
        color = [0.5, 0.25, 0]
        power = 7
        [material.m]
        color = [0.1, 0.2, 0.3]
        ambient = 0
        diffuse = 11.5
        specular = 12.5
        shininess = 1024
        reflection = 1"
    ));
    assert_eq!(image, ImageSize { width: 65535, height: 1 });
    let background = dvec3(0.25, 0.5, 1.0);
    let render = RenderSettings { background, max_reflections: 64, antialiasing: 0, ..render() };
    assert_eq!(scene.render, render);
    let (position, color) = (dvec3(1.0, 2.0, 3.0), dvec3(0.5, 0.25, 0.0));
    assert_eq!(scene.lights, [Light { position, color, power: 7.0 }]);
    let material = Material {
        color: dvec3(0.1, 0.2, 0.3),
        ambient: 0.0,
        diffuse: 11.5,
        specular: 12.5,
        shininess: 1024,
        reflection: 1.0,
    };
    assert_eq!(scene.materials, [material]);
}

#[test]
fn the_built_in_scene_is_that_of_the_lab_report() {
    let material = |r, g, b, reflection| Material { reflection, ..Material::new(dvec3(r, g, b)) };
    let sphere = |x, y, z, radius, material| Sphere { center: dvec3(x, y, z), radius, material };
    let (mirror, dim) = (0.47368421052631576, 0.3333333333333333);
    // By name: blue, floor, green, magenta, red.
    let (blue, floor, green, magenta, red) = (0, 1, 2, 3, 4);
    let corners = [dvec3(0.5, -1.0, -3.0), dvec3(-1.0, -0.8, -2.5), dvec3(-1.7, 0.2, -2.5)];
    let scene = Scene {
        camera: camera(),
        render: render(),
        lights: vec![light()],
        materials: vec![
            material(0.5, 0.5, 1.0, dim),
            material(0.8, 0.8, 0.8, mirror),
            material(0.3, 1.0, 0.0, mirror),
            material(1.0, 0.0, 1.0, mirror),
            material(1.0, 0.0, 0.0, mirror),
        ],
        planes: vec![plane(floor)],
        spheres: vec![
            sphere(0.5, -1.0, -2.0, 0.9, blue),
            sphere(-1.0, -0.8, -1.0, 0.2, red),
            sphere(-1.7, 0.2, -5.0, 0.3, green),
        ],
        triangles: vec![Triangle { vertices: corners, material: magenta }],
        cylinders: vec![cylinder(green)],
    };
    let image = ImageSize { width: 500, height: 500 };
    assert_eq!(
        report_scene(),
        SceneFile { image, scene, skipped_triangles: 0, meshes: Vec::new() }
    );
}

#[test]
fn the_scenes_of_the_project_load() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let count = |name: &str| {
        let file = load(&folder.join(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(file.scene.check(), Ok(()));
        let Scene { lights, materials, planes, spheres, triangles, cylinders, .. } = file.scene;
        let (flat, round) = (planes.len(), spheres.len());
        [lights.len(), materials.len(), flat, round, triangles.len(), cylinders.len()]
    };
    assert_eq!(count("lab.toml"), [1, 5, 1, 3, 1, 1]);
    assert_eq!(count("room.toml"), [2, 10, 3, 4, 2, 1]);
    assert_eq!(count("imbalance.toml")[..2], [6, 5]);
    assert_eq!(load(&folder.join("lab.toml")), Ok(report_scene()));
}

#[test]
fn an_integer_may_stand_for_a_float() {
    let file = sound(
        "camera = { position = [0, -0, 9_007_199_254_740_995], look_at = [+1, 0b11, 0o17], \
         up = [0x10, -9223372036854775808, 0], focal_length = 3, screen_width = 1e3 }",
    );
    let camera = file.scene.camera;
    // 2^53 + 3 is halfway between two floats. The even one counts, as for its digits with a
    // point.
    assert_eq!(camera.position, dvec3(0.0, 0.0, 9_007_199_254_740_995.0));
    assert_eq!(camera.look_at, dvec3(1.0, 3.0, 15.0));
    assert_eq!(camera.up, dvec3(16.0, -2_f64.powi(63), 0.0));
    assert_eq!((camera.focal_length, camera.screen_width), (3.0, 1000.0));
}

#[test]
fn an_integer_may_be_spelled_in_any_way() {
    let image = "[image]\nwidth = +6_4\nheight = 0xFFff\n";
    let render = "[render]\nmax_reflections = 0b1\nantialiasing = -0";
    let SceneFile { image, scene, .. } = sound(&format!("{CAMERA}{image}{render}"));
    assert_eq!(image, ImageSize { width: 64, height: 65535 });
    assert_eq!((scene.render.max_reflections, scene.render.antialiasing), (1, 0));
}

#[test]
fn materials_may_have_any_name_and_stand_anywhere() {
    let names = ["\"\"", "'dull red'", "\"été\"", "\"a.b\"", "3", "\"tab\\t\"", "camera"];
    let mut text = String::from(CAMERA);
    for (i, name) in names.iter().enumerate() {
        let bare = !name.starts_with(['"', '\'']);
        let quoted = if bare { format!("\"{name}\"") } else { String::from(*name) };
        // The sphere refers to a material that comes below it.
        text += &format!("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = {quoted}\n");
        text += &format!("[material.{name}]\ncolor = [0, 0, 0]\nambient = {i}\n");
    }
    let scene = sound(&text).scene;
    let ambient = scene.spheres.iter().map(|sphere| scene.materials[sphere.material].ambient);
    assert_eq!(ambient.collect::<Vec<_>>(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
}

#[test]
fn every_spelling_of_toml_means_the_same() {
    let headers = sound(&format!(
        "[material.red]\ncolor = [1, 0, 0]\n[[light]]\nposition = [1, 2, 3]\n{CAMERA}"
    ));
    let inline = sound(
        "light = [{ position = [1, 2, 3] }]\nmaterial.red.color = [1, 0, 0]\n\
         camera.position = [\n  0, # x\n  0, 2,\n]\ncamera.look_at = [0, 0, 0]\n\
         camera.up = [0, 1, 0]\ncamera.focal_length = 2e0\ncamera.\"screen_width\" = 2.4",
    );
    assert_eq!(headers, inline);
}

#[test]
fn line_ends_and_a_byte_order_mark_change_nothing() {
    let windows = format!("\u{feff}{}", REPORT_SCENE.replace('\n', "\r\n"));
    assert_eq!(read(&windows), Ok(report_scene()));
    assert_eq!(read(REPORT_SCENE.trim_end()), Ok(report_scene()));
}
