//! `region_cells`: each polygon of a region as a cell.
//!
//! The first axis of a cell is the direction in which it is longest, by the second moments of its area
//!
//! ```text
//! tan 2a = 2 Mxy / (Mxx - Myy)
//! ```
//!
//! so that wood laid into the points of a star runs along each of them.

use crate::geometry::assemble::{Piece, Ring, assemble};
use crate::node::{Build, Failure, Input, Inputs, Kind, Output};
use crate::value::{Partition, Polygon, Region, Type, Value};
use glam::DVec2;
use std::sync::Arc;

/// The polygons of a region as cells.
pub static KIND: Kind = Kind {
    name: "region_cells",
    version: 1,
    about: "Each polygon of a region as a cell, whose first axis is the direction in which it is longest: shapes from a \
            drawing become pieces that are laid or let in.",
    source: "own construction; principal axes of the area (Steger 1996, moments of polygons)",
    inputs: &[Input::new("of", Type::Region, "The polygons.")],
    outputs: &[Output::new("cells", Type::Partition, "The cells.")],
    example: "(nodes: {
        \"points\": region(outlines: [
            (outline: [(50, 50), (70, 60), (100, 100)]),
            (outline: [(50, 50), (0, 100), (30, 60)]),
        ]),
        \"example\": region_cells(of: \"points\"),
    })",
    build,
};

/// Shorter than this, relative to the moments themselves, the difference of two moments is chance.
const ROUND: f64 = 1e-9;

fn build(inputs: &Inputs<'_>, build: &Build<'_>) -> Result<Vec<Value>, Failure> {
    let cells = cells(inputs.region("of"), build)?;
    match cells.is_empty() {
        true => Err(Failure::of_input(
            "of",
            "no polygon of the region is large enough to be a cell",
        )),
        false => Ok(vec![Value::Partition(Arc::new(cells))]),
    }
}

/// The polygons of a region as cells.
///
/// # Errors
/// If the run was cancelled.
pub(in crate::nodes) fn cells(region: &Region, build: &Build<'_>) -> Result<Partition, Failure> {
    let polygons = region.polygons.iter().enumerate();
    let pieces = polygons.map(|(id, polygon)| Piece {
        rings: polygon
            .rings()
            .map(|ring| Ring::straight(ring.to_vec()))
            .collect(),
        id: id as u32,
        frame: longest(polygon),
        centre: None,
    });
    assemble(pieces.collect(), None, 0.0, &mut || build.go_on())
}

/// The direction in which a polygon is longest; along x if there is none.
fn longest(polygon: &Polygon) -> DVec2 {
    let origin = polygon.outline[0];
    // Area, first and second moments about a corner.
    let mut moments = [0.0; 6];
    for ring in polygon.rings() {
        let next = ring.iter().cycle().skip(1);
        for (from, to) in ring.iter().zip(next) {
            let (a, b) = (*from - origin, *to - origin);
            let cross = a.perp_dot(b);
            let sum = a + b;
            let of_edge = [
                cross / 2.0,
                cross * sum.x / 6.0,
                cross * sum.y / 6.0,
                cross * (a.x * a.x + a.x * b.x + b.x * b.x) / 12.0,
                cross * (2.0 * (a.x * a.y + b.x * b.y) + a.x * b.y + b.x * a.y) / 24.0,
                cross * (a.y * a.y + a.y * b.y + b.y * b.y) / 12.0,
            ];
            moments
                .iter_mut()
                .zip(of_edge)
                .for_each(|(sum, part)| *sum += part);
        }
    }
    let [area, mx, my, xx, xy, yy] = moments;
    let (xx, xy, yy) = (
        xx - mx * mx / area,
        xy - mx * my / area,
        yy - my * my / area,
    );
    let (across, difference) = (2.0 * xy, xx - yy);
    if across.abs().max(difference.abs()) <= ROUND * (xx + yy) {
        return DVec2::X;
    }
    let (sine, cosine) = libm::sincos(0.5 * libm::atan2(across, difference));
    DVec2::new(cosine, sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(corners: &[(f64, f64)]) -> DVec2 {
        let outline = corners.iter().map(|(x, y)| DVec2::new(*x, *y)).collect();
        longest(&Polygon {
            outline,
            holes: vec![],
        })
    }

    #[test]
    fn axes_run_along_what_is_long() {
        assert_eq!(
            frame(&[(0.0, 0.0), (9.0, 0.0), (9.0, 1.0), (0.0, 1.0)]),
            DVec2::X
        );
        let upright = frame(&[(5.0, 5.0), (6.0, 5.0), (6.0, 14.0), (5.0, 14.0)]);
        assert!((upright - DVec2::Y).length() < 1e-12, "{upright}");
        // A strip along the diagonal, far from the origin.
        let strip = frame(&[(1000.0, 0.0), (1010.0, 10.0), (1009.0, 11.0), (999.0, 1.0)]);
        assert!(
            (strip - DVec2::splat(0.5_f64.sqrt())).length() < 1e-9,
            "{strip}"
        );
        // A square has no long side.
        assert_eq!(
            frame(&[(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)]),
            DVec2::X
        );
    }
}
