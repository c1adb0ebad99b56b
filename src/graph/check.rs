//! Every node against its kind; the nodes of compounds in the place of their uses.

use super::compound::{Definition, Slot};
use super::links::{Linker, Scope};
use super::literal::Reader;
use super::parameters::{Interface, Parameters};
use super::recipe::Declaration;
use super::report::Report;
use super::{Binding, CompoundUse, Link, Node, Origin, Source};
use crate::diagnostics::{Span, Use};
use crate::node::Kind;
use crate::value::{Domain, Value};
use petgraph::graph::NodeIndex;
use std::sync::Arc;

/// A node or an output while it is checked.
#[derive(Clone, Debug)]
pub(super) struct Draft {
    /// The name, behind those of the nodes it lies in.
    pub(super) name: Arc<str>,
    /// Where the name is.
    pub(super) span: Span,
    /// The file, the seed and the use that it comes from.
    pub(super) origin: Arc<Origin>,
    /// The kind; `None` if there is none by that name, which is reported.
    pub(super) kind: Option<&'static Kind>,
    /// One entry for each input; `None` where something is wrong, which is reported.
    pub(super) bindings: Vec<Option<Binding>>,
    /// Where the outputs are defined; `None` until it is known.
    pub(super) domain: Option<Domain>,
    /// Whether it stands under `outputs`.
    pub(super) is_output: bool,
}

impl Draft {
    /// A node of which nothing is known yet.
    pub(super) fn empty(origin: &Arc<Origin>) -> Draft {
        Draft {
            name: "".into(),
            span: 0..0,
            origin: Arc::clone(origin),
            kind: None,
            bindings: vec![],
            domain: None,
            is_output: false,
        }
    }

    /// The node, if nothing is wrong with it.
    pub(super) fn finish(self) -> Option<Node> {
        Some(Node {
            name: self.name,
            kind: self.kind?,
            span: self.span,
            origin: self.origin,
            inputs: self.bindings.into_iter().collect::<Option<_>>()?,
            domain: self.domain?,
        })
    }
}

/// The use of a compound.
#[derive(Debug)]
pub(super) struct UseDraft {
    /// The name, behind those of the nodes it lies in.
    pub(super) name: Arc<str>,
    /// Where the name is.
    pub(super) span: Span,
    /// The file that uses it.
    pub(super) origin: Arc<Origin>,
    /// The compound.
    pub(super) kind: &'static Kind,
    /// Its inputs; `None` where something is wrong, which is reported.
    pub(super) bindings: Vec<Option<Binding>>,
    /// Where its outputs lie.
    pub(super) outputs: Vec<Option<Link>>,
    /// Its nodes.
    pub(super) nodes: std::ops::Range<usize>,
}

impl UseDraft {
    /// The use by name, if nothing is wrong with it.
    pub(super) fn finish(&self) -> Option<(String, CompoundUse)> {
        let outputs: Option<Vec<_>> = self.outputs.iter().copied().collect();
        let (kind, outputs) = (self.kind, outputs?);
        Some((self.name.to_string(), CompoundUse { kind, outputs }))
    }
}

/// All nodes of a recipe and of its compounds.
#[derive(Debug)]
pub(super) struct Expanded {
    /// The nodes, then the outputs.
    pub(super) drafts: Vec<Draft>,
    /// The uses of compounds.
    pub(super) uses: Vec<UseDraft>,
    /// For each definition which of its inputs or parameters something refers to.
    pub(super) used: Vec<Vec<bool>>,
}

/// A recipe, or a compound in the place of one use.
struct Instance {
    definition: usize,
    /// The index of its first node.
    base: usize,
    /// What stands before the names of its nodes.
    prefix: String,
    origin: Arc<Origin>,
    parameters: Parameters,
}

