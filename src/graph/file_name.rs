//! Names of files in a recipe: below its folder, and written the same on every system.

use super::literal::{Reader, Slot};
use super::names::{is_reserved, shown};
use super::tree::Tree;
use crate::diagnostics::Code;
use crate::value::{Type, Value};

impl Reader<'_> {
    /// A path below the recipe's folder or its assets; any path where the caller allows more.
    pub(super) fn file_name(&mut self, tree: &Tree, slot: Slot<'_>) -> Option<String> {
        let path = self.text_for(tree, slot)?;
        self.check_path(path, tree, slot)
    }

    /// The value of a parameter, if it may stand for a file where a file is named.
    pub(super) fn allowed_file(
        &mut self,
        value: Value,
        tree: &Tree,
        slot: Slot<'_>,
    ) -> Option<Value> {
        match (slot.value_type, value) {
            (Type::File, Value::Text(path)) => self.check_path(path, tree, slot).map(Value::Text),
            (_, value) => Some(value),
        }
    }

    fn check_path(&mut self, path: String, tree: &Tree, slot: Slot<'_>) -> Option<String> {
        let Some(reason) = mistake(&path, self.report.allow_outside) else {
            return Some(path);
        };
        let message = format!(
            "{} must be a file in the folder of the recipe or of its assets, found {}",
            shown(slot.name),
            shown(&path)
        );
        let span = tree.span.clone();
        self.refuse(Code::PathOutside, message, span, reason, |error| {
            error
                .expected(
                    "a path below the recipe's folder or its assets",
                    shown(&path),
                )
                .hint("write a path such as `photos/bar.png`, with forward slashes")
        })
    }
}

/// What is wrong with a path. Whether the file exists does not matter, so that nothing can be learnt
/// about other folders.
fn mistake(path: &str, allow_outside: bool) -> Option<&'static str> {
    if path.is_empty() {
        return Some("the path is empty");
    }
    if path.contains(char::is_control) {
        return Some("the path has a control character");
    }
    if allow_outside {
        return None;
    }
    let mut parts = path.split('/');
    if path.starts_with('/') {
        Some("the path begins at the root of the disk")
    } else if parts.clone().any(|part| part == "..") {
        Some("the path leaves the folder")
    } else if path.contains('\\') {
        Some("the path has a backslash")
    } else if path.contains(':') {
        Some("the path has a colon")
    } else if is_percent_escape(path) {
        Some("the path has a percent escape")
    } else {
        parts.find_map(mistake_of_part)
    }
}

/// `%2e`, `%2f`, `%5c`: a dot, a slash, a backslash for programs that decode them.
fn is_percent_escape(path: &str) -> bool {
    let path = path.to_ascii_lowercase();
    ["%2e", "%2f", "%5c"]
        .iter()
        .any(|escape| path.contains(escape))
}

/// What Windows would take for something else.
fn mistake_of_part(part: &str) -> Option<&'static str> {
    let stem = part.split('.').next().unwrap_or(part);
    let is_short = stem.split_once('~').is_some_and(|(_, number)| {
        !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
    });
    if is_short {
        Some("the path has a short name of Windows")
    } else if is_reserved(stem) {
        Some("the path has a device of Windows")
    } else if part != "." && part.ends_with(['.', ' ']) {
        Some("a part of the path ends with a dot or a space")
    } else {
        None
    }
}
