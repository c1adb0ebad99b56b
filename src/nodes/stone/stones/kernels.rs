//! The kernels of stones: what is at a point, what shows of it, and what belongs to the stone there.

use super::KIND;
use super::ground::{Found, Ground, Hand};
use crate::field::{Block, Kernel, Sampling};
use crate::key::{Key, KeyHasher};
use glam::DVec2;

/// Columns in: position. Columns out: height of the stone, whether there is one, depth inside the outline, number of the
/// stone or of the nearest, -1 for none. Unfiltered: what reads them is supersampled.
#[derive(Debug)]
pub(super) struct Find {
    pub(super) ground: Ground,
    pub(super) key: Key,
}

impl Kernel for Find {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("stones at a point")
            .whole(i64::from(KIND.version))
            .key(self.key);
    }

    fn width(&self) -> usize {
        4
    }

    fn nanoseconds(&self) -> f32 {
        40.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [x, y] = [0, 1].map(|axis| block.inputs[axis].values);
        let mut hand = Hand::default();
        for (index, (x, y)) in x.iter().zip(y).enumerate() {
            let at = DVec2::new(f64::from(*x), f64::from(*y));
            let Found {
                height,
                is_covered,
                depth,
                stone,
            } = self.ground.find(at, &mut hand);
            let number = stone.map_or(-1.0, |stone| stone as f32);
            let found = [height, f32::from(u8::from(is_covered)), depth, number];
            for (output, value) in block.outputs.iter_mut().zip(found) {
                output[index] = value;
            }
        }
    }
}

/// How much the height falls over a mm towards the edge where the stone is chipped.
const CHIP: f32 = 1.5;

/// What shows of stones above their bed. Columns in: those of [`Find`], height of the bed, width of the chips. Columns out:
/// height, mask, depth, and a column that bends where a pixel has to be divided.
#[derive(Debug)]
pub(super) struct Show;

/// Added where a stone shows, so that its rim bends by more than anything.
const STEP: f32 = 1000.0;

impl Kernel for Show {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("stones above their bed")
            .whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        4
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [stone, covered, depth, _, bed, chips] =
            [0, 1, 2, 3, 4, 5].map(|column| block.inputs[column].values);
        for index in 0..stone.len() {
            let chipped = stone[index] - CHIP * (chips[index] - depth[index].max(0.0)).max(0.0);
            let shows = covered[index] > 0.5 && chipped > bed[index];
            let shown = match shows {
                true => [chipped, 1.0, depth[index], STEP + stone[index]],
                false => [bed[index], 0.0, depth[index], 0.0],
            };
            for (output, value) in block.outputs.iter_mut().zip(shown) {
                output[index] = value;
            }
        }
    }
}

/// The first three columns of [`Show`], averaged over pixels where they bend.
#[derive(Debug)]
pub(super) struct Relief {
    /// Bend in mm that does not show.
    pub(super) even: f32,
}

impl Kernel for Relief {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("relief of stones")
            .whole(i64::from(KIND.version))
            .number(f64::from(self.even));
    }

    fn width(&self) -> usize {
        3
    }

    fn sampling(&self) -> Sampling {
        Sampling::FilteredWhereStraight {
            column: 3,
            absolute: self.even,
            relative: 0.1,
        }
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (output, input) in block.outputs.iter_mut().zip(block.inputs) {
            output.copy_from_slice(input.values);
        }
    }
}

/// What belongs to a stone, by its number. Columns in: number.
#[derive(Debug)]
pub(super) struct OfStone {
    /// For each column the value of every stone, and behind them that of no stone.
    pub(super) columns: Vec<Vec<f32>>,
    pub(super) key: Key,
    /// Whether pixels at borders are means, as opposed to what is in their middle.
    pub(super) is_mean: bool,
}

impl OfStone {
    pub(super) fn new(columns: Vec<Vec<f32>>, is_mean: bool) -> OfStone {
        let mut key = KeyHasher::new("table of stones", 1);
        for column in &columns {
            key.whole(column.len() as i64);
            column.iter().for_each(|value| {
                key.number(f64::from(*value));
            });
        }
        OfStone {
            key: key.finish(),
            columns,
            is_mean,
        }
    }
}

impl Kernel for OfStone {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("what belongs to a stone")
            .whole(i64::from(KIND.version))
            .key(self.key);
        key.whole(i64::from(self.is_mean));
    }

    fn width(&self) -> usize {
        self.columns.len()
    }

    fn sampling(&self) -> Sampling {
        match self.is_mean {
            true => Sampling::FilteredWhereEven {
                column: 0,
                absolute: 0.0,
            },
            false => Sampling::Filtered,
        }
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let numbers = block.inputs[0].values;
        for (output, column) in block.outputs.iter_mut().zip(&self.columns) {
            let none = column.len() - 1;
            for (value, number) in output.iter_mut().zip(numbers) {
                *value = column[if *number < 0.0 {
                    none
                } else {
                    *number as usize
                }];
            }
        }
    }
}

/// The id of the stone that shows, 0 where none does. Columns in: mask of [`Show`], id.
#[derive(Debug)]
pub(super) struct Shown;

impl Kernel for Shown {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("id of the stone that shows")
            .whole(i64::from(KIND.version));
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let pairs = block.inputs[0].values.iter().zip(block.inputs[1].values);
        for (output, (mask, id)) in block.outputs[0].iter_mut().zip(pairs) {
            *output = mask * id;
        }
    }
}
