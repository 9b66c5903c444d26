//! The part of Wavefront OBJ that a mesh is made of: vertices and faces.
//!
//! Read by hand, because no library keeps to what a scene file promises. `tobj` and `obj-rs` do not
//! say in which line a fault is, and `tobj` takes vertices from below a face. `obj` computes in
//! `f32` and takes any index and number of corners. `wavefront_obj` refuses lines of a kind that it
//! does not know.

use std::str::FromStr;

use glam::DVec3;

use crate::error::{Result, SceneFileError, Source};
use crate::wording;

/// Passes every triangle of the file to `add`: face by face, each a fan around its first corner.
/// `name` is what errors call the file.
pub(crate) fn read(
    bytes: &[u8],
    name: &str,
    mut add: impl FnMut([DVec3; 3]) -> Result<(), String>,
) -> Result<()> {
    if let Some(found) = other_format(bytes) {
        let message = format!("expected an OBJ file in ASCII or UTF-8, found {found}");
        return Err(SceneFileError::of_file(name, &message));
    }
    // Comments and names may be in any encoding. Only the text before the fault is needed.
    let fault = |offset: usize, message: &str| {
        let text = &String::from_utf8_lossy(&bytes[..offset]);
        Source { name, text }.error(text.len(), None, message)
    };
    if let Some(offset) = lone_carriage_return(bytes) {
        let message = "a line that ends with a carriage return alone: end lines with LF or CRLF";
        return Err(fault(offset, message));
    }
    let mut vertices = Vec::new();
    // A byte order mark would hide the keyword of the first line.
    let mut text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    while !text.is_empty() {
        let (statement, rest) = split_statement(text);
        let read = match words(statement).next() {
            Some(b"v") => vertex(statement).map(|vertex| vertices.push(vertex)),
            Some(b"f") => face(statement, &vertices, &mut add),
            _ => Ok(()),
        };
        read.map_err(|(place, message)| {
            let offset = place.first().and_then(|byte| bytes.element_offset(byte));
            fault(offset.unwrap_or_default(), &message)
        })?;
        text = rest;
    }
    Ok(())
}

/// Returns the name of the format or encoding, and what to do, if this cannot be an OBJ file.
fn other_format(bytes: &[u8]) -> Option<&'static str> {
    const UTF_16: &str = "UTF-16: save it as UTF-8";
    const COMPRESSED: [(&[u8], &str); 5] = [
        (b"\x1f\x8b", "a file compressed by gzip: decompress it"),
        (b"PK\x03\x04", "a zip archive: unpack it"),
        (b"BZh", "a file compressed by bzip2: decompress it"),
        (b"\xfd7zXZ", "a file compressed by xz: decompress it"),
        (b"\x28\xb5\x2f\xfd", "a file compressed by zstd: decompress it"),
    ];
    match bytes {
        [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, 1..=255, ..] | [1..=255, 0, ..] => Some(UTF_16),
        _ => COMPRESSED.iter().find(|(magic, _)| bytes.starts_with(magic)).map(|&(_, name)| name),
    }
}

/// Returns the first carriage return within a line. Whatever is behind it would be lost silently.
fn lone_carriage_return(bytes: &[u8]) -> Option<usize> {
    let mut pairs = bytes.windows(2);
    pairs.position(|pair| pair[0] == b'\r' && pair[1] != b'\r' && pair[1] != b'\n')
}

/// Splits off the first statement: a line, and every line that a `\` continues it with. It is
/// returned without its comment, which ends it.
fn split_statement(text: &[u8]) -> (&[u8], &[u8]) {
    let mut start = 0;
    loop {
        let length = text[start..].iter().position(|&byte| byte == b'\n');
        let end = length.map_or(text.len(), |length| start + length);
        let (line, rest) = (&text[start..end], text.get(end + 1..).unwrap_or_default());
        let comment = comment(line);
        if comment.is_some() || length.is_none() || uncontinued(line).is_none() {
            let end = comment.map_or(end, |comment| start + comment);
            return (text[..end].trim_ascii_start(), rest);
        }
        start = end + 1;
    }
}

/// Returns the start of the comment in a line: a `#` within a word begins none.
fn comment(line: &[u8]) -> Option<usize> {
    // Most lines have none, which is quick to see.
    if !line.contains(&b'#') {
        return None;
    }
    let begins_word = |index: usize| index == 0 || line[index - 1].is_ascii_whitespace();
    (0..line.len()).find(|&index| line[index] == b'#' && begins_word(index))
}

/// Returns the line without the `\` at its end, if it has one.
fn uncontinued(line: &[u8]) -> Option<&[u8]> {
    line.strip_suffix(b"\r").unwrap_or(line).strip_suffix(b"\\")
}

/// A fault and the part of the line that it is in.
type Located<'a> = (&'a [u8], String);

/// Reads a statement `v x y z`. Whatever comes after is ignored.
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

/// Passes the triangles of a statement `f p1 p2 p3 ...` to `add`.
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

/// Returns the vertex that a corner names, by its number or by how far above the line it is. The
/// numbers of texture and normal, behind a slash, are ignored.
fn corner<'a>(word: &'a [u8], vertices: &[DVec3]) -> Result<DVec3, Located<'a>> {
    let mut parts = word.split(|&byte| byte == b'/');
    let number = parts.next().and_then(parsed::<i64>);
    let is_number = |part| parsed::<i64>(part).is_some();
    let well_formed = match (parts.next(), parts.next(), parts.next()) {
        (None, ..) => true,
        (Some(texture), None, _) => is_number(texture),
        (Some(texture), Some(normal), None) => {
            (texture.is_empty() || is_number(texture)) && is_number(normal)
        }
        _ => false,
    };
    if !well_formed {
        return Err(mismatch(word, "a corner as in `1`, `1/2`, `1//3` or `1/2/3`"));
    }
    let index = number.and_then(|number| {
        let distance = usize::try_from(number.unsigned_abs()).ok()?;
        if number < 0 { vertices.len().checked_sub(distance) } else { distance.checked_sub(1) }
    });
    index.and_then(|index| vertices.get(index)).copied().ok_or_else(|| {
        let count = vertices.len();
        mismatch(word, &format!("the number of one of the {count} vertices above"))
    })
}

/// Returns the words of a statement. A `\` at the end of a line separates words like a space.
fn words(statement: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut lines = statement.split(|&byte| byte == b'\n').peekable();
    let lines = std::iter::from_fn(move || {
        let line = lines.next()?;
        // The last line has no `\` that continues it.
        Some(if lines.peek().is_some() { uncontinued(line).unwrap_or(line) } else { line })
    });
    lines.flat_map(|line| line.split(u8::is_ascii_whitespace)).filter(|word| !word.is_empty())
}

fn parsed<T: FromStr>(word: &[u8]) -> Option<T> {
    str::from_utf8(word).ok()?.parse().ok()
}

fn mismatch<'a>(found: &'a [u8], expected: &str) -> Located<'a> {
    let text = words(found).collect::<Vec<_>>().join(&b' ');
    let written = wording::shortened(&String::from_utf8_lossy(&text));
    (found, format!("expected {expected}, found `{written}`"))
}
