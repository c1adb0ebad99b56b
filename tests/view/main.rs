//! Shaded pictures: where things are seen, how they are lit, and that nothing but the recipe decides.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod light;
mod refused;
mod relief;
mod sight;

#[path = "../support/levels.rs"]
mod levels;
#[path = "../support/workshop.rs"]
#[allow(dead_code, reason = "views need no log of events")]
mod workshop;

use workshop::Workshop;
use yosegi::engine::{Cancel, Options};

/// A picture in linear light.
struct Picture {
    width: u32,
    height: u32,
    pixels: Vec<[f64; 3]>,
}

impl Picture {
    fn at(&self, x: u32, y: u32) -> [f64; 3] {
        self.pixels[(y * self.width + x) as usize]
    }

    /// The mean of the colour of a rectangle.
    fn mean(&self, x: std::ops::Range<u32>, y: std::ops::Range<u32>) -> f64 {
        let count = x.len() * y.len() * 3;
        let sum: f64 = y
            .flat_map(|y| x.clone().map(move |x| (x, y)))
            .flat_map(|(x, y)| self.at(x, y))
            .sum();
        sum / count as f64
    }
}

fn workshop() -> Workshop {
    let options = Options {
        threads: Some(2),
        memory: 0,
        ..Options::default()
    };
    Workshop::new("recipes", options)
}

/// Renders the output `a`, a view as PNG with 16 bits.
fn picture(recipe: &str) -> Picture {
    picture_in(&workshop(), recipe)
}

fn picture_in(workshop: &Workshop, recipe: &str) -> Picture {
    read(&rendered(workshop, recipe, "a_view.png"))
}

/// Renders a recipe and gives one of its files.
fn rendered(workshop: &Workshop, recipe: &str, name: &str) -> Vec<u8> {
    let run = workshop.render(recipe, &[], Cancel::new(), &|_| {});
    if let Err(error) = &run.result {
        panic!("{}", yosegi::diagnostics::render_all(error.diagnostics()));
    }
    workshop.map(name)
}

/// A colour map with 16 bits, in linear light.
fn read(bytes: &[u8]) -> Picture {
    let image = image::load_from_memory(bytes).unwrap().into_rgb16();
    let linear = |part: u16| yosegi::colour::from_srgb(f64::from(part) / 65535.0);
    Picture {
        width: image.width(),
        height: image.height(),
        pixels: image.pixels().map(|pixel| pixel.0.map(linear)).collect(),
    }
}

/// A recipe of some nodes and one view of the material `thing` on the mesh `shape`, in white light from all sides.
fn recipe(nodes: &str, view: &str) -> String {
    format!(
        r##"(nodes: {{ {nodes} }}, outputs: {{
            "a": view(of: "thing", on: "shape", format: png16, {view}),
        }})"##
    )
}

/// Light from all sides that makes everything white as bright as 0.5, and no other.
const EVEN: &str = "sky: (zenith: (1, 1, 1), horizon: (1, 1, 1), ground: (1, 1, 1), strength: 0.5), \
                    lights: [(direction: (0, 0, 1), strength: 0)], ground: false, background: (0.5, 0.5, 0.5)";
