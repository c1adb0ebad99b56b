//! Finding and reading the files of compounds.

use super::super::names::{is_name, shown};
use super::super::recipe::{Role, role_of};
use super::super::report::Report;
use super::super::text;
use super::super::tree::{Entry, Shape, Tree, Word};
use super::{DEPTH, FILES};
use crate::diagnostics::{Code, Diagnostic, SourceFile, Use, nearest};
use crate::node::{Kind, interned};
use crate::world::World;
use std::collections::{BTreeSet, HashSet};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

include!(concat!(env!("OUT_DIR"), "/shipped.rs"));

/// The kinds that a recipe can name.
pub(in crate::graph) struct Library<'w> {
    /// Those written in Rust; no compound takes their names.
    pub(in crate::graph) kinds: &'w [&'static Kind],
    world: &'w dyn World,
    /// Whether files may be anywhere.
    allow_outside: bool,
    /// Whether kinds of compounds say what they mean.
    is_described: bool,
    /// Where compounds are looked for, the first first, before those that come with Yosegi.
    folders: [PathBuf; 2],
}

/// A file that was read: the recipe, or a compound.
#[derive(Debug)]
pub(in crate::graph) struct File {
    /// The name of the kind; of a recipe the name of its file.
    pub(in crate::graph) name: String,
    /// The text.
    pub(in crate::graph) source: Arc<SourceFile>,
    /// Its tree; `None` if it cannot be read, which is reported.
    pub(in crate::graph) tree: Option<Tree>,
    /// Whether it is a recipe or a compound.
    pub(in crate::graph) role: Role,
    /// The first use that led to it; `None` for the file that is loaded.
    pub(in crate::graph) first_use: Option<Arc<Use>>,
}

impl<'w> Library<'w> {
    /// The kinds for a recipe in `folder`: compounds lie in `nodes` there or beside it.
    pub(in crate::graph) fn new(
        kinds: &'w [&'static Kind],
        world: &'w dyn World,
        folder: &Path,
    ) -> Library<'w> {
        let folders = [folder.join("nodes"), folder.join("../nodes")];
        Library {
            kinds,
            world,
            allow_outside: false,
            is_described: false,
            folders,
        }
    }

    /// With files anywhere, if the caller allows them.
    pub(in crate::graph) fn allowing(self, allow_outside: bool) -> Library<'w> {
        Library {
            allow_outside,
            ..self
        }
    }

    /// The kind written in Rust that is called `name`.
    pub(in crate::graph) fn native(&self, name: &str) -> Option<&'static Kind> {
        self.kinds.iter().copied().find(|kind| kind.name == name)
    }

    /// Up to three names of kinds like `name`; only those that give maps if it stands for an output.
    pub(in crate::graph) fn nearest(&self, name: &str, is_output: bool) -> Vec<String> {
        let fitting = self
            .kinds
            .iter()
            .filter(|kind| kind.gives_maps() == is_output);
        let compounds = if is_output {
            BTreeSet::new()
        } else {
            self.names()
        };
        let compounds = compounds.iter().map(String::as_str);
        nearest(name, fitting.map(|kind| kind.name).chain(compounds))
    }

    /// What an interface says for readers: nothing, unless someone lists compounds. Kinds are kept for good,
    /// and those that recipes are checked against should not change with every word.
    pub(super) fn described(&self, text: &str) -> &'static str {
        if self.is_described {
            interned::text(text)
        } else {
            ""
        }
    }

    /// Whether there is a compound called `name`.
    pub(super) fn has_compound(&self, name: &str) -> bool {
        is_name(name) && self.find(name).is_some()
    }

    /// The names of all compounds.
    fn names(&self) -> BTreeSet<String> {
        let listed = |folder| self.world.list(folder).unwrap_or_default();
        let files = self.folders.iter().flat_map(|folder| listed(folder));
        let names = files.filter_map(|file| {
            let name = file.path.file_name()?.to_str()?.strip_suffix(".ron");
            name.map(str::to_owned)
        });
        let shipped = SHIPPED.iter().map(|(name, _)| (*name).to_owned());
        let is_new = |name: &String| is_name(name) && self.native(name).is_none();
        names.chain(shipped).filter(is_new).collect()
    }

    /// The start of a file, as much as a recipe may have and one byte more. A symbolic link that leads out
    /// of the folder counts as if nothing were there, unless the caller allows more.
    fn read(&self, folder: &Path, path: &Path) -> io::Result<Vec<u8>> {
        let real = self.world.real_path(path)?;
        if !self.allow_outside && !real.starts_with(self.world.real_path(folder)?) {
            return Err(io::ErrorKind::NotFound.into());
        }
        self.world.read_start(&real, text::LARGEST + 1)
    }

    /// The file of a compound; `None` if there is none.
    fn find(&self, name: &str) -> Option<Result<Arc<SourceFile>, Box<Diagnostic>>> {
        use io::ErrorKind::{NotADirectory, NotFound};
        for folder in &self.folders {
            let path = folder.join(format!("{name}.ron"));
            match self.read(folder, &path) {
                Ok(bytes) => return Some(text::decode(&path, bytes)),
                Err(error) if matches!(error.kind(), NotFound | NotADirectory) => {}
                Err(error) => {
                    let message = format!("`{}` could not be read: {error}", path.display());
                    return Some(Err(Diagnostic::error(Code::FileNotRead, message).into()));
                }
            }
        }
        let (_, text) = SHIPPED.iter().find(|(shipped, _)| *shipped == name)?;
        let path = format!("<yosegi>/nodes/{name}.ron");
        Some(Ok(Arc::new(SourceFile::new(path, *text))))
    }
}

