//! Where in a material the points of a cell lie.

use super::KIND;
use crate::field::{Block, Kernel};
use crate::key::{Key, KeyHasher};
use crate::node::{Failure, Inputs};
use crate::nodes::cut::placed::spanned;
use crate::nodes::partition::found::share;
use crate::value::{Domain, Partition};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Sends points of cells to points of a material. Columns in: index of the cell, place in it, origin.
#[derive(Debug)]
pub(super) struct Laid {
    partition: Arc<Partition>,
    key: Key,
    scatter: DVec3,
    across: DVec3,
    along: DVec3,
    /// In radians.
    spin: f64,
    turns: f64,
    follows_cell: bool,
    seed: u64,
}

/// How one cell lies.
struct Lie {
    offset: DVec3,
    /// What x and y of the place in the cell are multiplied with.
    across: DVec3,
    along: DVec3,
    /// The turn about the upright axis: cosine and sine.
    spin: DVec2,
}

impl Laid {
    /// How cells lie in a material of the domain.
    pub(super) fn read(
        inputs: &Inputs<'_>,
        (partition, key): (&Arc<Partition>, Key),
        domain: Domain,
        seed: u64,
    ) -> Result<Laid, Failure> {
        let along = match (inputs.get("along"), domain) {
            (Some(_), _) => inputs.vector("along"),
            (None, Domain::Plane) => DVec3::Y,
            (None, _) => DVec3::Z,
        };
        // What is left out cannot be at fault.
        let blamed = inputs.get("along").map_or("across", |_| "along");
        let [across, along] = spanned(inputs.vector("across"), along, blamed)?;
        Ok(Laid {
            partition: Arc::clone(partition),
            key,
            scatter: inputs.vector("scatter"),
            across,
            along,
            spin: inputs.number("spin").to_radians(),
            turns: inputs.whole("turns") as f64,
            follows_cell: inputs.choice("frame") == "cell",
            seed,
        })
    }

    fn lie(&self, cell: usize) -> Lie {
        let id = self.partition.ids[cell];
        // Each draw has a seed of its own.
        let draw = |number: u64| share(self.seed.wrapping_add(number << 8), id);
        let offset = DVec3::new(draw(1), draw(2), draw(3)) * 2.0 - 1.0;
        let spin = (draw(4) - 0.5) * self.spin;
        let turn = (draw(5) * self.turns).floor() * TAU / self.turns;
        let frame = self.partition.frames[cell];
        let mut turn = DVec2::new(libm::cos(turn), libm::sin(turn));
        if !self.follows_cell {
            turn = turn.rotate(frame);
        }
        Lie {
            offset: offset * self.scatter,
            across: self.across * turn.x + self.along * turn.y,
            along: self.along * turn.x - self.across * turn.y,
            spin: DVec2::new(libm::cos(spin), libm::sin(spin)),
        }
    }
}

impl Kernel for Laid {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("laid in cell")
            .whole(i64::from(KIND.version))
            .key(self.key)
            .bytes(&self.seed.to_le_bytes())
            .number(self.spin)
            .number(self.turns)
            .whole(i64::from(self.follows_cell));
        for vector in [self.scatter, self.across, self.along] {
            vector.to_array().iter().for_each(|part| {
                key.number(*part);
            });
        }
    }

    fn width(&self) -> usize {
        3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let column = |index: usize| block.inputs[index].values;
        let (cells, x, y) = (column(0), column(1), column(2));
        let origin = [4, 5, 6].map(column);
        let last = self.partition.len() - 1;
        let (mut known, mut lie) = (usize::MAX, self.lie(0));
        for (sample, cell) in cells.iter().enumerate() {
            let cell = (*cell as usize).min(last);
            if cell != known {
                (known, lie) = (cell, self.lie(cell));
            }
            let origin = DVec3::from_array(origin.map(|part| f64::from(part[sample])));
            let (x, y) = (f64::from(x[sample]), f64::from(y[sample]));
            let place = origin + lie.offset + lie.across * x + lie.along * y;
            let turned = lie.spin.rotate(DVec2::new(place.x, place.y));
            let columns = [turned.x, turned.y, place.z];
            for (output, value) in block.outputs.iter_mut().zip(columns) {
                output[sample] = value as f32;
            }
        }
    }
}
