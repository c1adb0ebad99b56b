//! Prefix codes of limited length: lengths from counts, and the canonical codes of RFC 1951, 3.2.2.

/// A code word, its bits in the order of the stream, and how many they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Word {
    pub(super) bits: u16,
    pub(super) length: u8,
}

/// The words of all symbols; symbols without a count have words of no length.
///
/// The codes are of least redundancy (Huffman 1952) but for words longer than `limit`, which are cut to it.
pub(super) fn code(counts: &[u32], limit: u8) -> Vec<Word> {
    let mut symbols: Vec<usize> = (0..counts.len()).filter(|it| counts[*it] > 0).collect();
    // Rarest first; the symbol decides between equals.
    symbols.sort_by_key(|symbol| (counts[*symbol], *symbol));
    let weights: Vec<u32> = symbols.iter().map(|symbol| counts[*symbol]).collect();
    let mut words = vec![Word::default(); counts.len()];
    let mut rarest = symbols.into_iter();
    for (length, count) in numbers(&weights, usize::from(limit))
        .iter()
        .enumerate()
        .rev()
    {
        let symbols = rarest.by_ref().take(*count);
        symbols.for_each(|symbol| words[symbol].length = length as u8);
    }
    assign(&mut words);
    words
}

/// How many words of each length a code for sorted weights has.
fn numbers(weights: &[u32], limit: usize) -> Vec<usize> {
    let mut numbers = vec![0; limit + 1];
    match weights {
        [] => {}
        [_] => numbers[1] = 1,
        _ => depths(weights)
            .into_iter()
            .for_each(|depth| numbers[depth.min(limit)] += 1),
    }
    shorten(&mut numbers, limit);
    numbers
}

/// The depths of the leaves of Huffman's tree over sorted weights, of which there are two or more.
fn depths(weights: &[u32]) -> Vec<usize> {
    let leaves = weights.len();
    let mut nodes: Vec<u32> = weights.to_vec();
    let mut parents = vec![0; 2 * leaves - 1];
    // Inner nodes arise in the order of their weight, so two queues are enough (van Leeuwen 1976).
    let [mut leaf, mut inner] = [0, leaves];
    for parent in leaves..2 * leaves - 1 {
        let mut sum = 0;
        for _ in 0..2 {
            let takes_leaf = leaf < leaves && (inner == parent || nodes[leaf] <= nodes[inner]);
            let next = if takes_leaf { &mut leaf } else { &mut inner };
            sum += nodes[*next];
            parents[*next] = parent;
            *next += 1;
        }
        nodes.push(sum);
    }
    let mut depths = vec![0; 2 * leaves - 1];
    for node in (0..2 * leaves - 2).rev() {
        depths[node] = depths[parents[node]] + 1;
    }
    depths.truncate(leaves);
    depths
}

/// Makes room for words that were cut to the limit by lengthening the longest of the others.
fn shorten(numbers: &mut [usize], limit: usize) {
    let room = 1 << limit;
    let taken = |numbers: &[usize]| -> usize {
        let lengths = numbers.iter().enumerate().skip(1);
        lengths
            .map(|(length, count)| count << (limit - length))
            .sum()
    };
    for _ in room..taken(numbers) {
        let longest = (1..limit).rev().find(|length| numbers[*length] > 0);
        let longest = longest.expect("words that are all as long as the limit leave room");
        numbers[limit] -= 1;
        numbers[longest] -= 1;
        numbers[longest + 1] += 2;
    }
}

/// Gives the words their bits: those of one length count up in the order of the symbols.
fn assign(words: &mut [Word]) {
    let mut next = 0u16;
    let longest = words.iter().map(|word| word.length).max().unwrap_or(0);
    for length in 1..=longest {
        next <<= 1;
        for word in words.iter_mut().filter(|word| word.length == length) {
            word.bits = next.reverse_bits() >> (16 - length);
            next += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lengths(counts: &[u32], limit: u8) -> Vec<u8> {
        code(counts, limit).iter().map(|word| word.length).collect()
    }

    #[test]
    fn frequent_symbols_have_short_words() {
        assert_eq!(lengths(&[1, 0, 8, 2, 4], 15), [3, 0, 1, 3, 2]);
        assert_eq!(lengths(&[5, 5, 5, 5], 15), [2; 4]);
        assert_eq!(lengths(&[0, 7, 0], 15), [0, 1, 0]);
        assert_eq!(lengths(&[0, 0], 15), [0, 0]);
    }

    #[test]
    fn words_are_those_of_the_example_in_rfc_1951() {
        let mut words: Vec<Word> = [3u8, 3, 3, 3, 3, 2, 4, 4]
            .map(|length| Word { bits: 0, length })
            .to_vec();
        assign(&mut words);
        let written = words.iter().map(|word| {
            let bits = word.bits.reverse_bits() >> (16 - word.length);
            format!("{bits:0width$b}", width = usize::from(word.length))
        });
        assert_eq!(
            written.collect::<Vec<_>>(),
            ["010", "011", "100", "101", "110", "00", "1110", "1111"]
        );
    }

    #[test]
    fn limited_codes_fill_all_the_room() {
        // Counts like Fibonacci's numbers make the deepest trees.
        let mut counts = vec![1u32, 1];
        for index in 2..40 {
            counts.push(counts[index - 1] + counts[index - 2]);
        }
        for limit in [6, 7, 12, 15] {
            let lengths = lengths(&counts, limit);
            assert!(lengths.iter().all(|length| (1..=limit).contains(length)));
            let taken: u32 = lengths.iter().map(|length| 1 << (limit - length)).sum();
            assert_eq!(taken, 1 << limit, "limit {limit}");
        }
    }
}
