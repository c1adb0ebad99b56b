//! Signals at random moments: the program cleans up by itself, without a next start.

use super::heard::heard;
use super::place::{Place, VARIANTS};
use super::renders::Work;
use super::{Dice, number};
use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

#[derive(Debug, Default)]
struct Tally {
    /// Programs that had ended before.
    late: u64,
    /// Programs that had not begun to listen.
    early: u64,
    /// Programs that stopped themselves, with the time that each took.
    stopped: Vec<Duration>,
}

fn send(signal: &str, child: &Child) {
    let mut kill = Command::new("kill");
    kill.args([&format!("-{signal}"), &child.id().to_string()]);
    // It may have ended.
    let _ = kill.stderr(Stdio::null()).status();
}

/// The exit code is the one of the signal, unless the program had ended, or had not begun.
fn count(status: ExitStatus, signal: i32, time: Duration, tally: &mut Tally) {
    match (status.code(), status.signal()) {
        (Some(0), _) => tally.late += 1,
        (Some(code), _) => {
            assert_eq!(code, 128 + signal);
            tally.stopped.push(time);
        }
        (None, killed) => {
            assert_eq!(killed, Some(signal));
            tally.early += 1;
        }
    }
}

fn campaign(signals: u64) -> Tally {
    let seed = number("YOSEGI_SEED", 4);
    let (place, mut dice) = (Place::new(), Dice(seed));
    let time = Work::All.time(&place).as_micros() as u64;
    let (mut tally, heard) = (Tally::default(), heard());
    for _ in 0..signals {
        let variant = dice.throw(VARIANTS.len() as u64) as usize;
        Work::All.prepare(&place, variant);
        let before = place.maps();
        let is_watch = dice.throw(4) == 0;
        place.save(variant);
        let mut program = if is_watch {
            place.watch()
        } else {
            place.render(variant)
        };
        let mut child = program.spawn().unwrap();
        thread::sleep(Duration::from_micros(dice.throw(time)));
        let (name, signal) = heard[dice.throw(heard.len() as u64) as usize];
        let start = Instant::now();
        send(name, &child);
        let status = child.wait().unwrap();
        count(status, signal, start.elapsed(), &mut tally);
        place.look(&before, &[variant]);
        let left = place.unfinished("out") + place.unfinished("store");
        assert_eq!(left, 0, "unfinished files after {name}");
        place.start_again(variant);
    }
    tally
}

#[test]
fn a_signal_at_any_moment_leaves_nothing_unfinished() {
    let tally = campaign(8);
    let all = tally.late + tally.early + tally.stopped.len() as u64;
    assert_eq!(all, 8, "{tally:?}");
}

#[test]
#[ignore = "a campaign"]
fn five_hundred_signals_leave_nothing_unfinished() {
    let mut tally = campaign(number("YOSEGI_SIGNALS", 500));
    let (late, early) = (tally.late, tally.early);
    tally.stopped.sort();
    let stopped = tally.stopped.len();
    let [middle, most] = [stopped / 2, stopped - 1].map(|index| tally.stopped[index]);
    println!(
        "signals: {stopped} stopped, {late} late, {early} early; to the end {middle:.1?} in the middle, \
         {most:.1?} at most; 0 torn maps, 0 left over"
    );
}
