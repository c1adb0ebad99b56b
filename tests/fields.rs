//! Laws of field programs, with small kernels of the tests' own.
#![allow(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

use fearless_simd::Level;
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use yosegi::engine::FlatPiece;
use yosegi::field::{
    Block, ColumnCache, Columns, Field, Kernel, PixelGrid, Program, RunContext, Samples, Sampling,
    Scratch,
};
use yosegi::key::{Key, KeyHasher};
use yosegi::value::Domain;

/// A kernel that is one function.
#[derive(Clone, Debug)]
struct Test {
    name: &'static str,
    width: usize,
    function: fn(&mut Block<'_>),
    spread: bool,
    sampling: Sampling,
    nanoseconds: f32,
    calls: Arc<AtomicUsize>,
}

impl Test {
    fn new(name: &'static str, width: usize, function: fn(&mut Block<'_>)) -> Test {
        Test {
            name,
            width,
            function,
            spread: false,
            sampling: Sampling::Filtered,
            nanoseconds: 1.0,
            calls: Arc::default(),
        }
    }

    fn of(&self, inputs: &[&Field]) -> Field {
        let inputs = inputs.iter().map(|field| (*field).clone()).collect();
        Field::kernel(&Arc::from(self.name), Arc::new(self.clone()), inputs)
    }

    fn calls(&self) -> usize {
        self.calls.load(Ordering::Relaxed)
    }
}

impl Kernel for Test {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text(self.name);
    }

    fn width(&self) -> usize {
        self.width
    }

    fn reads_spread(&self, _: usize) -> bool {
        self.spread
    }

    fn sampling(&self) -> Sampling {
        self.sampling
    }

    fn nanoseconds(&self) -> f32 {
        self.nanoseconds
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        self.calls.fetch_add(1, Ordering::Relaxed);
        (self.function)(block);
    }
}

/// `f(a, b)` of the first two columns.
fn two(block: &mut Block<'_>, f: fn(f32, f32) -> f32) {
    for index in 0..block.outputs[0].len() {
        block.outputs[0][index] = f(block.inputs[0].values[index], block.inputs[1].values[index]);
    }
}

fn mean() -> Test {
    Test::new("mean", 1, |block| two(block, |a, b| 0.5 * (a + b)))
}

fn product() -> Test {
    Test::new("product", 1, |block| two(block, |a, b| a * b))
}

fn smaller() -> Test {
    Test::new("smaller", 1, |block| two(block, f32::min))
}

/// All input columns as one field.
fn join() -> Test {
    Test::new("join", 3, |block| {
        for (output, input) in block.outputs.iter_mut().zip(block.inputs) {
            output.copy_from_slice(input.values);
        }
    })
}

/// The change of a column from pixel to pixel along the rows.
fn rise() -> Test {
    let rise = Test::new("rise", 1, |block| {
        block.outputs[0].copy_from_slice(block.inputs[0].spread[0])
    });
    Test {
        spread: true,
        ..rise
    }
}

/// 1 where the column is below 0.
fn below_zero() -> Test {
    let step = Test::new("below_zero", 1, |block| {
        for (output, value) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = f32::from(u8::from(*value < 0.0));
        }
    });
    Test {
        sampling: Sampling::Supersampled,
        nanoseconds: 9.0,
        ..step
    }
}

fn context() -> RunContext<'static> {
    RunContext {
        level: Level::new(),
        cache: None,
        filtering: true,
    }
}

fn axis(domain: Domain, axis: usize) -> Field {
    Field::position(domain).part(axis, 1)
}

/// The values of one-column fields at points.
fn at_points(fields: &[Field], points: &[[f64; 3]]) -> Vec<Vec<f32>> {
    let program = Program::compile(fields);
    let mut scratch = Scratch::default();
    program.run(&Samples::Points(points), &mut scratch, &context());
    (0..fields.len())
        .map(|index| program.output(&scratch, index, 0)[..points.len()].to_vec())
        .collect()
}

