//! What is fed with recipes, and what must hold whatever they are.

use crate::mutate::Random;
use std::sync::Arc;
use yosegi::diagnostics::{SourceFile, render_all, render_json};
use yosegi::graph::edit::{Edit, Place, Section, Step, apply, changes, find};
use yosegi::graph::{Settings, load_text};
use yosegi::nodes::KINDS;

/// A way to use a text, whether it was accepted; it panics if something is wrong.
pub(crate) type Target = fn(&str, u64) -> bool;

/// The targets by name.
pub(crate) const TARGETS: [(&str, Target); 2] = [("reader", reader), ("edit", edit)];

/// Loads the text; whatever is wrong with it can be printed in every way.
pub(crate) fn reader(text: &str, _: u64) -> bool {
    let Err(diagnostics) = load_text("a.ron", text, &Settings::default()) else {
        return true;
    };
    assert!(!diagnostics.is_empty(), "refused without a reason");
    for diagnostic in &diagnostics {
        if let (Some(source), Some(label)) = (&diagnostic.source, &diagnostic.label) {
            assert!(label.span.start <= label.span.end && label.span.end <= source.text.len() + 1);
        }
    }
    let shown = render_all(&diagnostics[..diagnostics.len().min(3)]);
    assert!(
        shown
            .chars()
            .all(|letter| letter == '\n' || !letter.is_control())
    );
    assert!(!render_json(&diagnostics[0]).contains('\n'));
    false
}

const LITERALS: [&str; 14] = [
    "1",
    "-0.5",
    "\"look\"",
    "\"$w\"",
    "\"= 2 * look.position\"",
    "(1, 2, 3)",
    "[(0, 0), (1, 1)]",
    "true",
    "{\"a\": 1}",
    "(at: 1)",
    "r#\"#ffffff\"#",
    " 7 ",
    "1 // c",
    "(",
];

/// Edits the text; an edit that is made can be found again, and nothing else has changed.
pub(crate) fn edit(text: &str, seed: u64) -> bool {
    let mut random = Random::new(seed);
    let source = Arc::new(SourceFile::new("a.ron", text));
    let names = Names::of(text);
    let edit = random_edit(&mut random, &names);
    let Ok(changes) = changes(KINDS, &source, &edit) else {
        return false;
    };
    let edited = apply(KINDS, &source, &edit).expect("what can be described can be made");
    let mut end = 0;
    let mut at = 0;
    for change in &changes {
        assert!(
            end <= change.span.start && change.span.end <= text.len(),
            "in order"
        );
        let kept = &text[end..change.span.start];
        assert_eq!(
            &edited[at..at + kept.len()],
            kept,
            "what is not changed stays"
        );
        at += kept.len() + change.text.len();
        end = change.span.end;
    }
    assert_eq!(&edited[at..], &text[end..], "the rest stays");
    let after = Arc::new(SourceFile::new("a.ron", &*edited));
    match &edit {
        Edit::Set { place, literal } => {
            let span = find(&after, place)
                .expect("valid")
                .expect("what was set is there");
            assert_eq!(&edited[span], literal.trim());
        }
        Edit::Remove { place } => assert_removed(&source, &after, place),
        Edit::Rename { section, from, to } => {
            assert!(has(&after, *section, to), "the new name is there");
            assert!(
                from == to || !has(&after, *section, from),
                "the old one is not"
            );
        }
        Edit::Add { section, name, .. } => assert!(has(&after, *section, name)),
        Edit::Delete { section, name } => assert!(!has(&after, *section, name)),
    }
    true
}

/// Whether there is exactly one entry of that name; calling it as it is called changes nothing.
fn has(source: &Arc<SourceFile>, section: Section, name: &str) -> bool {
    let (from, to) = (name.to_owned(), name.to_owned());
    let same = Edit::Rename { section, from, to };
    changes(KINDS, source, &same).is_ok_and(|changes| changes.is_empty())
}

/// The place is empty, or holds what was behind it.
fn assert_removed(before: &Arc<SourceFile>, after: &Arc<SourceFile>, place: &Place) {
    let value = |source: &Arc<SourceFile>, place: &Place| {
        let span = find(source, place).ok().flatten()?;
        Some(source.text[span].to_owned())
    };
    let next = match place {
        Place::Field {
            section,
            name,
            field,
            path,
        } => {
            let mut path = path.clone();
            let is_item = match path.last_mut() {
                Some(Step::Item(index)) => {
                    *index += 1;
                    true
                }
                _ => false,
            };
            let (section, name, field) = (*section, name.clone(), field.clone());
            is_item.then_some(Place::Field {
                section,
                name,
                field,
                path,
            })
        }
        Place::Recipe(_) => None,
    };
    let expected = next.and_then(|next| value(before, &next));
    assert_eq!(value(after, place), expected);
}

/// Words of a text that may be names.
#[derive(Debug)]
struct Names<'t> {
    /// In quotes before a colon, with some that always are.
    keys: Vec<&'t str>,
    /// Before a colon.
    fields: Vec<&'t str>,
}

impl<'t> Names<'t> {
    fn of(text: &'t str) -> Names<'t> {
        let mut names = Names {
            keys: vec!["a", "new_name"],
            fields: vec!["a", "about"],
        };
        for before in text.split(':') {
            let is_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
            let quoted = before.strip_suffix('"');
            let word = quoted.unwrap_or(before);
            let word = word.rsplit(|letter| !is_name(letter)).next().unwrap_or("");
            let word = if word.is_empty() { "a" } else { word };
            match quoted {
                Some(_) => names.keys.push(word),
                None => names.fields.push(word),
            }
        }
        names
    }
}

fn random_edit(random: &mut Random, names: &Names<'_>) -> Edit {
    let section = random_section(random);
    let literal = |random: &mut Random| random.pick(&LITERALS).to_owned();
    match random.below(10) {
        0..4 => Edit::Set {
            place: random_place(random, names),
            literal: literal(random),
        },
        4..6 => Edit::Remove {
            place: random_place(random, names),
        },
        6..8 => Edit::Rename {
            section,
            from: random.pick(&names.keys).to_owned(),
            to: random.pick(&names.keys).to_owned(),
        },
        8 => Edit::Add {
            section,
            name: random.pick(&names.keys).to_owned(),
            instance: random
                .pick(&["mix()", "mix(a: 1)", "number(default: 1)", "3"])
                .to_owned(),
        },
        _ => Edit::Delete {
            section,
            name: random.pick(&names.keys).to_owned(),
        },
    }
}

fn random_section(random: &mut Random) -> Section {
    // Most of a recipe is nodes.
    Section::ALL[[0, 1, 1, 1, 1, 2][random.below(6)]]
}

fn random_place(random: &mut Random, names: &Names<'_>) -> Place {
    if random.below(12) == 0 {
        return Place::Recipe(random.pick(&["about", "seed"]).to_owned());
    }
    let steps = random.below(3) * random.below(2);
    let path = (0..steps).map(|_| match random.below(3) {
        0 => Step::Part(random.pick(&names.fields).to_owned()),
        1 => Step::Entry(random.pick(&names.keys).to_owned()),
        _ => Step::Item(random.below(4)),
    });
    let path = path.collect();
    Place::Field {
        section: random_section(random),
        name: random.pick(&names.keys).to_owned(),
        field: random.pick(&names.fields).to_owned(),
        path,
    }
}
