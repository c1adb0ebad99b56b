//! Recipes that take long in one part of a run.

use crate::soon::Folder;
use std::fmt::Write as _;

const END: &str = "
    \"wood\": material(base_color: \"last\"),
    \"board\": slice_cut(of: \"wood\", cut: end_grain, origin: (0, 0, 0), size: (40, 40)),
}, outputs: { \"board\": maps(of: \"board\", pixels: (256, 256)) })";

pub(crate) fn chain(length: usize) -> String {
    let mut text = String::from(
        "(nodes: { \"fibre\": solid_noise(size: (5, 5, 150)),
        \"n0\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: 0.5),\n",
    );
    for index in 1..length {
        let before = index - 1;
        writeln!(
            text,
            "\"n{index}\": mix(a: \"n{before}\", b: \"#c8a06e\", amount: 0.01),"
        )
        .unwrap();
    }
    let last = length - 1;
    write!(
        text,
        "\"last\": mix(a: \"n{last}\", b: \"#000000\", amount: \"fibre.value\"),{END}"
    )
    .unwrap();
    text
}

pub(crate) fn supersampled(length: usize) -> String {
    let mut text = String::from(
        "(nodes: { \"fibre\": solid_noise(size: (5, 5, 150)),
        \"n0\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: \"fibre.value\"),\n",
    );
    for index in 1..length {
        let before = index - 1;
        writeln!(
            text,
            "\"n{index}\": mix(a: \"n{before}\", b: \"#c8a06e\", amount: \"fibre.value\"),"
        )
        .unwrap();
    }
    let last = length - 1;
    write!(
        text,
        "\"last\": mix(a: \"n{last}\", b: \"#000000\", amount: 0),{END}"
    )
    .unwrap();
    text
}

pub(crate) fn tree(folder: &Folder, rows: usize) -> String {
    let mut text = String::from("# unit: mm\nid,parent,x,y,z,radius\n");
    for index in 1..=rows {
        let parent = if index % 10 == 1 && index > 1 {
            index - 10
        } else {
            index - 1
        };
        let (x, z) = ((index % 10) as f64 * 0.1, (index / 10 * 20) as f64);
        writeln!(text, "{index},{parent},{x},0,{z},5").unwrap();
    }
    folder.write("tree.csv", text);
    format!(
        "(nodes: {{ \"tree\": skeleton_from_file(tree: \"tree.csv\"),
        \"time\": growth_field(skeleton: \"tree\", elongation: 300, thickening: 3, reach: (100, 20)),
        \"last\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: \"time.branch\"),{END}"
    )
}

pub(crate) fn branches(count: usize) -> String {
    let mut text = String::from(
        "(nodes: { \"tree\": skeleton(trunk: [(0, 0, -50), (3, 1, 900), (0, 0, 2000)], branches: [",
    );
    for index in 0..count {
        let (at, x) = (index % 1900, index % 7);
        write!(
            text,
            "(at: {at}, direction: ({x}, 1, 0.5), thickening: 0.4),"
        )
        .unwrap();
    }
    text + "]), \"time\": growth_field(skeleton: \"tree\", elongation: 300, thickening: 3, sharpness: 3),
        \"last\": mix(a: \"#5b3a1e\", b: \"#c8a06e\", amount: \"time.branch\")," + END
}

fn noise_picture() -> image::RgbImage {
    let mut state = 1u32;
    image::RgbImage::from_fn(6000, 6000, |_, _| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        image::Rgb([state >> 24, state >> 16 & 255, 60 + (state >> 29)].map(|part| part as u8))
    })
}

pub(crate) fn photograph(folder: &Folder) -> String {
    noise_picture()
        .save(folder.0.path().join("noise.png"))
        .unwrap();
    "(nodes: {
        \"picture\": image_from_file(file: \"noise.png\", size: (600, 600)),
        \"board\": material(base_color: \"picture.colour\"),
    }, outputs: { \"board\": maps(of: \"board\", size: (600, 600), pixels: (512, 512)) })"
        .to_owned()
}

pub(crate) fn pattern(folder: &Folder) -> String {
    noise_picture()
        .save(folder.0.path().join("noise.bmp"))
        .unwrap();
    format!(
        "(nodes: {{ \"year\": sample_pattern(file: \"noise.bmp\", texels: 3000),
        \"last\": pattern_lookup(time: 0.5, pattern: \"year\"),{END}"
    )
}
