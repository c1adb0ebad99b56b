//! Rotary veneer: the numbers of an independent implementation, the log's volume, and strips of hundreds of metres.

use super::*;
use serde_json::Value as Json;
use yosegi::engine::FlatPiece;
use yosegi::field::PixelGrid;
use yosegi::nodes::cut::rotary_cut::KIND;

/// A strip as the inputs' defaults say unless a test changes it.
struct Strip {
    offset: [f64; 2],
    radius: f64,
    pitch: f64,
    core: f64,
    from: f64,
    length: Option<f64>,
    direction: &'static str,
    start: f64,
}

const STRIP: Strip = Strip {
    offset: [0.0; 2],
    radius: 20.0,
    pitch: 0.6,
    core: 0.0,
    from: 0.0,
    length: None,
    direction: "against_the_clock",
    start: 0.0,
};

fn peel(strip: &Strip) -> Result<Arc<Material>, Failure> {
    let mut given = vec![
        ("origin", Value::Vector(DVec3::ZERO)),
        ("offset", Value::Pair(strip.offset)),
        ("radius", Value::Number(strip.radius)),
        ("core", Value::Number(strip.core)),
        ("pitch", Value::Number(strip.pitch)),
        ("height", Value::Number(2.0)),
        ("start", Value::Number(strip.start)),
        ("direction", Value::Choice(strip.direction)),
        ("from", Value::Number(strip.from)),
    ];
    given.extend(strip.length.map(|length| ("length", Value::Number(length))));
    cut(&KIND, &given)
}

fn vectors() -> Json {
    serde_json::from_str(include_str!("../data/cut-vectors.json")).unwrap()
}

fn numbers(value: &Json) -> Vec<f64> {
    let items = value.as_array().unwrap().iter();
    items.map(|item| item.as_f64().unwrap()).collect()
}

