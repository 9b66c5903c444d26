//! Sound scene files: what is in them, and what is assumed where they are silent.

use std::path::PathBuf;

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

/// A file of every kind of entry, all optional keys spelled out with their defaults.
const EVERYTHING: &str = r#"
[image]                     # optional, these are the defaults; the command line may override it
width = 500                 # pixels, integers, 1..=65535
height = 500

[camera]                    # required, with all its keys
position = [0.0, 0.0, 2.0]
look_at = [0.0, 0.0, 0.0]   # not the position
up = [0.0, 1.0, 0.0]        # need not be unit or orthogonal to the view
focal_length = 2.0          # distance from the eye to the screen, > 0
screen_width = 2.4          # full width of the screen, > 0

[render]                    # optional, these are the defaults; the command line may override it
background = [0.0, 0.0, 0.0]
max_reflections = 4         # mirror bounces after the primary ray, integer, 0..=64
antialiasing = 2            # lattice density s: 0 = one ray per pixel, else 1..=32, integer

[[light]]                   # point light, no fall-off; zero or more
position = [-15.0, 10.0, 10.0]
color = [1.0, 1.0, 1.0]     # optional, default white
power = 1.0                 # optional, default 1, >= 0

[material.red]              # a table of named materials
color = [1.0, 0.0, 0.0]     # required
ambient = 0.1               # optional from here on, these are the defaults; >= 0
diffuse = 0.6
specular = 0.4
shininess = 2               # integer 1..=1024
reflection = 0.0            # share of the mirrored colour, 0..=1

[[plane]]                   # of each primitive zero or more, all keys required
point = [0.0, -1.0, 0.0]
normal = [0.0, 1.0, 0.0]    # any length > 0
material = "red"

[[sphere]]
center = [0.0, 0.0, 0.0]
radius = 1.0                # > 0
material = "red"

[[triangle]]
vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
material = "red"

[[cylinder]]                # open (no caps), axis parallel to y
bottom = [1.0, -1.0, -5.0]
top = [1.0, 2.0, -5.0]      # same x and z as bottom, y greater
radius = 0.31622776601683794
material = "red"
"#;

fn read(text: &str) -> Result<SceneFile, SceneFileError> {
    parse(text.as_bytes(), "test.toml")
}

fn sound(text: &str) -> SceneFile {
    read(text).unwrap_or_else(|error| panic!("{error}"))
}

/// What [`EVERYTHING`] and [`CAMERA`] say of the camera.
fn camera() -> Camera {
    Camera {
        position: [0.0, 0.0, 2.0].into(),
        look_at: [0.0, 0.0, 0.0].into(),
        up: [0.0, 1.0, 0.0].into(),
        focal_length: 2.0,
        screen_width: 2.4,
    }
}

#[test]
fn every_key_arrives_where_it_belongs() {
    let scene = Scene {
        camera: camera(),
        render: RenderSettings {
            background: [0.0; 3].into(),
            max_reflections: 4,
            antialiasing: 2,
            ..RenderSettings::default()
        },
        lights: vec![Light {
            position: [-15.0, 10.0, 10.0].into(),
            color: [1.0; 3].into(),
            power: 1.0,
        }],
        materials: vec![Material {
            color: [1.0, 0.0, 0.0].into(),
            ambient: 0.1,
            diffuse: 0.6,
            specular: 0.4,
            shininess: 2,
            reflection: 0.0,
        }],
        planes: vec![Plane {
            point: [0.0, -1.0, 0.0].into(),
            normal: [0.0, 1.0, 0.0].into(),
            material: 0,
        }],
        spheres: vec![Sphere { center: [0.0; 3].into(), radius: 1.0, material: 0 }],
        triangles: vec![Triangle {
            vertices: [[0.0; 3].into(), [1.0, 0.0, 0.0].into(), [0.0, 1.0, 0.0].into()],
            material: 0,
        }],
        cylinders: vec![Cylinder {
            bottom: [1.0, -1.0, -5.0].into(),
            top: [1.0, 2.0, -5.0].into(),
            radius: 0.316_227_766_016_837_94,
            material: 0,
        }],
    };
    assert_eq!(
        sound(EVERYTHING),
        SceneFile { image: ImageSize { width: 500, height: 500 }, scene, skipped_triangles: 0 }
    );
}

