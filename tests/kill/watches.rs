//! A watch is killed at random moments while its recipe changes all the time.

use super::place::{Place, Tally, VARIANTS};
use super::{Dice, number};
use std::fs;
use std::thread;
use std::time::Duration;

/// The longest time in ms from the start to the kill.
const LONGEST: u64 = 400;

fn campaign(kills: u64) -> Tally {
    let seed = number("YOSEGI_SEED", 4);
    let (place, mut dice) = (Place::new(), Dice(seed));
    let mut tally = Tally::default();
    for _ in 0..kills {
        if dice.throw(2) == 0 {
            // There may be none yet.
            let _ = fs::remove_dir_all(place.path("store"));
        }
        let before = place.maps();
        let child = place.watch().spawn().unwrap();
        let mut left = dice.throw(LONGEST);
        let mut variants = vec![];
        while left > 0 {
            let variant = dice.throw(VARIANTS.len() as u64) as usize;
            place.save(variant);
            variants.push(variant);
            let pause = left.min(dice.throw(80));
            thread::sleep(Duration::from_millis(pause));
            left -= pause;
        }
        // The recipe that was there before the first save counts as well.
        let all: Vec<usize> = (0..VARIANTS.len()).collect();
        let is_late = place.kill(child, &before, &all, &mut tally);
        assert!(!is_late, "the watch has ended by itself");
        let last = variants.last().copied().unwrap_or_default();
        place.start_again(last);
    }
    println!("watches, seed {seed}: {tally:?}, 0 torn maps, 0 wrong hits, 0 left over");
    tally
}

#[test]
fn a_watch_that_is_killed_tears_nothing_and_leaves_nothing() {
    assert_eq!(campaign(5).kills, 5);
}

#[test]
#[ignore = "a campaign"]
fn five_hundred_watches_that_are_killed_tear_nothing_and_leave_nothing() {
    let tally = campaign(number("YOSEGI_WATCH_KILLS", 500));
    assert!(tally.in_outputs > 0, "{tally:?}");
}