/// The file in `source`, and those of all compounds that it uses; a file that is missing or is no RON is
/// reported. `None` if they are nested too deep, which is reported as well.
pub(in crate::graph) fn gather(
    report: &mut Report,
    library: &Library<'_>,
    source: &Arc<SourceFile>,
) -> Option<Vec<File>> {
    let tree = text::read(report);
    let stem = source.path.file_stem().unwrap_or_default();
    let mut files = vec![File {
        name: stem.to_string_lossy().into_owned(),
        source: Arc::clone(source),
        role: tree.as_ref().map_or(Role::Recipe, role_of),
        tree,
        first_use: None,
    }];
    let mut known: HashSet<String> = HashSet::new();
    let mut next = 0;
    while next < files.len() {
        for (name, one) in uses(&files[next], library) {
            if !known.insert(name.clone()) {
                continue;
            }
            let Some(found) = library.find(&name) else {
                continue;
            };
            if files.len() > FILES || one.chain().count() > DEPTH {
                report_too_many(report, &one);
                return None;
            }
            files.push(read(report, name, found, Arc::new(one)));
        }
        next += 1;
    }
    Some(files)
}

/// The uses of what is no native kind, in the order of the file.
fn uses(file: &File, library: &Library<'_>) -> Vec<(String, Use)> {
    let entries = file.tree.iter().flat_map(node_entries);
    let used = entries.filter_map(|entry| {
        let (name, word) = (entry.key.as_text()?, entry.value.word()?);
        (is_name(&word.text) && library.native(&word.text).is_none()).then(|| {
            let one = Use {
                source: Arc::clone(&file.source),
                span: entry.key.span.clone(),
                node: name.into(),
                kind: word.text.as_str().into(),
                outer: file.first_use.clone(),
            };
            (word.text.clone(), one)
        })
    });
    used.collect()
}

/// The entries of the field `nodes`.
fn node_entries(tree: &Tree) -> &[Entry] {
    let Shape::Record(None, fields) = &tree.shape else {
        return &[];
    };
    let nodes = fields.iter().find(|field| field.name.text == "nodes");
    match nodes.map(|field| &field.value.shape) {
        Some(Shape::Map(entries)) => entries,
        _ => &[],
    }
}

impl Tree {
    fn as_text(&self) -> Option<&str> {
        match &self.shape {
            Shape::Text(text) => Some(&text.value),
            _ => None,
        }
    }

    /// The name before parentheses.
    fn word(&self) -> Option<&Word> {
        match &self.shape {
            Shape::Record(word, _) | Shape::Tuple(word, _) => word.as_ref(),
            _ => None,
        }
    }
}

fn read(
    report: &mut Report,
    name: String,
    found: Result<Arc<SourceFile>, Box<Diagnostic>>,
    first_use: Arc<Use>,
) -> File {
    let mut file = File {
        name,
        source: Arc::clone(&first_use.source),
        tree: None,
        role: Role::Compound,
        first_use: Some(first_use),
    };
    match found {
        Ok(source) => {
            let mut own = Report::new(&source);
            own.cancel = report.cancel.clone();
            file.tree = text::read(&mut own);
            if file.tree.is_none() && !own.has_errors() {
                let message = "the file holds no compound";
                own.add(own.error(
                    Code::NotARecipe,
                    message,
                    0..0,
                    "nothing but space and comments",
                ));
            }
            report.absorb(own, &file.first_use);
            file.source = source;
        }
        Err(diagnostic) => report.add(diagnostic.used_by(file.first_use.clone())),
    }
    file
}

fn report_too_many(report: &mut Report, one: &Use) {
    let message = format!(
        "compounds are nested more than {DEPTH} levels deep, or there are more than {FILES} of them"
    );
    let error = Diagnostic::error(Code::NestedTooDeep, message).at(
        &one.source,
        one.span.clone(),
        format!("{} is not read", shown(&one.kind)),
    );
    report.add(error.used_by(one.outer.clone()));
}

/// A compound that recipes in a folder can use.
#[derive(Clone, Debug)]
pub struct Compound {
    /// Its interface, as a kind.
    pub kind: &'static Kind,
    /// Where it is written; in angle brackets if it comes with Yosegi.
    pub path: PathBuf,
}

/// Every kind that recipes in `folder` can use: those written in Rust, then the compounds.
pub fn kinds(world: &dyn World, folder: &Path) -> Vec<&'static Kind> {
    let compounds = compounds(world, folder);
    let compounds = compounds.iter().map(|compound| compound.kind);
    crate::nodes::KINDS
        .iter()
        .copied()
        .chain(compounds)
        .collect()
}

/// The compounds that recipes in `folder` can use, by name; those with mistakes are left out.
pub fn compounds(world: &dyn World, folder: &Path) -> Vec<Compound> {
    let library = Library {
        is_described: true,
        ..Library::new(crate::nodes::KINDS, world, folder)
    };
    let described = |name: String| {
        let source = library.find(&name)?.ok()?;
        let kind = super::super::load::interface(&library, &source)?;
        let path = source.path.clone();
        Some(Compound { kind, path })
    };
    library.names().into_iter().filter_map(described).collect()
}
