//! What cuts along curved surfaces have in common: kernels that send points of the piece to the surface.

use crate::field::{Block, Field, Kernel};
use crate::key::KeyHasher;
use crate::node::{Build, Failure, Inputs};
use crate::nodes::average::Average;
use crate::value::{Domain, Material, Surface, Value};
use glam::{DVec2, DVec3};
use std::fmt::Debug;
use std::sync::Arc;

/// The channel that tells where the surface is on the piece.
const COVERAGE: &str = "coverage";

/// A surface that is spread out on a flat piece.
pub(super) trait CutSurface: Send + Sync + Debug {
    /// Adds all that the surface is.
    fn add_to_key(&self, key: &mut KeyHasher);

    /// What is at a point of the piece, in mm from its lower left corner.
    fn spot(&self, at: DVec2) -> Spot;

    /// The change of the place in space along u and v, in mm for each mm of the piece.
    fn tangents(&self, at: DVec2) -> [DVec3; 2];
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spot {
    /// Where it is in the solid.
    pub(super) place: DVec3,
    /// The chart that it belongs to.
    pub(super) chart: u32,
    /// Whether the surface is there, or only the nearest to what was asked for.
    pub(super) is_covered: bool,
}

/// The piece that shows the solid of the input `of` on a surface, `size` mm large.
///
/// # Errors
/// If the solid has a channel that cuts of surfaces make.
pub(super) fn piece(
    inputs: &Inputs<'_>,
    build: &Build<'_>,
    surface: Arc<dyn CutSurface>,
    size: [f64; 2],
) -> Result<Vec<Value>, Failure> {
    let solid = inputs.material("of");
    if solid.channels.contains_key(COVERAGE) {
        let message = format!("the material has a channel `{COVERAGE}`, which the cut makes");
        return Err(Failure::of_input("of", message).with_hint("rename the extra"));
    }
    let plane = || vec![Field::position(Domain::Plane)];
    let spots = build.kernel(Spots(Arc::clone(&surface)), plane());
    let tangents = build.kernel(Tangents(surface), plane());
    let position = spots.part(0, 3);
    let channels = solid.channels.iter();
    let channels = channels.map(|(name, field)| (name.clone(), field.at(&position)));
    let coverage = build.kernel(Average { width: 1 }, vec![spots.part(4, 1)]);
    Ok(vec![Value::Material(Arc::new(Material {
        domain: Domain::Plane,
        channels: channels.chain([(COVERAGE.to_owned(), coverage)]).collect(),
        size: Some(size),
        surface: Some(Surface {
            tangents: Some(tangents),
            charts: vec![spots.part(3, 1)],
        }),
    }))])
}

fn at(block: &Block<'_>, index: usize) -> DVec2 {
    let [u, v] = [0, 1].map(|column| f64::from(block.inputs[column].values[index]));
    DVec2::new(u, v)
}

/// Place, chart and whether the surface is there.
#[derive(Debug)]
struct Spots(Arc<dyn CutSurface>);

impl Kernel for Spots {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("spots").whole(1);
        self.0.add_to_key(key);
    }

    fn width(&self) -> usize {
        5
    }

    fn nanoseconds(&self) -> f32 {
        400.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for index in 0..block.inputs[0].values.len() {
            let spot = self.0.spot(at(block, index));
            let [x, y, z] = spot.place.to_array().map(|part| part as f32);
            let covered = f32::from(u8::from(spot.is_covered));
            // What is beside the surface is another part of the chart.
            let chart = spot.chart as f32 + 0.5 * (1.0 - covered);
            let columns = [x, y, z, chart, covered];
            for (output, value) in block.outputs.iter_mut().zip(columns) {
                output[index] = value;
            }
        }
    }
}

/// The change of the place along u, then along v.
#[derive(Debug)]
struct Tangents(Arc<dyn CutSurface>);

impl Kernel for Tangents {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("tangents").whole(1);
        self.0.add_to_key(key);
    }

    fn width(&self) -> usize {
        6
    }

    fn nanoseconds(&self) -> f32 {
        400.0
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for index in 0..block.inputs[0].values.len() {
            let [u, v] = self.0.tangents(at(block, index)).map(|it| it.to_array());
            for (output, value) in block.outputs.iter_mut().zip(u.into_iter().chain(v)) {
                output[index] = value as f32;
            }
        }
    }
}
