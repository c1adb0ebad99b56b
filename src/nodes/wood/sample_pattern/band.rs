//! The band: a line through a photograph with a width, and the colours along it.

use super::photograph::{Photograph, Point};
use super::{MAX_TEXELS, rings};
use crate::node::{Build, Failure, Inputs};

/// The line through the photograph, with its width.
pub(super) struct Band {
    from: Point,
    /// Unit vector along the line.
    along: Point,
    length: f64,
    /// Half the width of the band.
    half: f64,
}

impl Band {
    /// The band that the inputs describe.
    ///
    /// # Errors
    /// A line without an end or without length, and a band that leaves the picture.
    pub(super) fn read(inputs: &Inputs<'_>, photograph: &Photograph) -> Result<Band, Failure> {
        let [width, height] = photograph.size();
        let (from, to, default_band) = match (inputs.get("from"), inputs.get("to")) {
            (Some(_), Some(_)) => (inputs.pair("from"), inputs.pair("to"), 1.0),
            (None, None) => ([0.0, 0.5 * height], [width, 0.5 * height], height),
            (Some(_), None) => return Err(Failure::of_input("from", "`from` needs `to`")),
            (None, Some(_)) => return Err(Failure::of_input("to", "`to` needs `from`")),
        };
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        let length = (x * x + y * y).sqrt();
        if length < 1e-6 {
            return Err(Failure::of_input(
                "to",
                "the line has no length: `from` and `to` are one point",
            ));
        }
        let given = inputs.get("band").map(|_| inputs.number("band"));
        let half = 0.5 * given.unwrap_or(default_band);
        let band = Band {
            from,
            along: [x / length, y / length],
            length,
            half,
        };
        for corner in band.corners(0.0, length) {
            let outside =
                |axis: usize| corner[axis] < -1e-6 || corner[axis] > [width, height][axis] + 1e-6;
            if outside(0) || outside(1) {
                let [x, y] = corner.map(|part| (part * 100.0).round() / 100.0);
                let message = format!(
                    "the band reaches ({x}, {y}), outside of the picture of {width} x {height} pixels"
                );
                let blame = if given.is_some() { "band" } else { "to" };
                return Err(Failure::of_input(blame, message));
            }
        }
        Ok(band)
    }

    /// The corners of the part of the band between two distances from its start.
    fn corners(&self, start: f64, end: f64) -> [Point; 4] {
        let [x, y] = self.along;
        let corner = |along: f64, across: f64| {
            [
                self.from[0] + along * x - across * y,
                self.from[1] + along * y + across * x,
            ]
        };
        [(start, -1.0), (end, -1.0), (end, 1.0), (start, 1.0)]
            .map(|(along, side)| corner(along, side * self.half))
    }

    /// One texel for each pixel; with equal rings as many for each of them as are needed.
    pub(super) fn texels(&self, equal_rings: Option<usize>) -> usize {
        let rings = equal_rings.unwrap_or(1);
        // A length that rounding has put just above a whole number is that number.
        let for_each = (self.length / rings as f64 - 1e-6).ceil().max(1.0) as usize;
        (rings * for_each.min(MAX_TEXELS / rings)).max(2)
    }

    /// The mean colours between the borders that `border` gives, from 0 to 1 along the line.
    pub(super) fn colours(
        &self,
        photograph: &Photograph,
        texels: usize,
        border: impl Fn(usize) -> f64,
        build: &Build<'_>,
    ) -> Result<Vec<[f64; 3]>, Failure> {
        let colour = |texel: usize| {
            let [start, end] = [texel, texel + 1].map(|texel| border(texel) * self.length);
            let corners = self.corners(start, end);
            photograph.sum(corners, build)?.mean().ok_or_else(|| {
                let [x, y] = corners[0].map(f64::round);
                Failure::of_input(
                    "file",
                    format!("the picture is transparent at ({x}, {y}), under the band"),
                )
            })
        };
        (0..texels).map(colour).collect()
    }

    /// Where rings start, from 0 to 1 along the line.
    pub(super) fn rings(
        &self,
        photograph: &Photograph,
        rings: usize,
        build: &Build<'_>,
    ) -> Result<Vec<f64>, Failure> {
        let pixels = self.texels(None);
        let border = |texel: usize| texel as f64 / pixels as f64;
        let profile = self.colours(photograph, pixels, border, build)?;
        let starts = rings::starts(&profile, rings).map_err(|found| {
            let message =
                format!("expected {rings} rings along the line, found {found} by their edges");
            let hint =
                "give the number that the line crosses, or leave `rings` out for equal rings";
            Failure::of_input("rings", message).with_hint(hint)
        })?;
        Ok(starts
            .into_iter()
            .map(|start| start / pixels as f64)
            .collect())
    }
}
