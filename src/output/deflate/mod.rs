//! A fast compressor of filtered rows: literals and runs of one byte under codes made for each strip.
//!
//! Filtered rows of pictures with grain hold few repetitions that a search would find, so there is none: a
//! strip becomes one block of RFC 1951 whose only distance is 1. Strips end at whole bytes and refer to
//! nothing before them, so they are compressed apart and joined.

mod bits;
mod huffman;

use bits::BitWriter;
use huffman::{Word, code};

/// Longest word of a literal: four of them and a begun byte fit into 64 bits.
const LIMIT: u8 = 12;
/// Literals, the end of the block, and lengths.
const SYMBOLS: usize = 286;
const END: usize = 256;
const LONGEST_RUN: usize = 258;
const LARGEST_STORED: usize = 0xffff;
/// No fewer bytes than 19 lengths of 3 bits and 287 of up to 14, and the ends of blocks take.
const LARGEST_HEADER: usize = 600;

/// The first bytes of a stream in the format of RFC 1950: a window of 32 KiB, no dictionary, fastest.
pub(super) const ZLIB_HEADER: [u8; 2] = [0x78, 0x01];

/// Compresses one piece of a stream; `is_last` ends the stream.
///
/// The result is never longer than `data` by more than 5 bytes for every 65,535, and 5.
pub(super) fn compress(data: &[u8], is_last: bool) -> Vec<u8> {
    let tokens = Tokens::of(data);
    let words = code(&tokens.counts, LIMIT);
    let room = tokens.coded_bytes(&words) + LARGEST_HEADER;
    let stored = data.len() + 5 * data.len().div_ceil(LARGEST_STORED);
    if room >= stored + LARGEST_HEADER {
        return store(data, is_last);
    }
    let coded = write_block(data, &tokens, &words, room, is_last);
    if coded.len() > stored {
        store(data, is_last)
    } else {
        coded
    }
}

fn write_block(
    data: &[u8],
    tokens: &Tokens,
    words: &[Word],
    room: usize,
    is_last: bool,
) -> Vec<u8> {
    let mut bits = BitWriter::new(room);
    bits.put(u64::from(is_last) | 2 << 1, 3);
    write_code(&mut bits, words);
    tokens.write(data, words, &mut bits);
    if !is_last {
        // An empty stored block ends at a whole byte.
        bits.put(0, 3);
        bits.align();
        bits.put(0xffff_0000, 32);
    }
    bits.finish()
}

/// Stored blocks, which begin and end at whole bytes.
fn store(data: &[u8], is_last: bool) -> Vec<u8> {
    let count = data
        .len()
        .div_ceil(LARGEST_STORED)
        .max(usize::from(is_last));
    let mut bytes = Vec::with_capacity(data.len() + 5 * count);
    for index in 0..count {
        let start = index * LARGEST_STORED;
        let block = &data[start..data.len().min(start + LARGEST_STORED)];
        let length = block.len() as u16;
        bytes.push(u8::from(is_last && index + 1 == count));
        bytes.extend_from_slice(&length.to_le_bytes());
        bytes.extend_from_slice(&(!length).to_le_bytes());
        bytes.extend_from_slice(block);
    }
    bytes
}

/// Literals, then a run of the last of them.
struct Token {
    literals: usize,
    run: usize,
}

/// What a piece is made of, and how often each symbol occurs.
struct Tokens {
    tokens: Vec<Token>,
    counts: [u32; SYMBOLS],
}

impl Tokens {
    fn of(data: &[u8]) -> Tokens {
        let mut tokens = vec![];
        let mut counts = [[0u32; SYMBOLS]; 2];
        let [mut start, mut at] = [0, 0];
        while let Some(group) = data[at..].first_chunk::<8>() {
            let is_run = at > 0 && *group == [data[at - 1]; 8];
            if is_run {
                let run = run_length(&data[at..], data[at - 1]);
                tokens.push(Token {
                    literals: at - start,
                    run,
                });
                count_run(run, &mut counts[0]);
                at += run;
                start = at;
                continue;
            }
            // Two tables: counting the same byte twice in a row would wait for memory.
            for pair in group.as_chunks::<2>().0 {
                counts[0][usize::from(pair[0])] += 1;
                counts[1][usize::from(pair[1])] += 1;
            }
            at += 8;
        }
        data[at..]
            .iter()
            .for_each(|byte| counts[0][usize::from(*byte)] += 1);
        tokens.push(Token {
            literals: data.len() - start,
            run: 0,
        });
        let [mut counts, others] = counts;
        counts
            .iter_mut()
            .zip(others)
            .for_each(|(count, other)| *count += other);
        counts[END] = 1;
        Tokens { tokens, counts }
    }

