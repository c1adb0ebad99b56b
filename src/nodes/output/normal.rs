//! Normals from height: the slope of the relief in the piece's own plane.
//!
//! n = normalise(-dh/du, -dh/dv, 1) with u to the right and v up, so it is OpenGL-handed. The slope is
//! the spread of the height over the spread of the position (the inverse of their Jacobian).

use crate::field::{Block, Field, Kernel};
use crate::key::KeyHasher;
use crate::value::Domain;
use std::sync::Arc;

/// The unit normal of a plane field of heights in mm: three numbers from -1 to 1.
pub(crate) fn normal_from_height(node: &Arc<str>, height: &Field) -> Field {
    Field::kernel(
        node,
        Arc::new(Normal),
        vec![height.clone(), Field::position(Domain::Plane)],
    )
}

#[derive(Debug)]
struct Normal;

impl Kernel for Normal {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("normal_from_height").whole(1);
    }

    fn width(&self) -> usize {
        3
    }

    fn reads_spread(&self, column: usize) -> bool {
        // Height, u and v; the third part of a plane's position is always 0.
        column < 3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [height, u, v, _] = block.inputs else {
            return;
        };
        let [normal_u, normal_v, normal_w] = block.outputs else {
            return;
        };
        for index in 0..height.values.len() {
            let along_row = |column: &crate::field::InputColumn<'_>| column.spread[0][index];
            let along_column = |column: &crate::field::InputColumn<'_>| column.spread[1][index];
            let area = along_row(u) * along_column(v) - along_column(u) * along_row(v);
            // Points without neighbours have no slope.
            let scale = if area == 0.0 { 0.0 } else { 1.0 / area };
            let rise_u =
                scale * (along_row(height) * along_column(v) - along_column(height) * along_row(v));
            let rise_v =
                scale * (along_row(u) * along_column(height) - along_column(u) * along_row(height));
            let length = (rise_u * rise_u + rise_v * rise_v + 1.0).sqrt();
            normal_u[index] = -rise_u / length;
            normal_v[index] = -rise_v / length;
            normal_w[index] = 1.0 / length;
        }
    }
}
