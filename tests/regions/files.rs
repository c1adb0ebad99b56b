//! Regions from GeoJSON, SVG and meshes.

use super::{area, bounds, built, region_of, told};
use glam::{DVec2, DVec3};
use std::path::Path;
use std::sync::Arc;
use yosegi::node::Failure;
use yosegi::nodes::region::{region_from_file, region_from_mesh};
use yosegi::nodes::shape::block;
use yosegi::value::{FileContents, Polygon, Region, Value};

/// Of the ellipsoid of WGS 84.
const ECCENTRICITY_SQUARED: f64 = 0.006_694_38;

fn read(
    name: &str,
    bytes: impl Into<Vec<u8>>,
    given: Vec<(&str, Value)>,
) -> Result<Arc<Region>, Failure> {
    let file = FileContents {
        path: name.into(),
        bytes: bytes.into().into(),
    };
    let mut values = vec![
        ("file", Value::File(file)),
        ("parts", Value::List(vec![])),
        ("turn", Value::Number(0.0)),
        ("scale", Value::Number(1.0)),
        ("origin", Value::Choice("corner")),
        ("at", Value::Pair([0.0; 2])),
        ("tolerance", Value::Number(1e-4)),
    ];
    values.extend(given);
    built(&region_from_file::KIND, values).map(region_of)
}

fn outlines(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("assets/outlines")
        .join(name);
    std::fs::read(path).unwrap()
}

fn parts(names: &[&str]) -> (&'static str, Value) {
    let names = names.iter().map(|name| Value::Text((*name).to_owned()));
    ("parts", Value::List(names.collect()))
}

/// Areas that the files state, which others have computed: without taking off holes, and with 111,320 m for a degree of
/// longitude at the equator and 110,540 m for one of latitude. On the ellipsoid it is the radii of curvature, so that they are 0.75 %
/// too small.
#[test]
fn squares_have_the_areas_that_their_files_state() {
    let cases = [
        ("fischmarktplatz.geojson", "Fischmarktplatz", 0),
        ("sechselaeutenplatz.geojson", "Sechseläutenplatz", 3),
        ("sechselaeutenplatz.geojson", "relation/905867", 1),
        ("sechselaeutenplatz.geojson", "Bellevueplatz", 2),
    ];
    for (file, name, holes) in cases {
        let bytes = outlines(file);
        let json: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
        let is_it = |feature: &&serde_json::Value| {
            feature["properties"]["name"] == name || feature["id"] == name
        };
        let features = json["features"].as_array().unwrap();
        let stated = features.iter().find(is_it).unwrap()["properties"]["area_m2"]
            .as_f64()
            .unwrap();
        let region = read(file, bytes, vec![parts(&[name])]).unwrap();
        let outlines = region.polygons.iter().map(|polygon| Region {
            polygons: vec![Polygon {
                holes: vec![],
                ..polygon.clone()
            }],
        });
        let found = outlines.map(|outline| area(&outline)).sum::<f64>() / 1e6;
        let w = 1.0 - ECCENTRICITY_SQUARED * libm::sin(47.3f64.to_radians()).powi(2);
        let radii = 6_378_137f64.powi(2) * (1.0 - ECCENTRICITY_SQUARED) / (w * w);
        let stated = stated * radii * 1f64.to_radians().powi(2) / (111_320.0 * 110_540.0);
        assert!(
            (found / stated - 1.0).abs() < 1e-3,
            "{name}: {found} instead of {stated}"
        );
        let found: usize = region
            .polygons
            .iter()
            .map(|polygon| polygon.holes.len())
            .sum();
        assert_eq!(found, holes, "{name}");
        assert!(bounds(&region)[0].length() < 1e-6);
    }
}

#[test]
fn a_region_is_put_where_it_is_wanted() {
    let read = |given| read("square.geojson", outlines("fischmarktplatz.geojson"), given).unwrap();
    let plain = read(vec![]);
    let centred = read(vec![
        ("origin", Value::Choice("centre")),
        ("at", Value::Pair([5.0, 7.0])),
    ]);
    let [low, high] = bounds(&centred);
    assert!((0.5 * (low + high) - DVec2::new(5.0, 7.0)).length() < 1e-6);
    let half = read(vec![
        ("scale", Value::Number(0.5)),
        ("turn", Value::Number(90.0)),
    ]);
    assert!((area(&half) / area(&plain) - 0.25).abs() < 1e-9);
    let [size, turned] = [&plain, &half].map(|region| bounds(region)[1]);
    assert!((turned - 0.5 * DVec2::new(size.y, size.x)).length() < 1e-6);
}