#[test]
fn rotary_and_half_rotary_cuts_pass_through_the_points_of_the_vectors() {
    let vectors = vectors();
    for (points, offset) in [("rotary", [0.0; 2]), ("half_rotary", [5.0, 2.0])] {
        let piece = peel(&Strip { offset, ..STRIP }).unwrap();
        let on_strip = numbers(&vectors["arc"]);
        let on_strip: Vec<[f64; 3]> = on_strip.iter().map(|arc| [*arc, 1.0, 0.0]).collect();
        let expected = vectors[points].as_array().unwrap().iter();
        for (found, expected) in places(&piece, &on_strip).iter().zip(expected) {
            let expected = DVec3::from_slice(&numbers(expected));
            assert!(
                found.distance(expected) < 5e-6,
                "{points}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn the_strip_is_as_much_wood_as_the_log() {
    for part in [20.0, 33.0, 100.0, 1000.0] {
        let (radius, pitch) = (150.0, 150.0 / part);
        let whole = peel(&Strip {
            radius,
            pitch,
            ..STRIP
        })
        .unwrap()
        .size
        .unwrap()[0];
        let area = std::f64::consts::PI * radius * radius;
        let apart = (pitch * whole / area - 1.0).abs();
        assert!(apart < 1e-3, "pitch {pitch}: {apart}");
        let strip = Strip {
            radius,
            pitch,
            core: 40.0,
            ..STRIP
        };
        let peeled = peel(&strip).unwrap().size.unwrap()[0];
        // What is left is the core.
        let core = std::f64::consts::PI * 40.0 * 40.0;
        assert!(
            ((whole - peeled) * pitch / core - 1.0).abs() < 6e-3 * (pitch / 7.5),
            "pitch {pitch}"
        );
    }
}

/// The point of a spiral at a length, by halving the angle between bounds: another way than the program's.
fn expected(strip: &Strip, length: f64) -> DVec3 {
    let k = strip.pitch / std::f64::consts::TAU;
    let swept = |r: f64| 0.5 * (r * (r * r + k * k).sqrt() + k * k * (r / k).asinh());
    let (mut low, mut high) = (0.0, strip.radius / k);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        match (swept(strip.radius) - swept(strip.radius - k * middle)) / k < length {
            true => low = middle,
            false => high = middle,
        }
    }
    let radius = strip.radius - k * low;
    DVec3::new(radius * low.cos(), radius * low.sin(), 0.0)
}

/// A veneer of half a millimetre of a log of half a metre: its last 16 m at 4 pixels a millimetre.
#[test]
fn the_end_of_a_strip_of_393_metres_is_sharp() {
    let whole = Strip {
        radius: 250.0,
        pitch: 0.5,
        ..STRIP
    };
    let length = peel(&whole).unwrap().size.unwrap()[0];
    assert!((392_600.0..392_800.0).contains(&length), "{length}");
    let (from, part) = (length - 16_384.0, 16_384.0);
    let last = peel(&Strip {
        from,
        length: Some(part),
        ..whole
    })
    .unwrap();
    let target = FlatPiece::new([65_536, 8], [part, 2.0]);
    let program = Program::compile(&[last.channels["place"].clone()]);
    for corner in [0, 30_000, 60_000, 65_536 - 64] {
        let grid = PixelGrid::tile([corner, 0], [64, 4], 0);
        let samples = Samples::Grid {
            target: &target,
            grid,
        };
        let mut scratch = Scratch::default();
        program.run(&samples, &mut scratch, &context());
        let columns = program.columns(&scratch, 0);
        let mut before: Option<DVec3> = None;
        for pixel in 0..64 {
            let [x, y] = [0, 1].map(|axis: usize| f64::from(columns[axis][3 * 64 + pixel]));
            let found = DVec3::new(x, y, 0.0);
            let length = from + (f64::from(corner) + pixel as f64 + 0.5) / 4.0;
            let expected = expected(&whole, length);
            assert!(
                found.distance(expected) < 1e-4,
                "{corner} {pixel}: {found}, not {expected}"
            );
            if let Some(before) = before.filter(|_| corner < 60_001) {
                assert!(
                    (found.distance(before) - 0.25).abs() < 1e-3,
                    "{corner} {pixel}"
                );
            }
            before = Some(found);
        }
    }
    // In one piece, too: points of the whole strip are exact although u is a single-precision number.
    let lengths = [391_000.015_625, 392_000.123_456, 392_500.987_654];
    let points = lengths.map(|length| [length, 0.0, 0.0]);
    for (found, length) in places(&peel(&whole).unwrap(), &points).iter().zip(lengths) {
        assert!(
            found.distance(expected(&whole, length)) < 1e-4,
            "{length}: {found}"
        );
    }
}

#[test]
fn parts_of_a_strip_fit_together_and_the_other_way_round_is_mirrored() {
    let first = peel(&STRIP).unwrap();
    let later = peel(&Strip {
        from: 100.0,
        length: Some(50.0),
        ..STRIP
    })
    .unwrap();
    assert_eq!(later.size, Some([50.0, 2.0]));
    let [a, b] = [
        places(&first, &[[120.0, 1.0, 0.0]])[0],
        places(&later, &[[20.0, 1.0, 0.0]])[0],
    ];
    assert!(a.distance(b) < 1e-5);
    let mirrored = peel(&Strip {
        direction: "with_the_clock",
        ..STRIP
    })
    .unwrap();
    let c = places(&mirrored, &[[120.0, 1.0, 0.0]])[0];
    assert!(c.distance(a * DVec3::new(1.0, -1.0, 1.0)) < 1e-5);
    let quarter = peel(&Strip {
        start: 90.0,
        ..STRIP
    })
    .unwrap();
    let d = places(&quarter, &[[120.0, 1.0, 0.0]])[0];
    assert!(d.distance(DVec3::new(-a.y, a.x, a.z)) < 1e-5);
}

#[test]
fn strips_that_cannot_be_are_refused() {
    let refused = |strip: Strip| peel(&strip).unwrap_err().message;
    let core = refused(Strip {
        core: 20.0,
        ..STRIP
    });
    assert_eq!(
        core,
        "the strip would end 20 mm from the axis and begin at 20 mm"
    );
    let beyond = refused(Strip {
        from: 2000.0,
        length: Some(200.0),
        ..STRIP
    });
    assert_eq!(
        beyond,
        "the strip ends at 2094.7 mm, and the piece would at 2200.0 mm"
    );
    assert_eq!(
        refused(Strip {
            from: 3000.0,
            ..STRIP
        }),
        "the strip ends at 2094.7 mm"
    );
    let thin = refused(Strip {
        radius: 1e4,
        pitch: 0.01,
        ..STRIP
    });
    assert!(
        thin.starts_with("the strip would be 31415926536 mm long"),
        "{thin}"
    );
}
