//! From text to a checked graph.
//!
//! [`load`] reads a recipe and reports everything that is wrong with it at once. What it gives is a
//! [`Graph`]: every name resolved, every literal of the type its input declares, every link between
//! matching types, no cycle. Nothing behind this module sees recipe text again, except by span.

mod arithmetic;
mod binding;
mod check;
mod circles;
mod composite;
mod compound;
mod described;
mod domains;
pub mod edit;
mod file_name;
mod instead;
mod lexer;
mod links;
mod literal;
mod load;
mod names;
mod number;
mod order;
mod origin;
mod parameters;
mod recipe;
mod reference;
mod report;
mod syntax;
mod text;
mod text_literal;
mod tree;

pub use compound::{Compound, compounds, kinds};
pub use load::{Loaded, Settings, load, load_text, load_text_with, load_until, no_output};
pub use origin::Origin;

use crate::diagnostics::{SourceFile, Span};
use crate::node::Kind;
use crate::value::{Domain, Value};
use petgraph::graph::{DiGraph, NodeIndex};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A recipe that has been checked.
#[derive(Debug)]
pub struct Graph {
    /// The text it came from.
    pub source: Arc<SourceFile>,
    /// What the recipe says it is for.
    pub about: String,
    /// Mixed into every random stream.
    pub seed: u64,
    /// Whether files may be read from anywhere, and not only below the recipe's folder.
    pub allow_outside: bool,
    /// The parameters in the order of the file.
    pub parameters: Vec<Parameter>,
    /// The nodes and the outputs; an edge leads from a node to one that reads it.
    pub nodes: DiGraph<Node, ()>,
    /// The outputs in the order of the file.
    pub outputs: Vec<NodeIndex>,
    /// Nodes by name; those inside a compound behind the name of its use: `board/planks`.
    pub by_name: BTreeMap<String, NodeIndex>,
    /// The uses of compounds by name, whose nodes stand in their place.
    pub uses: BTreeMap<String, CompoundUse>,
    /// The files it was read from: the recipe, then the compounds it uses.
    pub files: Vec<Arc<SourceFile>>,
    /// The kind that it is, if it is a compound: it is checked with stand-ins for its inputs, and cannot be
    /// rendered.
    pub interface: Option<&'static Kind>,
}

/// The use of a compound.
#[derive(Clone, Debug)]
pub struct CompoundUse {
    /// The interface of the compound.
    pub kind: &'static Kind,
    /// Where its outputs come from, in the order of the interface.
    pub outputs: Vec<Link>,
}

impl Graph {
    /// The node called `name`; outputs are not nodes.
    pub fn node(&self, name: &str) -> Option<&Node> {
        self.by_name.get(name).map(|index| &self.nodes[*index])
    }
}

/// A value that a recipe exposes.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// The name, without the dollar sign.
    pub name: String,
    /// The value in force: the default, or what the caller set.
    pub value: Value,
    /// The unit, as written.
    pub unit: String,
    /// Smallest and largest value.
    pub range: Option<(f64, f64)>,
    /// What it means.
    pub about: String,
}

/// A node of a checked graph.
#[derive(Debug)]
pub struct Node {
    /// The name in the recipe.
    pub name: Arc<str>,
    /// What it is an instance of.
    pub kind: &'static Kind,
    /// Where the name stands.
    pub span: Span,
    /// The file that the name stands in, and through which uses of compounds it comes into the recipe.
    pub origin: Arc<Origin>,
    /// One entry for each input of the kind, in its order.
    pub inputs: Vec<Binding>,
    /// Where outputs without a domain of their own are defined.
    pub domain: Domain,
}

/// Where an input of a node gets its value.
#[derive(Clone, Debug)]
pub struct Binding {
    /// Where it is written; the node's own place for defaults.
    pub span: Span,
    /// The value or where it comes from.
    pub source: Source,
}

/// The value of an input, or where it comes from.
#[derive(Clone, Debug)]
pub enum Source {
    /// An optional input that the recipe left out.
    Absent,
    /// Known: a literal, a parameter or a default. Files hold their path; the engine reads them.
    Literal(Value),
    /// A file to be read.
    File(NamedFile),
    /// An output of another node.
    Link(Link),
    /// Arithmetic over links; what was constant in it is folded.
    Arithmetic(Arithmetic),
    /// Named values, each with a source of its own.
    Channels(Vec<(String, Source)>),
}

/// A file that an input names.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct NamedFile {
    /// The folder of the recipe or compound that names it.
    pub folder: Arc<Path>,
    /// The path from there, or from the assets there.
    pub path: PathBuf,
}

impl NamedFile {
    /// A file that is named in `source`.
    fn beside(source: &SourceFile, path: PathBuf) -> NamedFile {
        let folder = source.path.parent().unwrap_or(Path::new("")).into();
        NamedFile { folder, path }
    }
}

/// An output of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The node.
    pub node: NodeIndex,
    /// Which of its outputs.
    pub output: usize,
}

/// An arithmetic expression over fields.
#[derive(Clone, Debug, PartialEq)]
pub enum Arithmetic {
    /// A number.
    Number(f64),
    /// A number that another node gives.
    Link(Link),
    /// The opposite of a number.
    Negate(Box<Arithmetic>),
    /// Two numbers and what is done with them.
    Binary(Operator, Box<[Arithmetic; 2]>),
    /// A function of numbers, by name.
    Call(Function, Vec<Arithmetic>),
}

/// What arithmetic does with two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
}

/// The functions of arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    /// Smallest of two.
    Min,
    /// Largest of two.
    Max,
    /// Without sign.
    Abs,
    /// Square root; of a negative number 0.
    Sqrt,
    /// `clamp(x, low, high)`.
    Clamp,
    /// `mix(a, b, amount)`: a at 0, b at 1.
    Mix,
    /// Relative luminance of a colour link: 0.2126 r + 0.7152 g + 0.0722 b.
    Luminance,
}
