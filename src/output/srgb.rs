//! Rounding of linear values to sRGB codes: exact, by comparing with the limits between the codes.
//!
//! The codes are monotone in the value, so a code is known from two things: a guess that is off by at most
//! one, and the smallest value of every code. The guess reads the exponent and the first bits of the
//! mantissa as an index, as Giesen 2012 ("linear float to sRGB8") does; unlike there, the comparison makes the
//! result exact: the nearest code of the curve of IEC 61966-2-1.

use crate::colour::from_srgb;
use std::sync::LazyLock;

/// The smallest 32-bit float that rounds to `code` of `max`.
fn limit(code: usize, max: f64) -> f32 {
    let exact = from_srgb((code as f64 - 0.5) / max);
    let nearest = exact as f32;
    if f64::from(nearest) < exact {
        nearest.next_up()
    } else {
        nearest
    }
}

/// The limits of all codes up to `max`, between one that every value reaches and one that none does.
fn limits(max: usize) -> Vec<f32> {
    let inner = (1..=max).map(|code| limit(code, max as f64));
    std::iter::once(f32::NEG_INFINITY)
        .chain(inner)
        .chain([f32::INFINITY])
        .collect()
}

/// Positive floats up to 1 in buckets: `2^bits` to an octave, the first at `2^-octaves`.
struct Buckets {
    octaves: u32,
    bits: u32,
}

impl Buckets {
    /// How many there are; the last holds 1 alone.
    const fn count(&self) -> usize {
        ((self.octaves << self.bits) + 1) as usize
    }

    const fn first_bits(&self) -> u32 {
        1f32.to_bits() - (self.octaves << 23)
    }

    /// The smallest value of a bucket.
    const fn start(&self, bucket: usize) -> f32 {
        f32::from_bits(self.first_bits() + ((bucket as u32) << (23 - self.bits)))
    }

    /// The nearest value that lies in a bucket: NaN becomes the first.
    #[inline]
    const fn clamp(&self, value: f32) -> f32 {
        let low = self.start(0);
        let value = if value > low { value } else { low };
        if value < 1.0 { value } else { 1.0 }
    }

    /// The bucket of a clamped value.
    #[inline]
    const fn of(&self, value: f32) -> usize {
        ((value.to_bits() - self.first_bits()) >> (23 - self.bits)) as usize
    }
}

/// Linear values to 8-bit codes.
///
/// No bucket holds more than one limit. So the entry of a bucket is the code of its start, above the 16 bits
/// that a float has within the bucket, less the place of the limit: adding those bits carries into the code
/// from the limit on.
pub(super) struct Srgb8 {
    entries: [u32; Srgb8::BUCKETS.count()],
}

impl Srgb8 {
    const BUCKETS: Buckets = Buckets {
        octaves: 13,
        bits: 7,
    };
    /// Bits of a float within a bucket.
    const REST: u32 = 23 - Srgb8::BUCKETS.bits;

    /// The table.
    pub(super) fn get() -> &'static Srgb8 {
        static TABLE: LazyLock<Srgb8> = LazyLock::new(Srgb8::new);
        &TABLE
    }

    fn new() -> Srgb8 {
        let limits = limits(255);
        let entry = |bucket| {
            let start = Srgb8::BUCKETS.start(bucket);
            let code = limits.partition_point(|limit| *limit <= start) - 1;
            let place = limits[code + 1].to_bits() - start.to_bits();
            let size = 1 << Srgb8::REST;
            ((code as u32) << Srgb8::REST) + size - place.min(size)
        };
        Srgb8 {
            entries: std::array::from_fn(entry),
        }
    }

    /// The code nearest to the sRGB encoding of `linear`; what lies outside 0 to 1 is clamped, NaN is 0.
    #[inline]
    pub(super) fn code(&self, linear: f32) -> u8 {
        let linear = Srgb8::BUCKETS.clamp(linear);
        let rest = linear.to_bits() & ((1 << Srgb8::REST) - 1);
        ((self.entries[Srgb8::BUCKETS.of(linear)] + rest) >> Srgb8::REST) as u8
    }
}

