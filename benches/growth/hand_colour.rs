//! Colours by hand: the spread from neighbours, the box filter by integrals of the table, sRGB.

use super::hand::{ROW, Rows, Tree};
use super::scene::SIZE;
use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x4};
use fearless_simd_macros::simd;
use std::hint::black_box;
use yosegi::value::ColourPattern;

/// The table of one year, interpolated between texel centres: half a texel a piece.
pub(crate) struct Table {
    pieces: Vec<Piece>,
    year: [f64; 4],
}

/// `integral + g (value + slope g)` up to the distance g from the start of the piece.
#[repr(align(32))]
struct Piece {
    value: [f64; 4],
    slope: [f64; 4],
    integral: [f64; 4],
}

impl Table {
    pub(crate) fn new(pattern: &ColourPattern) -> Table {
        let last = pattern.colours.len() - 1;
        let colour = |texel: usize, part: usize| f64::from(pattern.colours[texel.min(last)][part]);
        let border = |piece: usize, part: usize| {
            let (texel, before) = (piece / 2, (piece / 2).max(1) - 1);
            match piece % 2 {
                0 => 0.5 * (colour(before, part) + colour(texel, part)),
                _ => colour(texel, part),
            }
        };
        let (mut integral, mut pieces) = ([0.0; 4], vec![]);
        for index in 0..2 * pattern.colours.len() {
            let mut piece = Piece {
                value: [0.0; 4],
                slope: [0.0; 4],
                integral,
            };
            for (part, integral) in integral[..3].iter_mut().enumerate() {
                piece.value[part] = border(index, part);
                piece.slope[part] = 0.5 * (border(index + 1, part) - piece.value[part]);
                *integral += piece.value[part] + piece.slope[part];
            }
            pieces.push(piece);
        }
        Table {
            pieces,
            year: integral,
        }
    }

    #[inline(always)]
    fn integral<S: Simd>(&self, simd: S, piece: i32, along: f32) -> f64x4<S> {
        let (piece, along) = (&self.pieces[piece as usize], f64::from(along));
        let mean = f64x4::load_array_ref(simd, &piece.slope) * along
            + f64x4::load_array_ref(simd, &piece.value);
        mean * along + f64x4::load_array_ref(simd, &piece.integral)
    }
}

/// Codes of sRGB by the first 16 bits of a float up to 1.
pub(crate) fn srgb() -> Vec<u8> {
    let code = |index: u32| {
        let linear = f64::from(f32::from_bits((index << 16) + (1 << 15)));
        let encoded = if linear <= 0.003_130_8 {
            12.92 * linear
        } else {
            1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
        };
        (255.0 * encoded + 0.5).min(255.0) as u8
    };
    (0..=1f32.to_bits() >> 16).map(code).collect()
}

/// Which boxes stand for a square sample.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Filter {
    /// One box of the same variance.
    OneBox,
    /// Two boxes where the smaller spread counts, as the library has it.
    TwoBoxes,
}

/// Ends of the boxes of a row: for each box its ends' pieces and the distances from their starts.
struct Ends {
    piece: [Vec<i32>; 4],
    along: [Vec<f32>; 4],
    periods: Vec<f32>,
    scale: Vec<f32>,
}

/// Colours of the whole picture; as bytes if there is a table of codes.
pub(crate) fn colours(
    tree: &Tree,
    table: &Table,
    level: Level,
    filter: Filter,
    codes: Option<&[u8]>,
) {
    let row = || vec![0.0; ROW];
    let (mut rows, mut times) = (Rows::new(ROW), [row(), row(), row()]);
    let mut ends = Ends {
        piece: std::array::from_fn(|_| vec![0; SIZE as usize]),
        along: std::array::from_fn(|_| vec![0.0; SIZE as usize]),
        periods: row(),
        scale: row(),
    };
    let mut colours = vec![[0.0; 4]; SIZE as usize];
    let mut bytes = vec![0; 3 * SIZE as usize];
    for y in 0..SIZE + 2 {
        times.rotate_left(1);
        tree.write_row(level, -0.5, f64::from(y) - 0.5, &mut rows, &mut times[2]);
        if y < 2 {
            continue;
        }
        dispatch!(level, simd => place(simd, &times, filter, table.pieces.len() as f32, &mut ends));
        if filter == Filter::OneBox {
            dispatch!(level, simd => mean::<_, false>(simd, table, &ends, &mut colours));
        } else {
            dispatch!(level, simd => mean::<_, true>(simd, table, &ends, &mut colours));
        }
        if let Some(codes) = codes {
            encode(codes, &colours, &mut bytes);
        }
        black_box((&colours, &bytes));
    }
}

