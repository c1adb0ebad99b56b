//! Diagnostics as text, for people.

use super::excerpt::{excerpts, safe};
use super::{Diagnostic, Label, Position, Severity, SourceFile, Use};
use annotate_snippets::{AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet};

/// Diagnostics that are printed; the rest is counted.
const SHOWN: usize = 20;
/// Uses of compounds that are printed with one diagnostic.
const USES: usize = 8;

/// The diagnostic as rustc would show it, without colours.
pub fn render_text(diagnostic: &Diagnostic) -> String {
    render(diagnostic, &Renderer::plain())
}

/// The diagnostic as rustc would show it, with ANSI colours for a terminal.
pub fn render_styled(diagnostic: &Diagnostic) -> String {
    render(diagnostic, &Renderer::styled())
}

/// The first twenty diagnostics in the order of their places, and how many there are.
pub fn render_all(diagnostics: &[Diagnostic]) -> String {
    render_list(diagnostics, &Renderer::plain())
}

/// Like [`render_all`], with ANSI colours for a terminal.
pub fn render_all_styled(diagnostics: &[Diagnostic]) -> String {
    render_list(diagnostics, &Renderer::styled())
}

fn render_list(diagnostics: &[Diagnostic], renderer: &Renderer) -> String {
    let mut sorted: Vec<_> = diagnostics.iter().collect();
    sorted.sort_by_key(|diagnostic| diagnostic.place());
    let shown: Vec<_> = sorted
        .iter()
        .take(SHOWN)
        .map(|diagnostic| render(diagnostic, renderer))
        .collect();
    let mut text = shown.join("\n");
    if let Some(count) = count(diagnostics) {
        text.push('\n');
        text.push_str(&count);
    }
    text
}

/// The last line: how many there are, if there is more than one.
fn count(diagnostics: &[Diagnostic]) -> Option<String> {
    let of = |severity, name: &str| {
        let number = diagnostics
            .iter()
            .filter(|one| one.severity == severity)
            .count();
        let plural = if number == 1 { "" } else { "s" };
        (number > 0).then(|| format!("{number} {name}{plural}"))
    };
    let parts = [
        of(Severity::Error, "error"),
        of(Severity::Warning, "warning"),
    ];
    let counts: Vec<_> = parts.into_iter().flatten().collect();
    let hidden = match diagnostics.len() {
        0 | 1 => return None,
        2..=SHOWN => String::new(),
        _ => format!("; the first {SHOWN} are shown"),
    };
    Some(format!("{}{hidden}\n", counts.join(" and ")))
}

fn render(diagnostic: &Diagnostic, renderer: &Renderer) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let title = level
        .primary_title(safe(&diagnostic.message))
        .id(diagnostic.code.name());
    let mut group = Group::with_title(title);
    let mut places = (String::new(), String::new());
    if let Some((source, label)) = diagnostic.source.as_ref().zip(diagnostic.label.as_ref()) {
        let (elements, shown_and_real) = place(diagnostic, source, label);
        group = group.elements(elements);
        places = shown_and_real;
    } else if let Some(source) = &diagnostic.source {
        group = group.element(Origin::path(printed_path(source)));
    }
    for note in uses(diagnostic) {
        group = group.element(Level::NOTE.message(safe(&note).into_owned()));
    }
    for help in helps(diagnostic) {
        group = group.element(Level::HELP.message(safe(&help).into_owned()));
    }
    let mut text = renderer.render(&[group]);
    if diagnostic.label.is_none() {
        text = without_excerpt(&text);
    }
    // A cut line begins elsewhere, and the renderer counts columns from there.
    let (before, after) = text.split_at(text.find("--> ").unwrap_or(0));
    format!("{before}{}\n", after.replacen(&places.0, &places.1, 1))
}

/// The lines behind the first moved to where they stand if there is an excerpt, without its edge.
fn without_excerpt(text: &str) -> String {
    let lines = text.split('\n').filter(|line| line.trim() != "|");
    lines.collect::<Vec<_>>().join("\n ")
}

