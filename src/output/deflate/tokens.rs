//! What a piece is made of: literals, and runs of one byte.

use super::bits::BitWriter;
use super::huffman::Word;

/// Literals, the end of the block, and lengths.
pub(super) const SYMBOLS: usize = 286;
const END: usize = 256;
pub(super) const LONGEST_RUN: usize = 258;
/// Of so many groups of eight bytes the literals of one are counted, once there are many: counting all
/// would take a third of the time and save less than a hundredth of the bytes.
const SPARSITY: usize = 4;
/// Pieces of fewer bytes are counted in full.
const FEW: usize = 1 << 14;

/// Literals, then a run of the last of them.
struct Token {
    literals: usize,
    run: usize,
}

/// What a piece is made of, and how often each symbol occurs.
pub(super) struct Tokens {
    tokens: Vec<Token>,
    pub(super) counts: [u32; SYMBOLS],
}

impl Tokens {
    pub(super) fn of(data: &[u8]) -> Tokens {
        let sparsity = if data.len() < FEW { 1 } else { SPARSITY };
        let mut tokens = vec![];
        let mut counts = Counts::new(sparsity);
        let [mut start, mut at, mut groups] = [0, 0, 0];
        while let Some(group) = data[at..].first_chunk::<8>() {
            if at > 0 && *group == [data[at - 1]; 8] {
                let run = run_length(&data[at..], data[at - 1]);
                let literals = at - start;
                tokens.push(Token { literals, run });
                counts.add_run(run);
                at += run;
                start = at;
                continue;
            }
            if groups % sparsity == 0 {
                counts.add_literals(group);
            }
            groups += 1;
            at += 8;
        }
        data[at..]
            .iter()
            .for_each(|byte| counts.literals[0][usize::from(*byte)] += 1);
        tokens.push(Token {
            literals: data.len() - start,
            run: 0,
        });
        Tokens {
            tokens,
            counts: counts.finish(),
        }
    }

    /// The bytes of everything but the header, as far as the counts tell.
    pub(super) fn coded_bytes(&self, words: &[Word]) -> usize {
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

    /// Appends everything but the header.
    pub(super) fn write(&self, data: &[u8], words: &[Word], bits: &mut BitWriter) {
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
pub(super) fn parts(run: usize) -> impl Iterator<Item = usize> {
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

/// Symbols while they are counted.
struct Counts {
    sparsity: usize,
    /// Two tables: counting the same byte twice in a row would wait for memory.
    literals: [[u32; 256]; 2],
    others: [u32; SYMBOLS],
}

impl Counts {
    fn new(sparsity: usize) -> Counts {
        Counts {
            sparsity,
            literals: [[0; 256]; 2],
            others: [0; SYMBOLS],
        }
    }

    #[inline]
    fn add_literals(&mut self, group: &[u8; 8]) {
        for [even, odd] in group.as_chunks::<2>().0 {
            self.literals[0][usize::from(*even)] += 1;
            self.literals[1][usize::from(*odd)] += 1;
        }
    }

    fn add_run(&mut self, run: usize) {
        for part in parts(run) {
            self.others[length_symbol(part).0] += 1;
        }
    }

    /// How often each symbol occurs; literals that may have been missed count once.
    fn finish(self) -> [u32; SYMBOLS] {
        let mut counts = self.others;
        counts[END] = 1;
        let missed = u32::from(self.sparsity > 1);
        let [even, odd] = self.literals;
        for ((count, even), odd) in counts.iter_mut().zip(even).zip(odd) {
            *count = (even + odd) * self.sparsity as u32 + missed;
        }
        counts
    }
}

/// The symbol of a length from 3 to 258, and the value of its extra bits.
pub(super) fn length_symbol(length: usize) -> (usize, u32) {
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
pub(super) fn length_extra(symbol: usize) -> u32 {
    match symbol {
        265..=284 => (symbol as u32 - 261) / 4,
        _ => 0,
    }
}
