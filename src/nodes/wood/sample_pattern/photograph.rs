//! Photographs: files decoded within limits, read as exact means over areas in linear light.

use crate::colour;
use crate::node::{Build, Failure};
use crate::nodes::picture::{self, Format};
use image::{DynamicImage, Rgba};

/// A point in pixels: x to the right, y down, (0.5, 0.5) is the centre of the first pixel.
pub(super) type Point = [f64; 2];

/// A decoded photograph.
pub(super) struct Photograph {
    pixels: Pixels,
    /// The linear value of every code.
    linear: Vec<f32>,
}

enum Pixels {
    Eight(image::RgbaImage),
    Sixteen(image::ImageBuffer<Rgba<u16>, Vec<u16>>),
}

/// Sums over an area of a photograph.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    /// Linear colours times area and opacity.
    colour: [f64; 3],
    /// Area times opacity.
    weight: f64,
}

impl Photograph {
    /// Decodes a PNG, JPEG or BMP file. Values are taken as sRGB, whatever profile the file has, and
    /// pixels as they are stored, whatever orientation it notes.
    ///
    /// # Errors
    /// Other formats, broken files, and pictures over the limits.
    pub(super) fn decode(bytes: &[u8]) -> Result<Photograph, Failure> {
        let format = Format::of(bytes).filter(|format| *format != Format::Exr);
        let Some(format) = format else {
            let message = "expected a PNG, JPEG or BMP picture, found another kind of file";
            return Err(Failure::of_input("file", message));
        };
        picture::head(bytes, format)?;
        let decoded = picture::decode(bytes, format)?;
        let codes: u32 = if sixteen_bits(&decoded) { 65_535 } else { 255 };
        let linear = |code| colour::from_srgb(f64::from(code) / f64::from(codes)) as f32;
        let pixels = match decoded {
            picture if codes == 255 => Pixels::Eight(picture.into_rgba8()),
            picture => Pixels::Sixteen(picture.into_rgba16()),
        };
        Ok(Photograph {
            pixels,
            linear: (0..=codes).map(linear).collect(),
        })
    }

    /// Width and height in pixels.
    pub(super) fn size(&self) -> [f64; 2] {
        let (width, height) = match &self.pixels {
            Pixels::Eight(picture) => picture.dimensions(),
            Pixels::Sixteen(picture) => picture.dimensions(),
        };
        [f64::from(width), f64::from(height)]
    }

    /// The sum over a convex polygon.
    ///
    /// # Errors
    /// If the run was cancelled.
    pub(super) fn sum(&self, corners: [Point; 4], build: &Build<'_>) -> Result<Sum, Failure> {
        let [width, height] = self.size();
        let area = Polygon::new(&corners);
        let mut sum = Sum::default();
        if let Some([low, high]) = area.upright() {
            for y in area.cells(1, height) {
                build.go_on()?;
                let tall = high[1].min(y + 1.0) - low[1].max(y);
                for x in area.cells(0, width) {
                    let wide = high[0].min(x + 1.0) - low[0].max(x);
                    self.add(&mut sum, x, y, wide * tall);
                }
            }
            return Ok(sum);
        }
        for y in area.cells(1, height) {
            build.go_on()?;
            let row = area.clip(1, y, 1.0).clip(1, y + 1.0, -1.0);
            for x in row.cells(0, width) {
                let cell = row.clip(0, x, 1.0).clip(0, x + 1.0, -1.0);
                self.add(&mut sum, x, y, cell.area([x, y]));
            }
        }
        Ok(sum)
    }

    fn add(&self, sum: &mut Sum, x: f64, y: f64, area: f64) {
        let (x, y) = (x as u32, y as u32);
        let codes = match &self.pixels {
            Pixels::Eight(picture) => picture.get_pixel(x, y).0.map(usize::from),
            Pixels::Sixteen(picture) => picture.get_pixel(x, y).0.map(usize::from),
        };
        let weight = area * codes[3] as f64 / (self.linear.len() - 1) as f64;
        for (part, code) in sum.colour.iter_mut().zip(codes) {
            *part += weight * f64::from(self.linear[code]);
        }
        sum.weight += weight;
    }
}

impl Sum {
    /// The mean colour, unless all is transparent.
    pub(super) fn mean(&self) -> Option<[f64; 3]> {
        (self.weight > 1e-9).then(|| self.colour.map(|part| part / self.weight))
    }
}

fn sixteen_bits(picture: &DynamicImage) -> bool {
    let color = picture.color();
    color.bytes_per_pixel() > color.channel_count()
}

/// A convex polygon: four corners, and one more for each of four cuts.
struct Polygon {
    corners: [Point; 8],
    count: usize,
}

impl Polygon {
    fn new(corners: &[Point]) -> Polygon {
        let mut polygon = Polygon {
            corners: [[0.0; 2]; 8],
            count: corners.len(),
        };
        polygon.corners[..corners.len()].copy_from_slice(corners);
        polygon
    }

    fn corners(&self) -> &[Point] {
        &self.corners[..self.count]
    }

    /// Two opposite corners, if all sides are parallel to the axes.
    fn upright(&self) -> Option<[Point; 2]> {
        let extreme = |pick: fn(f64, f64) -> f64| {
            let first = self.corners[0];
            self.corners().iter().fold(first, |so_far, c| {
                [pick(so_far[0], c[0]), pick(so_far[1], c[1])]
            })
        };
        let [low, high] = [extreme(f64::min), extreme(f64::max)];
        let at_rim =
            |corner: &Point| (0..2).all(|axis| [low[axis], high[axis]].contains(&corner[axis]));
        self.corners().iter().all(at_rim).then_some([low, high])
    }

    /// Pixels from 0 to `end` that the polygon may touch, along one axis.
    fn cells(&self, axis: usize, end: f64) -> impl Iterator<Item = f64> + use<> {
        let parts = || self.corners().iter().map(|corner| corner[axis]);
        let first = parts().fold(end, f64::min).max(0.0).floor();
        let last = parts().fold(0.0, f64::max).min(end).ceil();
        (first as u32..last as u32).map(f64::from)
    }

    /// The part where `side * (coordinate - border)` is not negative (Sutherland & Hodgman 1974).
    fn clip(&self, axis: usize, border: f64, side: f64) -> Polygon {
        let mut clipped = Polygon {
            corners: [[0.0; 2]; 8],
            count: 0,
        };
        let mut push = |corner: Point| {
            // A convex polygon gains at most one corner by a cut, but for rounding.
            if clipped.count < clipped.corners.len() {
                clipped.corners[clipped.count] = corner;
                clipped.count += 1;
            }
        };
        let corners = self.corners();
        for (index, corner) in corners.iter().enumerate() {
            let before = corners[(index + corners.len() - 1) % corners.len()];
            let [depth, depth_before] =
                [corner, &before].map(|corner| side * (corner[axis] - border));
            if depth * depth_before < 0.0 {
                let share = depth_before / (depth_before - depth);
                push([0, 1].map(|axis| before[axis] + share * (corner[axis] - before[axis])));
            }
            if depth >= 0.0 {
                push(*corner);
            }
        }
        clipped
    }

    /// The area; `near` is a point close by, so that far from the origin no digits are lost.
    fn area(&self, near: Point) -> f64 {
        let corners = self.corners();
        let cross = |index: usize| {
            let [a, b] = [corners[index], corners[(index + 1) % corners.len()]]
                .map(|corner| [corner[0] - near[0], corner[1] - near[1]]);
            a[0] * b[1] - a[1] * b[0]
        };
        0.5 * (0..corners.len()).map(cross).sum::<f64>().abs()
    }
}