/// The excerpts, and the place to blame as it is counted in the excerpt and in the file.
fn place<'d>(
    diagnostic: &'d Diagnostic,
    source: &SourceFile,
    blamed: &'d Label,
) -> (Vec<Element<'d>>, (String, String)) {
    let path = printed_path(source);
    let real = source.position(blamed.span.start);
    let mut shown_column = real.column;
    let mut elements: Vec<Element<'d>> = vec![];
    let labels: Vec<_> = std::iter::once(blamed).chain(&diagnostic.context).collect();
    for (excerpt, labels) in excerpts(source, &labels) {
        let blamed_here = labels.iter().position(|label| std::ptr::eq(*label, blamed));
        if let Some(index) = blamed_here {
            shown_column = excerpt.column(index);
        }
        let annotations = excerpt.spans.into_iter().zip(labels).map(|(span, label)| {
            let is_blamed = std::ptr::eq(label, blamed);
            let kind = if is_blamed {
                AnnotationKind::Primary
            } else {
                AnnotationKind::Context
            };
            kind.span(span).label(safe(&label.text))
        });
        let snippet = Snippet::source(excerpt.text)
            .line_start(excerpt.first_line)
            .path(path.clone());
        // The renderer takes the first excerpt for the one that matters.
        let index = if blamed_here.is_some() {
            0
        } else {
            elements.len()
        };
        elements.insert(index, snippet.annotations(annotations).into());
    }
    let place = |column| format!("{path}:{}:{column}", real.line);
    (elements, (place(shown_column), place(real.column)))
}

fn printed_path(source: &SourceFile) -> String {
    safe(&source.path.to_string_lossy()).into_owned()
}

/// The chain of uses that leads to the place, one line each; the middle of a long one is left out.
fn uses(diagnostic: &Diagnostic) -> Vec<String> {
    let chain: Vec<_> = diagnostic.uses.iter().flat_map(|one| one.chain()).collect();
    let described = |one: &&Use| {
        let Position { line, column } = one.source.position(one.span.start);
        let path = printed_path(&one.source);
        format!("in `{}` (`{}`): {path}:{line}:{column}", one.node, one.kind)
    };
    let mut notes: Vec<_> = chain.iter().map(described).collect();
    if notes.len() > USES {
        let hidden = notes.len() - USES;
        notes.splice(
            USES / 2..USES / 2 + hidden,
            [format!("through {hidden} more uses of compounds")],
        );
    }
    notes
}

/// The nearest names and the hints, one line each.
fn helps(diagnostic: &Diagnostic) -> Vec<String> {
    let names: Vec<_> = diagnostic
        .nearest
        .iter()
        .map(|name| format!("`{name}`"))
        .collect();
    let nearest = match names.as_slice() {
        [] => None,
        [one] => Some(format!("did you mean {one}?")),
        [first @ .., last] => Some(format!("did you mean {} or {last}?", first.join(", "))),
    };
    nearest
        .into_iter()
        .chain(diagnostic.hints.iter().cloned())
        .collect()
}

impl Diagnostic {
    /// What diagnostics are sorted by: file, byte, errors before warnings, code.
    fn place(&self) -> impl Ord + use<'_> {
        let path = self.source.as_ref().map(|source| source.path.as_path());
        let byte = self.label.as_ref().map(|label| label.span.start);
        (
            path,
            byte,
            self.severity == Severity::Warning,
            self.code,
            &self.message,
        )
    }
}

/// Sorts diagnostics by file and place; those about no place come first.
pub fn sort(diagnostics: &mut [Diagnostic]) {
    diagnostics.sort_by(|a, b| a.place().cmp(&b.place()));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostics::Code;
    use std::sync::Arc;

    fn example() -> Diagnostic {
        let source = Arc::new(SourceFile::new(
            "oak.ron",
            "(nodes: {\n    \"a\": nois(),\n})\n",
        ));
        Diagnostic::error(Code::UnknownKind, "there is no kind `nois`")
            .at(&source, 19..23, "no kind has this name")
            .nearest(vec!["noise".into()])
            .hint("run `yosegi nodes`")
    }

    #[test]
    fn text_looks_like_rustc() {
        insta::assert_snapshot!(render_text(&example()), @r#"
        error[unknown-kind]: there is no kind `nois`
         --> oak.ron:2:10
          |
        2 |     "a": nois(),
          |          ^^^^ no kind has this name
          |
          = help: did you mean `noise`?
          = help: run `yosegi nodes`
        "#);
    }

    #[test]
    fn a_cut_line_keeps_its_column() {
        let source = Arc::new(SourceFile::new("oak.ron", format!("{}x", "a".repeat(999))));
        let text = render_text(&Diagnostic::error(Code::Syntax, "here").at(&source, 999..1000, ""));
        assert!(
            text.contains("--> oak.ron:1:1000\n") && text.len() < 300,
            "{text}"
        );
    }

    #[test]
    fn only_twenty_of_many_are_printed() {
        let text = render_all(&vec![example(); 1000]);
        assert_eq!(text.matches("error[unknown-kind]").count(), 20);
        assert!(
            text.ends_with("\n1000 errors; the first 20 are shown\n"),
            "{text}"
        );
    }

    #[test]
    fn styled_text_has_colours_and_plain_text_has_none() {
        assert!(render_styled(&example()).contains("\u{1b}["));
        assert!(!render_text(&example()).contains('\u{1b}'));
    }
}
