//! What is followed: exactly what the last run has read or tried to read.

use super::desk::{Desk, Setup, pause, recipe, recipe_of};
use super::saves::Style;
use std::fs;
use std::path::Path;
use std::time::Duration;
use yosegi::watch::Told;

/// A recipe whose colour is that of the compound `dye`.
const DYED: &str = r#"(
    nodes: {
        "dye": dye(),
        "wood": material(base_color: "dye.colour"),
        "piece": slice_cut(of: "wood", cut: quarter_sawn, origin: (0, 0, 600), size: (40, 40)),
    },
    outputs: {
        "tile": maps(of: "piece", pixels: (8, 8), channels: [base_color]),
    },
)"#;

fn dye(colour: u32) -> String {
    format!(
        r##"(
    nodes: {{ "mixed": mix(a: "#{colour:06x}", b: "#{colour:06x}", amount: 0) }},
    outputs: {{ "colour": "mixed" }},
)"##
    )
}

pub(crate) fn picture(path: &Path, colour: u32) {
    let [_, red, green, blue] = colour.to_be_bytes();
    let image = image::RgbImage::from_pixel(64, 64, image::Rgb([red, green, blue]));
    let folder = path.parent().unwrap();
    fs::create_dir_all(folder).unwrap();
    image.save(path).unwrap();
}

/// A recipe that shows the picture `file` and nothing else.
pub(crate) fn shows(file: &str) -> String {
    format!(
        r#"(
    nodes: {{
        "photo": image_from_file(file: "{file}", size: (400, 400)),
        "wood": material(base_color: "photo.colour"),
    }},
    outputs: {{
        "tile": maps(of: "wood", size: (40, 40), pixels: (8, 8), channels: [base_color]),
    }},
)"#
    )
}

#[test]
fn compounds_are_followed_and_so_are_the_places_where_one_could_be() {
    let desk = Desk::with(Setup::default(), |folder| {
        fs::create_dir(folder.join("nodes")).unwrap();
        fs::write(folder.join("nodes/dye.ron"), dye(1)).unwrap();
        fs::write(folder.join("recipe.ron"), DYED).unwrap();
    });
    assert!(desk.shows(1));
    fs::write(desk.at("nodes/dye.ron"), dye(2)).unwrap();
    assert!(desk.shows(2));
    fs::remove_file(desk.at("nodes/dye.ron")).unwrap();
    desk.wait_for_failure(0);
    fs::write(desk.at("nodes/dye.ron"), dye(3)).unwrap();
    assert!(desk.shows(3));
}

#[test]
fn a_missing_picture_that_appears_is_used() {
    let desk = Desk::with(Setup::default(), |folder| {
        fs::write(folder.join("recipe.ron"), shows("leaf.png")).unwrap();
    });
    desk.wait_for_failure(0);
    picture(&desk.at("assets/leaf.png"), 0x102030);
    assert!(desk.shows(0x102030));
    // The recipe's folder comes before its assets.
    picture(&desk.at("leaf.png"), 0x405060);
    assert!(desk.shows(0x405060));
    fs::remove_file(desk.at("leaf.png")).unwrap();
    assert!(desk.shows(0x102030));
}

#[test]
fn what_is_no_longer_read_is_no_longer_followed() {
    let desk = Desk::with(Setup::default(), |folder| {
        picture(&folder.join("old.png"), 0x010101);
        picture(&folder.join("new.png"), 0x020202);
        fs::write(folder.join("recipe.ron"), shows("old.png")).unwrap();
    });
    let first = desk.wait_for_render(0);
    assert_eq!(desk.colour(), Some(0x010101));
    desk.save(&shows("new.png"));
    let told = desk.wait_for_render(first + 1) + 1;
    assert_eq!(desk.colour(), Some(0x020202));
    picture(&desk.at("old.png"), 0x030303);
    pause(300);
    assert_eq!(desk.told().len(), told);
    picture(&desk.at("new.png"), 0x040404);
    assert!(desk.shows(0x040404));
}

