//! The closed surface around the part of a box where a function is above 0, as triangles.
//!
//! The box is divided into cubes and these into six tetrahedra each (Kuhn's division, which fits at all faces);
//! the surface runs between corners of different signs (Doi & Koide 1991). That has no ambiguous cases, so every edge
//! belongs to exactly two triangles. At the sides of the box there is one more layer of corners, without thickness and
//! outside, so that flat faces with sharp edges close the surface there. Only blocks of cubes through which the surface
//! runs are looked at: it is found on a coarse grid and followed from block to block.

mod blocks;
mod tetrahedra;

use glam::DVec3;

/// The values of a function at points, positive inside; `None` if the run was cancelled.
pub(crate) type Evaluate<'e> = dyn Fn(&[DVec3]) -> Option<Vec<f64>> + 'e;

/// A box divided into cubes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    low: DVec3,
    high: DVec3,
    /// Cubes along each axis, without the flat layers at the sides.
    cubes: [i32; 3],
}

/// A corner of the grid; those of the flat layers are -1 and one more than the cubes.
type Corner = [i32; 3];

/// A surface of triangles.
#[derive(Debug, Default)]
pub(crate) struct Surface {
    /// Points on the surface.
    pub(crate) points: Vec<DVec3>,
    /// Corners counterclockwise seen from outside.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// For each triangle the side of the box that it closes, as 2 * axis + (1 for the high one); 6 if it is none.
    pub(crate) sides: Vec<u8>,
}

/// Why there is no surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NoSurface {
    /// The run was cancelled.
    Cancelled,
    /// The function is nowhere above 0.
    Empty,
    /// It would take more points than allowed.
    TooFine { points: u64 },
}

/// Most points at which the function is evaluated, each time.
pub(crate) const MOST_POINTS: u64 = 40_000_000;

/// Times that the place of a point is halved on its edge.
const HALVINGS: usize = 12;

impl Grid {
    /// A box in cubes of about `cell`, a little smaller so that they fit.
    pub(crate) fn new(low: DVec3, high: DVec3, cell: f64) -> Grid {
        let cubes = ((high - low) / cell).to_array();
        Grid {
            low,
            high,
            // Sides of more are refused by their number before they are used.
            cubes: cubes.map(|count| count.ceil().clamp(1.0, 1e6) as i32),
        }
    }

    /// The place of a corner; the flat layers lie on the sides of the box.
    fn place(&self, corner: Corner) -> DVec3 {
        let part = |axis: usize| {
            let share = f64::from(corner[axis]) / f64::from(self.cubes[axis]);
            self.low[axis] + (self.high[axis] - self.low[axis]) * share.clamp(0.0, 1.0)
        };
        DVec3::new(part(0), part(1), part(2))
    }

    /// Whether a corner belongs to a flat layer.
    fn is_outside(&self, corner: Corner) -> bool {
        (0..3).any(|axis| !(0..=self.cubes[axis]).contains(&corner[axis]))
    }

    /// The side of the box whose flat layer a cube belongs to; 6 if it lies in the box.
    fn side(&self, cube: Corner) -> u8 {
        let of = |axis: usize| match cube[axis] {
            -1 => Some(2 * axis as u8),
            index if index == self.cubes[axis] => Some(2 * axis as u8 + 1),
            _ => None,
        };
        (0..3).find_map(of).unwrap_or(6)
    }

    /// The surface around what is above 0.
    ///
    /// # Errors
    /// [`NoSurface`].
    pub(crate) fn surface(&self, evaluate: &Evaluate<'_>) -> Result<Surface, NoSurface> {
        let blocks = self.blocks(evaluate)?;
        let mut crossings = tetrahedra::Crossings::default();
        for block in &blocks {
            block.divide(self, &mut crossings);
        }
        let points = self.refined(&crossings.edges, evaluate)?;
        Ok(Surface {
            points,
            triangles: crossings.triangles,
            sides: crossings.sides,
        })
    }

    /// The points on edges at which the function is 0, by halving.
    fn refined(
        &self,
        edges: &[[Corner; 2]],
        evaluate: &Evaluate<'_>,
    ) -> Result<Vec<DVec3>, NoSurface> {
        let mut ends: Vec<[DVec3; 2]> = edges
            .iter()
            .map(|edge| edge.map(|corner| self.place(corner)))
            .collect();
        for _ in 0..HALVINGS {
            let middles: Vec<DVec3> = ends.iter().map(|[a, b]| a.midpoint(*b)).collect();
            let values = evaluate(&middles).ok_or(NoSurface::Cancelled)?;
            for ((ends, middle), value) in ends.iter_mut().zip(middles).zip(values) {
                ends[usize::from(value <= 0.0)] = middle;
            }
        }
        Ok(ends.iter().map(|[a, b]| a.midpoint(*b)).collect())
    }
}
