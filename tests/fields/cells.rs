//! What is given to fields around them, and what is not computed since nobody chooses it.

use super::*;
use yosegi::field::Alternatives;

/// A position on the plane from two columns.
fn place(u: &Field, v: &Field) -> Field {
    join().of(&[u, v, &Field::constant(0.0)])
}

fn given(name: &str, otherwise: f64) -> Field {
    Field::given(name, &Field::constant(otherwise))
}

#[test]
fn a_given_field_is_that_of_the_nearest_opening_around() {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let here = place(&u, &v);
    let shifted = place(&mean().of(&[&u, &v]), &v);
    let tone = given("tone", 9.0);
    let inside = product().of(&[&tone, &axis(Domain::Plane, 0)]);
    let name = |name: &str, field: &Field| (Arc::from(name), field.clone());
    let fields = [
        // Nothing is around.
        tone.clone(),
        inside.clone(),
        // Of the place around, not of the one inside.
        inside.at_given(&shifted, &[name("tone", &u)]),
        // Another name, and another number of columns, are not meant.
        inside.at_given(&shifted, &[name("shade", &u), name("tone", &here)]),
        // An opening between gives nothing; the outer one does.
        inside.at(&here).at_given(&shifted, &[name("tone", &v)]),
        // The inner one is nearer.
        inside
            .at_given(&here, &[name("tone", &Field::constant(2.0))])
            .at_given(&shifted, &[name("tone", &v)]),
        tone.at_given(&shifted, &[name("tone", &u)]),
    ];
    let values: Vec<f32> = at_points(&fields, &[[4.0, 10.0, 0.0]]).concat();
    assert_eq!(values, [9.0, 36.0, 28.0, 63.0, 70.0, 14.0, 4.0]);
}

#[test]
fn pixels_are_divided_with_what_is_given_inside_them() {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let here = place(&u, &v);
    // Below 0 in the left half of the pixels from u = 2 on.
    let less = Test::new("less", 1, |block| two(block, |a, b| a - b));
    let step = below_zero().of(&[&less.of(&[&given("edge", 0.0), &Field::constant(2.5)])]);
    let inside = step.at_given(&here, &[(Arc::from("edge"), u.clone())]);
    let picture = &painted(&[inside], [5, 1], 5, &context())[0];
    assert_eq!(picture, &[1.0, 1.0, 0.5, 0.0, 0.0]);
}

/// Takes the column that the first one chooses.
#[derive(Clone, Debug)]
struct Choose;

impl Kernel for Choose {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text("choose");
    }

    fn width(&self) -> usize {
        1
    }

    fn alternatives(&self) -> Option<Alternatives> {
        Some(Alternatives {
            choice: 0,
            first: 1,
            width: 1,
        })
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        for (index, output) in block.outputs[0].iter_mut().enumerate() {
            let at = |input: usize| block.inputs[input].values[index];
            *output = match at(0) {
                Alternatives::ALL => at(1) + at(2),
                chosen => at(1 + chosen as usize),
            };
        }
    }
}

fn choose(inputs: &[&Field]) -> Field {
    let inputs = inputs.iter().map(|field| (*field).clone()).collect();
    Field::kernel(&Arc::from("choose"), Arc::new(Choose), inputs)
}

/// 1 to the right of the twelfth column of pixels, else 0.
fn right() -> Field {
    let right = Test::new("right", 1, |block| {
        for (output, u) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = f32::from(u8::from(*u > 12.0));
        }
    });
    right.of(&[&axis(Domain::Plane, 0)])
}

#[test]
fn what_is_not_chosen_in_a_tile_is_not_computed() {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let [one, other, both] = [mean(), product(), smaller()];
    let shared = both.of(&[&u, &v]);
    let chosen = choose(&[&right(), &one.of(&[&shared, &u]), &other.of(&[&shared, &v])]);
    // Four tiles, of which only the last two hold what is to the right.
    let picture = &painted(&[chosen], [32, 8], 8, &context())[0];
    assert_eq!([one.calls(), other.calls(), both.calls()], [2, 3, 4]);
    for (index, value) in picture.iter().enumerate() {
        let (u, v) = ((index % 32) as f32 + 0.5, 7.5 - (index / 32) as f32);
        let expected = if u > 12.0 {
            u.min(v) * v
        } else {
            0.5 * (u.min(v) + u)
        };
        assert_eq!(*value, expected);
    }
}

#[test]
fn what_is_also_read_elsewhere_is_computed() {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let [one, other] = [mean(), product()];
    let (left, right_one) = (one.of(&[&u, &v]), other.of(&[&u, &v]));
    let chosen = choose(&[&right(), &left, &right_one]);
    let pictures = painted(&[right_one.clone(), chosen], [32, 8], 8, &context());
    assert_eq!([one.calls(), other.calls()], [2, 4]);
    for (index, value) in pictures[0].iter().enumerate() {
        let (u, v) = ((index % 32) as f32 + 0.5, 7.5 - (index / 32) as f32);
        assert_eq!(*value, u * v);
    }
}

#[test]
fn choices_within_choices_are_right() {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let upper = Test::new("upper", 1, |block| {
        for (output, v) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = f32::from(u8::from(*v > 4.0));
        }
    });
    let inner = choose(&[
        &upper.of(&[&v]),
        &mean().of(&[&u, &v]),
        &product().of(&[&u, &v]),
    ]);
    let outer = choose(&[&right(), &inner, &smaller().of(&[&u, &v])]);
    let picture = &painted(&[outer], [32, 8], 4, &context())[0];
    for (index, value) in picture.iter().enumerate() {
        let (u, v) = ((index % 32) as f32 + 0.5, 7.5 - (index / 32) as f32);
        let expected = match (u > 12.0, v > 4.0) {
            (true, _) => u.min(v),
            (false, true) => u * v,
            (false, false) => 0.5 * (u + v),
        };
        assert_eq!(*value, expected);
    }
}

#[test]
fn where_all_are_read_all_are_computed() {
    let [u, v] = [0, 1].map(|index| axis(Domain::Plane, index));
    let edge = Test::new("edge", 1, |block| {
        for (output, u) in block.outputs[0].iter_mut().zip(block.inputs[0].values) {
            *output = if *u > 11.0 && *u < 13.0 {
                Alternatives::ALL
            } else {
                f32::from(u8::from(*u > 12.0))
            };
        }
    });
    let (one, other) = (mean(), product());
    let chosen = choose(&[&edge.of(&[&u]), &one.of(&[&u, &v]), &other.of(&[&u, &v])]);
    let picture = &painted(&[chosen], [32, 8], 8, &context())[0];
    assert_eq!([one.calls(), other.calls()], [2, 3]);
    for (index, value) in picture.iter().enumerate() {
        let (u, v) = ((index % 32) as f32 + 0.5, 7.5 - (index / 32) as f32);
        let expected = match u {
            u if u < 11.0 => 0.5 * (u + v),
            u if u < 13.0 => 0.5 * (u + v) + u * v,
            _ => u * v,
        };
        assert_eq!(*value, expected);
    }
}
