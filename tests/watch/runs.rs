//! Runs that are overtaken, small pictures, and how a watch ends.

use super::desk::{Desk, Setup, pause, recipe, wait_until};
use std::fs;
use std::time::{Duration, Instant};
use yosegi::engine::Event;
use yosegi::watch::Told;

/// A map that takes a while: `pixels` on each side, of noise in the colour.
fn slow(pixels: u32, seed: u32) -> String {
    format!(
        r##"(
    seed: {seed},
    nodes: {{
        "rough": solid_noise(size: (3, 3, 3), octaves: 8),
        "tint": mix(a: "#000000", b: "#ffffff", amount: "rough"),
        "wood": material(base_color: "tint"),
        "piece": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (400, 400)),
    }},
    outputs: {{
        "tile": maps(of: "piece", pixels: ({pixels}, {pixels}), channels: [base_color]),
    }},
)"##
    )
}

#[test]
fn a_thousand_edits_in_a_second_end_with_the_last_one() {
    let desk = Desk::new();
    assert!(desk.shows(1));
    for colour in 2..1002 {
        desk.save(&recipe(colour));
        if colour % 10 == 0 {
            pause(10);
        }
    }
    assert!(desk.shows(1001));
    pause(400);
    assert_eq!(desk.colour(), Some(1001));
    assert_eq!(desk.count(|told| matches!(told, Told::Failed(_))), 0);
}

#[test]
fn an_edit_stops_the_run_and_the_newest_state_wins() {
    let desk = Desk::with(Setup::default(), |folder| {
        fs::write(folder.join("recipe.ron"), slow(3000, 1)).unwrap();
    });
    for colour in 1..6 {
        let from = desk.told().len();
        desk.save(&slow(3000, 10 + colour));
        desk.wait_for(from, |told| {
            matches!(told, Told::Run(Event::Progress { .. }))
        });
        desk.save(&recipe(colour));
        assert!(desk.shows(colour));
    }
    pause(500);
    assert_eq!(desk.colour(), Some(5));
    // The slow maps were never finished.
    assert!(desk.count(|told| matches!(told, Told::Rendered(_))) <= 5);
}

#[test]
fn small_pictures_come_first_and_never_replace_the_map() {
    let desk = Desk::with(Setup::with_preview(), |folder| {
        fs::write(folder.join("recipe.ron"), slow(1500, 1)).unwrap();
    });
    let previewed = desk.wait_for(0, |told| matches!(told, Told::Previewed { .. }));
    let preview = image::open(desk.at("out/tile.preview.png")).unwrap();
    // Each is twice as wide as the one before, however many there was time for.
    let widths = [32, 64, 128, 256, 512];
    assert!(widths.contains(&preview.width()), "{}", preview.width());
    let rendered = desk.wait_for_render(0);
    assert!(previewed < rendered);
    let map = image::open(desk.at("out/tile_base_color.png")).unwrap();
    assert_eq!(map.width(), 1500);
    let names = fs::read_dir(desk.at("out")).unwrap();
    assert_eq!(names.count(), 2);
}

#[test]
fn the_small_picture_goes_on_while_edits_come_faster_than_maps() {
    let desk = Desk::with(Setup::with_preview(), |folder| {
        fs::write(folder.join("recipe.ron"), slow(4000, 0)).unwrap();
    });
    let previews = || desk.count(|told| matches!(told, Told::Previewed { .. }));
    let mut seeds = 1..;
    let two_came = wait_until(|| {
        desk.save(&slow(4000, seeds.next().expect("there are enough numbers")));
        pause(50);
        previews() >= 2
    });
    assert!(two_came, "{}", previews());
    desk.save(&recipe(5));
    assert!(desk.shows(5));
}

#[test]
fn it_says_what_ran_and_what_was_there_already() {
    let text = |colour: &str| {
        format!(
            r##"(
    nodes: {{
        "tree": skeleton(trunk: [(0, 0, 0), (10, 4, 600), (0, 0, 1200)]),
        "time": growth_field(skeleton: "tree", elongation: 300, thickening: 3),
        "year": colour_pattern(stops: [(at: 0, colour: "{colour}"), (at: 1, colour: "#9a6438")]),
        "look": pattern_lookup(time: "time", pattern: "year"),
        "wood": material(base_color: "look"),
        "plank": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (120, 100)),
    }},
    outputs: {{ "tile": maps(of: "plank", pixels: (48, 40)) }},
)"##
        )
    };
    let setup = Setup {
        store: true,
        ..Setup::default()
    };
    let desk = Desk::with(setup, |folder| {
        fs::write(folder.join("recipe.ron"), text("#e8c99b")).unwrap();
    });
    let first = desk.wait_for_render(0);
    desk.save(&text("#ffffff"));
    let second = desk.wait_for_render(first + 1);
    desk.save(&format!("{}// nothing new", text("#ffffff")));
    let third = desk.wait_for_render(second + 1);
    let told = desk.told();
    let [
        Told::Rendered(first),
        Told::Rendered(second),
        Told::Rendered(third),
    ] = [&told[first], &told[second], &told[third]]
    else {
        unreachable!("they were found")
    };
    assert_eq!(first.ran, ["look", "plank", "time", "tree", "year"]);
    assert_eq!(second.ran, ["look", "year"]);
    assert_eq!(second.reused, ["time", "tree"]);
    assert_eq!(second.written.len(), 1);
    assert_eq!((&*third.ran, third.up_to_date.len()), (&[][..], 1));
    assert!(third.written.is_empty() && third.restored.is_empty());
}

#[test]
fn two_watches_of_one_recipe_are_both_right() {
    let desk = Desk::new();
    let other = desk.beside(Setup::default());
    for colour in 2..8 {
        desk.save(&recipe(colour));
        assert!(desk.shows(colour));
    }
    // The slower one may write the same map again, and nothing older.
    pause(300);
    assert_eq!(desk.colour(), Some(7));
    drop(other);
    desk.save(&recipe(8));
    assert!(desk.shows(8));
}

#[test]
fn it_ends_at_once_in_the_middle_of_a_run() {
    let desk = Desk::with(Setup::default(), |folder| {
        fs::write(folder.join("recipe.ron"), slow(8000, 1)).unwrap();
    });
    assert!(wait_until(|| desk
        .count(|told| matches!(told, Told::Run(_)))
        > 0));
    let start = Instant::now();
    let folder = desk.at("out");
    let before: Vec<_> = fs::read_dir(&folder).into_iter().flatten().collect();
    drop(desk);
    // Half a second is meant; a machine that is busy may take longer.
    assert!(start.elapsed() < Duration::from_secs(10), "{before:?}");
}
