//! From the bytes of a file to a tree that is valid RON.

use super::report::Report;
use super::syntax;
use super::tree::Tree;
use crate::diagnostics::{Code, Diagnostic, SourceFile};
use std::path::Path;
use std::sync::Arc;

/// Bytes of the largest recipe.
pub(super) const LARGEST: usize = 16 << 20;

/// The text of a file, if it is UTF-8 and not too large.
pub(super) fn decode(path: &Path, bytes: Vec<u8>) -> Result<Arc<SourceFile>, Box<Diagnostic>> {
    if bytes.len() > LARGEST {
        return Err(about_file(path, Code::TooLarge, too_large()).into());
    }
    let encoding = match bytes.as_slice() {
        [0xff, 0xfe, ..] | [1..=255, 0, ..] => Some("UTF-16 (little-endian)"),
        [0xfe, 0xff, ..] | [0, 1..=255, ..] => Some("UTF-16 (big-endian)"),
        _ => None,
    };
    if let Some(encoding) = encoding {
        let message = format!("expected UTF-8 text, found {encoding} from byte 0 on");
        return Err(about_file(path, Code::NotText, message)
            .expected("UTF-8 text", encoding)
            .hint("save the file as UTF-8")
            .into());
    }
    match String::from_utf8(bytes) {
        Ok(text) => Ok(Arc::new(SourceFile::new(path, text))),
        Err(error) => {
            let valid = error.utf8_error().valid_up_to();
            Err(not_utf8(path, error.as_bytes(), valid).into())
        }
    }
}

fn too_large() -> String {
    let mebibytes = LARGEST >> 20;
    format!("a recipe has at most {mebibytes} MiB ({LARGEST} bytes), this one has more")
}

fn about_file(path: &Path, code: Code, message: String) -> Diagnostic {
    let mut diagnostic = Diagnostic::error(code, message);
    diagnostic.source = Some(Arc::new(SourceFile::new(path, "")));
    diagnostic
}

/// Points at the first byte that is not UTF-8; the excerpt shows it as a replacement character.
fn not_utf8(path: &Path, bytes: &[u8], at: usize) -> Diagnostic {
    let byte = bytes.get(at).copied().unwrap_or(0);
    let source = Arc::new(SourceFile::new(path, String::from_utf8_lossy(bytes)));
    let end = at + '\u{fffd}'.len_utf8();
    let message = format!("expected UTF-8 text, found byte 0x{byte:02x} at byte {at}");
    Diagnostic::error(Code::NotText, message)
        .at(&source, at..end, "not UTF-8")
        .expected("UTF-8 text", format!("byte 0x{byte:02x} at byte {at}"))
        .hint("save the file as UTF-8")
}

/// The tree of the text of `report`; `None` if there is none or it is not valid, which is reported.
pub(super) fn read(report: &mut Report) -> Option<Tree> {
    let source = Arc::clone(&report.source);
    if source.text.len() > LARGEST {
        report.add(about_file(&source.path, Code::TooLarge, too_large()));
        return None;
    }
    if let Some(at) = source.text.find('\0') {
        let message = format!("expected text, found a NUL byte at byte {at}");
        report.add(report.error(Code::NotText, message, at..at + 1, "not text"));
        return None;
    }
    let tree = syntax::parse(report);
    if tree.is_some() && !report.has_errors() && !report.is_full() {
        judge(report);
    }
    tree.filter(|_| !report.has_errors())
}

/// Asks the `ron` crate whether the text is valid.
fn judge(report: &mut Report) {
    let source = Arc::clone(&report.source);
    let text = source.text.trim_start_matches('\u{feff}');
    let mark = source.text.len() - text.len();
    // For `ron` a lone carriage return ends no line, so a comment would never end.
    let unified = lone_returns_as_line_feeds(text);
    if let Err(error) = ron::from_str::<serde::de::IgnoredAny>(&unified) {
        let start = mark + byte_of(&unified, error.span.start);
        let end = (mark + byte_of(&unified, error.span.end)).max(start);
        let mut reason = error.code.to_string();
        if let Some(first) = reason.get(..1) {
            reason = first.to_lowercase() + &reason[1..];
        }
        let message = format!("not valid RON: {}", reason.trim_end_matches('.'));
        report.add(report.error(Code::Syntax, message, start..end, "here"));
    }
}

/// Of the same length, so that places stay right.
fn lone_returns_as_line_feeds(text: &str) -> String {
    // What holds the place of a CRLF is white space as well, should the text have it.
    text.replace("\r\n", "\u{b}\n")
        .replace('\r', "\n")
        .replace("\u{b}\n", "\r\n")
}

/// The byte of a place that `ron` counts in lines that end in line feeds.
fn byte_of(text: &str, position: ron::error::Position) -> usize {
    let skipped = position.line.saturating_sub(1);
    let before: usize = text.split_inclusive('\n').take(skipped).map(str::len).sum();
    let line = &text[before..];
    let letter = line.char_indices().nth(position.col.saturating_sub(1));
    before + letter.map_or(line.len(), |(at, _)| at)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEEDS: [&str; 4] = [
        "(a: 1, b: [(1, 2.5e-3), (-0x1F, .5)], c: {\"x\": kind(n: \"t\\n\"), \"y\": other()})",
        "// c\n(n: { /* a /* b */ */ \"k\": f(v: r#\"raw \"q\" \"#, w: 'x', z: 0..=5), })",
        "#![enable(unwrap_newtypes)]\r\n[Some(3), None, true, b\"b\", (), {}, [], -inf, 1_000u32]",
        "(r#type: \"\\u{e4}\\x41\\\n   on\", v: (1, (2, (3,),),), tail: name,)",
    ];

    /// A text with a few letters replaced, doubled or taken away; `seed` decides which.
    fn mutated(text: &str, mut seed: u64) -> String {
        let mut letters: Vec<char> = text.chars().collect();
        let mut draw = |end: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (seed >> 33) as usize % end.max(1)
        };
        for _ in 0..1 + draw(3) {
            let at = draw(letters.len());
            match draw(3) {
                0 => letters[at] = ['(', ')', '"', ',', ':', '1', 'e', '_', '#', '.'][draw(10)],
                1 => letters.insert(at, letters[draw(letters.len())]),
                _ => drop(letters.remove(at)),
            }
        }
        letters.into_iter().collect()
    }

    /// Our tree must accept what `ron` accepts, or a valid recipe would be refused.
    #[test]
    fn what_ron_accepts_is_read() {
        let mut accepted = 0;
        for (seed, text) in SEEDS.iter().cycle().enumerate().take(20_000) {
            let text = mutated(text, seed as u64);
            let mut report = Report::new(&Arc::new(SourceFile::new("a.ron", &*text)));
            let tree = syntax::parse(&mut report);
            if ron::from_str::<serde::de::IgnoredAny>(&text).is_ok() {
                accepted += 1;
                let problems = crate::diagnostics::render_all(&report.finish());
                assert!(tree.is_some() && problems.is_empty(), "{text}\n{problems}");
            }
        }
        assert!(accepted > 1000, "{accepted}");
    }
}
