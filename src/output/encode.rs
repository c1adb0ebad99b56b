//! From columns of numbers to the interleaved samples of a map.

use super::srgb::{Srgb8, Srgb16};
use crate::colour::from_srgb;
use crate::value::{MapFormat, SampleType};
use half::f16;
use half::slice::HalfFloatSliceExt;
use std::ops::AddAssign;

/// What the samples of a map are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapKind {
    /// Red, green and blue, linear Rec. 709; whole samples hold them sRGB-encoded.
    Colour,
    /// One number.
    Number,
    /// Three parts of a vector, each from -1 to 1; whole samples hold 0.5 + 0.5 n.
    Normal,
}

impl MapKind {
    /// How many samples a pixel has.
    pub fn samples(self) -> usize {
        match self {
            MapKind::Colour | MapKind::Normal => 3,
            MapKind::Number => 1,
        }
    }

    /// The values that whole samples write as black and as white, unless a recipe says otherwise.
    pub fn range(self) -> [f64; 2] {
        match self {
            MapKind::Colour | MapKind::Number => [0.0, 1.0],
            MapKind::Normal => [-1.0, 1.0],
        }
    }
}

/// How many samples a format could not hold as they were.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Not a number, or infinite. Whole samples hold the first as black, the second as black or white;
    /// floats hold them as they are, with one bit pattern for all that are not a number.
    pub non_finite: u64,
    /// Finite, but more than half a step beyond black or white, or beyond the largest half float:
    /// written as the nearest that the format has.
    pub clamped: u64,
}

impl AddAssign for Faults {
    fn add_assign(&mut self, other: Faults) {
        self.non_finite += other.non_finite;
        self.clamped += other.clamped;
    }
}

/// Turns columns into samples: to the nearest step, ties to even, the same bytes on every machine.
#[derive(Clone, Copy, Debug)]
pub struct Encoder {
    samples: usize,
    sample_bytes: usize,
    conversion: Conversion,
    /// Finite values outside these are counted as clamped.
    limits: [f32; 2],
}

/// How one sample is made from one number.
#[derive(Clone, Copy, Debug)]
enum Conversion {
    Linear8(Scale),
    Linear16(Scale),
    Srgb8,
    Srgb16,
    ScaledSrgb8(Scale),
    ScaledSrgb16(Scale),
    Half,
    Float,
}

/// Maps black to 0 and white to the largest sample.
#[derive(Clone, Copy, Debug)]
struct Scale {
    black: f64,
    factor: f64,
    max: f64,
}

impl Scale {
    fn new([black, white]: [f64; 2], max: f64) -> Scale {
        let factor = max / (white - black);
        // A range without width is a step.
        Scale {
            black,
            factor: if factor.is_finite() { factor } else { f64::MAX },
            max,
        }
    }

    /// The scaled value from 0 to the largest sample; NaN is 0.
    #[inline]
    fn apply(self, value: f32) -> f64 {
        let scaled = (f64::from(value) - self.black) * self.factor;
        let scaled = if scaled > 0.0 { scaled } else { 0.0 };
        if scaled < self.max { scaled } else { self.max }
    }

    /// The nearest whole sample: adding 2^52 leaves no bits for a fraction, so the sum rounds.
    #[inline]
    fn round(self, value: f32) -> u32 {
        (self.apply(value) + (1u64 << 52) as f64).to_bits() as u32
    }

    /// The values that lie `margin` samples beyond the ends, lower one first.
    fn limits(self, margins: [f64; 2]) -> [f32; 2] {
        let value = |sample: f64| (self.black + sample / self.factor) as f32;
        let [low, high] = [value(-margins[0]), value(self.max + margins[1])];
        if low <= high {
            [low, high]
        } else {
            [high, low]
        }
    }
}

/// Pixels that are encoded together.
const BLOCK: usize = 1024;

/// The least magnitude that rounds to infinity as a half float.
const HALF_OVERFLOW: f32 = 65520.0;