    /// The bytes of everything but the header.
    fn coded_bytes(&self, words: &[Word]) -> usize {
        let bits = |(symbol, count): (usize, &u32)| {
            let distance = if symbol > END {
                1 + length_extra(symbol)
            } else {
                0
            };
            u64::from(*count) * (u64::from(words[symbol].length) + u64::from(distance))
        };
        let bits: u64 = self.counts.iter().enumerate().map(bits).sum();
        bits.div_ceil(8) as usize
    }

    fn write(&self, data: &[u8], words: &[Word], bits: &mut BitWriter) {
        let literals: &[Word; 256] = words.first_chunk().expect("every literal has a word");
        let mut at = 0;
        for token in &self.tokens {
            let (fours, rest) = data[at..at + token.literals].as_chunks::<4>();
            for four in fours {
                four.iter()
                    .for_each(|byte| bits.word(literals[usize::from(*byte)]));
                bits.flush();
            }
            rest.iter()
                .for_each(|byte| bits.word(literals[usize::from(*byte)]));
            bits.flush();
            for part in parts(token.run) {
                let (symbol, extra) = length_symbol(part);
                bits.word(words[symbol]);
                // The distance has a word of one bit.
                bits.put(extra.into(), length_extra(symbol) + 1);
                bits.flush();
            }
            at += token.literals + token.run;
        }
        bits.word(words[END]);
        bits.flush();
    }
}

/// How many bytes from the start on are `byte`.
fn run_length(data: &[u8], byte: u8) -> usize {
    let groups = data.as_chunks::<8>().0;
    let whole = groups
        .iter()
        .take_while(|group| **group == [byte; 8])
        .count()
        * 8;
    let rest = data[whole..].iter().take_while(|it| **it == byte);
    whole + rest.count()
}

/// A run in parts that lengths can name: none has fewer than 3 bytes, as no run has fewer than 8.
fn parts(run: usize) -> impl Iterator<Item = usize> {
    let mut left = run;
    std::iter::from_fn(move || {
        let part = if left > LONGEST_RUN && left < LONGEST_RUN + 3 {
            LONGEST_RUN - 3
        } else {
            left.min(LONGEST_RUN)
        };
        left -= part;
        (part > 0).then_some(part)
    })
}

fn count_run(run: usize, counts: &mut [u32; SYMBOLS]) {
    for part in parts(run) {
        counts[length_symbol(part).0] += 1;
    }
}

/// The symbol of a length from 3 to 258, and the value of its extra bits.
fn length_symbol(length: usize) -> (usize, u32) {
    let over = length as u32 - 3;
    match over {
        0..8 => (257 + over as usize, 0),
        255 => (285, 0),
        _ => {
            // Four symbols for each power of two.
            let extra = over.ilog2() - 2;
            let step = over >> extra;
            (257 + (4 * extra + step) as usize, over & ((1 << extra) - 1))
        }
    }
}

/// How many extra bits the symbol of a length has.
fn length_extra(symbol: usize) -> u32 {
    match symbol {
        265..=284 => (symbol as u32 - 261) / 4,
        _ => 0,
    }
}

/// Writes the lengths of the words (RFC 1951, 3.2.7), with one distance of one bit.
fn write_code(bits: &mut BitWriter, words: &[Word]) {
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

/// The checksum of RFC 1950 over two pieces, from those of each and the length of the second.
pub(super) fn join_adler(first: u32, second: u32, second_length: usize) -> u32 {
    const BASE: u64 = 65521;
    let [a, b] = [first, second].map(|sum| [u64::from(sum & 0xffff), u64::from(sum >> 16)]);
    let length = second_length as u64 % BASE;
    // The second piece starts from 1 instead of from the sum of the first.
    let low = (a[0] + b[0] + BASE - 1) % BASE;
    let high = (a[1] + b[1] + length * (a[0] + BASE - 1)) % BASE;
    (high << 16 | low) as u32
}

#[cfg(test)]
mod tests;