#[simd]
fn place<S: Simd>(simd: S, times: &[Vec<f32>; 3], filter: Filter, pieces: f32, ends: &mut Ends) {
    let (lanes, [above, here, below]) = (S::f32s::LEN, times);
    for at in (0..SIZE as usize).step_by(lanes) {
        let across = (S::f32s::from_slice(simd, &here[at + 2..at + 2 + lanes])
            - S::f32s::from_slice(simd, &here[at..at + lanes]))
            * 0.5;
        let along = (S::f32s::from_slice(simd, &below[at + 1..at + 1 + lanes])
            - S::f32s::from_slice(simd, &above[at + 1..at + 1 + lanes]))
            * 0.5;
        let time = S::f32s::from_slice(simd, &here[at + 1..at + 1 + lanes]);
        let place = (time - floor::<S>(time)) * pieces;
        let (across, along) = (across.abs(), along.abs());
        let large = across.simd_gt(along).select(across, along);
        let small = across.simd_gt(along).select(along, across);
        let both = (across * across + along * along).sqrt();
        let skewed = small.simd_gt(large * 0.2);
        let two = filter == Filter::TwoBoxes;
        let width = if two {
            skewed.select(large, both)
        } else {
            both
        };
        let half = (width * (0.5 * pieces)).max(1e-4);
        let apart = skewed.select(small * (0.288_675_13 * pieces), S::f32s::splat(simd, 0.0));
        let first = if two { place - apart } else { place };
        let mut periods = store(simd, ends, 1, first + half, pieces, at)
            - store(simd, ends, 0, first - half, pieces, at);
        if two {
            let second = place + apart;
            periods += store(simd, ends, 3, second + half, pieces, at)
                - store(simd, ends, 2, second - half, pieces, at);
        }
        periods.store_slice(&mut ends.periods[at..at + lanes]);
        let scale = S::f32s::splat(simd, if two { 0.25 } else { 0.5 }) / half;
        scale.store_slice(&mut ends.scale[at..at + lanes]);
    }
}

#[inline(always)]
fn store<S: Simd>(
    simd: S,
    ends: &mut Ends,
    end: usize,
    place: S::f32s,
    pieces: f32,
    at: usize,
) -> S::f32s {
    let _ = simd;
    let whole = floor::<S>(place);
    let periods = floor::<S>((whole + 0.5) * (1.0 / pieces));
    let piece = (whole - periods * pieces).to_int::<S::i32s>();
    piece.store_slice(&mut ends.piece[end][at..at + S::f32s::LEN]);
    (place - whole).store_slice(&mut ends.along[end][at..at + S::f32s::LEN]);
    periods
}

/// By adding and taking away 1.5 * 2^23, for machines without an instruction for it.
#[inline(always)]
fn floor<S: Simd>(x: S::f32s) -> S::f32s {
    let nearest = (x + 12_582_912.0) - 12_582_912.0;
    nearest.simd_gt(x).select(nearest - 1.0, nearest)
}

#[simd]
fn mean<S: Simd, const TWO: bool>(simd: S, table: &Table, ends: &Ends, colours: &mut [[f32; 4]]) {
    for (pair, colours) in colours.as_chunks_mut::<2>().0.iter_mut().enumerate() {
        let first = mean_of::<S, TWO>(simd, table, ends, 2 * pair);
        let second = mean_of::<S, TWO>(simd, table, ends, 2 * pair + 1);
        first.narrow(second).store_slice(colours.as_flattened_mut());
    }
}

#[inline(always)]
fn mean_of<S: Simd, const TWO: bool>(
    simd: S,
    table: &Table,
    ends: &Ends,
    index: usize,
) -> f64x4<S> {
    let Ends { piece, along, .. } = ends;
    let mut sum = table.integral(simd, piece[1][index], along[1][index])
        - table.integral(simd, piece[0][index], along[0][index]);
    if TWO {
        sum += table.integral(simd, piece[3][index], along[3][index])
            - table.integral(simd, piece[2][index], along[2][index]);
    }
    let periods = f64::from(ends.periods[index]);
    (sum + f64x4::load_array_ref(simd, &table.year) * periods) * f64::from(ends.scale[index])
}

fn encode(codes: &[u8], colours: &[[f32; 4]], bytes: &mut [u8]) {
    for (colour, pixel) in colours.iter().zip(bytes.as_chunks_mut::<3>().0) {
        for part in 0..3 {
            let linear = colour[part].clamp(0.0, 1.0);
            pixel[part] = codes[(linear.to_bits() >> 16) as usize];
        }
    }
}
