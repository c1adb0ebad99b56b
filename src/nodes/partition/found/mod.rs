//! Which cell each point of a plane is in, and what is known of the cell, as columns.

mod quantity;

pub(in crate::nodes) use self::quantity::{Quantity, share};

use crate::field::{Block, Field, Kernel};
use crate::geometry::cells::CellIndex;
use crate::key::{Key, KeyHasher};
use crate::node::Build;
use crate::value::{Domain, Partition};
use glam::DVec2;
use std::sync::{Arc, OnceLock};

/// A partition as fields of the plane.
#[derive(Clone, Debug)]
pub(in crate::nodes) struct Found {
    partition: Arc<Partition>,
    key: Key,
    columns: Field,
}

/// Whole numbers up to this are told apart in a fraction of an f32.
const FRACTIONS: u32 = 1 << 22;

impl Found {
    /// The cells of a partition.
    pub(in crate::nodes) fn new(build: &Build<'_>, partition: &Arc<Partition>) -> Found {
        let key = partition.key();
        let find = Find {
            partition: Arc::clone(partition),
            key,
            index: OnceLock::new(),
        };
        Found {
            partition: Arc::clone(partition),
            key,
            columns: build.kernel(find, vec![Field::position(Domain::Plane)]),
        }
    }

    /// Identifies the partition.
    pub(in crate::nodes) fn key(&self) -> Key {
        self.key
    }

    /// The index of the cell at a point, or of the nearest one.
    pub(in crate::nodes) fn index(&self) -> Field {
        self.columns.part(0, 1)
    }

    /// The distance to the cell's border in mm, below 0 outside.
    pub(in crate::nodes) fn border(&self) -> Field {
        self.columns.part(1, 1)
    }

    /// Where the point is in the cell, in mm along the cell's own two axes from its centre.
    pub(in crate::nodes) fn place(&self) -> Field {
        self.columns.part(2, 3)
    }

    /// The id of the cell beyond the nearest edge, -1 if there is none.
    pub(in crate::nodes) fn beyond(&self) -> Field {
        self.columns.part(5, 1)
    }

    /// A fraction that is the same within a cell: parts of one chart.
    pub(in crate::nodes) fn chart(&self, build: &Build<'_>) -> Field {
        build.kernel(Chart, vec![self.index()])
    }

    /// What is known of the cell.
    pub(in crate::nodes) fn quantity(&self, build: &Build<'_>, quantity: Quantity) -> Field {
        let kernel = quantity.of(&self.partition, self.key);
        build.kernel(kernel, vec![self.index()])
    }
}

/// Index of the cell, distance to its border, place in it, id of the cell beyond.
#[derive(Debug)]
struct Find {
    partition: Arc<Partition>,
    key: Key,
    /// Made when it is first needed: runs that find all columns do without.
    index: OnceLock<CellIndex>,
}

impl Kernel for Find {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("find cell").whole(1).key(self.key);
    }

    fn width(&self) -> usize {
        6
    }

    fn nanoseconds(&self) -> f32 {
        60.0
    }

    fn period(&self) -> Option<[f64; 2]> {
        self.partition.period.map(|period| period.to_array())
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let partition = &self.partition;
        let index = self.index.get_or_init(|| CellIndex::new(partition));
        let [u, v] = [0, 1].map(|column| block.inputs[column].values);
        let mut last = None;
        for (sample, (u, v)) in u.iter().zip(v).enumerate() {
            let point = DVec2::new(f64::from(*u), f64::from(*v));
            let spot = index.find(point, last.as_ref());
            let frame = partition.frames[spot.cell as usize];
            let place = DVec2::new(frame.dot(spot.offset), frame.perp_dot(spot.offset));
            let beyond = partition.neighbours[spot.edge as usize];
            let beyond = partition.ids.get(beyond as usize);
            let columns = [
                spot.cell as f32,
                spot.border as f32,
                place.x as f32,
                place.y as f32,
                0.0,
                beyond.map_or(-1.0, |id| *id as f32),
            ];
            for (output, value) in block.outputs.iter_mut().zip(columns) {
                output[sample] = value;
            }
            last = Some(spot);
        }
    }
}

/// A fraction for each cell.
#[derive(Debug)]
struct Chart;

impl Kernel for Chart {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("cell as chart").whole(1);
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (output, index) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            let fraction = (*index as u32 % FRACTIONS) as f32 + 0.5;
            *output = fraction / FRACTIONS as f32;
        }
    }
}
