//! The header of a block: the lengths of its words (RFC 1951, 3.2.7).

use super::bits::BitWriter;
use super::huffman::{Word, code};
use super::tokens::SYMBOLS;

/// Writes the lengths of the words, and one distance of one bit.
pub(super) fn write(bits: &mut BitWriter, words: &[Word]) {
    const ORDER: [usize; 19] = [
        16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15,
    ];
    let lengths: Vec<u8> = words.iter().map(|word| word.length).chain([1]).collect();
    let steps = repetitions(&lengths);
    let mut counts = [0; 19];
    steps.iter().for_each(|step| counts[step.symbol] += 1);
    let steps_code = code(&counts, 7);
    bits.put((SYMBOLS - 257) as u64, 5);
    bits.put(0, 5);
    bits.put((ORDER.len() - 4) as u64, 4);
    bits.flush();
    for symbol in ORDER {
        bits.put(steps_code[symbol].length.into(), 3);
        bits.flush();
    }
    for step in steps {
        bits.word(steps_code[step.symbol]);
        bits.put(step.extra, step.extra_bits);
        bits.flush();
    }
}

/// A length, or the repetition of one.
struct Step {
    symbol: usize,
    extra: u64,
    extra_bits: u32,
}

/// The lengths with repetitions of 3 to 6 times the same, and up to 138 zeros.
fn repetitions(lengths: &[u8]) -> Vec<Step> {
    let mut steps = vec![];
    let mut before = None;
    let mut rest = lengths;
    while let [length, ..] = *rest {
        let same = rest.iter().take_while(|it| **it == length).count();
        let (taken, symbol, low, extra_bits) = match (length, same) {
            (0, 11..) => (same.min(138), 18, 11, 7),
            (0, 3..) => (same, 17, 3, 3),
            (_, 3..) if before == Some(length) => (same.min(6), 16, 3, 2),
            _ => (1, usize::from(length), 1, 0),
        };
        steps.push(Step {
            symbol,
            extra: (taken - low) as u64,
            extra_bits,
        });
        before = Some(length);
        rest = &rest[taken..];
    }
    steps
}