/// A one-column field on a picture of 1 mm pixels, painted in tiles of `side` pixels.
fn painted(
    fields: &[Field],
    pixels: [u32; 2],
    side: u32,
    context: &RunContext<'_>,
) -> Vec<Vec<f32>> {
    let program = Program::compile(fields);
    let target = FlatPiece::new(pixels, pixels.map(f64::from));
    let mut scratch = Scratch::default();
    let mut pictures = vec![vec![f32::NAN; (pixels[0] * pixels[1]) as usize]; fields.len()];
    for y in (0..pixels[1]).step_by(side as usize) {
        for x in (0..pixels[0]).step_by(side as usize) {
            let size = [side.min(pixels[0] - x), side.min(pixels[1] - y)];
            let grid = PixelGrid::tile([x, y], size, program.margin());
            let (stride, margin) = (grid.width, program.margin());
            program.run(
                &Samples::Grid {
                    target: &target,
                    grid,
                },
                &mut scratch,
                context,
            );
            for (index, picture) in pictures.iter_mut().enumerate() {
                for row in 0..size[1] as usize {
                    let from = (row + margin) * stride + margin;
                    let to = (y as usize + row) * pixels[0] as usize + x as usize;
                    let values = program.output(&scratch, index, 0);
                    picture[to..to + size[0] as usize]
                        .copy_from_slice(&values[from..from + size[0] as usize]);
                }
            }
        }
    }
    pictures
}

fn bits(pictures: &[Vec<f32>]) -> Vec<Vec<u32>> {
    pictures
        .iter()
        .map(|picture| picture.iter().map(|value| value.to_bits()).collect())
        .collect()
}

#[test]
fn equal_expressions_are_evaluated_once() {
    let counted = mean();
    let [x, y] = [0, 1].map(|index| axis(Domain::Solid, index));
    // Equal by key, not by address.
    let [a, b] = [counted.of(&[&x, &y]), counted.of(&[&x, &y])];
    let product = product().of(&[&a, &b]);
    let values = at_points(&[product, a], &[[1.0, 3.0, 0.0], [2.0, 6.0, 0.0]]);
    assert_eq!(values, [[4.0, 16.0], [2.0, 4.0]]);
    assert_eq!(counted.calls(), 1);
}

#[test]
fn what_no_output_needs_is_not_evaluated() {
    let (counted, other) = (mean(), product());
    let [x, y] = [0, 1].map(|index| axis(Domain::Solid, index));
    let _unused = counted.of(&[&x, &y]);
    at_points(&[other.of(&[&x, &y])], &[[1.0, 3.0, 0.0]]);
    assert_eq!((counted.calls(), other.calls()), (0, 1));
}

#[test]
fn a_field_elsewhere_is_its_value_there_and_elsewheres_nest() {
    let solid = product().of(&[&axis(Domain::Solid, 0), &axis(Domain::Solid, 2)]);
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    // The point (u, v) of the plane lies at (v, u, (u + v) / 2) of the solid.
    let cut = join().of(&[&v, &u, &mean().of(&[&u, &v])]);
    let points = [[1.0, 3.0, 0.0], [5.0, 7.0, 0.0]];
    assert_eq!(
        at_points(&[solid.at(&cut)], &points),
        [[3.0 * 2.0, 7.0 * 6.0]]
    );
    // The plane is turned over before: (u, v) shows (v, v).
    let turned = join().of(&[&v, &v, &v]);
    let (inside, outside) = (solid.at(&cut.at(&turned)), solid.at(&cut).at(&turned));
    assert_eq!(
        at_points(&[inside, outside], &points),
        [[9.0, 49.0], [9.0, 49.0]]
    );
    assert_eq!(solid.at(&cut).domain(), Domain::Plane);
}

