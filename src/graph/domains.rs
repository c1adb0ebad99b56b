//! Where every node is defined: nowhere in particular, in a solid or on a plane.

use super::Binding;
use super::check::{Draft, Expanded, UseDraft};
use super::names::shown;
use super::report::Report;
use crate::diagnostics::{Code, Diagnostic, Span};
use crate::node::Kind;
use crate::value::Domain;
use petgraph::graph::NodeIndex;

/// What an input is given.
struct Given {
    /// The place of the input.
    span: Span,
    /// The name of the input.
    input: &'static str,
    /// What the kind asks for.
    wanted: Option<Domain>,
    /// Where the link is defined.
    domain: Domain,
}

/// Finds the domains of the nodes, each after those it reads, and reports what does not fit.
pub(super) fn resolve(report: &mut Report, expanded: &mut Expanded, order: &[NodeIndex]) {
    let drafts = &mut expanded.drafts;
    let mut problems = vec![];
    for index in order {
        let draft = &drafts[index.index()];
        if draft.domain.is_some() {
            continue;
        }
        let domain = given(drafts, draft.kind, &draft.bindings)
            .and_then(|given| common(report, &mut problems, draft, &given));
        drafts[index.index()].domain = domain;
    }
    let uses = expanded.uses.iter();
    let wrong: Vec<_> = uses
        .flat_map(|one| of_use(report, &expanded.drafts, one))
        .collect();
    // What a use does not take, the nodes inside do not take either.
    problems.retain(|problem| wrong.is_empty() || problem.uses.is_none());
    problems
        .into_iter()
        .chain(wrong)
        .for_each(|problem| report.add(problem));
}

/// What a compound states about its inputs and is given otherwise.
fn of_use(report: &mut Report, drafts: &[Draft], one: &UseDraft) -> Vec<Diagnostic> {
    report.enter(&one.origin);
    let given = given(drafts, Some(one.kind), &one.bindings).unwrap_or_default();
    let wrong = given
        .iter()
        .filter_map(|given| Some((given, given.refused()?)));
    wrong
        .map(|(given, wanted)| wrong_domain(report, &one.name, given, wanted))
        .collect()
}

impl Given {
    /// What the kind asks for, if it is something else.
    fn refused(&self) -> Option<Domain> {
        self.wanted
            .filter(|wanted| self.domain != Domain::Everywhere && self.domain != *wanted)
    }
}

/// What the links of a node give; `None` if something else is wrong with it or with what it reads.
fn given(
    drafts: &[Draft],
    kind: Option<&'static Kind>,
    bindings: &[Option<Binding>],
) -> Option<Vec<Given>> {
    let mut given = vec![];
    for (input, binding) in kind?.inputs.iter().zip(bindings) {
        let binding = binding.as_ref()?;
        for link in binding.source.links() {
            let source = &drafts[link.node.index()];
            let output = &source.kind?.outputs[link.output];
            let domain = match output.domain {
                Some(domain) => domain,
                None => source.domain?,
            };
            let (span, wanted) = (binding.span.clone(), input.domain);
            given.push(Given {
                span,
                input: input.name,
                wanted,
                domain,
            });
        }
    }
    Some(given)
}

/// The domain that outputs without one of their own take from the inputs.
fn common(
    report: &mut Report,
    problems: &mut Vec<Diagnostic>,
    draft: &Draft,
    given: &[Given],
) -> Option<Domain> {
    report.enter(&draft.origin);
    let before = problems.len();
    for (one, wanted) in given.iter().filter_map(|one| Some((one, one.refused()?))) {
        problems.push(wrong_domain(report, &draft.name, one, wanted));
    }
    let mut is_valid = problems.len() == before;
    let kind = draft.kind?;
    let takes_all = kind.outputs.iter().any(|output| output.domain.is_none());
    let mut deciding = given
        .iter()
        .filter(|one| one.domain != Domain::Everywhere && (takes_all || one.wanted.is_none()));
    let Some(first) = deciding.next() else {
        return is_valid.then_some(Domain::Everywhere);
    };
    if let Some(other) = deciding.find(|other| other.domain != first.domain)
        && is_valid
    {
        problems.push(mixed(report, draft, first, other));
        is_valid = false;
    }
    is_valid.then_some(first.domain)
}

fn wrong_domain(report: &Report, node: &str, given: &Given, wanted: Domain) -> Diagnostic {
    let (name, found) = (shown(given.input), given.domain);
    let message = format!("{name} takes a {wanted} field or material, found a {found} one");
    let error = report
        .error(
            Code::WrongDomain,
            message,
            given.span.clone(),
            format!("{found}"),
        )
        .in_node(node)
        .expected(wanted, found);
    match wanted {
        Domain::Plane => error.hint("cut it first, for example with `slice_cut`"),
        _ => error.hint("link to what has not been cut"),
    }
}

fn mixed(report: &Report, draft: &Draft, first: &Given, other: &Given) -> Diagnostic {
    let (a, b) = (shown(first.input), shown(other.input));
    let message = format!(
        "node {} mixes a {} field ({a}) and a {} field ({b})",
        shown(&draft.name),
        first.domain,
        other.domain
    );
    report
        .error(
            Code::MixedDomains,
            message,
            other.span.clone(),
            format!("{}", other.domain),
        )
        .and_at(first.span.clone(), format!("{}", first.domain))
        .in_node(&*draft.name)
        .expected(first.domain, other.domain)
        .hint("cut the solid first, for example with `slice_cut`")
}
