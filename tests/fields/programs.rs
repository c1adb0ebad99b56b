//! Programs share what is equal, follow fields elsewhere, and mean what their expressions mean.

use super::*;

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