#[test]
fn one_field_in_two_places_is_evaluated_in_each_once() {
    let counted = product();
    let solid = counted.of(&[&axis(Domain::Plane, 0), &axis(Domain::Plane, 1)]);
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let [a, b] = [join().of(&[&u, &u, &u]), join().of(&[&v, &v, &v])];
    let fields = [
        solid.clone(),
        solid.at(&a),
        solid.at(&b),
        mean().of(&[&solid.at(&a), &solid.at(&b)]),
    ];
    assert_eq!(
        at_points(&fields, &[[2.0, 3.0, 0.0]]),
        [[6.0], [4.0], [9.0], [6.5]]
    );
    assert_eq!(counted.calls(), 3);
}

#[test]
fn a_constant_is_the_same_elsewhere() {
    let constant = Field::constant(2.5);
    let moved = constant.at(&Field::position(Domain::Plane));
    assert_eq!(
        (moved.key(), moved.domain()),
        (constant.key(), Domain::Everywhere)
    );
    assert_eq!(Field::constant(-0.0).key(), Field::constant(0.0).key());
}

#[test]
fn margins_add_up_where_spreads_are_read_of_spreads() {
    let u = axis(Domain::Plane, 0);
    let square = product().of(&[&u, &u]);
    let [once, twice] = [rise().of(&[&square]), rise().of(&[&rise().of(&[&square])])];
    let margins = [&square, &once, &twice].map(|field| Program::compile(&[field.clone()]).margin());
    assert_eq!(margins, [0, 1, 2]);
    let pictures = painted(&[once, twice], [9, 4], 3, &context());
    // u^2 at the pixel centres 0.5, 1.5 ..: slope 2u, and 2 everywhere, without an error at any border.
    for (index, (slope, bend)) in pictures[0].iter().zip(&pictures[1]).enumerate() {
        assert_eq!(
            (*slope, *bend),
            (2.0 * ((index % 9) as f32 + 0.5), 2.0),
            "pixel {index}"
        );
    }
}

/// The share of the pixel at (x, y) of a picture `height` pixels high where `below` holds.
fn coverage(x: u32, y: u32, height: u32, below: &dyn Fn(f64, f64) -> bool) -> f64 {
    const SIDE: u32 = 64;
    let at = |pixel: u32, part: u32| f64::from(pixel) + (f64::from(part) + 0.5) / f64::from(SIDE);
    let inside = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| (column, row)));
    let count = inside
        .filter(|(column, row)| below(at(x, *column), f64::from(height) - at(y, *row)))
        .count();
    count as f64 / f64::from(SIDE * SIDE)
}

#[test]
fn an_edge_is_supersampled_to_its_coverage() {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let (mut total, mut crossed) = (0.0, 0);
    for offset in [9.05, 9.4, 9.65, 9.9] {
        // u - 0.3 v < offset / 2, a slanted edge.
        let slant = mean().of(&[&u, &product().of(&[&v, &Field::constant(-0.3)])]);
        let distance = mean().of(&[&slant, &Field::constant(-0.5 * offset)]);
        let picture = &painted(&[below_zero().of(&[&distance])], [20, 12], 7, &context())[0];
        for (index, value) in (0u32..).zip(picture) {
            let wanted = coverage(index % 20, index / 20, 12, &|u, v| u - 0.3 * v < offset);
            let error = f64::from(*value) - wanted;
            assert!(
                error.abs() <= 0.13,
                "pixel {index}: {value}, expected {wanted}"
            );
            assert!(
                (wanted > 0.0 && wanted < 1.0) || error == 0.0,
                "pixel {index}: {value}"
            );
            total += error;
            crossed += u32::from(wanted > 0.0 && wanted < 1.0);
        }
    }
    assert!(
        crossed >= 60 && (total / f64::from(crossed)).abs() < 0.01,
        "{total} over {crossed}"
    );
}

