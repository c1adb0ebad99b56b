//! Outlines that are written out: what is right, what is mended, and what is refused.

use super::{area, bounds, built, region_of, told};
use glam::DVec2;
use yosegi::nodes::region::{combine_regions, grow_region, region, region_field, region_shape};
use yosegi::value::{Region, Value};

fn corners(corners: &[(f64, f64)]) -> Value {
    Value::List(corners.iter().map(|(x, y)| Value::Pair([*x, *y])).collect())
}

fn outline(outline: &[(f64, f64)], holes: &[&[(f64, f64)]]) -> Value {
    let holes = holes.iter().map(|hole| corners(hole)).collect();
    Value::Record(vec![
        ("outline", corners(outline)),
        ("holes", Value::List(holes)),
    ])
}

fn drawn(outlines: Vec<Value>) -> Result<std::sync::Arc<Region>, yosegi::node::Failure> {
    built(&region::KIND, vec![("outlines", Value::List(outlines))]).map(region_of)
}

const SQUARE: &[(f64, f64)] = &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];

fn shape(given: Vec<(&str, Value)>) -> Value {
    let mut values = vec![
        ("shape", Value::Choice("rectangle")),
        ("size", Value::Pair([40.0, 20.0])),
        ("at", Value::Pair([0.0; 2])),
        ("turn", Value::Number(0.0)),
        ("sides", Value::Whole(6)),
        ("round", Value::Number(0.0)),
        ("tolerance", Value::Number(1e-4)),
    ];
    values.extend(given);
    built(&region_shape::KIND, values).unwrap().remove(0)
}

fn area_of(value: Value) -> f64 {
    area(&region_of(vec![value]))
}

#[test]
fn what_is_drawn_has_its_area() {
    let hole: &[(f64, f64)] = &[(2.0, 2.0), (4.0, 2.0), (4.0, 5.0), (2.0, 5.0)];
    let region = drawn(vec![outline(SQUARE, &[hole])]).unwrap();
    assert_eq!(area(&region), 94.0);
    assert_eq!(region.polygons.len(), 1);
    let two = drawn(vec![
        outline(SQUARE, &[]),
        outline(&[(20.0, 0.0), (24.0, 0.0), (20.0, 4.0)], &[]),
    ]);
    assert_eq!(area(&two.unwrap()), 108.0);
}

#[test]
fn each_mistake_is_told_with_its_place() {
    let cases = [
        (
            "(outline: [(0, 0), (4, 4), (4, 0), (0, 4)])",
            "outline 1 crosses or touches itself at (2, 2) mm; it encloses what it winds around",
        ),
        (
            "(outline: [(0, 0), (4, 0), (4, 0), (4, 4)])",
            "outline 1 has a repeated corner at (4, 0) mm; it is taken out",
        ),
        (
            "(outline: [(0, 0), (4, 0), (4, 4), (7, 7), (4, 4), (0, 4)])",
            "outline 1 turns back on itself at (4, 4) mm; the spike is taken out",
        ),
        (
            "(outline: [(0, 0), (0, 4), (4, 4)])",
            "outline 1 runs clockwise; it is turned",
        ),
        (
            "(outline: [(0, 0), (4, 0), (4, 4)], holes: [[(8, 8), (9, 8), (9, 9)]])",
            "hole 1 of outline 1 lies outside its outline; it is left out",
        ),
        (
            "(outline: [(0, 0), (4, 0), (4, 4)], holes: [[(3, 1), (9, 1), (9, 2), (3, 2)]])",
            "hole 1 of outline 1 reaches beyond its outline at (9, 1) mm; what is beyond is left out",
        ),
        (
            "(outline: [(0, 0), (9, 0), (9, 9)], holes: [[(8, 1), (8, 2), (7, 1)], [(8, 1), (7, 1), (7, 0.5)]])",
            "hole 2 of outline 1 touches another ring at (7, 1) mm; they are joined",
        ),
        (
            "(outline: [(0, 0), (4, 0), (4, 4)]), (outline: [(3, 0), (6, 0), (3, 6)])",
            "outline 2 overlaps another at (3, 3) mm; they are joined",
        ),
    ];
    for (outlines, message) in cases {
        let found = told(&[], &format!("\"example\": region(outlines: [{outlines}])")).unwrap();
        assert_eq!(found, [message], "{outlines}");
    }
    let closed = "\"example\": region(outlines: [(outline: [(0, 0), (4, 0), (4, 4), (0, 0)])])";
    assert!(told(&[], closed).unwrap().is_empty());
}

#[test]
fn what_encloses_nothing_is_refused() {
    let refused = |outline_of: &[(f64, f64)]| {
        drawn(vec![outline(SQUARE, &[]), outline(outline_of, &[])]).unwrap_err()
    };
    let few = refused(&[(1.0, 1.0), (2.0, 2.0)]);
    assert_eq!(
        few.message,
        "expected at least 3 different corners of outline 2, found 2"
    );
    assert_eq!((few.input, few.item), (Some("outlines"), Some(1)));
    assert_eq!(
        refused(&[(0.0, 0.0), (1.0, 0.0), (5.0, 0.0)]).message,
        "outline 2 encloses no area"
    );
    assert_eq!(
        refused(&[(0.0, 0.0), (1.0, f64::NAN), (5.0, 5.0)])
            .message
            .split(" at ")
            .next(),
        Some("outline 2 has a corner")
    );
    assert!(
        refused(&[(0.0, 0.0), (1e38, 0.0), (5.0, 5.0)])
            .message
            .contains("the farthest is")
    );
    assert_eq!(drawn(vec![]).unwrap_err().message, "there are no outlines");
    // 1 : 1e-10.
    let thin = drawn(vec![outline(
        &[(0.0, 0.0), (10.0, 0.0), (10.0, 1e-9), (0.0, 1e-9)],
        &[],
    )]);
    assert_eq!(thin.unwrap_err().message, "outline 1 encloses no area");
}

