//! Charts: differences and means that do not cross from one to another, and borders that survive smaller pictures.

use super::surfaces::{SQUARES, on_mesh, on_patches, teapot};
use super::*;
use yosegi::engine::FlatPiece;
use yosegi::field::{Block, Kernel, PixelGrid, Sampling};
use yosegi::key::KeyHasher;
use yosegi::value::Surface;

/// Gives the spread of what it reads.
#[derive(Debug)]
struct Spread;

impl Kernel for Spread {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("spread of a test");
    }

    fn width(&self) -> usize {
        2
    }

    fn reads_spread(&self, _: usize) -> bool {
        true
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (axis, output) in block.outputs.iter_mut().enumerate() {
            output.copy_from_slice(block.inputs[0].spread[axis]);
        }
    }
}

/// Gives what it reads, as the mean of samples in each pixel.
#[derive(Debug)]
struct Mean;

impl Kernel for Mean {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("mean of a test");
    }

    fn width(&self) -> usize {
        1
    }

    fn sampling(&self) -> Sampling {
        Sampling::Supersampled
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        block.outputs[0].copy_from_slice(block.inputs[0].values);
    }
}

fn kernel(kernel: impl Kernel + 'static, of: &Field) -> Field {
    Field::kernel(&Arc::from("test"), Arc::new(kernel), vec![of.clone()])
}

/// The columns of fields over a whole piece, painted in tiles.
fn painted(
    fields: &[Field],
    charts: &[Field],
    piece: &Material,
    pixels: u32,
    tile: u32,
) -> Vec<Vec<f32>> {
    let program = Program::compile_in_charts(fields, charts);
    let target = FlatPiece::new([pixels; 2], piece.size.unwrap());
    let mut scratch = Scratch::default();
    let width = fields.iter().map(Field::width).sum();
    let mut columns = vec![vec![0.0; (pixels * pixels) as usize]; width];
    let corners = (0..pixels.div_ceil(tile))
        .flat_map(|y| (0..pixels.div_ceil(tile)).map(move |x| [x * tile, y * tile]));
    for corner in corners {
        let size = corner.map(|at| tile.min(pixels - at));
        let margin = program.margin();
        let grid = PixelGrid::tile(corner, size, margin);
        let row = grid.width;
        program.run(
            &Samples::Grid {
                target: &target,
                grid,
            },
            &mut scratch,
            &context(),
        );
        let found: Vec<&[f32]> = (0..fields.len())
            .flat_map(|output| program.columns(&scratch, output))
            .collect();
        for (column, found) in columns.iter_mut().zip(found) {
            for (x, y) in (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))) {
                let to = (corner[1] + y) * pixels + corner[0] + x;
                column[to as usize] = found[(y as usize + margin) * row + x as usize + margin];
            }
        }
    }
    columns
}

#[test]
fn differences_stay_within_their_chart() {
    // Without a gutter the patches of the teapot touch on the map, and lie anywhere in space.
    let piece = on_patches(&teapot(0.0));
    let x = piece.channels["place"].part(0, 1);
    let spread = kernel(Spread, &x);
    let most = |charts: &[Field]| {
        let columns = painted(&[spread.clone()], charts, &piece, 192, 64);
        columns
            .concat()
            .into_iter()
            .fold(0.0f32, |most, change| most.max(change.abs()))
    };
    // The longest patch is some 3 mm wide in x, and 32 pixels.
    let (within, across) = (most(piece.charts()), most(&[]));
    assert!(
        within < 0.25 && across > 0.7,
        "{within} in charts, {across} without"
    );
    let whole = painted(&[spread.clone()], piece.charts(), &piece, 192, 192);
    for tile in [17, 64] {
        assert!(
            painted(&[spread.clone()], piece.charts(), &piece, 192, tile) == whole,
            "{tile}"
        );
    }
}

#[test]
fn means_are_of_one_chart() {
    let mesh = read("it.obj", SQUARES, &PLAIN).unwrap();
    let piece = on_mesh(&mesh, &[]).unwrap();
    // Where x > 30, on the second square only. The border runs through the pixels of an odd picture.
    let second = kernel(Mean, &kernel(Beyond, &piece.channels["place"].part(0, 1)));
    let values = painted(&[second.clone()], piece.charts(), &piece, 31, 31).remove(0);
    assert!(values.iter().all(|value| *value == 0.0 || *value == 1.0));
    let mixed = painted(&[second], &[], &piece, 31, 31).remove(0);
    assert!(mixed.iter().any(|value| *value > 0.0 && *value < 1.0));
}

/// The whole part of a number.
#[derive(Debug)]
struct Whole;

impl Kernel for Whole {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("whole part of a test");
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (output, value) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = value.floor();
        }
    }
}

/// 1 where a number is above 30.
#[derive(Debug)]
struct Beyond;

impl Kernel for Beyond {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("beyond of a test");
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (output, value) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = f32::from(u8::from(*value > 30.0));
        }
    }
}

