//! Targets: what the pixels of an output lie on.

use crate::field::{Target, remainder};
use crate::key::{Key, KeyHasher};

/// A flat piece seen from the front: u runs to the right from 0 at the left edge, v runs up from 0 at the
/// lower edge, both in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatPiece {
    pixels: [u32; 2],
    size: [f64; 2],
}

impl FlatPiece {
    /// A piece of `size` mm on `pixels` pixels.
    pub fn new(pixels: [u32; 2], size: [f64; 2]) -> FlatPiece {
        FlatPiece { pixels, size }
    }
}

impl Target for FlatPiece {
    fn key(&self) -> Key {
        let mut key = KeyHasher::new("flat_piece", 1);
        self.pixels.iter().for_each(|side| {
            key.whole(i64::from(*side));
        });
        self.size.iter().for_each(|length| {
            key.number(*length);
        });
        key.finish()
    }

    fn pixels(&self) -> [u32; 2] {
        self.pixels
    }

    fn write_row(&self, x: f64, y: f64, step: f64, [u, v, w]: [&mut [f32]; 3]) {
        let [across, down] = [0, 1].map(|axis| self.size[axis] / f64::from(self.pixels[axis]));
        for (index, u) in (0i32..).zip(u) {
            *u = ((x + f64::from(index) * step) * across) as f32;
        }
        v.fill((self.size[1] - y * down) as f32);
        w.fill(0.0);
    }

    fn write_remainders(&self, x: f64, _: f64, step: f64, row: &mut [f32]) {
        let across = self.size[0] / f64::from(self.pixels[0]);
        for (index, value) in (0i32..).zip(row) {
            *value = remainder((x + f64::from(index) * step) * across);
        }
    }
}
