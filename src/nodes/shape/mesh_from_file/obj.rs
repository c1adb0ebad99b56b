//! OBJ: points, places, normals and faces by index, in groups, objects and materials.

use super::super::scan::{self, Line, shown};
use crate::diagnostics::nearest;
use crate::geometry::mesh::{Corners, Soup};
use crate::node::{Build, Failure, Inputs};
use earcut::Earcut;
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;

/// Bytes that the mesh takes for each byte of the file, at most: `f 1 1 1` is a triangle.
const TAKEN: u64 = 24;

/// Lines read between two questions whether to go on.
const AT_ONCE: usize = 4096;

/// Most corners of a face.
const MOST_CORNERS: usize = 100_000;

/// The faces of an OBJ file that belong to one of `parts`, or all if there are none.
pub(super) fn read(
    bytes: &[u8],
    parts: &[String],
    inputs: &Inputs<'_>,
    build: &Build<'_>,
) -> Result<Soup, Failure> {
    inputs.take_memory("file", bytes.len() as u64 * TAKEN)?;
    let mut reader = Reader {
        parts,
        soup: Soup::default(),
        current: Default::default(),
        named: BTreeSet::new(),
        is_taken: parts.is_empty(),
        earcut: Earcut::new(),
    };
    for line in scan::lines(bytes) {
        if line.number % AT_ONCE == 0 {
            build.go_on()?;
        }
        reader.line(&line)?;
    }
    reader.check_parts()?;
    Ok(reader.soup)
}

struct Reader<'a> {
    parts: &'a [String],
    soup: Soup,
    /// Names of the groups, the object and the material that faces belong to now.
    current: [Vec<String>; 3],
    /// All names that came.
    named: BTreeSet<String>,
    /// Whether faces are taken now.
    is_taken: bool,
    earcut: Earcut<f64>,
}

/// One corner of a face: point, place and normal.
type Corner = (u32, Option<u32>, Option<u32>);

