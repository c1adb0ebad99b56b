//! Units of arithmetic: what products, sums and roots of numbers are measured in.

use crate::value::Unit;
use std::fmt;

/// The base units, in the order of the exponents.
const BASES: [&str; 4] = ["mm", "year", "px", "degree"];

/// Whether a number has met a unit on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Origin {
    /// Written numbers only: they take the unit of what they are added to.
    Written,
    /// Plain parameters or links, and no unit anywhere.
    Plain,
    /// A unit took part, even if it has cancelled out.
    Measured,
}

/// What a part of an expression is measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Quantity {
    /// Of [`BASES`]; halves of halves from square roots are exact.
    exponents: [f64; 4],
    origin: Origin,
}

impl Quantity {
    /// A written number.
    pub(super) const WRITTEN: Quantity = Quantity {
        exponents: [0.0; 4],
        origin: Origin::Written,
    };

    /// A parameter or a link.
    pub(super) fn of(unit: Unit) -> Quantity {
        let exponents = exponents(unit);
        let origin = if exponents == [0.0; 4] {
            Origin::Plain
        } else {
            Origin::Measured
        };
        Quantity { exponents, origin }
    }

    /// Of a product.
    pub(super) fn times(self, other: Quantity) -> Quantity {
        self.with(other, 1.0)
    }

    /// Of a quotient.
    pub(super) fn over(self, other: Quantity) -> Quantity {
        self.with(other, -1.0)
    }

    fn with(self, other: Quantity, sign: f64) -> Quantity {
        let exponent = |base: usize| self.exponents[base] + sign * other.exponents[base];
        Quantity {
            exponents: std::array::from_fn(exponent),
            origin: self.origin.max(other.origin),
        }
    }

    /// Of a square root.
    pub(super) fn root(self) -> Quantity {
        Quantity {
            exponents: self.exponents.map(|exponent| exponent / 2.0),
            ..self
        }
    }

    /// Of a sum, a difference or the larger of two; `None` if the units differ.
    pub(super) fn and(self, other: Quantity) -> Option<Quantity> {
        match (self.origin, other.origin) {
            (Origin::Written, _) => Some(other),
            (_, Origin::Written) => Some(self),
            (origin, others) => (self.exponents == other.exponents).then(|| Quantity {
                origin: origin.max(others),
                ..self
            }),
        }
    }

    /// Whether the whole of an expression fits an input: its unit, or no unit anywhere in it.
    pub(super) fn fits(self, unit: Unit) -> bool {
        self.origin < Origin::Measured || self.exponents == exponents(unit)
    }

    /// Whether it is a plain number, or can be one.
    pub(super) fn is_plain(self) -> bool {
        self.exponents == [0.0; 4]
    }

    /// What a message says of a number of it, where it is not the first.
    pub(super) fn counted(self) -> String {
        match self.is_plain() {
            true => "a plain number".to_owned(),
            false => format!("one in {self}"),
        }
    }

    /// What a message says of it.
    pub(super) fn described(self) -> String {
        match self.is_plain() {
            true => "a plain number".to_owned(),
            false => format!("in {self}"),
        }
    }
}

/// As in `mm/year`, `1/year`, `mm^2`.
impl fmt::Display for Quantity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let powers = |sign: f64| {
            let powers = BASES.iter().zip(self.exponents);
            let of_sign = powers.filter(move |(_, exponent)| exponent * sign > 0.0);
            let written = of_sign.map(|(base, exponent)| match exponent.abs() {
                1.0 => (*base).to_owned(),
                power => format!("{base}^{power}"),
            });
            written.collect::<Vec<_>>()
        };
        let (above, below) = (powers(1.0), powers(-1.0));
        let above = if above.is_empty() {
            "1".to_owned()
        } else {
            above.join(" ")
        };
        match below.as_slice() {
            [] => formatter.write_str(&above),
            below => write!(formatter, "{above}/{}", below.join("/")),
        }
    }
}

fn exponents(unit: Unit) -> [f64; 4] {
    match unit {
        Unit::One => [0.0; 4],
        Unit::Millimetre => [1.0, 0.0, 0.0, 0.0],
        Unit::Year => [0.0, 1.0, 0.0, 0.0],
        Unit::MillimetrePerYear => [1.0, -1.0, 0.0, 0.0],
        Unit::Degree => [0.0, 0.0, 0.0, 1.0],
        Unit::Pixel => [0.0, 0.0, 1.0, 0.0],
        Unit::PixelPerMillimetre => [-1.0, 0.0, 1.0, 0.0],
    }
}

/// The unit behind a written number, and the bytes up to its end: `mm`, or `mm/year` without spaces.
pub(in crate::graph) fn written_unit(rest: &str) -> Option<(Unit, usize)> {
    let trimmed = rest.trim_start();
    let belongs = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '.';
    let found = Unit::ALL.into_iter().filter(|unit| {
        let behind = trimmed.strip_prefix(unit.symbol());
        *unit != Unit::One && behind.is_some_and(|behind| !behind.starts_with(belongs))
    });
    // Of `mm` and `mm/year` the longer one is meant.
    let unit = found.max_by_key(|unit| unit.symbol().len())?;
    Some((unit, rest.len() - trimmed.len() + unit.symbol().len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_is_written_as_its_unit() {
        for unit in Unit::ALL {
            assert_eq!(Quantity::of(unit).to_string(), unit.symbol());
        }
    }

    #[test]
    fn units_multiply_and_divide() {
        let [mm, year, rate] =
            [Unit::Millimetre, Unit::Year, Unit::MillimetrePerYear].map(Quantity::of);
        assert!(mm.over(rate).fits(Unit::Year));
        assert!(rate.times(year).fits(Unit::Millimetre));
        assert!(mm.times(mm).root().fits(Unit::Millimetre));
        assert_eq!(
            mm.root().over(year.times(year)).to_string(),
            "mm^0.5/year^2"
        );
        assert_eq!(Quantity::WRITTEN.over(rate).to_string(), "year/mm");
    }

    #[test]
    fn a_unit_that_has_cancelled_out_leaves_a_plain_number() {
        let mm = Quantity::of(Unit::Millimetre);
        let ratio = mm.over(mm);
        assert!(ratio.fits(Unit::One) && !ratio.fits(Unit::Millimetre));
        assert!(Quantity::of(Unit::One).fits(Unit::Millimetre));
    }

    #[test]
    fn only_written_numbers_take_the_unit_of_the_other_side() {
        let [mm, year, plain] = [Unit::Millimetre, Unit::Year, Unit::One].map(Quantity::of);
        assert_eq!(mm.and(Quantity::WRITTEN), Some(mm));
        assert_eq!(Quantity::WRITTEN.and(mm), Some(mm));
        assert_eq!(mm.and(mm), Some(mm));
        assert_eq!(mm.and(year), None);
        assert_eq!(mm.and(plain), None);
    }

    #[test]
    fn numbers_may_have_a_unit_behind_them() {
        assert_eq!(written_unit(" mm + x"), Some((Unit::Millimetre, 3)));
        assert_eq!(written_unit("mm/year"), Some((Unit::MillimetrePerYear, 7)));
        assert_eq!(written_unit(" mm / year"), Some((Unit::Millimetre, 3)));
        assert_eq!(written_unit(" px/mmx"), Some((Unit::Pixel, 3)));
        for other in ["", " * mm", " mmm", " mm.x", " 1", "metre"] {
            assert_eq!(written_unit(other), None, "{other}");
        }
    }
}
