//! Packing: the paper's case of some 400 stones, and 1,000 to 100,000 stones by time per stone, with both methods.
//!
//! `cargo bench --bench packing` prints milliseconds of processor time on one thread, and ratios, which are medians of
//! pairs measured one right after the other.

#[path = "support/clock.rs"]
mod clock;
#[path = "../tests/support/node.rs"]
mod node;

use clock::{median, seconds};
use std::hint::black_box;
use yosegi::value::Value;

/// Width of a stone in mm.
const STONE: f64 = 100.0;
const PAIRS: usize = 5;

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a pool of one thread").install(measure);
}

fn measure() {
    for method in ["position_field", "particles"] {
        let times = (0..9).map(|_| 1e3 * time(method, 400)).collect();
        println!("{method}: 400 stones in {:.1} ms (limit 30)", median(times));
        for count in [10_000, 100_000] {
            let pair = |_| {
                let few = time(method, 1000) / 1e3;
                time(method, count) / count as f64 / few
            };
            // Particles take minutes for the largest number.
            let pairs = if method == "particles" && count > 10_000 {
                1
            } else {
                PAIRS
            };
            let ratio = median((0..pairs).map(pair).collect());
            println!("{method}: a stone of {count} takes {ratio:.2} times one of 1000 (limit 1.5)");
        }
    }
}

/// Seconds that it takes to pack a square.
fn time(method: &'static str, count: usize) -> f64 {
    let kind = yosegi::nodes::kind("square_packing").expect("the kind is in the table");
    let side = STONE * (count as f64).sqrt();
    let given = [
        ("size", Value::Pair([side, side])),
        ("stone", Value::Number(STONE)),
        ("aspect", Value::Number(1.0)),
        ("corners", Value::Whole(4)),
        ("spread", Value::Pair([0.8, 1.2])),
        ("scale", Value::Number(1.0)),
        ("method", Value::Choice(method)),
        ("bond", Value::Number(0.0)),
        ("force", Value::Choice("radial")),
        ("start", Value::Choice("lattice")),
        ("steps", Value::Whole(600)),
        ("seed", Value::Whole(0)),
    ];
    let values = node::inputs(kind, &given);
    seconds(&mut || {
        let cells = node::built(kind, &values, 1, None);
        black_box(cells.expect("the node can be built"));
    })
}
