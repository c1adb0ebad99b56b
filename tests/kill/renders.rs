//! The program is killed at random moments of a render.

use super::place::{Place, Tally, VARIANTS};
use super::{Dice, number};
use std::fs;
use std::thread;
use std::time::{Duration, Instant};

/// How much a run finds in the store.
#[derive(Clone, Copy, Debug)]
pub(super) enum Work {
    /// Nothing: it paints, writes maps and fills the store.
    All,
    /// All: it copies maps into place.
    Restore,
}

impl Work {
    /// Makes the store what the work needs.
    pub(super) fn prepare(self, place: &Place, variant: usize) {
        match self {
            Work::All => {
                // There may be none yet.
                let _ = fs::remove_dir_all(place.path("store"));
            }
            Work::Restore => {
                let elsewhere = place.render(variant).args(["-o", "elsewhere"]).status();
                assert!(elsewhere.unwrap().success());
            }
        }
    }

    /// How long a run takes that is not killed: the median of five.
    pub(super) fn time(self, place: &Place) -> Duration {
        let mut times = [0, 1, 2, 3, 0].map(|variant| {
            self.prepare(place, variant);
            let start = Instant::now();
            assert!(place.render(variant).status().unwrap().success());
            start.elapsed()
        });
        times.sort();
        times[2]
    }
}

fn campaign(kills: u64) -> Tally {
    let seed = number("YOSEGI_SEED", 4);
    let (place, mut dice) = (Place::new(), Dice(seed));
    let mut times = [Work::All, Work::Restore].map(|work| (work, work.time(&place)));
    let mut tally = Tally::default();
    for _ in 0..kills {
        let (work, time) = &mut times[dice.throw(3) as usize / 2];
        let variant = dice.throw(VARIANTS.len() as u64) as usize;
        work.prepare(&place, variant);
        let before = place.maps();
        let child = place.render(variant).spawn().unwrap();
        let delay = dice.throw(time.as_micros().max(1) as u64);
        thread::sleep(Duration::from_micros(delay));
        let is_late = place.kill(child, &before, &[variant], &mut tally);
        // Other programs share the machine, more of them or fewer as time goes by.
        *time = time.mul_f64(if is_late { 0.96 } else { 1.01 });
        // The same maps, or others that share structures with them.
        let next = [variant, dice.throw(VARIANTS.len() as u64) as usize];
        place.start_again(next[dice.throw(2) as usize]);
    }
    println!("renders, seed {seed}: {tally:?}, 0 torn maps, 0 wrong hits, 0 left over");
    tally
}

#[test]
fn kills_tear_nothing_and_leave_nothing() {
    assert_eq!(campaign(12).kills, 12);
}

#[test]
#[ignore = "a campaign"]
fn two_thousand_kills_tear_nothing_and_leave_nothing() {
    let tally = campaign(number("YOSEGI_KILLS", 2000));
    assert!(tally.in_outputs > 0 && tally.in_store > 0, "{tally:?}");
}