#[test]
fn optional_keys_have_the_defaults_of_the_model() {
    // Keys that EVERYTHING states with their defaults may go without any effect.
    let stated = sound(EVERYTHING);
    let optional = [
        "[image]",
        "width",
        "height",
        "[render]",
        "background",
        "max_reflections",
        "antialiasing",
        "power",
        "ambient",
        "diffuse",
        "specular",
        "shininess",
        "reflection",
        "color = [1.0, 1.0, 1.0]",
    ];
    let silent: Vec<&str> = EVERYTHING
        .lines()
        .filter(|line| !optional.iter().any(|key| line.starts_with(key)))
        .collect();
    assert_eq!(silent.len(), EVERYTHING.lines().count() - optional.len());
    assert_eq!(sound(&silent.join("\n")), stated);

    // All the rest but the camera may be absent altogether.
    let bare = sound(CAMERA);
    assert_eq!(bare.image, ImageSize::default());
    assert_eq!(bare.scene.camera, camera());
    assert_eq!(bare.scene.render, RenderSettings::default());
    assert!(bare.scene.lights.is_empty() && bare.scene.materials.is_empty());
    assert!(bare.scene.planes.is_empty() && bare.scene.spheres.is_empty());
    assert!(bare.scene.triangles.is_empty() && bare.scene.cylinders.is_empty());
}

#[test]
fn stated_values_win_over_defaults() {
    let file = sound(&format!(
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
reflection = 1
"
    ));
    assert_eq!(file.image, ImageSize { width: 65535, height: 1 });
    let render = RenderSettings {
        background: [0.25, 0.5, 1.0].into(),
        max_reflections: 64,
        antialiasing: 0,
        ..RenderSettings::default()
    };
    assert_eq!(file.scene.render, render);
    let light =
        Light { position: [1.0, 2.0, 3.0].into(), color: [0.5, 0.25, 0.0].into(), power: 7.0 };
    assert_eq!(file.scene.lights, [light]);
    let material = Material {
        color: [0.1, 0.2, 0.3].into(),
        ambient: 0.0,
        diffuse: 11.5,
        specular: 12.5,
        shininess: 1024,
        reflection: 1.0,
    };
    assert_eq!(file.scene.materials, [material]);
}

#[test]
fn the_report_scene_is_the_reports() {
    let SceneFile { image, scene, .. } = report_scene();
    assert_eq!(image, ImageSize { width: 500, height: 500 });
    assert_eq!(scene.camera, camera());
    assert_eq!(scene.render, RenderSettings::default());
    assert_eq!(
        scene.lights,
        [Light { position: [-15.0, 10.0, 10.0].into(), color: [1.0; 3].into(), power: 1.0 }]
    );

    let material =
        |color: [f64; 3], reflection: f64| Material { reflection, ..Material::new(color.into()) };
    let (mirror, dim) = (0.47368421052631576, 0.3333333333333333);
    // By name: blue, floor, green, magenta, red.
    let (blue, floor, green, magenta, red) = (0, 1, 2, 3, 4);
    assert_eq!(
        scene.materials,
        [
            material([0.5, 0.5, 1.0], dim),
            material([0.8, 0.8, 0.8], mirror),
            material([0.3, 1.0, 0.0], mirror),
            material([1.0, 0.0, 1.0], mirror),
            material([1.0, 0.0, 0.0], mirror),
        ]
    );
    assert_eq!(
        scene.planes,
        [Plane { point: [0.0, -1.0, 0.0].into(), normal: [0.0, 1.0, 0.0].into(), material: floor }]
    );
    let sphere =
        |center: [f64; 3], radius, material| Sphere { center: center.into(), radius, material };
    assert_eq!(
        scene.spheres,
        [
            sphere([0.5, -1.0, -2.0], 0.9, blue),
            sphere([-1.0, -0.8, -1.0], 0.2, red),
            sphere([-1.7, 0.2, -5.0], 0.3, green),
        ]
    );
    assert_eq!(
        scene.triangles,
        [Triangle {
            vertices: [
                [0.5, -1.0, -3.0].into(),
                [-1.0, -0.8, -2.5].into(),
                [-1.7, 0.2, -2.5].into()
            ],
            material: magenta,
        }]
    );
    assert_eq!(
        scene.cylinders,
        [Cylinder {
            bottom: [1.0, -1.0, -5.0].into(),
            top: [1.0, 2.0, -5.0].into(),
            radius: 0.316_227_766_016_837_94,
            material: green,
        }]
    );
}