#[test]
fn touching_and_reading_and_new_modes_start_nothing() {
    let desk = Desk::new();
    assert!(desk.shows(1));
    desk.wait_for_render(0);
    let told = desk.told().len();
    let path = desk.at("recipe.ron");
    fs::File::options()
        .write(true)
        .open(&path)
        .unwrap()
        .set_modified(std::time::SystemTime::now())
        .unwrap();
    fs::read(&path).unwrap();
    Style::Rename.save(&path, &recipe(1), Duration::ZERO);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
    }
    // Longer than the interval at which all stamps are looked at.
    pause(1500);
    assert_eq!(desk.told().len(), told);
}

#[test]
fn same_size_and_same_time_are_no_disguise() {
    let desk = Desk::new();
    assert!(desk.shows(1));
    let path = desk.at("recipe.ron");
    let time = fs::metadata(&path).unwrap().modified().unwrap();
    let changed = tempfile::NamedTempFile::new_in(desk.folder.path()).unwrap();
    fs::write(changed.path(), recipe(2)).unwrap();
    changed.as_file().set_modified(time).unwrap();
    changed.persist(&path).unwrap();
    assert!(desk.shows(2));
}

#[test]
fn maps_in_the_folder_of_the_recipe_start_nothing() {
    let setup = Setup {
        output: "".into(),
        ..Setup::default()
    };
    let desk = Desk::with(setup, |folder| {
        fs::write(folder.join("recipe.ron"), recipe(1)).unwrap();
    });
    let first = desk.wait_for_render(0);
    desk.save(&recipe(2));
    desk.wait_for_render(first + 1);
    assert!(desk.shows_at("", 2));
    pause(1500);
    assert_eq!(desk.count(|told| matches!(told, Told::Rendered(_))), 2);
}

#[test]
fn a_folder_that_is_renamed_and_brought_back_is_followed_again() {
    let setup = Setup {
        recipes: vec!["work/deep/recipe.ron".into()],
        ..Setup::default()
    };
    let desk = Desk::with(setup, |folder| {
        fs::create_dir_all(folder.join("work/deep")).unwrap();
        fs::write(folder.join("work/deep/recipe.ron"), recipe(1)).unwrap();
    });
    assert!(desk.shows(1));
    for round in 1..4 {
        fs::rename(desk.at("work"), desk.at("aside")).unwrap();
        pause(30 * u64::from(round));
        fs::write(desk.at("aside/deep/recipe.ron"), recipe(10 * round)).unwrap();
        fs::rename(desk.at("aside"), desk.at("work")).unwrap();
        assert!(desk.shows(10 * round));
        fs::write(desk.at("work/deep/recipe.ron"), recipe(10 * round + 1)).unwrap();
        assert!(desk.shows(10 * round + 1));
    }
    // Another folder in its place, as after a checkout.
    fs::remove_dir_all(desk.at("work")).unwrap();
    fs::create_dir_all(desk.at("work/deep")).unwrap();
    fs::write(desk.at("work/deep/recipe.ron"), recipe(77)).unwrap();
    assert!(desk.shows(77));
    fs::write(desk.at("work/deep/recipe.ron"), recipe(78)).unwrap();
    assert!(desk.shows(78));
}

#[cfg(unix)]
#[test]
fn a_link_that_leads_elsewhere_now_is_followed() {
    use std::os::unix::fs::symlink;
    let desk = Desk::with(Setup::default(), |folder| {
        fs::write(folder.join("a.ron"), recipe(1)).unwrap();
        fs::write(folder.join("b.ron"), recipe(2)).unwrap();
        symlink("a.ron", folder.join("recipe.ron")).unwrap();
    });
    assert!(desk.shows(1));
    symlink("b.ron", desk.at("other")).unwrap();
    fs::rename(desk.at("other"), desk.at("recipe.ron")).unwrap();
    assert!(desk.shows(2));
    fs::write(desk.at("b.ron"), recipe(3)).unwrap();
    assert!(desk.shows(3));
    fs::write(desk.at("a.ron"), recipe_of("nonsense")).unwrap();
    pause(400);
    assert_eq!(desk.count(|told| matches!(told, Told::Failed(_))), 0);
}
