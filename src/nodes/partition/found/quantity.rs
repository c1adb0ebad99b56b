//! What is known of a cell, looked up by its index.

use crate::field::{Block, Kernel};
use crate::key::{Key, KeyHasher};
use crate::value::Partition;
use glam::DVec2;
use std::sync::{Arc, OnceLock};

/// Something that each cell has one of.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::nodes) enum Quantity {
    /// Its id.
    Id,
    /// A number from 0 to 1, drawn from its id and a seed.
    Random(u64),
    /// Its centre in mm.
    Centre,
    /// The angle of its first axis in degrees.
    Angle,
    /// Width and height of the box around it along its own axes, in mm.
    Extent,
    /// The middle of that box seen from its centre, in mm along its own axes.
    Middle,
    /// Its area in mm².
    Area,
    /// An attribute.
    Attribute(String),
}

/// Columns of a quantity.
#[derive(Debug)]
pub(in crate::nodes) struct LookUp {
    quantity: Quantity,
    partition: Arc<Partition>,
    key: Key,
    /// Boxes along the cells' own axes, made when they are first needed.
    boxes: OnceLock<Vec<[DVec2; 2]>>,
}

impl Quantity {
    /// The kernel that gives it for indices of cells; `key` is that of the partition.
    pub(super) fn of(self, partition: &Arc<Partition>, key: Key) -> LookUp {
        LookUp {
            quantity: self,
            partition: Arc::clone(partition),
            key,
            boxes: OnceLock::new(),
        }
    }

    fn width(&self) -> usize {
        match self {
            Quantity::Centre | Quantity::Extent | Quantity::Middle => 3,
            _ => 1,
        }
    }

    fn add_to_key(&self, key: &mut KeyHasher) {
        match self {
            Quantity::Id => key.text("id"),
            Quantity::Random(seed) => key.text("random").bytes(&seed.to_le_bytes()),
            Quantity::Centre => key.text("centre"),
            Quantity::Angle => key.text("angle"),
            Quantity::Extent => key.text("extent"),
            Quantity::Middle => key.text("middle"),
            Quantity::Area => key.text("area"),
            Quantity::Attribute(name) => key.text("attribute").text(name),
        };
    }
}

impl LookUp {
    fn value(&self, cell: usize) -> [f64; 3] {
        let partition = &self.partition;
        let one = |number: f64| [number, 0.0, 0.0];
        let two = |vector: DVec2| [vector.x, vector.y, 0.0];
        let along_axes = || self.boxes.get_or_init(|| boxes(partition))[cell];
        match &self.quantity {
            Quantity::Id => one(f64::from(partition.ids[cell])),
            Quantity::Random(seed) => one(share(*seed, partition.ids[cell])),
            Quantity::Centre => two(partition.centres[cell]),
            Quantity::Angle => {
                let frame = partition.frames[cell];
                one(libm::atan2(frame.y, frame.x).to_degrees())
            }
            Quantity::Extent => {
                let [low, high] = along_axes();
                two(high - low)
            }
            Quantity::Middle => {
                let [low, high] = along_axes();
                two((high + low) * 0.5)
            }
            Quantity::Area => one(partition.areas[cell]),
            Quantity::Attribute(name) => one(partition.attributes[name][cell]),
        }
    }
}

impl Kernel for LookUp {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("quantity of cell").whole(2).key(self.key);
        self.quantity.add_to_key(key);
    }

    fn width(&self) -> usize {
        self.quantity.width()
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let last = self.partition.len() - 1;
        // Neighbours are of one cell mostly.
        let (mut known, mut value) = (usize::MAX, [0.0; 3]);
        for (sample, index) in block.inputs[0].values.iter().enumerate() {
            let cell = (*index as usize).min(last);
            if cell != known {
                (known, value) = (cell, self.value(cell));
            }
            for (output, part) in block.outputs.iter_mut().zip(value) {
                output[sample] = part as f32;
            }
        }
    }
}

/// A number from 0 to less than 1 in steps of 2^-24, drawn from a seed and an id (the mixing of splitmix64, Steele, Lea &
/// Flood 2014).
pub(in crate::nodes) fn share(seed: u64, id: u32) -> f64 {
    let mixed = (seed ^ u64::from(id))
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(seed);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((mixed ^ (mixed >> 31)) >> 40) as f64 / f64::from(1 << 24)
}

/// The boxes around all cells along their own axes, seen from their centres.
fn boxes(partition: &Partition) -> Vec<[DVec2; 2]> {
    let around = |cell: usize| {
        let (frame, centre) = (partition.frames[cell], partition.centres[cell]);
        let place = |corner: &DVec2| {
            let offset = *corner - centre;
            DVec2::new(frame.dot(offset), frame.perp_dot(offset))
        };
        let corners = partition.outline(cell).iter().map(place);
        corners.fold(
            [DVec2::INFINITY, DVec2::NEG_INFINITY],
            |[low, high], corner| [low.min(corner), high.max(corner)],
        )
    };
    (0..partition.len()).map(around).collect()
}
