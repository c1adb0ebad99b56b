//! Meshes from well-formed files: the same shape in every form, normals, charts, box unwraps without overlaps.

use super::*;
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;

/// The corners of the unit cube by their bits, and its sides as squares seen from outside.
const SQUARES: [[usize; 4]; 6] = [
    [1, 3, 7, 5],
    [0, 4, 6, 2],
    [2, 6, 7, 3],
    [0, 1, 5, 4],
    [4, 5, 7, 6],
    [0, 2, 3, 1],
];

fn corner(index: usize) -> [f64; 3] {
    [0, 1, 2].map(|bit| (index >> bit & 1) as f64)
}

fn triangles() -> Vec<[[f64; 3]; 3]> {
    let halves = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]];
    let all = SQUARES.into_iter().flat_map(halves);
    all.map(|triangle| triangle.map(corner)).collect()
}

fn stl_text() -> String {
    let mut text = "solid cube\n".to_owned();
    for triangle in triangles() {
        text += "facet normal 0 0 0\n outer loop\n";
        for [x, y, z] in triangle {
            text += &format!("  vertex {x} {y} {z}\n");
        }
        text += " endloop\nendfacet\n";
    }
    text + "endsolid cube\n"
}

pub(super) fn stl_binary(head: &[u8]) -> Vec<u8> {
    let mut bytes = [head, &[0; 80]].concat();
    bytes.truncate(80);
    bytes.extend(12u32.to_le_bytes());
    for triangle in triangles() {
        bytes.extend([0; 12]);
        for part in triangle.as_flattened() {
            bytes.extend((*part as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

pub(super) fn obj() -> String {
    let points = (0..8).map(corner);
    let points = points.map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = SQUARES.map(|corners| corners.map(|index| (index + 1).to_string()).join(" "));
    let faces = faces.map(|corners| format!("f {corners}\n"));
    points.chain(faces).collect()
}

#[test]
fn a_cube_is_the_same_in_every_form() {
    // A binary file may begin as a text does.
    let files = [
        ("cube.stl", stl_text().into_bytes()),
        ("cube.stl", stl_text().to_uppercase().into_bytes()),
        (
            "cube.stl",
            [b"\xef\xbb\xbf", stl_text().as_bytes()].concat(),
        ),
        ("cube.stl", stl_text().replace('\n', "\r\n").into_bytes()),
        ("cube.stl", stl_binary(b"made by hand")),
        ("cube.stl", stl_binary(b"solid, but binary")),
        ("cube.obj", obj().into_bytes()),
        ("cube.obj", obj().replace(" 2", " \\\n2").into_bytes()),
        ("cube", obj().into_bytes()),
        ("cube", stl_binary(b"")),
    ];
    for (number, (path, bytes)) in files.into_iter().enumerate() {
        let mesh = read(path, bytes, &PLAIN).unwrap();
        assert_eq!(
            (mesh.points.len(), mesh.triangles.len()),
            (8, 12),
            "{number}"
        );
        assert!((six_volumes(&mesh) - 6.0).abs() < 1e-12, "{number}");
        // Edges of 90 degrees stay sharp: six normals, along the axes.
        assert_eq!(mesh.normals.len(), 6, "{number}");
        let charts: BTreeSet<u32> = mesh.triangles.iter().map(|it| it.chart).collect();
        assert_eq!(charts.into_iter().collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5]);
    }
}

#[test]
fn units_and_axes_are_those_of_the_file() {
    for (unit, length) in [("mm", 1.0), ("cm", 10.0), ("m", 1000.0), ("inch", 25.4)] {
        let mesh = read("cube.obj", obj(), &Reading { unit, ..PLAIN }).unwrap();
        let farthest = mesh
            .points
            .iter()
            .map(|point| point.length())
            .fold(0.0, f64::max);
        assert!(
            (farthest - length * 3f64.sqrt()).abs() < 1e-9 * length,
            "{unit}"
        );
    }
    let text = "v 0 0 0\nv 1 0 0\nv 0 2 0\nvn 0 1 0\nf 1//1 2//1 3//1\n";
    let mesh = read("it.obj", text, &Reading { up: "y", ..PLAIN }).unwrap();
    assert_eq!(mesh.points[2], DVec3::new(0.0, 0.0, 2.0));
    assert_eq!(mesh.normals, [DVec3::Z]);
}

#[test]
fn smoothing_weighs_faces_by_their_angle_and_stops_at_creases() {
    let smooth = Reading {
        crease: 180.0,
        ..PLAIN
    };
    let mesh = read("cube.obj", obj(), &smooth).unwrap();
    // Whichever way the squares are divided, a corner's normal is along its diagonal.
    for triangle in &mesh.triangles {
        for (point, normal) in triangle.points.into_iter().zip(triangle.normals) {
            let outwards = (mesh.points[point as usize] - 0.5).normalize();
            assert!(mesh.normals[normal as usize].distance(outwards) < 1e-12);
        }
    }
    let with_normals = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nf 1//1 2//1 3//1\n";
    let kept = read("it.obj", with_normals, &PLAIN).unwrap();
    assert!(kept.normals[0].distance(DVec3::new(0.0, 0.6, 0.8)) < 1e-12);
    let anew = Reading {
        normals: "smooth",
        ..PLAIN
    };
    assert_eq!(
        read("it.obj", with_normals, &anew).unwrap().normals,
        [DVec3::Z]
    );
}

#[test]
fn faces_may_be_hollow_and_counted_from_the_end() {
    // An arrow whose third corner is a dent: a fan from the first corner would reach beyond it.
    let text = "v 0 0 5\nv 4 0 5\nv 1 1 5\nv 0 4 5\nf -4 -3 -2 -1\n";
    let mesh = read("it.obj", text, &PLAIN).unwrap();
    let area = |points: [u32; 3]| {
        let [a, b, c] = points.map(|index| mesh.points[index as usize]);
        0.5 * (b - a).cross(c - a).z
    };
    let areas: Vec<f64> = mesh.triangles.iter().map(|it| area(it.points)).collect();
    assert!(areas.iter().all(|area| *area > 0.0));
    assert!((areas.iter().sum::<f64>() - 4.0).abs() < 1e-12);
}

#[test]
fn parts_are_chosen_by_group_object_or_material() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no bench\ng seat top\nusemtl wood\nf 1 2 3\ng legs\nusemtl iron\n\
                f 1 2 4\nusemtl wood\nf 1 3 4\n";
    for (part, count) in [
        ("seat", 1),
        ("top", 1),
        ("bench", 3),
        ("wood", 2),
        ("iron", 1),
    ] {
        let parts = vec![Value::Text(part.to_owned())];
        let mesh = read("it.obj", text, &Reading { parts, ..PLAIN }).unwrap();
        assert_eq!(mesh.triangles.len(), count, "{part}");
    }
    let parts = vec![Value::Text("wod".to_owned())];
    let failure = read("it.obj", text, &Reading { parts, ..PLAIN }).unwrap_err();
    assert_eq!(failure.message, "the file has no part `wod`");
    assert_eq!(
        failure.hint.unwrap(),
        "did you mean `wood`? it has bench, iron, legs, seat, top, wood"
    );
}

#[test]
fn charts_of_a_file_end_where_places_part() {
    // Two squares side by side in space, apart on the square; and the two halves of each together.
    let text = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n\
                vt 0 0\nvt .4 0\nvt .4 .4\nvt 0 .4\nvt .6 0\nvt 1 0\nvt 1 .4\nvt .6 .4\n\
                f 1/1 2/2 5/3 4/4\nf 2/5 3/6 6/7 5/8\n";
    let mesh = read("it.obj", text, &PLAIN).unwrap();
    let charts: Vec<u32> = mesh.triangles.iter().map(|it| it.chart).collect();
    assert_eq!(charts, [0, 0, 1, 1]);
    let joined = text.replace("2/5", "2/2").replace("5/8", "5/3");
    let mesh = read("it.obj", joined, &PLAIN).unwrap();
    assert!(mesh.triangles.iter().all(|it| it.chart == 0));
}

fn places(mesh: &Mesh, triangle: usize) -> [DVec2; 3] {
    mesh.triangles[triangle]
        .coordinates
        .map(|index| mesh.coordinates[index as usize])
}

fn area(corners: [DVec2; 3]) -> f64 {
    0.5 * (corners[1] - corners[0]).perp_dot(corners[2] - corners[0])
}

/// How often each sample of a fine grid is covered: once at most, whatever the shape.
fn most_covered(mesh: &Mesh) -> usize {
    const SIDE: usize = 1500;
    let mut counts = vec![0u8; SIDE * SIDE];
    for triangle in 0..mesh.triangles.len() {
        let corners = places(mesh, triangle);
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        let cells =
            |low: f64, high: f64| (low * SIDE as f64) as usize..=(high * SIDE as f64) as usize;
        for (x, y) in cells(low.x, high.x).flat_map(|x| cells(low.y, high.y).map(move |y| (x, y))) {
            let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / SIDE as f64;
            let inside = |side: usize| area([corners[side], corners[(side + 1) % 3], at]) > 1e-12;
            counts[y * SIDE + x] += u8::from((0..3).all(inside));
        }
    }
    usize::from(counts.into_iter().max().unwrap())
}

/// A ramp that winds round and round above itself, seen from above on one spot.
fn winding_ramp() -> String {
    let point = |step: i32, radius: f64| {
        let angle = f64::from(step) * 0.4;
        format!(
            "v {} {} {}\n",
            radius * libm::cos(angle),
            radius * libm::sin(angle),
            0.1 * f64::from(step)
        )
    };
    let points: String = (0..60)
        .flat_map(|step| [point(step, 1.0), point(step, 2.0)])
        .collect();
    let faces = (0..59).map(|it| {
        let first = 2 * it + 1;
        format!(
            "f {} {} {}\nf {} {} {}\n",
            first,
            first + 1,
            first + 3,
            first,
            first + 3,
            first + 2
        )
    });
    points + &faces.collect::<String>()
}

#[test]
fn a_box_unwrap_has_one_scale_and_no_overlaps() {
    let spot = std::fs::read("assets/spot/spot.obj").unwrap();
    let unwrapped = Reading {
        places: "box",
        ..PLAIN
    };
    for (name, bytes) in [
        ("cube", obj().into_bytes()),
        ("ramp", winding_ramp().into()),
        ("spot", spot),
    ] {
        let mesh = read("it.obj", bytes, &unwrapped).unwrap();
        assert_eq!(most_covered(&mesh), 1, "{name}");
        assert!(
            mesh.coordinates
                .iter()
                .all(|it| it.min_element() > 0.0 && it.max_element() < 1.0)
        );
        let mut scales = vec![];
        for (index, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = triangle.points.map(|point| mesh.points[point as usize]);
            let facing = (b - a).cross(c - a).abs().max_element();
            if facing > 1e-6 {
                scales.push(2.0 * area(places(&mesh, index)) / facing);
            }
        }
        // Areas along the axis that a triangle faces most are to one scale, and none is mirrored.
        let apart = scales
            .iter()
            .map(|scale| (scale / scales[0] - 1.0).abs())
            .fold(0.0, f64::max);
        assert!(apart < 1e-6, "{name}: {apart}");
        let again = read(
            "it.obj",
            match name {
                "ramp" => winding_ramp(),
                _ => obj(),
            },
            &unwrapped,
        )
        .unwrap();
        assert!(name == "spot" || *again == *mesh, "{name}");
    }
}

#[test]
fn spot_has_the_charts_of_her_author() {
    let spot = std::fs::read("assets/spot/spot.obj").unwrap();
    let mesh = read("spot.obj", spot, &PLAIN).unwrap();
    assert_eq!((mesh.points.len(), mesh.triangles.len()), (2930, 5856));
    assert!(six_volumes(&mesh) > 0.0);
    let charts = mesh.triangles.iter().map(|it| it.chart).max().unwrap() + 1;
    assert!((2..100).contains(&charts), "{charts}");
}