/// Linear values to 16-bit codes.
pub(super) struct Srgb16 {
    limits: Vec<f32>,
    /// For each bucket offset and slope of the line through the curve at its ends.
    lines: Vec<[f32; 2]>,
}

impl Srgb16 {
    const BUCKETS: Buckets = Buckets {
        octaves: 21,
        bits: 7,
    };

    /// The table.
    pub(super) fn get() -> &'static Srgb16 {
        static TABLE: LazyLock<Srgb16> = LazyLock::new(Srgb16::new);
        &TABLE
    }

    fn new() -> Srgb16 {
        let limits = limits(65535);
        let lines = (0..Srgb16::BUCKETS.count()).map(|bucket| {
            let [start, end] = [bucket, bucket + 1].map(|at| f64::from(Srgb16::BUCKETS.start(at)));
            let [low, high] = [start, end].map(|at| crate::colour::to_srgb(at) * 65535.0);
            let slope = (high - low) / (end - start);
            [(low - slope * start) as f32, slope as f32]
        });
        Srgb16 {
            limits,
            lines: lines.collect(),
        }
    }

    /// The code nearest to the sRGB encoding of `linear`; what lies outside 0 to 1 is clamped, NaN is 0.
    #[inline]
    pub(super) fn code(&self, linear: f32) -> u16 {
        let linear = Srgb16::BUCKETS.clamp(linear);
        let [offset, slope] = self.lines[Srgb16::BUCKETS.of(linear)];
        let guess = (offset + slope * linear) as u16;
        let above = u16::from(linear >= self.limits[usize::from(guess) + 1]);
        let below = u16::from(linear < self.limits[usize::from(guess)]);
        guess + above - below
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::to_srgb;

    /// What the tables must give, straight from the curve.
    fn nearest(linear: f32, max: f64) -> u32 {
        let linear = f64::from(linear).clamp(0.0, 1.0);
        (to_srgb(linear) * max + 0.5).floor() as u32
    }

    #[test]
    fn every_limit_of_8_bits_is_the_first_value_of_its_code() {
        for code in 1..=255u8 {
            let first = limit(code.into(), 255.0);
            assert_eq!(nearest(first, 255.0), u32::from(code));
            assert_eq!(nearest(first.next_down(), 255.0), u32::from(code) - 1);
            assert_eq!(Srgb8::get().code(first), code);
            assert_eq!(Srgb8::get().code(first.next_down()), code - 1);
        }
    }

    #[test]
    fn every_limit_of_16_bits_is_the_first_value_of_its_code() {
        for code in 1..=65535u16 {
            let first = Srgb16::get().limits[usize::from(code)];
            assert_eq!(nearest(first, 65535.0), u32::from(code));
            assert_eq!(nearest(first.next_down(), 65535.0), u32::from(code) - 1);
            assert_eq!(Srgb16::get().code(first), code);
            assert_eq!(Srgb16::get().code(first.next_down()), code - 1);
        }
    }

    #[test]
    fn floats_all_over_the_range_get_the_nearest_code() {
        for step in 0..=(1f32.to_bits() / 1009) {
            let linear = f32::from_bits(step * 1009);
            assert_eq!(u32::from(Srgb8::get().code(linear)), nearest(linear, 255.0));
            assert_eq!(
                u32::from(Srgb16::get().code(linear)),
                nearest(linear, 65535.0)
            );
        }
    }

    #[test]
    fn what_lies_outside_is_clamped() {
        let cases = [
            f32::NAN,
            -f32::NAN,
            f32::NEG_INFINITY,
            -1.0,
            -0.0,
            0.0,
            f32::MIN_POSITIVE,
        ];
        for linear in cases {
            assert_eq!(
                (Srgb8::get().code(linear), Srgb16::get().code(linear)),
                (0, 0),
                "{linear}"
            );
        }
        for linear in [1.0, 1.0f32.next_up(), 2.0, f32::MAX, f32::INFINITY] {
            assert_eq!(
                (Srgb8::get().code(linear), Srgb16::get().code(linear)),
                (255, 65535)
            );
        }
    }
}
