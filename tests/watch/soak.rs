//! Every way of saving in every kind of folder: no save is missed, and the last one stays.

use super::desk::{Desk, Setup, pause, recipe};
use super::saves::{Situation, Style};
use std::time::{Duration, Instant};
use yosegi::watch::Told;

/// What came of many saves.
#[derive(Debug, Default)]
struct Figures {
    saves: usize,
    missed: usize,
    stale: usize,
    failures: usize,
    /// Whether it fell back to looking again and again.
    polling: usize,
    /// From the end of a save to the map in its place, in seconds.
    slowest: f64,
}

/// Saves `saves` times in each style.
fn soak(situation: Situation, saves: u32, longest: Duration) -> Figures {
    let setup = Setup {
        recipes: vec![situation.recipe()],
        output: situation.output().into(),
        ..Setup::default()
    };
    let desk = Desk::with(setup, |folder| situation.lay(folder, &recipe(1)));
    assert!(desk.shows_at(situation.output(), 1));
    let mut figures = Figures::default();
    let saved = desk.folder.path().join(situation.saved());
    for (number, style) in (1..).zip(Style::ALL) {
        for save in 0..saves {
            let colour = number << 16 | (save + 1);
            // Short pauses and long ones, in no simple rhythm.
            let share = f64::from(save * 7919 % 101) / 100.0;
            style.save(&saved, &recipe(colour), longest.mul_f64(share * share));
            let start = Instant::now();
            figures.saves += 1;
            if !desk.shows_at(situation.output(), colour) {
                figures.missed += 1;
                println!("{situation:?} {style:?}: save {save} was missed");
            }
            figures.slowest = figures.slowest.max(start.elapsed().as_secs_f64());
        }
        // Nothing older comes after the newest.
        pause(300);
        let last = number << 16 | saves;
        figures.stale += usize::from(!desk.shows_at(situation.output(), last));
    }
    figures.failures = desk.count(|told| matches!(told, Told::Failed(_)));
    figures.polling = desk.count(|told| matches!(told, Told::Polling { .. }));
    figures
}

fn soak_all(saves: u32, longest: Duration) -> Vec<Figures> {
    let all: Vec<(Situation, Figures)> = std::thread::scope(|scope| {
        let threads = Situation::ALL.map(|situation| {
            (
                situation,
                scope.spawn(move || soak(situation, saves, longest)),
            )
        });
        threads
            .into_iter()
            .map(|(situation, thread)| (situation, thread.join().unwrap()))
            .collect()
    });
    for (situation, figures) in &all {
        println!("{situation:?}: {figures:?}");
    }
    for (situation, figures) in &all {
        assert_eq!(figures.missed + figures.stale, 0, "{situation:?}");
    }
    all.into_iter().map(|(_, figures)| figures).collect()
}

#[test]
fn no_save_is_missed() {
    soak_all(4, Duration::from_millis(60));
}

/// `cargo test --release --test watch -- --ignored --nocapture soak`
#[test]
#[ignore = "takes minutes: the whole campaign"]
fn soak_with_250_saves_of_each_style() {
    let saves = std::env::var("YOSEGI_SAVES").map_or(250, |saves| saves.parse().unwrap());
    for figures in soak_all(saves, Duration::from_secs(1)) {
        assert_eq!(figures.polling, 0);
    }
}