#[test]
fn without_filtering_and_at_points_nothing_is_averaged() {
    let u = axis(Domain::Plane, 0);
    let edge = below_zero().of(&[&mean().of(&[&u, &Field::constant(-3.3)])]);
    let plain = RunContext {
        filtering: false,
        ..context()
    };
    assert_eq!(
        painted(&[edge.clone()], [6, 1], 4, &plain)[0],
        [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
    );
    assert_eq!(
        at_points(&[edge], &[[3.2, 0.0, 0.0], [3.4, 0.0, 0.0]])[0],
        [1.0, 0.0]
    );
}

/// Fields that read spreads and edges of each other, each in several ways.
fn relatives() -> Vec<Field> {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let wave = mean().of(&[
        &product().of(&[&u, &u]),
        &product().of(&[&v, &Field::constant(-7.3)]),
    ]);
    let edge = below_zero().of(&[&mean().of(&[&wave, &Field::constant(-20.0)])]);
    let slope = rise().of(&[&edge]);
    let turned = join().of(&[&v, &u, &v]);
    let steep = below_zero().of(&[&mean().of(&[&slope, &Field::constant(0.4)])]);
    vec![
        rise().of(&[&rise().of(&[&wave])]),
        wave,
        edge.clone(),
        slope.clone(),
        rise().of(&[&slope]),
        steep,
        edge.at(&turned),
    ]
}

#[test]
fn tiles_give_the_same_bits_as_the_whole() {
    let fields = relatives();
    let whole = bits(&painted(&fields, [23, 17], 64, &context()));
    for side in [1, 2, 5, 16, 22] {
        assert!(
            bits(&painted(&fields, [23, 17], side, &context())) == whole,
            "tiles of {side}"
        );
    }
}

/// Keeps every column that it is given.
#[derive(Default)]
struct Everything(Mutex<HashMap<Key, Columns>>);

impl ColumnCache for Everything {
    fn get(&self, key: &Key) -> Option<Columns> {
        self.0.lock().unwrap().get(key).cloned()
    }

    fn put(&self, key: Key, columns: Columns, _: f64) {
        self.0.lock().unwrap().insert(key, columns);
    }
}

/// A column may be needed farther beyond the tile by one program than by another.
#[test]
fn a_cache_filled_by_one_program_does_not_change_another() {
    let fields = relatives();
    let cache = Everything::default();
    let warm = RunContext {
        cache: Some(&cache),
        ..context()
    };
    for _ in 0..2 {
        for first in 0..fields.len() {
            for second in 0..fields.len() {
                let pair = [fields[first].clone(), fields[second].clone()];
                let cold = bits(&painted(&pair, [23, 17], 8, &context()));
                assert!(
                    bits(&painted(&pair, [23, 17], 8, &warm)) == cold,
                    "fields {first} and {second}"
                );
            }
        }
    }
}

#[test]
fn a_cached_kernel_does_not_run_again() {
    let counted = Test {
        nanoseconds: 9.0,
        ..mean()
    };
    let field = counted.of(&[&axis(Domain::Plane, 0), &axis(Domain::Plane, 1)]);
    let cache = Everything::default();
    let warm = RunContext {
        cache: Some(&cache),
        ..context()
    };
    let first = painted(&[field.clone()], [8, 8], 4, &warm);
    assert_eq!(counted.calls(), 4);
    assert_eq!(painted(&[field], [8, 8], 4, &warm), first);
    assert_eq!(counted.calls(), 4);
}

#[test]
fn a_chain_of_a_hundred_thousand_fields_compiles_runs_and_drops() {
    let (mut field, one) = (axis(Domain::Solid, 0), Field::constant(1.0));
    for _ in 0..100_000 {
        field = mean().of(&[&field, &one]);
    }
    let program = Program::compile(&[field.clone()]);
    assert!(
        program.length() == 100_000 && program.buffers() < 10,
        "{}",
        program.buffers()
    );
    // Half of the way to 1 at each link.
    assert_eq!(at_points(&[field], &[[3.0, 0.0, 0.0]]), [[1.0]]);
}

/// An expression, with the numbers of those it is made of.
#[derive(Clone, Copy, Debug)]
enum Expression {
    Constant(f32),
    Axis(usize),
    Mean(usize, usize),
    Product(usize, usize),
    Smaller(usize, usize),
    At(usize, [usize; 3]),
}

/// The plain meaning of expressions.
struct Meaning<'a> {
    expressions: &'a [Expression],
    known: HashMap<(usize, [u32; 3]), f32>,
}

