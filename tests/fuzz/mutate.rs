//! Recipes with mistakes: tokens of real ones doubled, swapped, cut and replaced.

/// Pieces that mean something to the reader.
const PIECES: &[&str] = &[
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "\\",
    ",",
    ":",
    "$",
    "=",
    "#",
    "/*",
    "*/",
    "//",
    "\n",
    "\r",
    "\t",
    " ",
    "\u{202e}",
    "\u{feff}",
    "\u{430}",
    "\u{1b}[31m",
    "\0",
    "r#\"",
    "\"#",
    "'",
    "b\"",
    "..",
    "..=",
    "-",
    "+",
    "*",
    "/",
    "0",
    "1",
    "-1",
    "1e999",
    "1e-999",
    "NaN",
    "inf",
    "0x",
    "99999999999999999999",
    "0.5",
    "true",
    "Some(",
    "r#",
    "\"$\"",
    "\"$$\"",
    "\"=\"",
    "\"= 1 / 0\"",
    "\"= $w * 2\"",
    "\"= -(\"",
    "\"#ffffff\"",
    "\"a.b.c\"",
    "\"\"",
    "()",
    "(a: 1)",
    "\"\\u{41}\"",
    "\"\\x\"",
    "#![enable(x)]",
    "nodes",
    "outputs",
    "parameters",
    "about",
    "seed",
    "default",
    "range",
    "unit",
    "\"mm/year\"",
    "= mix(",
    "sqrt(",
    "luminance(",
];

/// Random numbers that are the same on every machine: SplitMix64 (Steele, Lea & Flood 2014).
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    /// Starts at `seed`.
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed)
    }

    /// The next 64 bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `end`, 0 if `end` is 0.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        if end == 0 {
            0
        } else {
            (self.bits() % end as u64) as usize
        }
    }

    /// One of `items`.
    pub(crate) fn pick<'i, T: ?Sized>(&mut self, items: &[&'i T]) -> &'i T {
        items[self.below(items.len())]
    }
}

/// Texts to begin with, cut into tokens.
#[derive(Debug)]
pub(crate) struct Corpus {
    texts: Vec<Vec<String>>,
}

impl Corpus {
    /// From whole texts; none may be empty.
    pub(crate) fn new<'t>(texts: impl IntoIterator<Item = &'t str>) -> Corpus {
        let texts = texts
            .into_iter()
            .map(tokens)
            .filter(|text| !text.is_empty());
        Corpus {
            texts: texts.collect(),
        }
    }

    /// A text with up to six changes, and half of the time none.
    pub(crate) fn text(&self, random: &mut Random) -> String {
        let mut tokens = self.texts[random.below(self.texts.len())].clone();
        for _ in 0..random.below(4) * random.below(3) {
            self.change(&mut tokens, random);
        }
        let mut text: String = tokens.concat();
        if random.below(8) == 0 {
            change_letter(&mut text, random);
        }
        text
    }

    fn change(&self, tokens: &mut Vec<String>, random: &mut Random) {
        let at = random.below(tokens.len());
        match random.below(8) {
            0 => tokens.insert(at, PIECES[random.below(PIECES.len())].to_owned()),
            1 if !tokens.is_empty() => tokens[at] = PIECES[random.below(PIECES.len())].to_owned(),
            2 if !tokens.is_empty() => drop(tokens.remove(at)),
            3 if !tokens.is_empty() => {
                tokens.insert(at, tokens[random.below(tokens.len())].clone())
            }
            4 if !tokens.is_empty() => {
                let other = random.below(tokens.len());
                tokens.swap(at, other);
            }
            5 if !tokens.is_empty() => {
                let end = at + random.below((tokens.len() - at).min(40));
                let doubled = tokens[at..end].to_vec();
                tokens.splice(at..at, doubled);
            }
            6 => {
                let other = &self.texts[random.below(self.texts.len())];
                let start = random.below(other.len());
                let end = start + random.below((other.len() - start).min(60));
                tokens.splice(at..at, other[start..end].iter().cloned());
            }
            7 if random.below(4) == 0 => tokens.truncate(at),
            _ if !tokens.is_empty() => {
                let end = at + random.below((tokens.len() - at).min(20));
                tokens.drain(at..end);
            }
            _ => {}
        }
    }
}

/// Names, numbers, strings and spaces, each in one piece.
fn tokens(text: &str) -> Vec<String> {
    let class = |letter: char| match letter {
        letter if letter.is_alphanumeric() || letter == '_' => 0,
        letter if letter.is_whitespace() => 1,
        _ => 2,
    };
    let mut tokens: Vec<String> = vec![];
    for letter in text.chars() {
        let last = tokens.last().and_then(|token| token.chars().last());
        match (tokens.last_mut(), last) {
            (Some(token), Some(last)) if class(last) == class(letter) && class(letter) < 2 => {
                token.push(letter);
            }
            _ => tokens.push(letter.to_string()),
        }
    }
    tokens
}

fn change_letter(text: &mut String, random: &mut Random) {
    let letters = text.chars().count();
    let at = random.below(letters);
    let Some((byte, letter)) = text.char_indices().nth(at) else {
        return;
    };
    let end = byte + letter.len_utf8();
    match random.below(3) {
        0 => text.replace_range(byte..end, ""),
        1 => text.insert(byte, letter),
        _ => {
            let other = char::from_u32(random.below(0x250) as u32).unwrap_or('?');
            text.replace_range(byte..end, other.encode_utf8(&mut [0; 4]));
        }
    }
}
