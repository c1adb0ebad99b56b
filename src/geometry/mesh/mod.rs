//! Meshes from loose triangles: equal points are one, every corner has a normal and a place on the square.

mod atlas;
mod charts;
mod closed;
mod normals;
mod overlap;
mod packing;
mod unwrap;

pub(crate) use atlas::Atlas;
pub(crate) use closed::{Open, check_closed};

use crate::value::{Mesh, Triangle};
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// Triangles as a file states them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Soup {
    /// Points in mm; the same one may come several times.
    pub(crate) points: Vec<DVec3>,
    /// Normals of any length.
    pub(crate) normals: Vec<DVec3>,
    /// Places on the square.
    pub(crate) coordinates: Vec<DVec2>,
    /// The triangles, counterclockwise seen from outside.
    pub(crate) triangles: Vec<Corners>,
}

/// The corners of a triangle, as indices into the lists of a [`Soup`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corners {
    /// Points.
    pub(crate) points: [u32; 3],
    /// Normals, if the file has them.
    pub(crate) normals: Option<[u32; 3]>,
    /// Places on the square, if the file has them.
    pub(crate) coordinates: Option<[u32; 3]>,
}

/// How a mesh is made of loose triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Finish {
    /// Whether normals of the file are kept.
    pub(crate) keeps_normals: bool,
    /// Whether places of the file are kept.
    pub(crate) keeps_coordinates: bool,
    /// Faces that meet at more than this angle, in radians, meet at an edge.
    pub(crate) crease: f64,
}

/// Makes a mesh, and tells how many triangles without an area were left out. `go_on` is asked now and then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn assemble<E>(
    mut soup: Soup,
    finish: Finish,
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<(Mesh, usize), E> {
    weld(&mut soup);
    let before = soup.triangles.len();
    let Soup {
        points, triangles, ..
    } = &mut soup;
    triangles.retain(|corners| face_normal(points, corners.points).is_some());
    let left_out = before - soup.triangles.len();
    go_on()?;
    let (normals, corner_normals) = normals::of_corners(&soup, finish, go_on)?;
    let has_places = soup.triangles.iter().all(|it| it.coordinates.is_some());
    let placed = match has_places && finish.keeps_coordinates {
        true => charts::of_file(&soup),
        false => unwrap::unwrap(&soup, go_on)?,
    };
    let corners = soup.triangles.iter().zip(corner_normals);
    let triangles = corners.zip(placed.corners).zip(placed.charts);
    let triangles = triangles
        .map(|(((corners, normals), coordinates), chart)| Triangle {
            points: corners.points,
            normals,
            coordinates,
            chart,
        })
        .collect();
    let mesh = Mesh {
        points: soup.points,
        normals,
        coordinates: placed.coordinates,
        triangles,
    };
    Ok((mesh, left_out))
}

/// Where triangles are on the square.
struct Placed {
    coordinates: Vec<DVec2>,
    /// For each triangle the places of its corners.
    corners: Vec<[u32; 3]>,
    /// For each triangle its chart.
    charts: Vec<u32>,
}

/// The unit normal of a triangle; `None` if it has no area.
fn face_normal(points: &[DVec3], corners: [u32; 3]) -> Option<DVec3> {
    let [a, b, c] = corners.map(|index| points[index as usize]);
    let (ab, ac) = (b - a, c - a);
    let area = ab.cross(ac);
    let longest = ab.length_squared().max(ac.length_squared());
    match area.length() > 1e-12 * longest.max((c - b).length_squared()) {
        true => Some(area.normalize()),
        false => None,
    }
}

/// Gives equal points and equal places one index each, in the order in which they come first.
fn weld(soup: &mut Soup) {
    let mut first: HashMap<[u64; 3], u32> = HashMap::new();
    let bits = |point: &DVec3| point.to_array().map(|part| (part + 0.0).to_bits());
    let points: Vec<u32> = numbered(soup.points.iter().map(bits), &mut first);
    soup.points = distinct(&soup.points, &points);
    let mut first: HashMap<[u64; 2], u32> = HashMap::new();
    let bits = |place: &DVec2| place.to_array().map(|part| (part + 0.0).to_bits());
    let places: Vec<u32> = numbered(soup.coordinates.iter().map(bits), &mut first);
    soup.coordinates = distinct(&soup.coordinates, &places);
    for corners in &mut soup.triangles {
        corners.points = corners.points.map(|index| points[index as usize]);
        let renamed = |corners: [u32; 3]| corners.map(|index| places[index as usize]);
        corners.coordinates = corners.coordinates.map(renamed);
    }
}

/// A number for each item, the same for equal ones.
fn numbered<T: Eq + std::hash::Hash>(
    items: impl Iterator<Item = T>,
    first: &mut HashMap<T, u32>,
) -> Vec<u32> {
    let number = |item: T| {
        let next = first.len() as u32;
        *first.entry(item).or_insert(next)
    };
    items.map(number).collect()
}

/// One item of each number.
fn distinct<T: Copy>(items: &[T], numbers: &[u32]) -> Vec<T> {
    let mut kept: Vec<T> = vec![];
    for (item, number) in items.iter().zip(numbers) {
        if *number as usize == kept.len() {
            kept.push(*item);
        }
    }
    kept
}
