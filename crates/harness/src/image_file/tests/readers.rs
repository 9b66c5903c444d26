//! Our files, read by programs and libraries of others.

use super::{bits, large_sample};
use crate::image_file::ImageFormat;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Writes the sample in this format to the folder.
fn written(folder: &Path, format: ImageFormat, name: &str) {
    let contents = format.encode(&large_sample()).expect("encodes");
    std::fs::write(folder.join(name), contents).expect("written");
}

/// Reports that a reader is not installed, and fails if it must be.
#[allow(clippy::print_stdout, reason = "a test that could not be made is not silent")]
fn is_missing(reader: &str) {
    let required = std::env::var("RAYWEAVE_READERS").unwrap_or_default();
    let is_required = required.split(',').any(|name| name == reader);
    assert!(!is_required, "{reader} is not installed, but RAYWEAVE_READERS is {required}");
    println!("{reader} is not installed: not read by it");
}

/// Runs a program in the folder. Returns its output.
fn run(folder: &Path, program: &str, arguments: &[&str]) -> Result<String, String> {
    let output = Command::new(program).args(arguments).current_dir(folder).output();
    let output = output.map_err(|error| error.to_string())?;
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    if output.status.success() { Ok(text(output.stdout)) } else { Err(text(output.stderr)) }
}

#[test]
fn pillow_reads_a_png_and_a_ppm() {
    let folder = TempDir::new().expect("a folder");
    // Debian's library is for Debian's interpreter, which need not be the first.
    let has_pillow = |python: &&str| run(folder.path(), python, &["-c", "import PIL"]).is_ok();
    let Some(python) = ["python3", "/usr/bin/python3"].into_iter().find(has_pillow) else {
        return is_missing("pillow");
    };
    written(folder.path(), ImageFormat::Png, "a.png");
    written(folder.path(), ImageFormat::Ppm, "a.ppm");
    let script = "from PIL import Image\n\
                  for name in ['a.png', 'a.ppm']:\n    \
                      image = Image.open(name)\n    \
                      print(image.format, image.mode, *image.size, image.info)\n    \
                      print(image.tobytes().hex())\n";
    let found =
        run(folder.path(), python, &["-c", script]).unwrap_or_else(|error| panic!("{error}"));
    let hex: String = large_sample().to_rgb8().iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(found, format!("PNG RGB 37 35 {{'srgb': 0}}\n{hex}\nPPM RGB 37 35 {{}}\n{hex}\n"));
}

#[test]
fn tinyexr_reads_an_exr() {
    let folder = TempDir::new().expect("a folder");
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/src/image_file/tests/tinyexr.cpp");
    let is_installed = Path::new("/usr/include/tinyexr.h").exists();
    if !is_installed {
        return is_missing("tinyexr");
    }
    run(folder.path(), "c++", &[source, "-o", "reader", "-ltinyexr"])
        .unwrap_or_else(|error| panic!("{error}"));
    written(folder.path(), ImageFormat::Exr, "a.exr");
    let reader = folder.path().join("reader").display().to_string();
    let found = run(folder.path(), &reader, &["a.exr"]).unwrap_or_else(|error| panic!("{error}"));
    let bits: String = bits(&large_sample()).iter().map(|bits| format!("{bits:08x}\n")).collect();
    assert_eq!(found, format!("37x35 tiled 0 compression 3 channels B G R\n{bits}"));
}
