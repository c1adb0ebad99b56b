//! What a chart covers already: triangles on a plane that may touch, but not overlap.

use glam::DVec2;
use std::collections::HashMap;

/// Triangles that do not overlap, in a grid of cells.
pub(super) struct Covered {
    cell: f64,
    triangles: Vec<[DVec2; 3]>,
    in_cell: HashMap<[i64; 2], Vec<u32>>,
}

impl Covered {
    /// Nothing yet; `cell` is about the size of a triangle.
    pub(super) fn new(cell: f64) -> Covered {
        Covered {
            cell,
            triangles: vec![],
            in_cell: HashMap::new(),
        }
    }

    /// Adds a triangle, unless it overlaps another.
    pub(super) fn add(&mut self, triangle: [DVec2; 3]) -> bool {
        let cells = self.cells(&triangle);
        let near = || cells.iter().filter_map(|cell| self.in_cell.get(cell));
        let is_free = near()
            .flatten()
            .all(|other| !overlap(&triangle, &self.triangles[*other as usize]));
        if is_free {
            let number = self.triangles.len() as u32;
            self.triangles.push(triangle);
            for cell in cells {
                self.in_cell.entry(cell).or_default().push(number);
            }
        }
        is_free
    }

    fn cells(&self, triangle: &[DVec2; 3]) -> Vec<[i64; 2]> {
        let [low, high] = super::unwrap::bounds(*triangle).map(|it| (it / self.cell).floor());
        let columns = low.x as i64..=high.x as i64;
        let rows = || low.y as i64..=high.y as i64;
        columns.flat_map(|x| rows().map(move |y| [x, y])).collect()
    }
}

/// Whether the insides of two triangles have a point in common: if no side of either parts them.
pub(crate) fn overlap(one: &[DVec2; 3], other: &[DVec2; 3]) -> bool {
    let parts = |a: &[DVec2; 3], b: &[DVec2; 3]| {
        (0..3).any(|side| {
            let along = a[(side + 1) % 3] - a[side];
            let across = along.perp();
            let heights = |points: &[DVec2; 3]| points.map(|it| across.dot(it - a[side]));
            let (own, others) = (heights(a), heights(b));
            let size = own.iter().fold(0.0f64, |size, it| size.max(it.abs()));
            let least = 1e-9 * size;
            // The own third corner says on which side the inside is.
            match own.iter().sum::<f64>() > 0.0 {
                true => others.iter().all(|height| *height <= least),
                false => others.iter().all(|height| *height >= -least),
            }
        })
    };
    !parts(one, other) && !parts(other, one)
}
