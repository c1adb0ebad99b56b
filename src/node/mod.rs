//! The authoring kit: what a node's file declares, and what its build function receives.
//!
//! From one [`Kind`] come the recipe reader, range checks, keys, `yosegi nodes` and the tests that run
//! over every kind. Start from `CONTRIBUTING.md`, and from `src/nodes/wood/pattern_lookup.rs`.

mod inputs;
pub(crate) mod interned;
mod ledger;
mod words;

pub(crate) use inputs::field_of;
pub use inputs::{Build, Failure, Inputs, common_domain};
pub(crate) use ledger::Budget;
pub(crate) use words::{counted, stretched};

use crate::value::{Domain, Type, Unit, Value};

/// A kind of node: its interface, its documentation and its maths.
#[derive(Debug)]
pub struct Kind {
    /// The name in recipes, in snake case; also the name of its file.
    pub name: &'static str,
    /// Raised whenever a result changes, so that no cache gives the old one.
    pub version: u32,
    /// What it does, in one or two sentences.
    pub about: &'static str,
    /// Where the maths comes from: author, year, equations; or `own construction` and why.
    pub source: &'static str,
    /// What goes in, in the order of the manual.
    pub inputs: &'static [Input],
    /// What comes out; `"node"` links to the first, `"node.name"` to any.
    pub outputs: &'static [Output],
    /// A whole recipe in which a node of this kind, or an output if it gives maps, is called `example`.
    pub example: &'static str,
    /// Makes the outputs, in order, from the inputs.
    pub build: fn(&Inputs<'_>, &Build<'_>) -> Result<Vec<Value>, Failure>,
}

impl Kind {
    /// The input called `name`, with its position.
    pub fn input(&self, name: &str) -> Option<(usize, &'static Input)> {
        self.inputs
            .iter()
            .enumerate()
            .find(|(_, input)| input.name == name)
    }

    /// The output called `name`, with its position.
    pub fn output(&self, name: &str) -> Option<(usize, &'static Output)> {
        self.outputs
            .iter()
            .enumerate()
            .find(|(_, output)| output.name == name)
    }

    /// Whether it draws random numbers, so that its results depend on the recipe's seed: such kinds have
    /// an input `seed` of their own.
    pub fn draws(&self) -> bool {
        self.input("seed").is_some()
    }

    /// Whether it is an output of a recipe, as opposed to a node.
    pub fn gives_maps(&self) -> bool {
        let first = self.outputs.first();
        first.is_some_and(|output| output.value_type == Type::Maps)
    }

    /// Whether it repeats on request: such kinds have an input `period`, a length or one for each axis.
    pub fn repeats(&self) -> bool {
        use Unit::Millimetre;
        let lengths = [
            Type::Number(Millimetre),
            Type::Pair(Millimetre),
            Type::Vector(Millimetre),
        ];
        self.input("period")
            .is_some_and(|(_, input)| lengths.contains(&input.value_type))
    }

    /// Whether its outputs are structures: built once, cached and stored.
    pub fn is_structure(&self) -> bool {
        self.outputs
            .iter()
            .any(|output| output.value_type.is_structure())
    }
}

/// Whether an input may differ from point to point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Varies {
    /// Must be known before evaluation: takes a literal or a parameter.
    Constant,
    /// Takes a literal, a parameter, arithmetic or a field.
    PerPoint,
}

/// What happens when a recipe leaves an input out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// It is an error.
    Required,
    /// The node does without.
    Optional,
    /// This RON literal is taken.
    Default(&'static str),
}

/// An input of a kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input {
    /// The name in recipes.
    pub name: &'static str,
    /// What it accepts.
    pub value_type: Type,
    /// Whether it may differ from point to point.
    pub varies: Varies,
    /// The domain that a field or material must have; `None` takes any.
    pub domain: Option<Domain>,
    /// What happens when it is left out.
    pub presence: Presence,
    /// Smallest and largest literal, both allowed; for vectors and pairs it holds for every part.
    pub range: Option<(f64, f64)>,
    /// What it means.
    pub about: &'static str,
}

impl Input {
    /// A required, constant input.
    pub const fn new(name: &'static str, value_type: Type, about: &'static str) -> Input {
        Input {
            name,
            value_type,
            varies: Varies::Constant,
            domain: None,
            presence: Presence::Required,
            range: None,
            about,
        }
    }

    /// A required number.
    pub const fn number(name: &'static str, unit: Unit, about: &'static str) -> Input {
        Input::new(name, Type::Number(unit), about)
    }

    /// Lets the input differ from point to point.
    pub const fn per_point(mut self) -> Input {
        self.varies = Varies::PerPoint;
        self
    }

    /// Asks for a field or material of one domain.
    pub const fn of(mut self, domain: Domain) -> Input {
        self.domain = Some(domain);
        self
    }

    /// Lets the recipe leave the input out.
    pub const fn optional(mut self) -> Input {
        self.presence = Presence::Optional;
        self
    }

    /// Takes this RON literal when the recipe leaves the input out.
    pub const fn default(mut self, literal: &'static str) -> Input {
        self.presence = Presence::Default(literal);
        self
    }

    /// Allows literals from `low` to `high`.
    pub const fn range(mut self, low: f64, high: f64) -> Input {
        self.range = Some((low, high));
        self
    }
}

/// An output of a kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output {
    /// The name in links.
    pub name: &'static str,
    /// What it gives.
    pub value_type: Type,
    /// Whether it differs from point to point.
    pub varies: Varies,
    /// Where it is defined; `None` is the domain of the node's inputs.
    pub domain: Option<Domain>,
    /// What it means.
    pub about: &'static str,
}

impl Output {
    /// A structure or another value that is the same everywhere.
    pub const fn new(name: &'static str, value_type: Type, about: &'static str) -> Output {
        Output {
            name,
            value_type,
            varies: Varies::Constant,
            domain: Some(Domain::Everywhere),
            about,
        }
    }

    /// A field or material, defined where the node's inputs are.
    pub const fn field(name: &'static str, value_type: Type, about: &'static str) -> Output {
        Output {
            name,
            value_type,
            varies: Varies::PerPoint,
            domain: None,
            about,
        }
    }

    /// States the domain, for outputs that do not take it from the inputs.
    pub const fn on(mut self, domain: Domain) -> Output {
        self.domain = Some(domain);
        self
    }
}
