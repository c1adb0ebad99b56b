//! Normals from height: the slope of the relief in the piece's own plane, or in the surface that the piece lies on.
//!
//! On a plane n = normalise(-dh/du, -dh/dv, 1) with u to the right and v up, so it is OpenGL-handed. The slope is
//! the spread of the height over the spread of the position (the inverse of their Jacobian).
//!
//! On a surface P(u, v) the frame is the tangent T along dP/du, the bitangent B at a right angle to it towards dP/dv, and
//! the normal (Mikkelsen 2008, with the frame of the point itself in place of one smoothed over the vertices). The slope
//! along T is (dh/du) / |dP/du|; along B it is (dh/dv - slope_T (T . dP/dv)) / (B . dP/dv).

use crate::field::{Block, Field, InputColumn, Kernel};
use crate::key::KeyHasher;
use crate::value::{Domain, Material};
use glam::DVec3;
use std::sync::Arc;

/// The unit normal of a piece with heights in mm: three numbers from -1 to 1.
pub(crate) fn normal_from_height(node: &Arc<str>, material: &Material) -> Field {
    let height = material.channels["height"].clone();
    let surface = material.surface.as_ref();
    let tangents = surface.and_then(|surface| surface.tangents.clone());
    let on_surface = tangents.is_some();
    let mut inputs = vec![height, Field::position(Domain::Plane)];
    inputs.extend(tangents);
    Field::kernel(node, Arc::new(Normal { on_surface }), inputs)
}

/// Squares of slopes up to this are finite.
const STEEPEST: f32 = 1e18;

/// Columns in: height, position, and on a surface dP/du and dP/dv.
#[derive(Debug)]
struct Normal {
    on_surface: bool,
}

impl Kernel for Normal {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("normal_from_height").whole(2);
    }

    fn width(&self) -> usize {
        3
    }

    fn reads_spread(&self, column: usize) -> bool {
        // Height, u and v; the third part of a plane's position is always 0.
        column < 3
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let [height, u, v, ..] = block.inputs else {
            return;
        };
        let [normal_u, normal_v, normal_w] = block.outputs else {
            return;
        };
        for index in 0..height.values.len() {
            let along_row = |column: &InputColumn<'_>| column.spread[0][index];
            let along_column = |column: &InputColumn<'_>| column.spread[1][index];
            let area = along_row(u) * along_column(v) - along_column(u) * along_row(v);
            // Points without neighbours have no slope.
            let scale = if area == 0.0 { 0.0 } else { 1.0 / area };
            let rise_u =
                scale * (along_row(height) * along_column(v) - along_column(height) * along_row(v));
            let rise_v =
                scale * (along_row(u) * along_column(height) - along_column(u) * along_row(height));
            let [rise_u, rise_v] = match self.on_surface {
                true => on_surface(&block.inputs[4..], index, [rise_u, rise_v]),
                false => [rise_u, rise_v],
            };
            let [rise_u, rise_v] = measurable([rise_u, rise_v]);
            let length = (rise_u * rise_u + rise_v * rise_v + 1.0).sqrt();
            normal_u[index] = -rise_u / length;
            normal_v[index] = -rise_v / length;
            normal_w[index] = 1.0 / length;
        }
    }
}

/// Slopes whose squares do not overflow: of those that would, the direction is what counts.
fn measurable(slopes: [f32; 2]) -> [f32; 2] {
    let steepest = slopes[0].abs().max(slopes[1].abs());
    if steepest > STEEPEST && steepest < f32::INFINITY {
        return slopes.map(|slope| slope / steepest * STEEPEST);
    }
    slopes
}

