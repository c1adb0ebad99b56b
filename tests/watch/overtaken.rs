//! Runs in calls that cannot be stopped: the newest state does not wait for them, and what they give is dropped.

use super::desk::{Desk, Setup, pause, recipe};
use super::files::{picture, shows};
use super::odd::{Behaviour, Odd, SLOW};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use yosegi::watch::{Options, Told};

/// A desk whose recipe shows a picture that is slow to read.
fn slow(preview: bool) -> (Arc<Odd>, Desk) {
    let world = Odd::new(Behaviour::Slow);
    let setup = Setup {
        world: Arc::<Odd>::clone(&world),
        options: Options {
            preview,
            poll: None,
        },
        ..Setup::default()
    };
    let desk = Desk::with(setup, |folder| {
        picture(&folder.join("leaf.png"), 0x102030);
        fs::write(folder.join("recipe.ron"), recipe(1)).unwrap();
    });
    desk.wait_for_render(0);
    (world, desk)
}

fn colour_of_preview(desk: &Desk) -> [u8; 3] {
    let preview = image::open(desk.at("out/tile.preview.png")).unwrap();
    preview.to_rgb8().get_pixel(0, 0).0
}

#[test]
fn what_was_overtaken_shows_and_says_nothing_any_more() {
    for preview in [true, false] {
        let (_, desk) = slow(preview);
        desk.save(&shows("leaf.png"));
        pause(150);
        let from = desk.told().len();
        desk.save(&recipe(7));
        let rendered = desk.wait_for_render(from);
        assert!(desk.shows(7));
        pause(3 * SLOW.as_millis() as u64);
        assert_eq!(desk.colour(), Some(7));
        let after = &desk.told()[rendered + 1..];
        assert!(after.is_empty(), "{after:?}");
        if preview {
            assert_eq!(colour_of_preview(&desk), [0, 0, 7]);
        }
    }
}

#[test]
fn no_more_than_one_run_is_left_behind() {
    let (world, desk) = slow(false);
    for save in 0..8 {
        desk.save(&format!("{}// {save}", shows("leaf.png")));
        pause(120);
    }
    desk.save(&recipe(9));
    assert!(desk.shows(9));
    assert!(world.most.load(Ordering::SeqCst) <= 2);
}

#[test]
fn after_an_undo_the_small_picture_is_that_of_the_old_state_again() {
    let setup = Setup {
        store: true,
        ..Setup::with_preview()
    };
    let desk = Desk::with(setup, |folder| {
        fs::write(folder.join("recipe.ron"), recipe(1)).unwrap();
    });
    let mut from = desk.wait_for_render(0);
    for colour in [2, 1, 2] {
        desk.save(&recipe(colour));
        from = desk.wait_for_render(from + 1);
        assert_eq!(desk.colour(), Some(colour));
        assert_eq!(colour_of_preview(&desk), [0, 0, colour as u8]);
    }
}

#[test]
fn a_small_picture_that_cannot_be_written_keeps_no_map_from_being_written() {
    let desk = Desk::with(Setup::with_preview(), |folder| {
        fs::create_dir_all(folder.join("out/tile.preview.png")).unwrap();
        fs::write(folder.join("recipe.ron"), recipe(3)).unwrap();
    });
    desk.wait_for(0, |told| matches!(told, Told::PreviewFailed(_)));
    assert!(desk.shows(3));
}

#[test]
fn several_recipes_are_followed_and_what_they_share_is_as_well() {
    let recipes = ["a.ron", "b.ron"].map(PathBuf::from);
    let with = |name: &str, colour| recipe(colour).replace("tile", name);
    let setup = Setup {
        recipes: recipes.to_vec(),
        ..Setup::default()
    };
    let desk = Desk::with(setup, |folder| {
        fs::write(folder.join("a.ron"), with("left", 1)).unwrap();
        fs::write(folder.join("b.ron"), with("tile", 2)).unwrap();
    });
    assert!(desk.shows(2));
    for colour in 3..8 {
        fs::write(desk.at("b.ron"), with("tile", colour)).unwrap();
        assert!(desk.shows(colour));
        fs::write(desk.at("a.ron"), with("left", colour)).unwrap();
    }
    desk.wait_for(0, |told| match told {
        Told::Rendered(rendered) => rendered
            .written
            .iter()
            .any(|it| it.ends_with("left_base_color.png")),
        _ => false,
    });
}