impl Reader<'_> {
    fn line(&mut self, line: &Line) -> Result<(), Failure> {
        let (keyword, rest) = line.keyword();
        match keyword {
            "v" => self.soup.points.push(line.numbers::<3>(rest)?.into()),
            "vn" => self.soup.normals.push(line.numbers::<3>(rest)?.into()),
            "vt" => {
                // One number is a place on a line.
                let place = match rest.split_whitespace().nth(1) {
                    Some(_) => line.numbers::<2>(rest)?,
                    None => [line.numbers::<1>(rest)?[0], 0.0],
                };
                self.soup.coordinates.push(DVec2::from(place));
            }
            "f" | "fo" => self.face(line, rest)?,
            "g" => self.names(0, rest.split_whitespace().map(str::to_owned).collect()),
            "o" => self.names(1, vec![rest.to_owned()]),
            "usemtl" => self.names(2, vec![rest.to_owned()]),
            _ => {}
        }
        Ok(())
    }

    fn names(&mut self, kind: usize, names: Vec<String>) {
        self.named.extend(names.iter().cloned());
        self.current[kind] = names;
        let is_asked = |name: &String| self.parts.contains(name);
        self.is_taken = self.parts.is_empty() || self.current.iter().flatten().any(is_asked);
    }

    fn face(&mut self, line: &Line, words: &str) -> Result<(), Failure> {
        let corners = words.split_whitespace().map(|word| self.corner(line, word));
        let corners: Vec<Corner> = corners.collect::<Result<_, _>>()?;
        match corners.len() {
            0..3 => {
                let message = format!("a face needs three corners, found {}", corners.len());
                return Err(line.refuse(message));
            }
            count if count > MOST_CORNERS => {
                let message = format!("a face has {count} corners; the most is {MOST_CORNERS}");
                return Err(line.refuse(message));
            }
            _ => {}
        }
        if !self.is_taken {
            return Ok(());
        }
        for triangle in self.triangles(&corners) {
            let [a, b, c] = triangle.map(|index| corners[index as usize]);
            let all = |part: fn(Corner) -> Option<u32>| Some([part(a)?, part(b)?, part(c)?]);
            self.soup.triangles.push(Corners {
                points: [a.0, b.0, c.0],
                coordinates: all(|corner| corner.1),
                normals: all(|corner| corner.2),
            });
        }
        Ok(())
    }

    /// A corner as `point`, `point/place`, `point//normal` or `point/place/normal`.
    fn corner(&self, line: &Line, word: &str) -> Result<Corner, Failure> {
        let mut parts = word.split('/');
        let soup = &self.soup;
        let index = |text: &str, count, what| index(line, text, count, what);
        let point = parts.next().unwrap_or_default();
        let point = index(point, soup.points.len(), "point")?;
        let mut optional = |count: usize, what: &'static str| match parts.next() {
            None | Some("") => Ok(None),
            Some(text) => index(text, count, what).map(Some),
        };
        let place = optional(soup.coordinates.len(), "place")?;
        let normal = optional(soup.normals.len(), "normal")?;
        match parts.next() {
            None => Ok((point, place, normal)),
            Some(_) => Err(line.refuse(format!(
                "expected point/place/normal, found {}",
                shown(word)
            ))),
        }
    }

    /// Divides a face into triangles: indices into its corners.
    fn triangles(&mut self, corners: &[Corner]) -> Vec<[u32; 3]> {
        if corners.len() == 3 {
            return vec![[0, 1, 2]];
        }
        let points: Vec<DVec3> = corners
            .iter()
            .map(|it| self.soup.points[it.0 as usize])
            .collect();
        let flat = flattened(&points);
        let mut indices: Vec<u32> = vec![];
        self.earcut.earcut(flat, &[], &mut indices);
        indices
            .chunks_exact(3)
            .map(|it| [it[0], it[1], it[2]])
            .collect()
    }

    /// Refuses parts that the file does not have.
    fn check_parts(&self) -> Result<(), Failure> {
        let Some(unknown) = self.parts.iter().find(|part| !self.named.contains(*part)) else {
            return Ok(());
        };
        let names = || self.named.iter().map(String::as_str);
        let near = nearest(unknown, names());
        let near = near.first().map(|near| format!("did you mean `{near}`? "));
        let all: Vec<&str> = names().take(20).collect();
        let failure =
            Failure::of_input("parts", format!("the file has no part {}", shown(unknown)));
        Err(failure.with_hint(match all.is_empty() {
            true => "it names no groups, objects or materials".to_owned(),
            false => format!("{}it has {}", near.unwrap_or_default(), all.join(", ")),
        }))
    }
}

/// An index from 1, or from the end if it is negative, as one from 0.
fn index(line: &Line, text: &str, count: usize, what: &str) -> Result<u32, Failure> {
    let Ok(stated) = text.parse::<i64>() else {
        let message = format!("expected the number of a {what}, found {}", shown(text));
        return Err(line.refuse(message));
    };
    let index = match stated {
        0 => return Err(line.refuse(format!("there is no {what} 0: they are counted from 1"))),
        1.. => stated - 1,
        _ => stated.saturating_add(count as i64),
    };
    let index = u32::try_from(index)
        .ok()
        .filter(|index| (*index as usize) < count);
    index.ok_or_else(|| {
        line.refuse(format!(
            "{what} {stated} is not there: {count} come before this line"
        ))
    })
}

/// The corners of a face in its own plane, counterclockwise as they are.
fn flattened(points: &[DVec3]) -> Vec<[f64; 2]> {
    // Newell's normal: it holds for faces that are not quite flat.
    let next = points.iter().skip(1).chain(points.first());
    let normal: DVec3 = points
        .iter()
        .zip(next)
        .map(|(a, b)| (*a - points[0]).cross(*b - points[0]))
        .sum();
    let size = normal.abs();
    let flat = |point: &DVec3| {
        if size.x >= size.y && size.x >= size.z {
            [point.y * normal.x.signum(), point.z]
        } else if size.y >= size.z {
            [point.z * normal.y.signum(), point.x]
        } else {
            [point.x * normal.z.signum(), point.y]
        }
    };
    points.iter().map(flat).collect()
}
