//! The kernels of stones: what is at a point, what shows of it, and what belongs to the stone there.

use super::KIND;
use super::ground::{Ground, Hand};
use super::top::Pixel;
use crate::field::{Block, Kernel, Sampling};
use crate::key::{Key, KeyHasher};
use glam::{DVec2, Vec2};

/// Columns in: position. Columns out: mean height of the stones in the pixel, by how much it differs within, the share that
/// they cover, depth inside the outline, number of the stone or of the nearest, -1 for none, number of another stone in the
/// pixel, and its share of what is covered. Numbers have no means, so no pixel is divided here.
#[derive(Debug)]
pub(super) struct Find {
    pub(super) ground: Ground,
    pub(super) key: Key,
}

/// Pixels in which `x`, a column in, changes by more than `widest` mm hold more than this filters: the engine divides them.
fn divided(x: usize, widest: f32) -> Sampling {
    Sampling::FilteredWhereEven {
        column: x,
        absolute: widest,
    }
}

impl Kernel for Find {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("stones at a point")
            .whole(i64::from(KIND.version))
            .key(self.key);
    }

    fn width(&self) -> usize {
        7
    }

    fn reads_spread(&self, column: usize) -> bool {
        column < 2
    }

    fn period(&self) -> Option<[f64; 2]> {
        self.ground.grid.period.map(|period| period.to_array())
    }

    fn nanoseconds(&self) -> f32 {
        40.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [x, y] = [0, 1].map(|axis| block.inputs[axis]);
        let mut hand = Hand::default();
        for index in 0..x.values.len() {
            let at = DVec2::new(f64::from(x.values[index]), f64::from(y.values[index]));
            let sides = [0, 1].map(|side| Vec2::new(x.spread[side][index], y.spread[side][index]));
            let found = self.ground.find(at, &Pixel::new(sides), &mut hand);
            let number = |stone: Option<u32>| stone.map_or(-1.0, |stone| stone as f32);
            let columns = [
                found.height,
                found.range,
                found.cover,
                found.depth,
                number(found.stone),
                number(found.other),
                found.share,
            ];
            for (output, value) in block.outputs.iter_mut().zip(columns) {
                output[index] = value;
            }
        }
    }
}

/// How much the height falls over a mm towards the edge where the stone is chipped.
const CHIP: f32 = 1.5;

/// How far on stones, in mm, a point is still in the shade of joints.
const SHADED: f32 = 5.0;

/// Over how many mm joints that are wider than usual lie open to the sky.
pub(super) const OPEN: f32 = 4.0;

/// How much wider than half of a joint a gap is before it does, as a share of the joint.
pub(super) const WIDE: f32 = 0.75;

/// What shows of stones above their bed. Columns in: the first four of [`Find`]; height of the bed, width of the chips,
/// relief, position. Columns out: height, mask, depth, recess.
#[derive(Debug)]
pub(super) struct Relief {
    /// Width of the joints in mm.
    pub(super) joint: f32,
    /// Change of x within a pixel, in mm, up to which it is not divided.
    pub(super) widest: f32,
}

impl Kernel for Relief {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("relief of stones")
            .whole(i64::from(KIND.version))
            .number(f64::from(self.joint))
            .number(f64::from(self.widest));
    }

    fn width(&self) -> usize {
        4
    }

    fn sampling(&self) -> Sampling {
        divided(7, self.widest)
    }

    fn widest(&self) -> Option<(usize, f32)> {
        Some((7, self.widest))
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [height, range, cover, depth, bed, chips, relief] =
            [0, 1, 2, 3, 4, 5, 6].map(|column| block.inputs[column].values);
        for index in 0..height.len() {
            let lost = CHIP * (chips[index] - depth[index].max(0.0)).max(0.0);
            let above = height[index] + relief[index] - lost - bed[index];
            let [share, rise] = positive(above, range[index]);
            let hidden = (SHADED - depth[index]) / (SHADED + 0.5 * self.joint);
            let open = (-depth[index] - WIDE * self.joint) / OPEN;
            let hidden = hidden.clamp(0.0, 1.0) * (1.0 - open.clamp(0.0, 1.0));
            let shown = [
                bed[index] + cover[index] * rise,
                cover[index] * share,
                depth[index],
                hidden * hidden * (3.0 - 2.0 * hidden),
            ];
            for (output, value) in block.outputs.iter_mut().zip(shown) {
                output[index] = value;
            }
        }
    }
}

/// Of numbers evenly spread over `range` around `middle`: the share that is above 0, and the mean with those below as 0.
#[inline]
fn positive(middle: f32, range: f32) -> [f32; 2] {
    let reach = middle + 0.5 * range;
    if reach <= 0.0 {
        [0.0, 0.0]
    } else if reach >= range {
        [1.0, middle]
    } else {
        [reach / range, 0.5 * reach * reach / range]
    }
}

/// What belongs to a stone, by its number. Columns in: the last three of [`Find`], position.
#[derive(Debug)]
pub(super) struct OfStone {
    /// For each column the value of every stone, and behind them that of no stone.
    pub(super) columns: Vec<Vec<f32>>,
    pub(super) key: Key,
    /// Change of x within a pixel, in mm, up to which it is not divided, if pixels with two stones are means and not what
    /// most of it is.
    pub(super) widest: Option<f32>,
}

impl OfStone {
    pub(super) fn new(columns: Vec<Vec<f32>>, widest: Option<f32>) -> OfStone {
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
            widest,
        }
    }
}

impl Kernel for OfStone {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("what belongs to a stone")
            .whole(i64::from(KIND.version))
            .key(self.key);
        key.number(self.widest.map_or(-1.0, f64::from));
    }

    fn width(&self) -> usize {
        self.columns.len()
    }

    fn sampling(&self) -> Sampling {
        self.widest
            .map_or(Sampling::Filtered, |widest| divided(3, widest))
    }

    fn widest(&self) -> Option<(usize, f32)> {
        self.widest.map(|widest| (3, widest))
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [numbers, others, shares] = [0, 1, 2].map(|column| block.inputs[column].values);
        for (output, column) in block.outputs.iter_mut().zip(&self.columns) {
            let none = column.len() - 1;
            let of = |number: f32| column[if number < 0.0 { none } else { number as usize }];
            for (index, value) in output.iter_mut().enumerate() {
                *value = of(numbers[index]);
                if self.widest.is_some() && shares[index] > 0.0 {
                    *value += (of(others[index]) - *value) * shares[index];
                }
            }
        }
    }
}

/// The id of the stone that shows, 0 where the bed is most of the pixel. Columns in: mask of [`Relief`], id.
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
            *output = if *mask > 0.5 { *id } else { 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_above_is_the_mean_of_many() {
        for (middle, range) in [(3.0, 2.0), (0.3, 2.0), (-0.7, 2.0), (-3.0, 2.0), (1.0, 0.0)] {
            let values = (0..1000).map(|i| middle + range * ((i as f32 + 0.5) / 1000.0 - 0.5));
            let [share, mean] = positive(middle, range);
            let above: Vec<f32> = values.map(|value| value.max(0.0)).collect();
            let found = above.iter().filter(|value| **value > 0.0).count() as f32 / 1000.0;
            assert!(
                (found - share).abs() < 2e-3,
                "{middle} {range}: {share}, not {found}"
            );
            assert!((above.iter().sum::<f32>() / 1000.0 - mean).abs() < 2e-3);
        }
    }
}
