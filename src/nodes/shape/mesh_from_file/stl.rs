//! STL: triangles as text or as 50 bytes each. Normals are those of the corners' order, since files often state none.

use super::super::scan::{self, refuse, shown};
use crate::geometry::mesh::{Corners, Soup};
use crate::node::{Build, Failure, Inputs};
use glam::DVec3;

/// Bytes before the first triangle of a binary file, and of a triangle.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

/// Bytes that a triangle takes while a mesh is made of it.
const TAKEN: u64 = 400;

/// Triangles read between two questions whether to go on.
const AT_ONCE: usize = 4096;

/// Whether the bytes are an STL file, whatever it is called.
pub(super) fn looks_like_one(bytes: &[u8]) -> bool {
    begins_as_text(bytes) || has_binary_length(bytes)
}

/// The triangles of an STL file.
pub(super) fn read(bytes: &[u8], inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Soup, Failure> {
    if has_binary_length(bytes) || !begins_as_text(bytes) {
        read_binary(bytes, inputs, build)
    } else {
        read_text(bytes, inputs, build)
    }
}

fn begins_as_text(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let word = bytes.trim_ascii_start().get(..5).unwrap_or_default();
    word.eq_ignore_ascii_case(b"solid")
}

/// How many triangles a binary file says it has.
fn stated_count(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEAD - 4..HEAD)?;
    let count = <[u8; 4]>::try_from(count).ok()?;
    usize::try_from(u32::from_le_bytes(count)).ok()
}

fn has_binary_length(bytes: &[u8]) -> bool {
    let length = |count: usize| count.checked_mul(TRIANGLE)?.checked_add(HEAD);
    stated_count(bytes).and_then(length) == Some(bytes.len())
}

fn read_binary(bytes: &[u8], inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Soup, Failure> {
    let Some(count) = stated_count(bytes) else {
        let message = format!(
            "the file has {} bytes; a binary STL has at least {HEAD}, and one of text begins with `solid`",
            bytes.len()
        );
        return Err(refuse(message));
    };
    let there = (bytes.len() - HEAD) / TRIANGLE;
    if there < count {
        let message = format!(
            "the file says it has {count} triangles, but ends at byte {} after {there}",
            bytes.len()
        );
        return Err(refuse(message).with_hint("the file is cut off, or no STL; get it again"));
    }
    let behind = bytes.len() - HEAD - count * TRIANGLE;
    if behind > 0 {
        inputs.warn(format!(
            "{behind} bytes behind the last triangle are not read"
        ));
    }
    inputs.take_memory("file", count as u64 * TAKEN)?;
    let mut soup = Soup::default();
    for (number, triangle) in bytes[HEAD..].chunks_exact(TRIANGLE).take(count).enumerate() {
        if number % AT_ONCE == 0 {
            build.go_on()?;
        }
        // The first three numbers are the normal.
        for corner in triangle[12..48].chunks_exact(12) {
            let part = |axis: usize| {
                let bytes: [u8; 4] = std::array::from_fn(|index| corner[4 * axis + index]);
                f64::from(f32::from_le_bytes(bytes))
            };
            let point = DVec3::new(part(0), part(1), part(2));
            if !point.is_finite() {
                let at = HEAD + number * TRIANGLE;
                return Err(refuse(format!(
                    "triangle {} at byte {at} has a corner that is not finite",
                    number + 1
                )));
            }
            soup.points.push(point);
        }
        soup.close_triangle();
    }
    Ok(soup)
}

fn read_text(bytes: &[u8], inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Soup, Failure> {
    // The shortest triangle in words has some eighty letters.
    inputs.take_memory("file", bytes.len() as u64 / 80 * TAKEN)?;
    let mut soup = Soup::default();
    let (mut corners, mut last) = (None::<usize>, 1);
    for line in scan::lines(bytes) {
        if line.number % AT_ONCE == 0 {
            build.go_on()?;
        }
        last = line.number;
        let (keyword, rest) = line.keyword();
        match (keyword.to_ascii_lowercase().as_str(), corners) {
            ("" | "solid" | "endsolid" | "facet" | "endloop", None) => {}
            ("outer", None) => corners = Some(0),
            ("outer", Some(_)) => return Err(line.refuse("a triangle begins inside another")),
            ("vertex", Some(3)) => {
                return Err(line.refuse("a triangle has more than three corners"));
            }
            ("vertex", Some(count)) => {
                soup.points.push(line.numbers::<3>(rest)?.into());
                corners = Some(count + 1);
            }
            ("endloop", Some(3)) => {
                soup.close_triangle();
                corners = None;
            }
            ("endloop" | "endfacet" | "facet" | "endsolid", Some(count)) => {
                return Err(line.refuse(format!("a triangle has {count} corners")));
            }
            ("endfacet", None) | ("", Some(_)) => {}
            (word, _) => {
                return Err(line.refuse(format!(
                    "expected a word of an STL file, found {}",
                    shown(word)
                )));
            }
        }
    }
    match corners {
        Some(_) => Err(refuse(format!(
            "line {last}: the file ends inside a triangle"
        ))),
        None => Ok(soup),
    }
}

impl Soup {
    /// Makes a triangle of the last three points.
    fn close_triangle(&mut self) {
        let end = self.points.len() as u32;
        self.triangles.push(Corners {
            points: [end - 3, end - 2, end - 1],
            normals: None,
            coordinates: None,
        });
    }
}