impl Encoder {
    /// The encoder of maps of `kind` in `format`.
    ///
    /// `range` holds the values that whole samples write as black and as white instead of those of
    /// [`MapKind::range`]; the second may be less than the first. Floats hold values as they are.
    pub fn new(kind: MapKind, format: MapFormat, range: Option<[f64; 2]>) -> Encoder {
        let conversion = Conversion::new(kind, format, range.unwrap_or(kind.range()));
        Encoder {
            samples: kind.samples(),
            sample_bytes: format.sample_type().bytes(),
            conversion,
            limits: conversion.limits(),
        }
    }

    /// The bytes of one pixel.
    pub fn pixel_bytes(&self) -> usize {
        self.samples * self.sample_bytes
    }

    /// Writes the pixels of one run of a row: `columns` has one slice for each sample of a pixel, all
    /// of one length. Whole samples are big-endian, floats in the order of the machine.
    ///
    /// # Panics
    /// If the number or the lengths of the columns or of `bytes` do not fit.
    pub fn encode(&self, columns: &[&[f32]], bytes: &mut [u8]) -> Faults {
        assert_eq!(
            columns.len(),
            self.samples,
            "one column for each sample of a pixel"
        );
        let pixels = bytes.len() / self.pixel_bytes();
        assert_eq!(bytes.len(), pixels * self.pixel_bytes(), "whole pixels");
        assert!(
            columns.iter().all(|column| column.len() == pixels),
            "columns fill the bytes"
        );
        let mut faults = Faults::default();
        // Short blocks stay in the nearest cache between the two passes.
        for (index, bytes) in bytes.chunks_mut(BLOCK * self.pixel_bytes()).enumerate() {
            let start = index * BLOCK;
            let range = start..pixels.min(start + BLOCK);
            let mut block: [&[f32]; 3] = [&[]; 3];
            block
                .iter_mut()
                .zip(columns)
                .for_each(|(to, column)| *to = &column[range.clone()]);
            let block = &block[..self.samples];
            self.convert(block, bytes);
            block
                .iter()
                .for_each(|column| faults += count(column, self.limits));
        }
        faults
    }

    fn convert(&self, columns: &[&[f32]], bytes: &mut [u8]) {
        match self.conversion {
            Conversion::Linear8(scale) => fill(columns, bytes, |value| [scale.round(value) as u8]),
            Conversion::Linear16(scale) => {
                fill(columns, bytes, |value| {
                    (scale.round(value) as u16).to_be_bytes()
                });
            }
            Conversion::Srgb8 => {
                let table = Srgb8::get();
                fill(columns, bytes, |value| [table.code(value)]);
            }
            Conversion::Srgb16 => {
                let table = Srgb16::get();
                fill(columns, bytes, |value| table.code(value).to_be_bytes());
            }
            Conversion::ScaledSrgb8(scale) => {
                let table = Srgb8::get();
                fill(columns, bytes, |value| {
                    [table.code(scale.apply(value) as f32)]
                });
            }
            Conversion::ScaledSrgb16(scale) => {
                let table = Srgb16::get();
                fill(columns, bytes, |value| {
                    table.code(scale.apply(value) as f32).to_be_bytes()
                });
            }
            Conversion::Half => fill_halves(columns, bytes),
            Conversion::Float => fill(columns, bytes, |value| canonical(value).to_ne_bytes()),
        }
    }
}

impl Conversion {
    fn new(kind: MapKind, format: MapFormat, range: [f64; 2]) -> Conversion {
        let encoded = kind == MapKind::Colour;
        let plain = range == [0.0, 1.0];
        match format.sample_type() {
            SampleType::Whole8 if encoded && plain => Conversion::Srgb8,
            SampleType::Whole16 if encoded && plain => Conversion::Srgb16,
            SampleType::Whole8 if encoded => Conversion::ScaledSrgb8(Scale::new(range, 1.0)),
            SampleType::Whole16 if encoded => Conversion::ScaledSrgb16(Scale::new(range, 1.0)),
            SampleType::Whole8 => Conversion::Linear8(Scale::new(range, 255.0)),
            SampleType::Whole16 => Conversion::Linear16(Scale::new(range, 65535.0)),
            SampleType::Half => Conversion::Half,
            SampleType::Float => Conversion::Float,
        }
    }