/// Each chart has a value of its own. However often a picture is halved, as long as the texels of two charts do not meet
/// in one, a texel that shows a chart shows its value and nothing else.
#[test]
fn seams_survive_smaller_pictures() {
    let spot = std::fs::read("assets/spot/spot.obj").unwrap();
    for (mesh, pixels, levels) in [
        (read("it.obj", SQUARES, &PLAIN).unwrap(), 512, 5),
        (
            read(
                "spot.obj",
                spot,
                &Reading {
                    places: "box",
                    ..PLAIN
                },
            )
            .unwrap(),
            1024,
            2,
        ),
    ] {
        let piece = on_mesh(&mesh, &[]).unwrap();
        let fields = [
            kernel(Whole, &piece.charts()[0]),
            piece.channels["coverage"].clone(),
        ];
        let mut side = pixels;
        let mut columns = painted(&fields, piece.charts(), &piece, pixels as u32, 128);
        let shown: Vec<f32> = columns[0].clone();
        let coverage = columns[1].clone();
        for level in 1..=levels {
            columns[0] = halved(&columns[0], side);
            side /= 2;
            let block = pixels / side;
            let mut looked_at = 0;
            for texel in 0..side * side {
                let (x, y) = (texel % side * block, texel / side * block);
                let inside =
                    (0..block * block).map(|it| (y + it / block) * pixels + x + it % block);
                let mut charts: Vec<f32> = inside
                    .filter(|it| coverage[*it] > 0.0)
                    .map(|it| shown[it])
                    .collect();
                charts.dedup();
                if let [only] = charts[..] {
                    looked_at += 1;
                    assert_eq!(columns[0][texel], only, "level {level}, texel {x} {y}");
                }
            }
            assert!(looked_at > 0, "level {level}");
        }
    }
}

fn halved(values: &[f32], side: usize) -> Vec<f32> {
    let half = side / 2;
    let mean = |texel: usize| {
        let (x, y) = (texel % half * 2, texel / half * 2);
        let sum: f32 = [0, 1, side, side + 1]
            .iter()
            .map(|it| values[y * side + x + it])
            .sum();
        sum / 4.0
    };
    (0..half * half).map(mean).collect()
}

#[test]
fn pieces_made_of_pieces_keep_their_charts() {
    let mesh = read("it.obj", SQUARES, &PLAIN).unwrap();
    let piece = on_mesh(&mesh, &[]).unwrap();
    let other = on_patches(&teapot(0.0));
    let mut other = (*other).clone();
    other.size = piece.size;
    let key = |surface: &Surface| surface.charts.iter().map(Field::key).collect::<Vec<_>>();
    let blend = |a: &Arc<Material>, b: &Arc<Material>| {
        let given = [
            ("a", Value::Material(Arc::clone(a))),
            ("b", Value::Material(Arc::clone(b))),
            ("mask", Value::Number(0.5)),
            ("by", Value::Choice("mask")),
        ];
        match built(yosegi::nodes::kind("blend").unwrap(), &given)
            .unwrap()
            .remove(0)
        {
            Value::Material(material) => material.surface.clone().unwrap(),
            other => panic!("found a {}", other.type_name()),
        }
    };
    let own = key(piece.surface.as_ref().unwrap());
    assert_eq!(key(&blend(&piece, &piece)), own);
    let both = key(&blend(&piece, &Arc::new(other)));
    assert_eq!((both.len(), both[0]), (2, own[0]));
    let moved = [
        ("of", Value::Material(piece)),
        ("move", Value::Vector(DVec3::X)),
        ("turn", Value::Vector(DVec3::ZERO)),
        ("scale", Value::Vector(DVec3::ONE)),
        ("pivot", Value::Vector(DVec3::ZERO)),
    ];
    let Value::Material(moved) = built(yosegi::nodes::kind("transform").unwrap(), &moved)
        .unwrap()
        .remove(0)
    else {
        panic!("no material")
    };
    assert_eq!(moved.charts().len(), 1);
    assert_ne!(key(moved.surface.as_ref().unwrap()), own);
}

/// At every pixel of a patch, those at its border included, the spread is what the surface's tangents say.
#[test]
fn spreads_are_true_up_to_the_border() {
    let piece = on_patches(&teapot(0.0));
    let place = piece.channels["place"].clone();
    let tangents = piece.surface.as_ref().unwrap().tangents.clone().unwrap();
    let spreads = [0, 1, 2].map(|axis| kernel(Spread, &place.part(axis, 1)));
    let fields: Vec<Field> = spreads.into_iter().chain([tangents]).collect();
    let pixels = 6 * 64;
    let columns = painted(&fields, piece.charts(), &piece, pixels, 96);
    let pixel = piece.size.unwrap()[0] / f64::from(pixels);
    // Of the last row of squares two are patches.
    let shown =
        (4 * 64 * pixels..6 * 64 * pixels).filter(|it| it / pixels >= 64 || it % pixels < 128);
    for at in shown.map(|it| it as usize) {
        for axis in 0..3 {
            let (row, column) = (columns[2 * axis][at], columns[2 * axis + 1][at]);
            let [u, v] = [6 + axis, 9 + axis].map(|it| columns[it][at] * pixel as f32);
            // v runs up, rows run down; one-sided differences lag half a pixel behind.
            assert!(
                (row - u).abs() < 0.004 && (column + v).abs() < 0.004,
                "{at}: {row} {u}, {column} {v}"
            );
        }
    }
}

/// A texel outside the bark is transparent: the solid says so.
#[test]
fn opacity_is_that_of_the_solid() {
    let Value::Material(solid) = where_one_is() else {
        unreachable!()
    };
    let mut solid = (*solid).clone();
    let opacity = kernel(Beyond, &solid.channels["place"].part(0, 1));
    solid.channels.insert("opacity".to_owned(), opacity);
    let mesh = read("it.obj", SQUARES, &PLAIN).unwrap();
    let given = [
        ("mesh", Value::Mesh(mesh)),
        ("of", Value::Material(Arc::new(solid))),
    ];
    let piece = match built(&yosegi::nodes::cut::mesh_cut::KIND, &given)
        .unwrap()
        .remove(0)
    {
        Value::Material(piece) => piece,
        other => panic!("found a {}", other.type_name()),
    };
    let opacity = painted(
        &[piece.channels["opacity"].clone()],
        piece.charts(),
        &piece,
        40,
        40,
    )
    .remove(0);
    assert_eq!((opacity[20 * 40 + 8], opacity[20 * 40 + 32]), (0.0, 1.0));
}