impl Meaning<'_> {
    fn of(&mut self, index: usize, point: [f32; 3]) -> f32 {
        let place = (index, point.map(f32::to_bits));
        if let Some(known) = self.known.get(&place) {
            return *known;
        }
        let value = match self.expressions[index] {
            Expression::Constant(number) => number,
            Expression::Axis(axis) => point[axis],
            Expression::Mean(a, b) => 0.5 * (self.of(a, point) + self.of(b, point)),
            Expression::Product(a, b) => self.of(a, point) * self.of(b, point),
            Expression::Smaller(a, b) => self.of(a, point).min(self.of(b, point)),
            Expression::At(of, place) => {
                let there = place.map(|part| self.of(part, point));
                self.of(of, there)
            }
        };
        self.known.insert(place, value);
        value
    }
}

/// Random whole numbers below a limit (linear congruential, Knuth's MMIX).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % limit
    }
}

/// A random expression over the first `count`.
fn expression(random: &mut Random, count: usize) -> Expression {
    let a = random.below(count);
    let b = random.below(count);
    match random.below(5) {
        0 => Expression::Mean(a, b),
        1 => Expression::Product(a, b),
        2 => Expression::Smaller(a, b),
        3 => Expression::Constant(random.below(64) as f32 / 64.0),
        _ => Expression::At(a, [b, random.below(count), random.below(count)]),
    }
}

fn field(expression: Expression, fields: &[Field]) -> Field {
    match expression {
        Expression::Constant(number) => Field::constant(f64::from(number)),
        Expression::Axis(index) => axis(Domain::Solid, index),
        Expression::Mean(a, b) => mean().of(&[&fields[a], &fields[b]]),
        Expression::Product(a, b) => product().of(&[&fields[a], &fields[b]]),
        Expression::Smaller(a, b) => smaller().of(&[&fields[a], &fields[b]]),
        Expression::At(of, [x, y, z]) => {
            fields[of].at(&join().of(&[&fields[x], &fields[y], &fields[z]]))
        }
    }
}

#[test]
fn programs_mean_what_their_expressions_mean() {
    let points: Vec<[f64; 3]> = (0..37)
        .map(|index| [index % 4, index % 5, index % 7].map(|part| f64::from(part) / 8.0))
        .collect();
    for seed in 1..=200 {
        let mut random = Random(seed);
        let mut expressions: Vec<Expression> = (0..3).map(Expression::Axis).collect();
        let mut fields: Vec<Field> = expressions.iter().map(|it| field(*it, &[])).collect();
        for count in 3..40 {
            expressions.push(expression(&mut random, count));
            fields.push(field(expressions[count], &fields));
        }
        let outputs: Vec<usize> = (0..4).map(|_| random.below(40)).collect();
        let chosen: Vec<Field> = outputs
            .iter()
            .map(|output| fields[*output].clone())
            .collect();
        let values = at_points(&chosen, &points);
        let mut meaning = Meaning {
            expressions: &expressions,
            known: HashMap::new(),
        };
        for (output, values) in outputs.iter().zip(&values) {
            for (point, value) in points.iter().zip(values) {
                let wanted = meaning.of(*output, point.map(|part| part as f32));
                assert_eq!(
                    value.to_bits(),
                    wanted.to_bits(),
                    "seed {seed}, {:?} at {point:?}",
                    expressions[*output]
                );
            }
        }
    }
}

#[test]
fn points_do_not_depend_on_their_neighbours() {
    let points: Vec<[f64; 3]> = (0..50)
        .map(|index| [f64::from(index) * 0.37, f64::from(index % 7), 0.0])
        .collect();
    let fields = relatives();
    let whole = at_points(&fields, &points);
    for length in [1, 7, 16, 33] {
        let mut parts = vec![vec![]; fields.len()];
        for points in points.chunks(length) {
            for (part, values) in parts.iter_mut().zip(at_points(&fields, points)) {
                part.extend(values);
            }
        }
        assert_eq!(bits(&parts), bits(&whole), "blocks of {length}");
    }
}
