//! A fast compressor of filtered rows: literals and runs of one byte under codes made for each strip.
//!
//! Filtered rows of pictures with grain hold few repetitions that a search would find, so there is none: a
//! strip becomes one block of RFC 1951 whose only distance is 1. Strips end at whole bytes and refer to
//! nothing before them, so they are compressed apart and joined.

mod bits;
mod huffman;
mod lengths;
mod tokens;

use bits::BitWriter;
use huffman::{Word, code};
use tokens::Tokens;

/// Longest word of a literal: four of them and a begun byte fit into 64 bits.
const LIMIT: u8 = 14;
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
    let stored = data.len() + 5 * data.len().div_ceil(LARGEST_STORED);
    if tokens.coded_bytes(&words) >= stored {
        return store(data, is_last);
    }
    let coded = write_block(data, &tokens, &words, is_last);
    if coded.len() > stored {
        store(data, is_last)
    } else {
        coded
    }
}

fn write_block(data: &[u8], tokens: &Tokens, words: &[Word], is_last: bool) -> Vec<u8> {
    let mut bits = BitWriter::new(data.len() * usize::from(LIMIT) / 8 + LARGEST_HEADER);
    bits.put(u64::from(is_last) | 2 << 1, 3);
    lengths::write(&mut bits, words);
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