/// The rules hold at any size: powers of two change nothing but the size.
#[test]
fn tiny_and_huge_outlines_are_mended_alike() {
    let knot = [
        (0.0, 0.0),
        (3.0, 0.1),
        (1.0, 2.0),
        (2.5, -1.0),
        (4.0, 3.0),
        (0.3, 2.7),
    ];
    let at = |scale: f64| {
        let corners: Vec<(f64, f64)> = knot.iter().map(|(x, y)| (x * scale, y * scale)).collect();
        drawn(vec![outline(&corners, &[])]).unwrap()
    };
    let one = at(1.0);
    for power in [-100, -20, 20] {
        let scale = 2f64.powi(power);
        let scaled = at(scale);
        let corners = |region: &Region| region.rings().flatten().copied().collect::<Vec<DVec2>>();
        let expected: Vec<DVec2> = corners(&one).iter().map(|corner| *corner * scale).collect();
        assert_eq!(corners(&scaled), expected, "{power}");
    }
}

#[test]
fn shapes_have_the_areas_of_the_books() {
    let pi = std::f64::consts::PI;
    assert!((area_of(shape(vec![])) - 800.0).abs() < 1e-9);
    assert!(
        (area_of(shape(vec![("round", Value::Number(5.0))])) - (800.0 - 25.0 * (4.0 - pi))).abs()
            < 0.01
    );
    assert!((area_of(shape(vec![("shape", Value::Choice("ellipse"))])) - 200.0 * pi).abs() < 0.01);
    let hexagon = shape(vec![
        ("shape", Value::Choice("polygon")),
        ("size", Value::Pair([20.0, 20.0])),
    ]);
    assert!((area_of(hexagon) - 150.0 * 3f64.sqrt()).abs() < 1e-9);
    let turned = shape(vec![
        ("turn", Value::Number(90.0)),
        ("at", Value::Pair([100.0, 0.0])),
    ]);
    let [low, high] = bounds(&region_of(vec![turned]));
    assert!((low - DVec2::new(110.0, -10.0)).length() < 1e-9);
    assert!((high - DVec2::new(130.0, 30.0)).length() < 1e-9);
}

#[test]
fn regions_are_joined_cut_and_grown() {
    let combined = |operation: &'static str| {
        let other = shape(vec![("at", Value::Pair([30.0, 10.0]))]);
        let given = vec![
            ("a", shape(vec![])),
            ("b", other),
            ("operation", Value::Choice(operation)),
        ];
        area_of(built(&combine_regions::KIND, given).unwrap().remove(0))
    };
    for (operation, expected) in [
        ("union", 1500.0),
        ("difference", 700.0),
        ("intersection", 100.0),
    ] {
        assert!((combined(operation) - expected).abs() < 1e-9, "{operation}");
    }
    let grown = |by: f64, corners: &'static str| {
        let given = vec![
            ("of", shape(vec![])),
            ("by", Value::Number(by)),
            ("corners", Value::Choice(corners)),
            ("tolerance", Value::Number(1e-4)),
        ];
        built(&grow_region::KIND, given).map(|mut values| area_of(values.remove(0)))
    };
    let pi = std::f64::consts::PI;
    assert!((grown(3.0, "round").unwrap() - (800.0 + 3.0 * 120.0 + 9.0 * pi)).abs() < 0.01);
    assert!((grown(3.0, "pointed").unwrap() - 46.0 * 26.0).abs() < 1e-9);
    assert!((grown(-3.0, "round").unwrap() - 34.0 * 14.0).abs() < 1e-9);
    assert_eq!(
        grown(-10.0, "round").unwrap_err().message,
        "nothing is left of the region"
    );
}

#[test]
fn fields_say_what_is_inside_and_how_far_the_outline_is() {
    use fearless_simd::Level;
    use yosegi::field::{Program, RunContext, Samples, Scratch};
    let given = vec![("of", shape(vec![])), ("width", Value::Number(0.0))];
    let values = built(&region_field::KIND, given).unwrap();
    let points = [
        [20.0, 10.0, 0.0],
        [1.0, 10.0, 0.0],
        [-3.0, -4.0, 0.0],
        [39.5, 19.0, 0.0],
    ];
    let expected = [(1.0, 10.0), (1.0, 1.0), (0.0, -5.0), (1.0, 0.5)];
    let context = RunContext {
        level: Level::new(),
        cache: None,
        filtering: false,
        cancel: None,
    };
    for (output, value) in values.iter().enumerate() {
        let Value::Field(field) = value else { panic!() };
        let program = Program::compile(std::slice::from_ref(field));
        let mut scratch = Scratch::default();
        program.run(&Samples::Points(&points), &mut scratch, &context);
        let found = &program.output(&scratch, 0, 0)[..points.len()];
        let wanted = expected.map(|(inside, distance)| [inside, distance][output]);
        assert_eq!(found, wanted);
    }
}
