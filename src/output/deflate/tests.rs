//! Pieces are read back by another decompressor; sizes and checksums are as promised.

use super::tokens::{LONGEST_RUN, length_extra, length_symbol, parts};
use super::*;

/// The pieces as one stream, through the decompressor of `png`.
fn read_back(pieces: &[&[u8]]) -> Vec<u8> {
    let mut stream = ZLIB_HEADER.to_vec();
    let mut sum = 1;
    for (index, piece) in pieces.iter().enumerate() {
        stream.extend(compress(piece, index + 1 == pieces.len()));
        sum = join_adler(sum, simd_adler32::adler32(piece), piece.len());
    }
    stream.extend(sum.to_be_bytes());
    fdeflate::decompress_to_vec(&stream).expect("the stream is valid")
}

/// Bytes around zero with long tails, as filtered rows are.
fn grain(length: usize, spread: u32) -> Vec<u8> {
    let mut state = 1u32;
    let mut next = || {
        state = state.wrapping_mul(0x915f_77f5).wrapping_add(0x3c6e_f35f);
        state >> 16
    };
    (0..length)
        .map(|_| ((next() % spread + next() % spread) as i32 - spread as i32) as u8)
        .collect()
}

#[test]
fn everything_comes_back() {
    let mut mixed = grain(700, 9);
    mixed.extend([7; 1000]);
    mixed.extend(grain(33, 200));
    mixed.extend([0; 259]);
    for data in [
        &[][..],
        &[5],
        &[0; 3],
        &[9; 8],
        &[1; 100_000],
        &grain(100_003, 5),
        &grain(70_000, 60_000),
        &mixed,
    ] {
        assert!(read_back(&[data]) == data, "{} bytes", data.len());
        assert!(read_back(&[data, &mixed, data]) == [data, &mixed, data].concat());
    }
}

#[test]
fn runs_of_every_length_come_back() {
    for run in 0..1100 {
        let data = [&[1, 2, 3][..], &vec![200; run], &[4]].concat();
        assert!(read_back(&[&data]) == data, "a run of {run}");
        assert!(parts(run).all(|part| (3..=LONGEST_RUN).contains(&part)) || run < 8);
    }
}

#[test]
fn every_length_has_the_symbol_of_rfc_1951() {
    let first = [
        3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 15, 17, 19, 23, 27, 31, 35, 43, 51, 59, 67, 83, 99, 115,
        131, 163, 195, 227, 258,
    ];
    for length in 3..=LONGEST_RUN {
        let index = first.partition_point(|first| *first <= length) - 1;
        let (symbol, extra) = length_symbol(length);
        assert_eq!(
            (symbol, extra as usize),
            (257 + index, length - first[index])
        );
        assert!(extra < 1 << length_extra(symbol));
    }
}

#[test]
fn noise_grows_by_no_more_than_is_said() {
    for length in [0, 1, 65_535, 65_536, 200_000] {
        let data = grain(length, 65_536);
        let limit = length + 5 * length.div_ceil(LARGEST_STORED) + 5;
        assert!(compress(&data, true).len() <= limit, "{length} bytes");
    }
}

#[test]
fn a_long_run_is_next_to_nothing() {
    assert!(compress(&[0; 1 << 17], false).len() < 300);
}