/// The slopes along tangent and bitangent; 0 where the surface has no area.
fn on_surface(tangents: &[InputColumn<'_>], index: usize, [rise_u, rise_v]: [f32; 2]) -> [f32; 2] {
    let vector = |first: usize| {
        let part = |axis: usize| f64::from(tangents[first + axis].values[index]);
        DVec3::new(part(0), part(1), part(2))
    };
    let (along_u, along_v) = (vector(0), vector(3));
    let Some(tangent) = along_u.try_normalize() else {
        return [0.0; 2];
    };
    let slanted = tangent.dot(along_v);
    let across = (along_v - tangent * slanted).length();
    if across <= 1e-9 * along_v.length() {
        return [0.0; 2];
    }
    let slope_u = f64::from(rise_u) / along_u.length();
    let slope_v = (f64::from(rise_v) - slope_u * slanted) / across;
    [slope_u as f32, slope_v as f32]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::FlatPiece;
    use crate::field::{PixelGrid, Program, RunContext, Samples, Scratch};
    use crate::value::Surface;
    use fearless_simd::Level;
    use std::collections::BTreeMap;

    /// 0.3 u + 0.6 v.
    #[derive(Debug)]
    struct Slope;

    impl Kernel for Slope {
        fn add_to_key(&self, key: &mut KeyHasher) {
            key.text("slope of a test");
        }

        fn width(&self) -> usize {
            1
        }

        fn evaluate(&self, block: &mut Block<'_>) {
            for (index, output) in block.outputs[0].iter_mut().enumerate() {
                *output = 0.3 * block.inputs[0].values[index] + 0.6 * block.inputs[1].values[index];
            }
        }
    }

    fn normal(tangents: Option<[f64; 6]>) -> [f32; 3] {
        let node: Arc<str> = "test".into();
        let height = Field::kernel(&node, Arc::new(Slope), vec![Field::position(Domain::Plane)]);
        let material = Material {
            domain: Domain::Plane,
            channels: BTreeMap::from([("height".to_owned(), height)]),
            size: Some([8.0, 8.0]),
            surface: Some(Surface {
                tangents: tangents.map(|tangents| Field::constants(&tangents)),
                charts: vec![],
            }),
        };
        let program = Program::compile(&[normal_from_height(&node, &material)]);
        let target = FlatPiece::new([16, 16], [8.0, 8.0]);
        let samples = Samples::Grid {
            target: &target,
            grid: PixelGrid::tile([4, 4], [1, 1], program.margin()),
        };
        let context = RunContext {
            level: Level::baseline(),
            cache: None,
            filtering: true,
            cancel: None,
        };
        let mut scratch = Scratch::default();
        program.run(&samples, &mut scratch, &context);
        let middle = samples.len() / 2;
        [0, 1, 2].map(|column| program.output(&scratch, 0, column)[middle])
    }

    fn is_near(found: [f32; 3], slopes: [f32; 2]) {
        let length = (slopes[0] * slopes[0] + slopes[1] * slopes[1] + 1.0).sqrt();
        let expected = [-slopes[0] / length, -slopes[1] / length, 1.0 / length];
        let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(
            apart.fold(0.0, f32::max) < 1e-5,
            "{found:?}, not {expected:?}"
        );
    }

    #[test]
    fn walls_of_any_height_have_normals_of_length_1() {
        let slopes = measurable([3e30, -4e30]);
        assert!(
            (slopes[0] / 7.5e17 - 1.0).abs() < 1e-6 && slopes[1] == -1e18,
            "{slopes:?}"
        );
        assert!((slopes[0] * slopes[0] + slopes[1] * slopes[1]).is_finite());
        assert_eq!(measurable([0.3, 1e18]), [0.3, 1e18]);
        assert!(measurable([f32::NAN, 1.0])[0].is_nan());
    }

    #[test]
    fn slopes_are_those_in_the_surface() {
        is_near(normal(None), [0.3, 0.6]);
        is_near(normal(Some([1.0, 0.0, 0.0, 0.0, 1.0, 0.0])), [0.3, 0.6]);
        // P = (2 u + v, 3 v), so h = 0.15 x + 0.15 y.
        is_near(normal(Some([2.0, 0.0, 0.0, 1.0, 3.0, 0.0])), [0.15, 0.15]);
        // The same, upright in space and seen from behind: tangent and bitangent follow u and v.
        is_near(normal(Some([0.0, 0.0, -2.0, 0.0, 3.0, -1.0])), [0.15, 0.15]);
        // Where the surface has no area nothing slopes.
        is_near(normal(Some([1.0, 0.0, 0.0, 2.0, 0.0, 0.0])), [0.0, 0.0]);
        is_near(normal(Some([0.0; 6])), [0.0, 0.0]);
    }
}
