//! Mesh files that are broken, cut off or strange: each is refused at its place, or read.

use super::meshes::{obj, stl_binary};
use super::*;

fn refused(path: &str, bytes: impl Into<Vec<u8>>) -> String {
    read(path, bytes, &PLAIN).unwrap_err().message
}

#[test]
fn mistakes_in_an_obj_are_found_at_their_line() {
    let points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (rest, message) in [
        (
            "f 1 2 0",
            "line 4: there is no point 0: they are counted from 1",
        ),
        (
            "f 1 2 4",
            "line 4: point 4 is not there: 3 come before this line",
        ),
        (
            "f 1 2 -4",
            "line 4: point -4 is not there: 3 come before this line",
        ),
        (
            "f 1/1 2/1 3/1",
            "line 4: place 1 is not there: 0 come before this line",
        ),
        (
            "f 1//1 2 3",
            "line 4: normal 1 is not there: 0 come before this line",
        ),
        ("f 1 2", "line 4: a face needs three corners, found 2"),
        (
            "f 1 2 x",
            "line 4: expected the number of a point, found `x`",
        ),
        (
            "f 1/2/3/4 2 3",
            "line 4: place 2 is not there: 0 come before this line",
        ),
        (
            "f 1 2 99999999999999999999",
            "line 4: expected the number of a point, found `99999999999999999999`",
        ),
        (
            "\n\nv 1 nan 0",
            "line 6: expected a finite number, found `nan`",
        ),
        (
            "v 1 1e999 0",
            "line 4: expected a finite number, found `1e999`",
        ),
        ("v 1 2", "line 4: expected 3 numbers, found 2"),
        ("", "the file has no triangle with an area"),
        ("f 1 1 2", "the file has no triangle with an area"),
        (
            "v 1e12 0 0\nf 1 2 4",
            "a point is at [1000000000000, 0, 0] mm; the farthest is 1000000000 mm off",
        ),
    ] {
        assert_eq!(
            refused("it.obj", format!("{points}{rest}\n")),
            message,
            "{rest}"
        );
    }
}

#[test]
fn odd_files_are_read_as_they_are_meant() {
    let whole = read("cube.obj", obj(), &PLAIN).unwrap();
    let marked = [b"\xef\xbb\xbf".to_vec(), obj().into_bytes()].concat();
    let latin = [
        b"mtllib ../../secret\no caf\xe9\n# caf\xe9\n".to_vec(),
        obj().into_bytes(),
    ]
    .concat();
    let remark = obj().replace("f ", "# f 0 0\nf ");
    for bytes in [
        marked,
        latin,
        remark.into_bytes(),
        obj().replace('\n', "\r\n").into_bytes(),
    ] {
        assert_eq!(read("cube.obj", bytes, &PLAIN).unwrap(), whole);
    }
    let polygon = |count: usize| {
        let angle = |it: usize| it as f64 * std::f64::consts::TAU / count as f64;
        let points =
            (0..count).map(|it| format!("v {} {} 0\n", libm::cos(angle(it)), libm::sin(angle(it))));
        let corners = (1..=count).map(|it| format!(" {it}"));
        points.collect::<String>() + "f" + &corners.collect::<String>() + "\n"
    };
    let mesh = read("it.obj", polygon(5000), &PLAIN).unwrap();
    assert!((six_volumes(&read("it.obj", obj(), &PLAIN).unwrap()) - 6.0).abs() < 1e-12);
    assert_eq!(mesh.triangles.len(), 4998);
    assert_eq!(
        refused("it.obj", polygon(200_000)),
        "line 200001: a face has 200000 corners; the most is 100000"
    );
}

#[test]
fn mistakes_in_an_stl_are_found_at_their_place() {
    let whole = stl_binary(b"");
    let length = whole.len();
    let cut = refused("it.stl", &whole[..length - 1]);
    assert_eq!(
        cut,
        "the file says it has 12 triangles, but ends at byte 683 after 11"
    );
    let mut huge = whole.clone();
    huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let message = refused("it.stl", huge);
    assert_eq!(
        message,
        "the file says it has 4294967295 triangles, but ends at byte 684 after 12"
    );
    let mut nan = whole;
    nan[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(
        refused("it.stl", nan),
        "triangle 2 at byte 134 has a corner that is not finite"
    );
    let few = refused("it.stl", "sol");
    assert_eq!(
        few,
        "the file has 3 bytes; a binary STL has at least 84, and one of text begins with `solid`"
    );
    for (text, message) in [
        (
            "solid\nouter loop\nvertex 0 0 0\nendloop",
            "line 4: a triangle has 1 corners",
        ),
        (
            "solid\nouter loop\nvertex 0 0 nan",
            "line 3: expected a finite number, found `nan`",
        ),
        (
            "solid\nouter loop\nvertex 0 0 0\n",
            "line 4: the file ends inside a triangle",
        ),
        (
            "solid\nvertex 0 0 0",
            "line 2: expected a word of an STL file, found `vertex`",
        ),
        (
            "solid it\nendsolid it",
            "the file has no triangle with an area",
        ),
    ] {
        assert_eq!(refused("it.stl", text), message, "{text}");
    }
}

#[test]
fn places_of_another_size_than_the_square_are_no_map() {
    for places in [
        "vt -1e300 0\nvt -1e300 1\nvt -2e300 0",
        "vt 0 0\nvt 1e-30 0\nvt 0 1e-30",
    ] {
        let text = format!("v 0 0 0\nv 10 0 0\nv 0 10 0\n{places}\nf 1/1 2/2 3/3\n");
        let mesh = read("it.obj", text, &PLAIN).unwrap();
        let failure = super::surfaces::on_mesh(&mesh, &[]).unwrap_err();
        assert_eq!(
            failure.message,
            "the places of the mesh are of another size than the square: its map would have no usable scale"
        );
    }
}

/// Bytes that are changed, cut off and put together anew are read or refused: nothing else happens.
#[test]
fn broken_files_never_stop_the_program() {
    let files = [
        ("it.obj", obj().replace("v ", "vt 0.1 0.2\nv ").into_bytes()),
        ("it.stl", stl_binary(b"solid")),
        ("it.stl", b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n".to_vec()),
    ];
    let mut random = 1u64;
    let mut next = |below: usize| {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) as usize % below.max(1)
    };
    let (mut good, mut bad) = (0, 0);
    for round in 0..6000 {
        let (path, bytes) = &files[round % files.len()];
        let mut bytes = bytes.clone();
        for _ in 0..=next(4) {
            let at = next(bytes.len());
            match next(4) {
                0 => bytes[at] = next(256) as u8,
                1 => bytes.truncate(at.max(1)),
                2 => bytes[at] = b"0123456789-/. \n"[next(15)],
                _ => {
                    let part = bytes[at..(at + next(40)).min(bytes.len())].to_vec();
                    let to = next(bytes.len());
                    bytes.splice(to..to, part);
                }
            }
        }
        match read(path, bytes, &PLAIN) {
            Ok(_) => good += 1,
            Err(_) => bad += 1,
        }
    }
    assert!(good > 500 && bad > 500, "{good} read, {bad} refused");
}
