//! The names under which fields read what is given around them.

use super::{Field, Operation};
use crate::key::Key;
use std::collections::{BTreeSet, HashSet};
use std::rc::Rc;
use std::sync::Arc;

/// A name with the number of columns.
type Name = (Arc<str>, usize);

/// The names, with the number of columns, that fields read from around them and that nothing inside gives.
pub(crate) fn names_read(fields: impl IntoIterator<Item = Field>) -> BTreeSet<(Arc<str>, usize)> {
    let nothing: Rc<BTreeSet<Name>> = Rc::default();
    let mut waiting: Vec<(Field, Rc<BTreeSet<Name>>)> = fields
        .into_iter()
        .map(|field| (field, Rc::clone(&nothing)))
        .collect();
    let mut seen: HashSet<(Key, Rc<BTreeSet<Name>>)> = HashSet::new();
    let mut read = BTreeSet::new();
    while let Some((field, given)) = waiting.pop() {
        if !seen.insert((field.key(), Rc::clone(&given))) {
            continue;
        }
        let mut wait = |field: &Field, given: &Rc<BTreeSet<Name>>| {
            waiting.push((field.clone(), Rc::clone(given)));
        };
        match &field.0.operation {
            Operation::Constant(_) | Operation::Position | Operation::Remainder => {}
            Operation::Part { of, .. } => wait(of, &given),
            Operation::Kernel { inputs, .. } => inputs.iter().for_each(|it| wait(it, &given)),
            Operation::At { field, opening } => {
                opening.fields().for_each(|it| wait(it, &given));
                match opening.given.is_empty() {
                    true => wait(field, &given),
                    false => {
                        let mut inner = (*given).clone();
                        let names = opening.given.iter();
                        inner.extend(names.map(|(name, field)| (Arc::clone(name), field.width())));
                        wait(field, &Rc::new(inner));
                    }
                }
            }
            Operation::Given { name, otherwise } => {
                let name = (Arc::clone(name), field.width());
                if !given.contains(&name) {
                    read.insert(name);
                }
                wait(otherwise, &given);
            }
        }
    }
    read
}
