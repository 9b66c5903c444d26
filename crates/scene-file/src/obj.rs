//! The part of Wavefront OBJ that a mesh is made of: vertices and faces.
//!
//! Read by hand, because no library keeps to what a scene file promises. `tobj` and `obj-rs` do not
//! say in which line a fault is, and `tobj` takes vertices from below a face. `obj` computes in
//! `f32` and takes any index and number of corners. `wavefront_obj` refuses lines of a kind that it
//! does not know.

use std::str::FromStr;

use glam::DVec3;

use crate::error::{Result, Source};
use crate::wording;

/// Passes every triangle of the file to `add`: face by face, each a fan around its first corner.
/// `name` is what errors call the file.
pub(crate) fn read(
    bytes: &[u8],
    name: &str,
    mut add: impl FnMut([DVec3; 3]) -> Result<(), String>,
) -> Result<()> {
    let mut vertices = Vec::new();
    // A byte order mark would hide the keyword of the first line.
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    for line in text.split(|&byte| byte == b'\n') {
        let line = line.split(|&byte| byte == b'#').next().unwrap_or_default().trim_ascii();
        let read = match words(line).next() {
            Some(b"v") => vertex(line).map(|vertex| vertices.push(vertex)),
            Some(b"f") => face(line, &vertices, &mut add),
            _ => Ok(()),
        };
        read.map_err(|(place, message)| {
            let offset = place.first().and_then(|byte| bytes.element_offset(byte));
            // Comments and names may be in any encoding. Only the text before the fault is needed.
            let text = &String::from_utf8_lossy(&bytes[..offset.unwrap_or_default()]);
            Source { name, text }.error(text.len(), None, &message)
        })?;
    }
    Ok(())
}

/// A fault and the part of the line that it is in.
type Located<'a> = (&'a [u8], String);

/// Reads a line `v x y z`. Whatever comes after is ignored.
fn vertex(line: &[u8]) -> Result<DVec3, Located<'_>> {
    let mut numbers = words(line).skip(1);
    let mut number = || {
        let Some(word) = numbers.next() else {
            return Err(mismatch(line, "`v` and three numbers"));
        };
        let number = parsed(word).filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| mismatch(word, "a finite number"))
    };
    Ok(DVec3::new(number()?, number()?, number()?))
}

/// Passes the triangles of a line `f p1 p2 p3 ...` to `add`.
fn face<'a>(
    line: &'a [u8],
    vertices: &[DVec3],
    add: &mut impl FnMut([DVec3; 3]) -> Result<(), String>,
) -> Result<(), Located<'a>> {
    let mut corners = words(line).skip(1).map(|word| corner(word, vertices));
    let (Some(first), Some(second), Some(third)) = (corners.next(), corners.next(), corners.next())
    else {
        return Err(mismatch(line, "`f` and three corners or more"));
    };
    let (first, mut last) = (first?, second?);
    for next in std::iter::once(third).chain(corners) {
        let next = next?;
        add([first, last, next]).map_err(|message| (line, message))?;
        last = next;
    }
    Ok(())
}

/// Returns the vertex that a corner names, by its number or by how far above the line it is.
/// Texture and normal, behind a slash, are ignored.
fn corner<'a>(word: &'a [u8], vertices: &[DVec3]) -> Result<DVec3, Located<'a>> {
    let number = word.split(|&byte| byte == b'/').next().and_then(parsed::<i64>);
    let index = number.and_then(|number| {
        let distance = usize::try_from(number.unsigned_abs()).ok()?;
        if number < 0 { vertices.len().checked_sub(distance) } else { distance.checked_sub(1) }
    });
    index.and_then(|index| vertices.get(index)).copied().ok_or_else(|| {
        let count = vertices.len();
        mismatch(word, &format!("the number of one of the {count} vertices above"))
    })
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

fn parsed<T: FromStr>(word: &[u8]) -> Option<T> {
    str::from_utf8(word).ok()?.parse().ok()
}

fn mismatch<'a>(found: &'a [u8], expected: &str) -> Located<'a> {
    let written = wording::shortened(&String::from_utf8_lossy(found));
    (found, format!("expected {expected}, found `{written}`"))
}
