//! A short run of the fuzzer: mutated recipes neither stop the reader nor the editor.
//!
//! `cargo run --release --manifest-path fuzz/Cargo.toml -- reader` goes on from here.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod mutate;
mod targets;

use mutate::{Corpus, Random};
use std::fs;
use targets::TARGETS;

/// Texts for each target.
const EXECUTIONS: u64 = 20_000;

fn corpus() -> Corpus {
    let entries = ["graphs", "tests/diagnostics"].map(|folder| fs::read_dir(folder).unwrap());
    let paths = entries
        .into_iter()
        .flatten()
        .map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = paths
        .filter(|path| path.extension().is_some_and(|found| found == "ron"))
        .collect();
    paths.sort();
    let texts = paths
        .iter()
        .filter_map(|path| fs::read_to_string(path).ok());
    let texts: Vec<_> = texts.filter(|text| text.len() < 4000).collect();
    Corpus::new(texts.iter().map(String::as_str))
}

#[test]
fn mutated_recipes_neither_stop_the_reader_nor_the_editor() {
    let corpus = corpus();
    for (name, target) in TARGETS {
        for number in 0..EXECUTIONS {
            let text = corpus.text(&mut Random::new(number));
            let result = std::panic::catch_unwind(|| target(&text, number));
            assert!(result.is_ok(), "{name} number {number} panics:\n{text}");
        }
    }
}

#[test]
fn the_same_number_gives_the_same_text() {
    let corpus = corpus();
    let text = |number| corpus.text(&mut Random::new(number));
    assert_eq!(text(7), text(7));
    assert_ne!(text(7), text(8));
}