#[test]
fn files_that_are_no_areas_are_refused() {
    let message = |text: &str| read("file", text, vec![]).unwrap_err().message;
    assert!(message("{").starts_with("the file is no JSON"));
    assert_eq!(message(" "), "the file is empty");
    assert_eq!(
        message("<svg xmlns='http://www.w3.org/2000/svg'><path d='L 3 4'/></svg>"),
        "the file has no areas: the path in line 1 has a mistake in its data at character 1; it is drawn up to there"
    );
    assert!(message("<svg").starts_with("the file is no SVG"));
    assert_eq!(message("<html/>"), "the file is no SVG: it is a `html`");
    assert_eq!(
        message("{}"),
        "the file is no GeoJSON: its object has no `type`"
    );
    assert_eq!(
        message(r#"{"type":"Blob"}"#),
        "its object has the type `Blob`, which is none of GeoJSON"
    );
    assert_eq!(
        message(r#"{"type":"Point","coordinates":[1,2]}"#),
        "the file has 1 points and lines, but no areas"
    );
    assert_eq!(
        message(r#"{"type":"Polygon","coordinates":[[[2700000,1200000],[1,2],[3,4]]]}"#),
        "expected longitude and latitude in degrees at `coordinates[0][0]`, found `[2700000,1200000]`"
    );
    assert_eq!(
        message("<svg xmlns='http://www.w3.org/2000/svg'/>"),
        "the file has no areas"
    );
    let wide = r#"{"type":"Polygon","coordinates":[[[0,0],[20,0],[20,5],[0,0]]]}"#;
    assert_eq!(
        message(wide),
        "the areas span 20.0 degrees of longitude; at most 6 are projected"
    );
    let other = read(
        "file",
        outlines("fischmarktplatz.geojson"),
        vec![parts(&["Fischmarkt"])],
    )
    .unwrap_err();
    assert_eq!(other.message, "the file has no area called `Fischmarkt`");
    assert_eq!(other.hint.unwrap(), "there are `Fischmarktplatz`");
}

#[test]
fn badly_drawn_files_are_mended_with_a_warning() {
    let square = r#"{"type":"Feature","properties":{"name":"Yard"},"geometry":{"type":"Polygon",
        "coordinates":[[[8,47],[8.001,47.001],[8.001,47],[8,47.001]]]}}"#;
    let nodes = r#""example": region_from_file(file: "yard.geojson", origin: file)"#;
    let found = told(&[("yard.geojson", square)], nodes).unwrap();
    assert_eq!(found[0], "1 ring does not end where it began; it is closed");
    assert!(
        found[1].starts_with("`Yard` crosses or touches itself at ("),
        "{}",
        found[1]
    );
    assert_eq!(found.len(), 2);
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0L9 0L9 9x"/><path id="dot" d="M1 1z"/></svg>"#;
    let nodes = r#""example": region_from_file(file: "a.svg")"#;
    let found = told(&[("a.svg", svg)], nodes).unwrap();
    assert_eq!(
        found,
        ["the path in line 1 has a mistake in its data at character 13; it is drawn up to there"]
    );
}

fn svg(inside: &str, given: Vec<(&str, Value)>) -> Arc<Region> {
    let text = format!(
        "<?xml version='1.0'?><!DOCTYPE svg><svg xmlns='http://www.w3.org/2000/svg' \
         xmlns:xlink='http://www.w3.org/1999/xlink' width='200mm' height='100mm' viewBox='0 0 400 200'>{inside}</svg>"
    );
    read("drawing.svg", text, given)
        .unwrap_or_else(|failure| panic!("{inside}: {}", failure.message))
}

/// Two units are a millimetre.
#[test]
fn shapes_of_svg_have_their_areas() {
    let pi = std::f64::consts::PI;
    let cases = [
        ("<rect x='10' y='10' width='40' height='20'/>", 200.0),
        (
            "<rect width='40' height='20' rx='4'/>",
            (800.0 - 16.0 * (4.0 - pi)) / 4.0,
        ),
        (
            "<rect width='20mm' height='1cm'/>",
            200.0 * (96.0f64 / 25.4).powi(2) / 4.0,
        ),
        ("<circle cx='50' cy='50' r='20'/>", 100.0 * pi),
        ("<ellipse cx='50' cy='50' rx='20' ry='10'/>", 50.0 * pi),
        ("<polygon points='0,0 40,0 40,20'/>", 100.0),
        ("<polyline points='0 0 40 0 40 20 0 20'/>", 200.0),
        ("<path d='M0 0h40v40h-40zM10 10h20v20h-20z'/>", 400.0),
        (
            "<path fill-rule='evenodd' d='M0 0h40v40h-40zM10 10h20v20h-20z'/>",
            300.0,
        ),
        (
            "<g style='fill-rule: evenodd'><path d='M0 0h40v40h-40zM10 10h20v20h-20z'/></g>",
            300.0,
        ),
        ("<path d='M0 0h40v40h-40zM10 10v20h20v-20z'/>", 300.0),
        (
            "<g transform='translate(5) scale(2, 3)'><rect width='10' height='10'/></g>",
            150.0,
        ),
        (
            "<rect transform='rotate(30 5 5) skewX(20)' width='10' height='10'/>",
            25.0,
        ),
        (
            "<rect transform='matrix(1 0 0 -1 0 0)' width='10' height='10'/>",
            25.0,
        ),
        (
            "<rect width='10' height='10'/><rect x='5' width='10' height='10'/>",
            37.5,
        ),
        (
            "<rect width='10' height='10'/><rect display='none' x='50' width='10' height='10'/>",
            25.0,
        ),
        (
            "<defs><rect id='a' width='10' height='10'/></defs><use href='#a'/><use xlink:href='#a' x='20'/>",
            50.0,
        ),
        (
            "<symbol id='s'><rect width='10' height='10'/></symbol><use href='#s'/>",
            25.0,
        ),
        // What has no fill or is hidden is not there.
        (
            "<rect fill='none' stroke='red' width='400' height='200'/><rect width='10' height='10'/>",
            25.0,
        ),
        (
            "<g style='fill:none'><rect width='99' height='99'/><rect fill='#123' width='10' height='10'/></g>",
            25.0,
        ),
        (
            "<g visibility='hidden'><rect width='99' height='99'/><rect visibility='visible' width='10' height='10'/></g>",
            25.0,
        ),
        (
            "<circle r='-20'/><rect width='-9' height='9'/><rect width='10' height='10'/>",
            25.0,
        ),
        // Percentages, of a circle that of the diagonal.
        ("<rect width='25%' height='10%'/>", 500.0),
        (
            "<circle cx='50%' cy='50%' r='10%'/>",
            pi * 0.01 * (400.0f64.powi(2) + 200.0f64.powi(2)) / 2.0 / 4.0,
        ),
        ("<rect width='2em' height='1ex'/>", 64.0),
        // Drawings in drawings.
        (
            "<svg width='50' height='50' viewBox='0 0 10 10'><rect width='10' height='10'/></svg>",
            625.0,
        ),
        (
            "<svg width='80' height='50' viewBox='0 0 10 10' preserveAspectRatio='none'><rect width='10' height='10'/></svg>",
            1000.0,
        ),
        (
            "<svg width='80' height='50' viewBox='0 0 10 10' preserveAspectRatio='xMinYMax slice'><rect width='10' height='10'/></svg>",
            1600.0,
        ),
        (
            "<symbol id='s' viewBox='0 0 10 10'><rect width='100%' height='50%'/></symbol><use href='#s' width='50' height='50'/>",
            312.5,
        ),
    ];
    for (inside, expected) in cases {
        let found = area(&svg(inside, vec![]));
        assert!(
            (found / expected - 1.0).abs() < 1e-4,
            "{inside}: {found} instead of {expected}"
        );
    }
}

#[test]
fn the_page_of_an_svg_stands_upright() {
    let at = [("origin", Value::Choice("file"))];
    let region = svg("<rect x='20' y='10' width='40' height='20'/>", at.to_vec());
    let [low, high] = bounds(&region);
    assert!((low - DVec2::new(10.0, 85.0)).length() < 1e-9, "{low}");
    assert!((high - DVec2::new(30.0, 95.0)).length() < 1e-9, "{high}");
    let group = "<g id='a'><rect width='10' height='10'/></g><g id='b'><rect x='90' width='20' height='20'/></g>";
    assert!((area(&svg(group, vec![parts(&["b"])])) - 100.0).abs() < 1e-9);
}

#[test]
fn viewports_align_what_is_drawn_in_them() {
    let at = [("origin", Value::Choice("file"))];
    let inside = "<rect width='10' height='10'/></svg>";
    for (ratio, x) in [
        ("xMinYMin", 0.0),
        ("xMidYMid", 7.5),
        ("xMaxYMax meet", 15.0),
    ] {
        let nested = format!(
            "<svg x='20' width='80' height='50' viewBox='0 0 10 10' preserveAspectRatio='{ratio}'>{inside}"
        );
        let [low, high] = bounds(&svg(&nested, at.to_vec()));
        assert!(
            (low - DVec2::new(10.0 + x, 75.0)).length() < 1e-9,
            "{ratio}: {low}"
        );
        assert!(
            (high - low - DVec2::splat(25.0)).length() < 1e-9,
            "{ratio}: {high}"
        );
    }
}

#[test]
fn an_outline_without_a_fill_is_taken_by_its_name() {
    let drawn =
        "<rect id='frame' fill='none' width='40' height='20'/><rect width='10' height='10'/>";
    assert!((area(&svg(drawn, vec![])) - 25.0).abs() < 1e-9);
    assert!((area(&svg(drawn, vec![parts(&["frame"])])) - 200.0).abs() < 1e-9);
}

#[test]
fn what_is_not_understood_in_an_svg_is_said_once() {
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg"><style>rect { fill: none }</style>
        <g clip-path="url(#c)"><rect transform="rotat(45)" width="9" height="9"/></g><rect transform="rotat(45)" width="9" height="3vw"/>
        <rect fill="none" width="5" height="5"/><use href="#gone"/></svg>"##;
    let nodes = r#""example": region_from_file(file: "a.svg")"#;
    assert_eq!(
        told(&[("a.svg", svg)], nodes).unwrap(),
        [
            "style sheets are not regarded; only attributes and `style` of elements are",
            "a `clip-path` is not regarded; what it hides is taken too",
            "the transform `rotat(45)` in line 2 is not understood and left out",
            "the length `height=\"3vw\"` in line 2 is not understood and left out",
            "the use in line 3 uses `#gone`, which is left out",
            "1 shape without a fill is left out; those that `parts` names are taken",
        ]
    );
}

#[test]
fn areas_on_both_sides_of_the_antimeridian_are_side_by_side() {
    let file = r#"{"type":"MultiPolygon","coordinates":[[[[179.99,0],[180,0],[180,0.01],[179.99,0.01],[179.99,0]]],
        [[[-180,0],[-179.99,0],[-179.99,0.01],[-180,0.01],[-180,0]]]]}"#;
    let [low, high] = bounds(&read("islands.geojson", file, vec![]).unwrap());
    let size = high - low;
    assert!((size.x / size.y - 2.0).abs() < 0.02, "{size}");
}

