//! Cuts along meshes and patches: what lies where, how large a piece is, what is beside the surface.

use super::*;
use glam::DVec2;
use yosegi::nodes::cut::{mesh_cut, patch_cut};
use yosegi::nodes::shape::{mesh_from_patches, nurbs_surface, patches_from_file};
use yosegi::value::Patches;

/// Two squares of 10 mm: one on the floor, one upright 50 mm off; on the map they are 0.4 wide, with 0.2 between.
pub(super) const SQUARES: &str = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 50 0 0\nv 50 0 10\nv 50 10 10\nv 50 10 0\n\
    vt 0 0.3\nvt .4 0.3\nvt .4 0.7\nvt 0 0.7\nvt .6 0.3\nvt 1 0.3\nvt 1 0.7\nvt .6 0.7\n\
    f 1/1 2/2 3/3 4/4\nf 5/5 6/6 7/7 8/8\n";

pub(super) fn on_mesh(mesh: &Arc<Mesh>, given: &[(&str, Value)]) -> Result<Arc<Material>, Failure> {
    let mesh = [("mesh", Value::Mesh(Arc::clone(mesh)))];
    cut(&mesh_cut::KIND, &[&mesh, given].concat())
}

pub(super) fn teapot(gutter: f64) -> Arc<Patches> {
    let given = [
        (
            "file",
            file(
                "teapot.txt",
                std::fs::read("assets/teapot/teapot.txt").unwrap(),
            ),
        ),
        ("unit", Value::Choice("mm")),
        ("up", Value::Choice("z")),
        ("inside_out", Value::Toggle(false)),
        ("gutter", Value::Number(gutter)),
    ];
    patches(built(&patches_from_file::KIND, &given).unwrap().remove(0))
}

fn patches(value: Value) -> Arc<Patches> {
    match value {
        Value::Patches(patches) => {
            assert!(patches.is_sound());
            patches
        }
        other => panic!("found a {}", other.type_name()),
    }
}

pub(super) fn on_patches(patches: &Arc<Patches>) -> Arc<Material> {
    cut(
        &patch_cut::KIND,
        &[("patches", Value::Patches(Arc::clone(patches)))],
    )
    .unwrap()
}

/// A channel of one column at points.
fn number(piece: &Material, channel: &str, points: &[[f64; 3]]) -> Vec<f32> {
    let program = Program::compile(&[piece.channels[channel].clone()]);
    let mut scratch = Scratch::default();
    program.run(&Samples::Points(points), &mut scratch, &context());
    program.output(&scratch, 0, 0)[..points.len()].to_vec()
}

#[test]
fn a_mesh_shows_the_solid_where_its_triangles_are() {
    let mesh = read("it.obj", SQUARES, &PLAIN).unwrap();
    let piece = on_mesh(&mesh, &[]).unwrap();
    // 200 mm^2 on 0.32 of the square.
    let side = 25.0;
    assert!(
        (piece.size.unwrap()[0] - side).abs() < 1e-9
            && piece.size.unwrap()[1] == piece.size.unwrap()[0]
    );
    for (u, v, expected, covered) in [
        (0.1, 0.5, [2.5, 5.0, 0.0], 1.0),
        (0.4, 0.7, [10.0, 10.0, 0.0], 1.0),
        (0.7, 0.4, [50.0, 2.5, 2.5], 1.0),
        // Beside the squares their borders go on, as far as the middle between them.
        (0.49, 0.5, [10.0, 5.0, 0.0], 0.0),
        (0.51, 0.5, [50.0, 5.0, 0.0], 0.0),
        (0.2, 1.0, [5.0, 10.0, 0.0], 0.0),
        (0.0, 0.0, [0.0, 0.0, 0.0], 0.0),
        (1.0, 0.0, [50.0, 0.0, 10.0], 0.0),
    ] {
        let at = [[u * side, v * side, 0.0]];
        let found = places(&piece, &at)[0];
        // The first square's u is along x, the second's along z.
        let expected = DVec3::from_array(expected);
        assert!(
            found.distance(expected) < 1e-4,
            "{u} {v}: {found}, not {expected}"
        );
        assert_eq!(number(&piece, "coverage", &at), [covered], "{u} {v}");
    }
}

