//! Reads pith and knots of a measured log from JSON.

use crate::geometry::spline::TrunkCurve;
use crate::value::{Branch, Thickness};
use glam::DVec3;

/// The formula of a knot; see `skeleton_from_file`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Knot {
    /// A and B: the angle of its diameter is `A + B r^(1/4)`.
    size: [f64; 2],
    /// C, D and E: its height is `C + D sqrt(r) + E r`.
    height: [f64; 3],
    /// F and G: its azimuth is `F + G ln(r)`.
    azimuth: [f64; 2],
    /// H: the distance from the pith at which it ends.
    end: f64,
}

impl Knot {
    /// The branch on `curve`; `None` for a knot that starts beyond its ends or has no thickness left.
    pub(crate) fn branch(&self, curve: &TrunkCurve) -> Option<Branch> {
        let ([a, b], [c, d, e], [f, g], r) = (self.size, self.height, self.azimuth, self.end);
        let [lowest, highest] = curve.heights();
        if !(lowest..=highest).contains(&c) || r <= 0.0 {
            return None;
        }
        let azimuth = f + g * libm::log(r);
        let outwards = DVec3::new(libm::cos(azimuth), libm::sin(azimuth), 0.0);
        let end = curve.at(c + d * r.sqrt() + e * r) + outwards * r;
        let chord = end - curve.at(c);
        let half_width = r * libm::tan(0.5 * (a + b * r.sqrt().sqrt()));
        let possible = half_width > 0.0 && half_width.is_finite();
        possible.then_some(Branch {
            height: c,
            direction: chord.try_normalize()?,
            thickness: Thickness::HalfWidth {
                distance: chord.length(),
                half_width,
            },
            length: Some(chord.length()),
        })
    }
}

/// The points of a pith, in mm.
pub(crate) fn pith(bytes: &[u8]) -> Result<Vec<DVec3>, String> {
    Ok(rows::<3>(bytes)?
        .into_iter()
        .map(DVec3::from_array)
        .collect())
}

/// The formulas of knots.
pub(crate) fn knots(bytes: &[u8]) -> Result<Vec<Knot>, String> {
    let knot = |[a, b, c, d, e, f, g, h, _]: [f64; 9]| Knot {
        size: [a, b],
        height: [c, d, e],
        azimuth: [f, g],
        end: h,
    };
    Ok(rows::<9>(bytes)?.into_iter().map(knot).collect())
}

/// A JSON list of rows of `N` numbers.
fn rows<const N: usize>(bytes: &[u8]) -> Result<Vec<[f64; N]>, String> {
    let rows: Vec<serde_json::Value> =
        serde_json::from_slice(bytes).map_err(|error| format!("expected a JSON list: {error}"))?;
    let row = |(index, row): (usize, &serde_json::Value)| {
        let place = |reason: String| format!("row {}: {reason}", index + 1);
        let numbers = row
            .as_array()
            .ok_or_else(|| place(format!("expected a list of {N} numbers")))?;
        let finite = |value: &serde_json::Value| {
            let number = value.as_f64().filter(|number| number.is_finite());
            number.ok_or_else(|| place(format!("expected a number, found {value}")))
        };
        let numbers: Vec<f64> = numbers.iter().map(finite).collect::<Result<_, _>>()?;
        let found = numbers.len();
        numbers
            .try_into()
            .map_err(|_| place(format!("expected {N} numbers, found {found}")))
    };
    rows.iter().enumerate().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::value::Tangents;

    #[test]
    fn what_is_wrong_with_a_file_is_told_with_its_row() {
        let told = |text: &str| pith(text.as_bytes()).unwrap_err();
        assert_eq!(
            told("[[0, 0, 0], [1, 2]]"),
            "row 2: expected 3 numbers, found 2"
        );
        assert_eq!(
            told("[[0, 0, 0], [1, null, 3]]"),
            "row 2: expected a number, found null"
        );
        assert_eq!(
            told("[[0, 0, 0], [1, \"2\", 3]]"),
            "row 2: expected a number, found \"2\""
        );
        assert_eq!(told("[7]"), "row 1: expected a list of 3 numbers");
        assert!(
            told("[[0, 0, NaN]]").starts_with("expected a JSON list: expected value at line 1")
        );
        assert!(told("[[0, 0, 1e999]]").starts_with("expected a JSON list: number out of range"));
        assert!(told("{}").starts_with("expected a JSON list: invalid type: map"));
        assert!(
            knots(b"[[1, 2, 3]]")
                .unwrap_err()
                .contains("expected 9 numbers, found 3")
        );
    }

    #[test]
    fn a_knot_becomes_the_chord_to_its_end() {
        // Horizontal at first: r = 16, azimuth 90 degrees, 4 * 2 + 16 / 2 mm up, 2 * 0.1 rad thick.
        let curve = TrunkCurve::through(
            &[DVec3::ZERO, DVec3::new(0.0, 0.0, 100.0)],
            Tangents::Natural,
        );
        let curve = curve.unwrap();
        let quarter = std::f64::consts::FRAC_PI_2;
        let knot = Knot {
            size: [0.1, 0.05],
            height: [10.0, 2.0, 0.5],
            azimuth: [quarter, 0.0],
            end: 16.0,
        };
        let branch = knot.branch(&curve).unwrap();
        assert_eq!(branch.height, 10.0);
        assert!(
            branch
                .direction
                .distance(DVec3::new(0.0, 1.0, 1.0).normalize())
                < 1e-15
        );
        let Thickness::HalfWidth {
            distance,
            half_width,
        } = branch.thickness
        else {
            panic!("expected a half width")
        };
        assert!((distance - 16.0 * 2f64.sqrt()).abs() < 1e-12);
        assert!((half_width - 16.0 * libm::tan(0.1)).abs() < 1e-12);
        let left_out = [
            Knot {
                size: [0.1, -0.05],
                ..knot
            },
            Knot {
                height: [-0.1, 2.0, 0.5],
                ..knot
            },
            Knot {
                height: [100.1, 2.0, 0.5],
                ..knot
            },
            Knot { end: 0.0, ..knot },
        ];
        assert!(left_out.iter().all(|knot| knot.branch(&curve).is_none()));
    }
}