#[test]
fn circles_of_uses_come_to_an_end() {
    let endless = "<g id='a'><rect width='10' height='10'/><use href='#a' x='20'/></g>";
    assert!((area(&svg(endless, vec![])) - 17.0 * 25.0).abs() < 1e-6);
}

/// A block of 30 x 10 x 20 mm, whose front takes the whole map.
#[test]
fn the_sides_of_a_block_are_laid_out_or_seen() {
    let front = Value::Vector(DVec3::X);
    let given = vec![
        ("origin", Value::Vector(DVec3::ZERO)),
        ("across", front),
        ("along", Value::Vector(DVec3::Z)),
        ("size", Value::Pair([30.0, 20.0])),
        ("thickness", Value::Number(10.0)),
        ("rounding", Value::Number(0.0)),
    ];
    let mesh = built(&block::KIND, given).unwrap().remove(0);
    let region = |laid: &'static str, towards: DVec3| {
        let given = vec![
            ("of", mesh.clone()),
            ("as", Value::Choice(laid)),
            ("size", Value::Pair([300.0, 200.0])),
            ("sides", Value::List(vec![])),
            ("towards", Value::Vector(towards)),
        ];
        area(&region_of(built(&region_from_mesh::KIND, given).unwrap()))
    };
    assert!((region("shadow", -DVec3::Z) - 300.0).abs() < 1e-6);
    assert!((region("shadow", DVec3::Y) - 600.0).abs() < 1e-6);
    assert!(
        (region("shadow", DVec3::new(1.0, 0.0, 1.0)) - (300.0 + 200.0) / 2f64.sqrt()).abs() < 1e-6
    );
    assert!((region("map", DVec3::Z) - 60_000.0).abs() < 1e-3);
}