#[test]
fn a_placed_mesh_is_cut_elsewhere_and_larger() {
    let mesh = read("it.obj", SQUARES, &PLAIN).unwrap();
    let placed = Value::Record(vec![
        ("move", Value::Vector(DVec3::new(0.0, 0.0, 100.0))),
        ("scale", Value::Vector(DVec3::splat(3.0))),
    ]);
    let piece = on_mesh(&mesh, &[("placed", placed)]).unwrap();
    assert!((piece.size.unwrap()[0] - 75.0).abs() < 1e-9);
    let found = places(&piece, &[[7.5, 37.5, 0.0]])[0];
    assert!(
        found.distance(DVec3::new(7.5, 15.0, 100.0)) < 1e-4,
        "{found}"
    );
}

#[test]
fn places_beyond_the_square_come_again_on_it() {
    let text = "v 0 0 0\nv 10 0 0\nv 0 10 0\nvt 0.8 0.2\nvt 1.4 0.2\nvt 0.8 0.8\nf 1/1 2/2 3/3\n";
    let piece = on_mesh(&read("it.obj", text, &PLAIN).unwrap(), &[]).unwrap();
    let side = piece.size.unwrap()[0];
    // u = 0.2 shows what is at u = 1.2.
    let found = places(
        &piece,
        &[
            [0.2 * side, 0.25 * side, 0.0],
            [0.9 * side, 0.25 * side, 0.0],
        ],
    );
    assert!(
        found[0].distance(DVec3::new(20.0 / 3.0, 5.0 / 6.0, 0.0)) < 1e-4,
        "{found:?}"
    );
    assert!(
        found[1].distance(DVec3::new(10.0 / 6.0, 5.0 / 6.0, 0.0)) < 1e-4,
        "{found:?}"
    );
}

#[test]
fn meshes_and_materials_that_cannot_be_cut_are_refused() {
    let flat = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/2 3/1\n";
    let failure = on_mesh(&read("it.obj", flat, &PLAIN).unwrap(), &[]).unwrap_err();
    assert_eq!(
        failure.message,
        "the triangles of the mesh have no area on its square"
    );
    let mut without = (*read("it.obj", flat, &PLAIN).unwrap()).clone();
    without.coordinates.clear();
    let failure = on_mesh(&Arc::new(without), &[]).unwrap_err();
    assert_eq!(
        failure.message,
        "the mesh has no places on a square, so nothing says how a map lies on it"
    );
    let Value::Material(solid) = where_one_is() else {
        unreachable!()
    };
    let mut solid = (*solid).clone();
    solid
        .channels
        .insert("coverage".to_owned(), Field::constant(1.0));
    let mesh = read("it.obj", SQUARES, &PLAIN).unwrap();
    let given = [
        ("mesh", Value::Mesh(mesh)),
        ("of", Value::Material(Arc::new(solid))),
    ];
    let failure = built(&mesh_cut::KIND, &given).unwrap_err();
    assert_eq!(
        failure.message,
        "the material has a channel `coverage`, which the cut makes"
    );
}

/// De Casteljau's construction of a cubic.
fn casteljau(points: [DVec3; 4], at: f64) -> DVec3 {
    let mut points = points.to_vec();
    while points.len() > 1 {
        points = points
            .windows(2)
            .map(|pair| pair[0].lerp(pair[1], at))
            .collect();
    }
    points[0]
}

