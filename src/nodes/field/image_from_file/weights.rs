//! Weights of pixels along one axis: what a span sees of an interpolated row.
//!
//! A row is the sum of its pixels, each times a kernel around its centre, and a span sees the mean of that: the
//! difference of the kernel's antiderivative at its ends. The weights of all pixels add up to 1.

/// How a row is interpolated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Interpolation {
    /// Every point shows the nearest pixel.
    Nearest,
    /// Straight from centre to centre.
    Linear,
    /// Keys 1981 with a = -1/2 (Catmull-Rom): smooth, through all centres.
    Cubic,
}

impl Interpolation {
    /// The names that recipes use.
    pub(super) const NAMES: &'static [&'static str] = &["nearest", "linear", "cubic"];

    /// The interpolation called `name`.
    pub(super) fn from_name(name: &str) -> Interpolation {
        match name {
            "nearest" => Interpolation::Nearest,
            "cubic" => Interpolation::Cubic,
            _ => Interpolation::Linear,
        }
    }

    /// How far from its centre a pixel counts.
    fn radius(self) -> f64 {
        match self {
            Interpolation::Nearest => 0.5,
            Interpolation::Linear => 1.0,
            Interpolation::Cubic => 2.0,
        }
    }

    /// Most pixels of a row that a point sees.
    pub(super) fn taps(self) -> usize {
        match self {
            Interpolation::Nearest => 1,
            Interpolation::Linear => 2,
            Interpolation::Cubic => 4,
        }
    }

    /// The kernel at the distance `x` from the centre.
    fn at(self, x: f64) -> f64 {
        let d = x.abs();
        match self {
            Interpolation::Nearest if (-0.5..0.5).contains(&x) => 1.0,
            Interpolation::Linear if d < 1.0 => 1.0 - d,
            Interpolation::Cubic if d < 1.0 => 1.0 + d * d * (1.5 * d - 2.5),
            Interpolation::Cubic if d < 2.0 => 2.0 + d * (-4.0 + d * (2.5 - 0.5 * d)),
            _ => 0.0,
        }
    }

    /// The integral of the kernel from its centre to `x`; half of 1 at its end.
    fn integral(self, x: f64) -> f64 {
        let d = x.abs().min(self.radius());
        let half = match self {
            Interpolation::Nearest => d,
            Interpolation::Linear => d - 0.5 * d * d,
            Interpolation::Cubic if d < 1.0 => d + d * d * d * (0.375 * d - 2.5 / 3.0),
            Interpolation::Cubic => {
                let up_to = |d: f64| d * (2.0 + d * (-2.0 + d * (2.5 / 3.0 - 0.125 * d)));
                // 13/24 lie within the first pixel.
                13.0 / 24.0 + up_to(d) - up_to(1.0)
            }
        };
        half.copysign(x)
    }
}

/// What is beyond the sides of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wrap {
    /// The picture again.
    Repeat,
    /// The picture again, mirrored.
    Mirror,
    /// Its outermost pixels.
    Clamp,
    /// Nothing.
    Blank,
}

impl Wrap {
    /// The names that recipes use.
    pub(super) const NAMES: &'static [&'static str] = &["repeat", "mirror", "clamp", "blank"];

    /// The rule called `name`.
    pub(super) fn from_name(name: &str) -> Wrap {
        match name {
            "mirror" => Wrap::Mirror,
            "clamp" => Wrap::Clamp,
            "blank" => Wrap::Blank,
            _ => Wrap::Repeat,
        }
    }

    /// Which of `count` pixels stands at `index`.
    #[inline]
    pub(super) fn index(self, index: i64, count: usize) -> Option<usize> {
        let last = count as i64 - 1;
        match (0..=last).contains(&index) {
            true => Some(index as usize),
            false => self.beyond(index, last),
        }
    }

    /// The same for an index that is none of 0 to `last`.
    #[inline(never)]
    fn beyond(self, index: i64, last: i64) -> Option<usize> {
        let wrapped = match self {
            Wrap::Repeat => index.rem_euclid(last + 1),
            Wrap::Mirror => {
                let folded = index.rem_euclid(2 * (last + 1));
                folded.min(2 * last + 1 - folded)
            }
            Wrap::Clamp => index.clamp(0, last),
            Wrap::Blank => return None,
        };
        usize::try_from(wrapped).ok()
    }
}

/// Spans shorter than this part of a pixel are points.
const POINT: f64 = 1e-3;

/// Writes pixels and weights of the span of `width` around `middle`, both in pixels.
pub(super) fn write(
    into: &mut Vec<(Option<usize>, f32)>,
    [middle, width]: [f64; 2],
    interpolation: Interpolation,
    wrap: Wrap,
    count: usize,
) {
    into.clear();
    let reach = 0.5 * width + interpolation.radius() - 0.5;
    let (first, last) = (floor(middle - reach), floor(middle + reach));
    for index in first..=last {
        let away = middle - (index as f64 + 0.5);
        let weight = match width < POINT {
            true => interpolation.at(away),
            false => {
                let ends = [away + 0.5 * width, away - 0.5 * width];
                (interpolation.integral(ends[0]) - interpolation.integral(ends[1])) / width
            }
        };
        if weight == 0.0 {
            continue;
        }
        let found = wrap.index(index, count);
        match into.last_mut() {
            Some((last, sum)) if *last == found => *sum += weight as f32,
            _ => into.push((found, weight as f32)),
        }
    }
}

/// The largest whole number that is not above `value`, which an i64 can hold.
#[inline]
pub(super) fn floor(value: f64) -> i64 {
    let whole = value as i64;
    whole - i64::from(whole as f64 > value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_add_up_and_are_those_of_the_kernel() {
        let kinds = [
            Interpolation::Nearest,
            Interpolation::Linear,
            Interpolation::Cubic,
        ];
        for interpolation in kinds {
            for (middle, width) in [(3.3, 0.0), (3.3, 0.4), (-7.9, 5.5), (100.5, 63.0)] {
                let mut weights = vec![];
                write(
                    &mut weights,
                    [middle, width],
                    interpolation,
                    Wrap::Repeat,
                    7,
                );
                let sum: f32 = weights.iter().map(|(_, weight)| weight).sum();
                assert!(
                    (sum - 1.0).abs() < 1e-5,
                    "{interpolation:?} {middle} {width}: {sum}"
                );
            }
            // The antiderivative's slope is the kernel.
            for x in [-1.7, -0.3, 0.2, 0.7, 1.2, 1.9] {
                let slope =
                    (interpolation.integral(x + 1e-6) - interpolation.integral(x - 1e-6)) / 2e-6;
                assert!(
                    (slope - interpolation.at(x)).abs() < 1e-6,
                    "{interpolation:?} at {x}"
                );
            }
        }
    }

    #[test]
    fn wraps_go_on_as_they_say() {
        let along = |wrap: Wrap| {
            (-4..7)
                .map(|index| wrap.index(index, 3))
                .collect::<Vec<_>>()
        };
        let some = |indices: [usize; 11]| indices.map(Some).to_vec();
        assert_eq!(along(Wrap::Repeat), some([2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0]));
        assert_eq!(along(Wrap::Mirror), some([2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]));
        assert_eq!(along(Wrap::Clamp), some([0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]));
        assert_eq!(
            along(Wrap::Blank)[3..8],
            [None, Some(0), Some(1), Some(2), None]
        );
    }
}