#[test]
fn the_scenes_of_the_project_load() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let count = |name: &str| {
        let file = load(&folder.join(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(file.scene.check(), Ok(()));
        let Scene { lights, materials, planes, spheres, triangles, cylinders, .. } = file.scene;
        [
            lights.len(),
            materials.len(),
            planes.len(),
            spheres.len(),
            triangles.len(),
            cylinders.len(),
        ]
    };
    assert_eq!(count("report.toml"), [1, 5, 1, 3, 1, 1]);
    assert_eq!(count("room.toml"), [2, 10, 3, 4, 2, 1]);
    assert_eq!(count("imbalance.toml")[..2], [6, 5]);
    assert_eq!(load(&folder.join("report.toml")), Ok(report_scene()));
}

#[test]
fn an_integer_may_stand_for_a_float() {
    let file = sound(
        "camera = { position = [0, -0, 9_007_199_254_740_993], look_at = [+1, 0b11, 0o17], \
         up = [0x10, -9223372036854775808, 0], focal_length = 3, screen_width = 1e3 }",
    );
    let camera = file.scene.camera;
    // 2^53 + 1 lies between two floats; the even one is the nearest, as for its digits with a
    // point.
    assert_eq!(camera.position, [0.0, 0.0, 9_007_199_254_740_993.0].into());
    assert_eq!(camera.look_at, [1.0, 3.0, 15.0].into());
    assert_eq!(camera.up, [16.0, -2_f64.powi(63), 0.0].into());
    assert_eq!((camera.focal_length, camera.screen_width), (3.0, 1000.0));
}

#[test]
fn an_integer_may_be_spelled_in_any_way() {
    let keys = "[image]\nwidth = +6_4\nheight = 0xFFff\n[render]\nmax_reflections = 0b1\nantialiasing = -0";
    let SceneFile { image, scene, .. } = sound(&format!("{CAMERA}{keys}"));
    assert_eq!(image, ImageSize { width: 64, height: 65535 });
    assert_eq!((scene.render.max_reflections, scene.render.antialiasing), (1, 0));
}

#[test]
fn materials_may_have_any_name_and_stand_anywhere() {
    let names = ["\"\"", "'dull red'", "\"été\"", "\"a.b\"", "3", "\"tab\\t\"", "camera"];
    let mut text = String::from(CAMERA);
    for (i, name) in names.iter().enumerate() {
        // A primitive refers to a material that comes below it.
        let quoted =
            if name.starts_with(['"', '\'']) { String::from(*name) } else { format!("\"{name}\"") };
        text.push_str(&format!(
            "[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = {quoted}\n"
        ));
        text.push_str(&format!("[material.{name}]\ncolor = [0, 0, 0]\nambient = {i}\n"));
    }
    let scene = sound(&text).scene;
    let ambient: Vec<f64> =
        scene.spheres.iter().map(|s| scene.materials[s.material].ambient).collect();
    assert_eq!(ambient, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
}

#[test]
fn every_spelling_of_toml_means_the_same() {
    let headers = sound(
        "[material.red]\ncolor = [1, 0, 0]\n[[light]]\nposition = [1, 2, 3]\n[camera]\nposition = [0, 0, 2]\n\
         look_at = [0, 0, 0]\nup = [0, 1, 0]\nfocal_length = 2.0\nscreen_width = 2.4\n",
    );
    let inline = sound(
        "light = [{ position = [1, 2, 3] }]\nmaterial.red.color = [1, 0, 0]\ncamera.position = [\n  0, # x\n  \
         0, 2,\n]\ncamera.look_at = [0, 0, 0]\ncamera.up = [0, 1, 0]\ncamera.focal_length = 2e0\n\
         camera.\"screen_width\" = 2.4",
    );
    assert_eq!(headers, inline);
}

#[test]
fn line_ends_and_a_byte_order_mark_change_nothing() {
    let windows = format!("\u{feff}{}", REPORT_SCENE.replace('\n', "\r\n"));
    assert_eq!(read(&windows), Ok(report_scene()));
    assert_eq!(read(REPORT_SCENE.trim_end()), Ok(report_scene()));
}