#[test]
fn the_teapot_is_cut_on_its_patches_exactly() {
    let text = std::fs::read_to_string("assets/teapot/teapot.txt").unwrap();
    let numbers: Vec<f64> = text
        .split([',', '\n', '\r'])
        .filter_map(|word| word.trim().parse().ok())
        .collect();
    let points = &numbers[1 + 32 * 16 + 1..];
    let control = |patch: usize, index: usize| {
        let point = numbers[1 + patch * 16 + index] as usize - 1;
        DVec3::from_slice(&points[3 * point..])
    };
    let piece = on_patches(&teapot(0.02));
    let [width, height] = piece.size.unwrap();
    // 32 patches: six rows of six squares.
    assert!((width - height).abs() < 1e-9);
    let side = width / 6.0;
    for (patch, step) in (0..32).flat_map(|patch| (0..25).map(move |step| (patch, step))) {
        let [u, v] = [f64::from(step % 5) / 4.0, f64::from(step / 5) / 4.0];
        let row = |row: usize| casteljau(std::array::from_fn(|it| control(patch, 4 * row + it)), u);
        let expected = casteljau(std::array::from_fn(row), v);
        let corner = DVec2::new((patch % 6) as f64, (patch / 6) as f64);
        let at = (corner + 0.02 + 0.96 * DVec2::new(u, v)) * side;
        let found = places(&piece, &[[at.x, at.y, 0.0]])[0];
        // Where a point of the map is exact to 1e-7 of its side.
        assert!(
            found.distance(expected) < 1e-5,
            "{patch} {u} {v}: {found}, not {expected}"
        );
    }
    // In the gutter and in empty squares the nearest border goes on.
    let found = places(
        &piece,
        &[
            [0.5 * side, 0.0, 0.0],
            [5.9 * side, 5.5 * side, 0.0],
            [5.9 * side, 5.1 * side, 0.0],
        ],
    );
    let bottom = casteljau(std::array::from_fn(|it| control(0, it)), 0.5);
    assert!(found[0].distance(bottom) < 1e-5);
    // The last square, 31, is the second of its row; the one below the corner is 29.
    let top = casteljau(
        std::array::from_fn(|it| control(29, 12 + it)),
        (0.9 - 0.02) / 0.96,
    );
    assert!(
        found[1].distance(top) < 1e-5 && found[2].distance(top) < 1e-5,
        "{found:?}, not {top}"
    );
}

#[test]
fn a_mesh_of_patches_has_their_map_and_their_outside() {
    let given = [
        ("patches", Value::Patches(teapot(0.02))),
        ("divisions", Value::Whole(16)),
    ];
    let Value::Mesh(mesh) = built(&mesh_from_patches::KIND, &given).unwrap().remove(0) else {
        panic!("no mesh")
    };
    assert!(mesh.is_sound());
    // The pot without a bottom would not do, but Newell's has one since Crow 1987; outside is outside.
    assert!(six_volumes(&mesh) > 0.0, "{}", six_volumes(&mesh));
    let charts = mesh.triangles.iter().map(|it| it.chart).max().unwrap() + 1;
    assert_eq!(charts, 32);
    let (from_mesh, from_patches) = (on_mesh(&mesh, &[]).unwrap(), on_patches(&teapot(0.02)));
    let sizes = [from_mesh.size.unwrap()[0], from_patches.size.unwrap()[0]];
    // Both spread the same area: the mesh over what its triangles cover of the square.
    assert!((sizes[0] / sizes[1] - 1.0).abs() < 0.01, "{sizes:?}");
    for step in 0..400 {
        // Not at the very tips, where the triangles of a mesh leave out what has no area.
        let inside =
            DVec2::new(f64::from(step * 37 % 401), f64::from(step * 91 % 401)) / 500.0 + 0.1;
        let corner = DVec2::new(f64::from(step % 32 % 6), f64::from(step % 32 / 6));
        let at = ((corner + 0.02 + 0.96 * inside) / 6.0).to_array();
        let [a, b] = [&from_mesh, &from_patches].map(|piece| {
            let side = piece.size.unwrap()[0];
            places(piece, &[[at[0] * side, at[1] * side, 0.0]])[0]
        });
        assert!(a.distance(b) < 0.02, "{at:?}: {a} and {b}");
    }
    for (triangle, corner) in mesh
        .triangles
        .iter()
        .flat_map(|it| (0..3).map(move |corner| (it, corner)))
    {
        let normal = mesh.normals[triangle.normals[corner] as usize];
        let [p, q, r] = triangle.points.map(|index| mesh.points[index as usize]);
        assert!(normal.dot((q - p).cross(r - p).normalize()) > 0.0);
    }
}