    /// The least and the largest value that are not clamped.
    fn limits(self) -> [f32; 2] {
        // Half a step beyond black and white on the sRGB curve, which goes on past its ends.
        let encoded = |scale: Scale, max: f64| {
            scale.limits([-from_srgb(-0.5 / max), from_srgb(1.0 + 0.5 / max) - 1.0])
        };
        let plain = Scale::new([0.0, 1.0], 1.0);
        match self {
            Conversion::Linear8(scale) | Conversion::Linear16(scale) => scale.limits([0.5; 2]),
            Conversion::Srgb8 => encoded(plain, 255.0),
            Conversion::Srgb16 => encoded(plain, 65535.0),
            Conversion::ScaledSrgb8(scale) => encoded(scale, 255.0),
            Conversion::ScaledSrgb16(scale) => encoded(scale, 65535.0),
            Conversion::Half => [(-HALF_OVERFLOW).next_up(), HALF_OVERFLOW.next_down()],
            Conversion::Float => [f32::MIN, f32::MAX],
        }
    }
}

/// Counts what cannot be written as it is, in one block.
fn count(column: &[f32], [low, high]: [f32; 2]) -> Faults {
    // 32-bit counters fill vectors.
    let [mut non_finite, mut clamped] = [0u32; 2];
    for value in column {
        let finite = value.abs() <= f32::MAX;
        non_finite += u32::from(!finite);
        clamped += u32::from(finite & ((*value < low) | (*value > high)));
    }
    Faults {
        non_finite: non_finite.into(),
        clamped: clamped.into(),
    }
}

/// Writes each value of the columns as `B` bytes, the samples of a pixel side by side.
#[inline]
fn fill<const B: usize>(columns: &[&[f32]], bytes: &mut [u8], sample: impl Fn(f32) -> [u8; B]) {
    let samples = bytes.as_chunks_mut::<B>().0;
    match columns {
        [x, y, z] => {
            let pixels = samples.as_chunks_mut::<3>().0;
            for (((pixel, x), y), z) in pixels.iter_mut().zip(*x).zip(*y).zip(*z) {
                *pixel = [sample(*x), sample(*y), sample(*z)];
            }
        }
        [x] => samples
            .iter_mut()
            .zip(*x)
            .for_each(|(place, x)| *place = sample(*x)),
        _ => unreachable!("maps have one or three samples"),
    }
}

fn fill_halves(columns: &[&[f32]], bytes: &mut [u8]) {
    const PART: usize = 256;
    let samples = bytes.as_chunks_mut::<2>().0;
    for (offset, column) in columns.iter().enumerate() {
        let mut places = samples.iter_mut().skip(offset).step_by(columns.len());
        for block in column.chunks(PART) {
            let mut values = [0.0; PART];
            let mut halves = [f16::ZERO; PART];
            values
                .iter_mut()
                .zip(block)
                .for_each(|(to, value)| *to = within_half(*value));
            halves.convert_from_f32_slice(&values);
            for (half, place) in halves[..block.len()].iter().zip(&mut places) {
                *place = half.to_ne_bytes();
            }
        }
    }
}

/// Finite values stay finite as half floats.
#[inline]
fn within_half(value: f32) -> f32 {
    const MAX: f32 = 65504.0;
    if value.abs() <= f32::MAX {
        value.clamp(-MAX, MAX)
    } else {
        canonical(value)
    }
}

/// One bit pattern for all that is not a number: machines differ in the one they make.
#[inline]
fn canonical(value: f32) -> f32 {
    if value.is_nan() {
        f32::from_bits(0x7fc0_0000)
    } else {
        value
    }
}
