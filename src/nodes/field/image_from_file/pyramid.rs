//! A picture and its reduced copies, each half as large as the one before (Williams 1983).

use super::window::Window;
use crate::node::{Build, Failure};

/// The pixels of a picture as they were decoded.
#[derive(Debug)]
pub(super) struct Base {
    /// Width and height.
    pub(super) size: [u32; 2],
    /// Red, green, blue and opacity of every pixel, row by row from the top.
    pub(super) codes: Codes,
    /// Whether colours are still to be multiplied by the opacity.
    pub(super) is_weighed: bool,
}

/// Samples as codes or as numbers.
#[derive(Debug)]
pub(super) enum Codes {
    /// Codes of 8 bits, and the value of each.
    Eight(Vec<u8>, Vec<f32>),
    /// Codes of 16 bits, and the value of each.
    Sixteen(Vec<u16>, Vec<f32>),
    /// Values.
    Floats(Vec<[f32; 4]>),
}

impl Base {
    fn texel(&self, index: usize) -> [f32; 4] {
        match &self.codes {
            Codes::Eight(codes, table) => self.weighed(decoded(codes, table, index)),
            Codes::Sixteen(codes, table) => self.weighed(decoded(codes, table, index)),
            Codes::Floats(values) => self.weighed(values[index]),
        }
    }

    /// The colour multiplied by the opacity, if it still has to be.
    fn weighed(&self, texel: [f32; 4]) -> [f32; 4] {
        let [r, g, b, opacity] = texel;
        match self.is_weighed && opacity != 1.0 {
            true => [r * opacity, g * opacity, b * opacity, opacity],
            false => texel,
        }
    }

    fn sum(&self, window: Window<'_>) -> [f32; 4] {
        let width = self.size[0] as usize;
        match &self.codes {
            Codes::Eight(codes, table) => {
                window.sum(|x, y| self.weighed(decoded(codes, table, y * width + x)))
            }
            Codes::Sixteen(codes, table) => {
                window.sum(|x, y| self.weighed(decoded(codes, table, y * width + x)))
            }
            Codes::Floats(values) => window.sum(|x, y| self.weighed(values[y * width + x])),
        }
    }
}

fn decoded<C: Copy + Into<u32>>(codes: &[C], table: &[f32], index: usize) -> [f32; 4] {
    let codes = &codes[4 * index..4 * index + 4];
    let code = |part: usize| Into::<u32>::into(codes[part]) as usize;
    let largest = table.len() - 1;
    // Most pixels are opaque, and dividing is slow.
    let opacity = match code(3) {
        opacity if opacity == largest => 1.0,
        opacity => opacity as f32 / largest as f32,
    };
    [table[code(0)], table[code(1)], table[code(2)], opacity]
}

/// A picture and its reduced copies.
#[derive(Debug)]
pub(super) struct Pyramid {
    base: Base,
    reduced: Vec<Reduced>,
}

#[derive(Debug)]
struct Reduced {
    size: [usize; 2],
    texels: Vec<[f32; 4]>,
}

impl Pyramid {
    /// Reduces a picture until one pixel is left.
    ///
    /// # Errors
    /// If the run was cancelled.
    pub(super) fn new(base: Base, build: &Build<'_>) -> Result<Pyramid, Failure> {
        let mut pyramid = Pyramid {
            base,
            reduced: vec![],
        };
        while pyramid.size(pyramid.levels() - 1) != [1, 1] {
            let halved = pyramid.halved(build)?;
            pyramid.reduced.push(halved);
        }
        Ok(pyramid)
    }

    /// Number of copies, the picture itself among them.
    pub(super) fn levels(&self) -> usize {
        self.reduced.len() + 1
    }

    /// Width and height of a copy.
    pub(super) fn size(&self, level: usize) -> [usize; 2] {
        match level {
            0 => self.base.size.map(|side| side as usize),
            _ => self.reduced[level - 1].size,
        }
    }

    /// A pixel of a copy.
    fn texel(&self, level: usize, x: usize, y: usize) -> [f32; 4] {
        let index = y * self.size(level)[0] + x;
        match level {
            0 => self.base.texel(index),
            _ => self.reduced[level - 1].texels[index],
        }
    }

    /// The sum of the pixels of a copy in a window, by their weights.
    pub(super) fn sum(&self, level: usize, window: Window<'_>) -> [f32; 4] {
        match level {
            0 => self.base.sum(window),
            _ => {
                let Reduced { size, texels } = &self.reduced[level - 1];
                window.sum(|x, y| texels[y * size[0] + x])
            }
        }
    }

    /// The last copy with half as many pixels on each side: exact means over the areas that theirs have in it.
    fn halved(&self, build: &Build<'_>) -> Result<Reduced, Failure> {
        let last = self.levels() - 1;
        let from = self.size(last);
        let size = from.map(|side| side.div_ceil(2));
        let [columns, rows] = [0, 1].map(|axis| shares(from[axis], size[axis]));
        let mut texels = Vec::with_capacity(size[0] * size[1]);
        for row in &rows {
            build.go_on()?;
            for column in &columns {
                let mut sum = [0.0f64; 4];
                for (y, tall) in row {
                    for (x, wide) in column {
                        let texel = self.texel(last, *x, *y);
                        for (sum, part) in sum.iter_mut().zip(texel) {
                            *sum += f64::from(part) * tall * wide;
                        }
                    }
                }
                texels.push(sum.map(|part| part as f32));
            }
        }
        Ok(Reduced { size, texels })
    }
}

/// Which of `from` pixels each of `to` covers, and by how much of itself.
fn shares(from: usize, to: usize) -> Vec<Vec<(usize, f64)>> {
    let width = from as f64 / to as f64;
    let share = |index: usize| {
        let (start, end) = (index as f64 * width, (index + 1) as f64 * width);
        let covered = start.floor() as usize..(end.ceil() as usize).min(from);
        let part = |texel: usize| {
            let overlap = end.min((texel + 1) as f64) - start.max(texel as f64);
            (texel, overlap.max(0.0) / width)
        };
        covered.map(part).collect()
    };
    (0..to).map(share).collect()
}