#[test]
fn a_quarter_of_a_cylinder_is_round() {
    let row = |z: f64| {
        let corners = [[100.0, 0.0], [100.0, 100.0], [0.0, 100.0]];
        Value::List(
            corners
                .map(|[x, y]| Value::Vector(DVec3::new(x, y, z)))
                .into(),
        )
    };
    let weights = || Value::List([1.0, 1.0, 2.0].map(Value::Number).into());
    let surface = |inside_out: bool| {
        let given = [
            ("points", Value::List(vec![row(0.0), row(300.0)])),
            ("weights", Value::List(vec![weights(), weights()])),
            ("degrees", Value::Pair([2.0, 1.0])),
            ("inside_out", Value::Toggle(inside_out)),
            ("gutter", Value::Number(0.0)),
        ];
        patches(built(&nurbs_surface::KIND, &given).unwrap().remove(0))
    };
    let piece = on_patches(&surface(false));
    let [side, _] = piece.size.unwrap();
    // A quarter of the circumference times the height.
    assert!(
        (side * side / (157.079_6 * 300.0) - 1.0).abs() < 1e-3,
        "{side}"
    );
    for step in 0..=10 {
        let along = f64::from(step) / 10.0;
        let found = places(&piece, &[[along * side, 0.5 * side, 0.0]])[0];
        assert!((found.truncate().length() - 100.0).abs() < 1e-4 && (found.z - 150.0).abs() < 1e-4);
    }
    let turned = on_patches(&surface(true));
    let [a, b] = [
        places(&piece, &[[20.0, 70.0, 0.0]])[0],
        places(&turned, &[[70.0, 20.0, 0.0]])[0],
    ];
    assert!(a.distance(b) < 1e-4, "{a} {b}");
}

#[test]
fn surfaces_that_cannot_be_are_refused() {
    let row = |count: usize| {
        Value::List(
            (0..count)
                .map(|x| Value::Vector(DVec3::X * x as f64))
                .collect(),
        )
    };
    let numbers =
        |numbers: &[f64]| Value::List(numbers.iter().copied().map(Value::Number).collect());
    let refused = |rows: &[usize], more: &[(&str, Value)]| {
        let given = [
            (
                "points",
                Value::List(rows.iter().map(|count| row(*count)).collect()),
            ),
            ("degrees", Value::Pair([2.0, 1.0])),
            ("inside_out", Value::Toggle(false)),
            ("gutter", Value::Number(0.0)),
        ];
        built(&nurbs_surface::KIND, &[&given, more].concat())
            .unwrap_err()
            .message
    };
    assert_eq!(refused(&[3, 4], &[]), "row 2 has 4 items, the first has 3");
    assert_eq!(
        refused(&[2, 2], &[]),
        "degree 2 along u needs 3 control points, found 2"
    );
    assert_eq!(
        refused(&[], &[]),
        "degree 2 along u needs 3 control points, found 0"
    );
    let knots = |knots: &[f64]| refused(&[3, 3], &[("knots_u", numbers(knots))]);
    assert_eq!(
        knots(&[0.0, 1.0]),
        "3 points of degree 2 need 6 knots, found 2"
    );
    assert_eq!(
        knots(&[0.0, 0.0, 1.0, 0.0, 1.0, 1.0]),
        "knots rise, but 0 follows 1"
    );
    assert_eq!(
        knots(&[0.0; 6]),
        "the surface would have no length: knots 3 and 4 are 0 and 0"
    );
    let nearer_than_any_slope_can_tell = knots(&[0.0, 0.0, 0.0, 1e-320, 1e-320, 1e-320]);
    assert!(nearer_than_any_slope_can_tell.starts_with("the surface would have no length"));
    let weights = refused(&[3, 3], &[("weights", Value::List(vec![numbers(&[1.0])]))]);
    assert_eq!(weights, "expected 2 rows of 3 weights, found 1 of 1");
    let text = |text: &str| {
        let given = [
            ("file", file("it.txt", text)),
            ("unit", Value::Choice("mm")),
            ("up", Value::Choice("z")),
            ("inside_out", Value::Toggle(false)),
            ("gutter", Value::Number(0.0)),
        ];
        built(&patches_from_file::KIND, &given).unwrap_err().message
    };
    let ones = "1,".repeat(16);
    assert_eq!(
        text(""),
        "line 1: expected the number of patches, found the end of the file"
    );
    assert_eq!(text("0\n0\n"), "the file has no patches");
    assert_eq!(
        text("999999999\n1 2"),
        "line 2: expected the number of a control point, found the end of the file"
    );
    assert_eq!(
        text("1\n1 2 x"),
        "line 2: expected the number of a control point, found `x`"
    );
    assert_eq!(
        text("1\n1.5"),
        "line 2: expected the number of a control point, found `1.5`"
    );
    assert_eq!(
        text(&format!("1\n{ones}\n1\n0,0\n")),
        "line 4: expected a coordinate, found the end of the file"
    );
    assert_eq!(
        text(&format!("1\n{}2\n1\n0,0,0\n", "1,".repeat(15))),
        "line 2: there is no point 2: they are counted from 1 to 1"
    );
}