/// Checks the nodes, then the outputs, in the order of the file, and what is inside compounds behind
/// them. `parameters` are those of the first definition, which is the recipe.
pub(super) fn check(
    report: &mut Report,
    definitions: &[Definition<'_>],
    parameters: Parameters,
    origin: Arc<Origin>,
) -> Expanded {
    let mut expanded = Expanded {
        drafts: vec![Draft::empty(&origin); definitions[0].layout.size],
        uses: vec![],
        used: vec![vec![]; definitions.len()],
    };
    let mut pending = vec![Instance {
        definition: 0,
        base: 0,
        prefix: String::new(),
        origin,
        parameters,
    }];
    while let Some(mut instance) = pending.pop() {
        report.enter(&instance.origin);
        let definition = &definitions[instance.definition];
        pending.extend(instance.check(report, definitions, definition, &mut expanded));
        instance
            .parameters
            .add_used(&mut expanded.used[instance.definition]);
    }
    check_unusable(report, definitions);
    expanded
}

/// Nodes of a compound that is looked at although nothing can use it.
const LARGEST_ASIDE: usize = 10_000;

/// Finds what else is wrong inside compounds that have no interface, so that nothing uses them.
fn check_unusable(report: &mut Report, definitions: &[Definition<'_>]) {
    for (index, definition) in definitions.iter().enumerate().skip(1) {
        if definition.kind.is_some() || definition.layout.size > LARGEST_ASIDE {
            continue;
        }
        let origin = Arc::new(Origin::of_file(definition.file));
        let interface = Arc::clone(&definition.interface);
        let unknown = vec![None; interface.declared.len()];
        let mut instance = Instance {
            definition: index,
            base: 0,
            prefix: String::new(),
            parameters: Parameters::bound(interface, unknown),
            origin: Arc::clone(&origin),
        };
        let mut aside = Expanded {
            drafts: vec![Draft::empty(&origin); definition.layout.size],
            uses: vec![],
            used: vec![],
        };
        report.enter(&origin);
        instance.check(report, definitions, definition, &mut aside);
    }
}

impl Instance {
    /// Checks the declarations, and gives the compounds that are used among them.
    fn check(
        &mut self,
        report: &mut Report,
        definitions: &[Definition<'_>],
        definition: &Definition<'_>,
        expanded: &mut Expanded,
    ) -> Vec<Instance> {
        let scope = Scope {
            layout: &definition.layout,
            base: self.base,
        };
        let recipe = &definition.recipe;
        let declarations = recipe.nodes.iter().chain(&recipe.outputs);
        let mut inside = vec![];
        for (position, (declaration, slot)) in
            declarations.zip(&definition.layout.slots).enumerate()
        {
            let index = self.base + slot.offset;
            let mut linker = Linker {
                reader: Reader::new(&mut self.parameters, report, Some(declaration.name)),
                scope: &scope,
                index: NodeIndex::new(index),
            };
            // What comes after too many mistakes is not reported anyway.
            let kind = slot.kind.filter(|_| !linker.reader.report.is_full());
            let interface = slot.inside.map(|used| &*definitions[used].interface);
            let bindings = kind.map(|kind| bind_inputs(&mut linker, declaration, kind, interface));
            let bindings = bindings.unwrap_or_default();
            match (slot.inside, kind) {
                (None, _) => {
                    expanded.drafts[index] = Draft {
                        name: self.name(declaration),
                        span: declaration.span.clone(),
                        origin: Arc::clone(&self.origin),
                        kind,
                        bindings,
                        domain: None,
                        is_output: position >= recipe.nodes.len(),
                    };
                }
                (Some(used), Some(kind)) => {
                    let one = self.used(declaration, slot, kind, bindings, &definitions[used]);
                    inside.push(self.instance(&one, used, &definitions[used]));
                    expanded.uses.push(one);
                }
                (Some(_), None) => {}
            }
        }
        inside
    }

    fn name(&self, declaration: &Declaration<'_>) -> Arc<str> {
        match self.prefix.as_str() {
            "" => declaration.name.into(),
            prefix => format!("{prefix}/{}", declaration.name).into(),
        }
    }

    fn used(
        &self,
        declaration: &Declaration<'_>,
        slot: &Slot,
        kind: &'static Kind,
        bindings: Vec<Option<Binding>>,
        definition: &Definition<'_>,
    ) -> UseDraft {
        let first = self.base + slot.offset;
        let link = |output| {
            slot.output(output).map(|place| Link {
                node: NodeIndex::new(self.base + place.offset),
                output: place.output,
            })
        };
        UseDraft {
            name: self.name(declaration),
            span: declaration.span.clone(),
            origin: Arc::clone(&self.origin),
            kind,
            bindings,
            outputs: (0..kind.outputs.len()).map(link).collect(),
            nodes: first..first + definition.layout.size,
        }
    }

    /// The compound in the place of its use.
    fn instance(
        &self,
        one: &UseDraft,
        definition: usize,
        Definition {
            file, interface, ..
        }: &Definition<'_>,
    ) -> Instance {
        let sources = one.bindings.iter().take(interface.declared.len());
        let sources = sources.map(|binding| Some(binding.as_ref()?.source.clone()));
        let seed = match one.bindings.last() {
            Some(Some(Binding {
                source: Source::Literal(Value::Whole(seed)),
                ..
            })) => *seed,
            _ => 0,
        };
        let uses = Use {
            source: Arc::clone(&self.origin.source),
            span: one.span.clone(),
            node: Arc::clone(&one.name),
            kind: one.kind.name.into(),
            outer: self.origin.uses.clone(),
        };
        Instance {
            definition,
            base: one.nodes.start,
            prefix: one.name.to_string(),
            origin: Arc::new(Origin {
                source: Arc::clone(&file.source),
                seed: Origin::mixed_seed(self.origin.seed, seed),
                uses: Some(Arc::new(uses)),
            }),
            parameters: Parameters::bound(Arc::clone(interface), sources.collect()),
        }
    }
}

fn bind_inputs(
    linker: &mut Linker<'_, '_>,
    declaration: &Declaration<'_>,
    kind: &'static Kind,
    interface: Option<&Interface>,
) -> Vec<Option<Binding>> {
    let owner = format!("an input of `{}`", kind.name);
    let found = linker
        .reader
        .assign(&owner, kind.inputs, declaration.fields);
    let declared = |index: usize| interface?.declared.get(index);
    let inputs = kind.inputs.iter().enumerate().zip(found);
    inputs
        .map(|((index, input), tree)| {
            let input = (input, declared(index));
            linker.bind(&owner, input, tree, &declaration.span)
        })
        .collect()
}
