//! What packings must not do, and what the table must see: narrow arms, steep sizes, too many stones, wrong angles.

use super::{built, measured, packed, plaza, region_area};
use glam::DVec2;
use std::sync::Arc;
use std::time::Instant;
use yosegi::field::{Block, Field, Kernel};
use yosegi::key::KeyHasher;
use yosegi::node::Failure;
use yosegi::nodes::kind;
use yosegi::value::{Domain, Partition, Polygon, Region, Value};

fn region(corners: &[(f64, f64)]) -> Value {
    let outline = corners.iter().map(|corner| DVec2::from(*corner)).collect();
    let holes = vec![];
    let polygons = vec![Polygon { outline, holes }];
    Value::Region(Arc::new(Region { polygons }))
}

fn square(side: f64) -> Value {
    region(&[(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)])
}

/// A number that has a value up to some x, and grows from there on to another.
#[derive(Clone, Copy, Debug)]
struct Growing {
    from: f32,
    to: f32,
    low: f32,
    high: f32,
}

impl Kernel for Growing {
    fn add_to_key(&self, key: &mut KeyHasher) {
        key.text(&format!("{self:?}"));
    }

    fn width(&self) -> usize {
        1
    }

    fn evaluate(&self, block: &mut Block<'_>) {
        let places = block.inputs[0].values;
        for (number, x) in block.outputs[0].iter_mut().zip(places) {
            let share = ((x - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
            *number = self.from + share * (self.to - self.from);
        }
    }
}

/// A number for each place that is the first of `sizes` up to the first of `places`, and the last from the last on.
fn growing(sizes: [f32; 2], places: [f32; 2]) -> Value {
    let ([from, to], [low, high]) = (sizes, places);
    let kernel = Growing {
        from,
        to,
        low,
        high,
    };
    let place = Field::position(Domain::Plane);
    Value::Field(Field::kernel(
        &Arc::from("test"),
        Arc::new(kernel),
        vec![place],
    ))
}

fn refused(given: &[(&str, Value)]) -> Failure {
    packed(given).unwrap_err()
}

#[test]
fn too_many_stones_are_refused_however_they_become_so_many() {
    let size = |side: f64| ("size", Value::Pair([side, side]));
    let stone = ("stone", Value::Number(10.0));
    let small = [
        size(15_000.0),
        stone.clone(),
        ("scale", Value::Number(0.0625)),
    ];
    let spread = [
        size(20_000.0),
        stone.clone(),
        ("spread", Value::Pair([0.3, 0.3])),
        ("method", Value::Choice("particles")),
        ("steps", Value::Whole(0)),
    ];
    let places = [
        size(15_000.0),
        stone,
        ("scale", growing([0.05, 0.07], [0.0, 15_000.0])),
    ];
    let start = Instant::now();
    assert_eq!(
        refused(&small).message,
        "expected at most 4000000 stones, found about 576000000"
    );
    assert_eq!(
        refused(&spread).message,
        "expected at most 4000000 stones, found about 44444444"
    );
    let found = refused(&places).message;
    assert!(
        found.starts_with("expected at most 4000000 stones"),
        "{found}"
    );
    assert!(start.elapsed().as_secs() < 20);
}

#[test]
fn narrow_arms_are_filled_with_stones() {
    for method in ["position_field", "particles"] {
        for share in [0.2, 0.4, 0.6, 0.8, 1.0, 1.2] {
            let (low, high) = (50.0 - 5.0 * share, 50.0 + 5.0 * share);
            let arm = [(100.0, low), (300.0, low), (300.0, high), (100.0, high)];
            let court = [(0.0, 0.0), (100.0, 0.0)];
            let court = [&court[..], &arm[..], &[(100.0, 100.0), (0.0, 100.0)]].concat();
            let strip = [
                (0.0, 0.0),
                (1000.0, 0.0),
                (1000.0, 10.0 * share),
                (0.0, 10.0 * share),
            ];
            for outline in [&court[..], &strip[..]] {
                let region = region(outline);
                let given = [
                    ("region", region.clone()),
                    ("stone", Value::Number(10.0)),
                    ("method", Value::Choice(method)),
                ];
                let cells = packed(&given).unwrap();
                let covered: f64 = cells.areas.iter().sum();
                assert!((covered / region_area(&region) - 1.0).abs() < 1e-9);
                let largest = cells.areas.iter().copied().fold(0.0, f64::max);
                assert!(largest < 201.0, "{method} {share}: {largest}");
                if method == "position_field" {
                    let found = measured(&cells, &region);
                    assert!(found["occupancy"] > 0.99, "{share}: {found:?}");
                }
            }
        }
    }
}

#[test]
fn sizes_that_grow_tenfold_are_followed() {
    let region = square(300.0);
    // The stones of all places, of side 10 (0.3 + x / 100).
    let due = 300.0 * 100.0 / 100.0 * (1.0 / 0.3 - 1.0 / 3.3);
    for (method, least) in [("position_field", 0.8), ("particles", 0.9)] {
        let given = [
            ("region", region.clone()),
            ("stone", Value::Number(10.0)),
            ("scale", growing([0.3, 3.3], [0.0, 300.0])),
            ("method", Value::Choice(method)),
        ];
        let cells = packed(&given).unwrap();
        let share = cells.len() as f64 / due;
        assert!(share > least && share < 1.05, "{method}: {share}");
        let found = measured(&cells, &region);
        assert!(found["occupancy"] > 0.97, "{method}: {found:?}");
        assert!(found["angle_median_degrees"] < 5.0, "{method}: {found:?}");
    }
}

#[test]
fn a_step_to_stones_of_sixteen_times_the_size_keeps_the_small_ones() {
    let region = square(300.0);
    // 0.5 up to the middle, 8 from there on, within a millimetre.
    let scale = growing([0.5, 8.0], [150.0, 151.0]);
    for method in ["position_field", "particles"] {
        let given = [
            ("region", region.clone()),
            ("stone", Value::Number(10.0)),
            ("scale", scale.clone()),
            ("method", Value::Choice(method)),
        ];
        let start = Instant::now();
        let cells = packed(&given).unwrap();
        let small = cells.centres.iter().filter(|centre| centre.x < 138.0);
        // 27.6 columns of 60.
        let share = small.count() as f64 / 1656.0;
        assert!(share > 0.93 && share < 1.05, "{method}: {share}");
        assert!(start.elapsed().as_secs() < 60);
    }
}

#[test]
fn particles_of_every_shape_are_as_many_as_have_room() {
    let side = 600.0;
    for (corners, aspect, share, angle, least) in [
        (6, 1.0, 0.75_f64.sqrt(), 5.0, 0.97),
        (5, 1.0, 0.933, 45.0, 0.93),
        (4, 3.0, 1.0, 3.0, 0.97),
        (4, 4.0, 1.0, 3.0, 0.94),
        (4, 6.0, 1.0, 3.0, 0.9),
    ] {
        let region = square(side);
        let given = [
            ("region", region.clone()),
            ("stone", Value::Number(12.0)),
            ("corners", Value::Whole(corners)),
            ("aspect", Value::Number(aspect)),
            ("method", Value::Choice("particles")),
        ];
        let cells = packed(&given).unwrap();
        let due = side * side / (144.0 * aspect * share);
        let found = cells.len() as f64 / due;
        assert!(found > least && found < 1.05, "{corners} {aspect}: {found}");
        let found = measured(&cells, &region);
        assert!(
            found["angle_median_degrees"] < angle,
            "{corners} {aspect}: {found:?}"
        );
        assert!(found["occupancy"] > 0.97, "{corners} {aspect}: {found:?}");
    }
}

#[test]
fn the_order_of_each_shape_is_that_of_its_own_lattice() {
    let region = square(600.0);
    for (name, number, least) in [
        ("bond", Value::Number(0.5), 0.85),
        ("corners", Value::Whole(6), 0.85),
        ("corners", Value::Whole(4), 0.95),
    ] {
        let given = [
            ("region", region.clone()),
            ("stone", Value::Number(20.0)),
            ("spread", Value::Pair([1.0, 1.0])),
            (name, number),
        ];
        let found = measured(&packed(&given).unwrap(), &region);
        assert!(found["order"] > least, "{name}: {found:?}");
        // Without joints there is nothing that varies.
        assert_eq!(found["joint_variation"], 0.0);
    }
    let pentagons = packed(&[
        ("region", region.clone()),
        ("stone", Value::Number(20.0)),
        ("corners", Value::Whole(5)),
    ]);
    assert!(!measured(&pentagons.unwrap(), &region).contains_key("order"));
}

/// Rectangles of a wall, in rows.
fn wall(columns: usize, rows: usize, size: [f64; 2], told: [f64; 2]) -> Arc<Partition> {
    let mut cells = Partition::default();
    for cell in 0..columns * rows {
        let low = DVec2::new((cell % columns) as f64, (cell / columns) as f64) * DVec2::from(size);
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let corner = |at: (f64, f64)| low + DVec2::from(at) * DVec2::from(size);
        cells.rings.push(cells.corners.len() as u32);
        cells.cells.push(cell as u32);
        cells.corners.extend(corners.map(corner));
        cells.neighbours.extend([Partition::NONE; 4]);
        cells.ids.push(cell as u32);
        cells.centres.push(low + 0.5 * DVec2::from(size));
        cells.frames.push(DVec2::X);
        cells.areas.push(size[0] * size[1]);
    }
    cells.rings.push(cells.corners.len() as u32);
    cells.cells.push(cells.ids.len() as u32);
    let count = cells.ids.len();
    let attributes = [("size", told[0]), ("aspect", told[1]), ("corners", 4.0)];
    cells.attributes = attributes
        .map(|(name, number)| (name.to_owned(), vec![number; count]))
        .into();
    Arc::new(cells)
}

#[test]
fn the_table_sees_stones_that_are_all_too_large_or_lie_across() {
    // Of 10 mm each should be, and is of 30: more than half of the place is empty.
    let region = square(300.0);
    let found = measured(&wall(10, 10, [30.0, 30.0], [10.0, 1.0]), &region);
    assert!((found["occupancy"] - 1.5 / 9.0).abs() < 1e-9, "{found:?}");
    // Along the x axis in a street along the y axis.
    let street = self::region(&[(0.0, 0.0), (60.0, 0.0), (60.0, 3000.0), (0.0, 3000.0)]);
    let found = measured(&wall(2, 300, [30.0, 10.0], [10.0, 3.0]), &street);
    assert!(found["angle_median_degrees"] > 85.0, "{found:?}");
}

#[test]
fn the_table_refuses_a_region_without_stones() {
    let away = region(&[(1e4, 0.0), (1.1e4, 0.0), (1.1e4, 1e3), (1e4, 1e3)]);
    let given = [
        (
            "of",
            Value::Partition(wall(3, 3, [10.0, 10.0], [10.0, 1.0])),
        ),
        ("region", away),
    ];
    let failure = built(kind("packing_table").unwrap(), &given).unwrap_err();
    assert_eq!(failure.message, "none of the stones lies in the region");
}

#[test]
fn inputs_that_a_method_does_not_look_at_are_refused() {
    let ground = [
        ("size", Value::Pair([300.0, 300.0])),
        ("stone", Value::Number(30.0)),
    ];
    let message = |more: &[(&'static str, Value)]| refused(&[&ground[..], more].concat()).message;
    let particles = ("method", Value::Choice("particles"));
    assert_eq!(
        message(&[particles, ("bond", Value::Number(0.5))]),
        "there is a `bond`, but the method is not `position_field`"
    );
    for (name, value) in [
        ("force", Value::Choice("five_sources")),
        ("start", Value::Choice("random")),
        ("steps", Value::Whole(7)),
    ] {
        let expected = format!("there is a `{name}`, but the method is not `particles`");
        assert_eq!(message(&[(name, value)]), expected);
    }
    assert_eq!(
        message(&[("corners", Value::Whole(6)), ("bond", Value::Number(0.5))]),
        "only stones with 4 corners have a bond"
    );
}

#[test]
fn a_place_without_room_for_a_stone_is_refused_whether_it_repeats_or_not() {
    for name in ["size", "period"] {
        let given = [
            (name, Value::Pair([10.0, 10.0])),
            ("stone", Value::Number(100.0)),
        ];
        assert_eq!(refused(&given).message, "no stone has room in the region");
    }
}

#[test]
fn half_the_size_gives_four_times_the_stones_on_a_plaza() {
    let region = plaza("fischmarktplatz", "Fischmarktplatz");
    for (method, many) in [("position_field", 2400.0), ("particles", 1600.0)] {
        let count = |stones: f64| {
            let side = (region_area(&region) / stones).sqrt();
            let given = [
                ("region", region.clone()),
                ("stone", Value::Number(side)),
                ("method", Value::Choice(method)),
            ];
            packed(&given).unwrap().len() as f64
        };
        let times = count(many) / count(0.25 * many);
        assert!((times / 4.0 - 1.0).abs() < 0.15, "{method}: {times}");
    }
}
