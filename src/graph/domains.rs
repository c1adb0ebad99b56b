//! Where every node is defined: nowhere in particular, in a solid or on a plane.

use super::check::Draft;
use super::names::shown;
use super::report::Report;
use crate::diagnostics::{Code, Span};
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
pub(super) fn resolve(report: &mut Report, drafts: &mut [Draft], order: &[NodeIndex]) {
    for index in order {
        let domain = given(drafts, &drafts[index.index()])
            .and_then(|given| common(report, &drafts[index.index()], &given));
        drafts[index.index()].domain = domain;
    }
}

/// What the links of a node give; `None` if something else is wrong with it or with what it reads.
fn given(drafts: &[Draft], draft: &Draft) -> Option<Vec<Given>> {
    let kind = draft.kind?;
    let mut given = vec![];
    for (input, binding) in kind.inputs.iter().zip(&draft.bindings) {
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
fn common(report: &mut Report, draft: &Draft, given: &[Given]) -> Option<Domain> {
    let mut is_valid = true;
    for one in given {
        if let Some(wanted) = one.wanted
            && one.domain != Domain::Everywhere
            && one.domain != wanted
        {
            report_wrong(report, draft, one, wanted);
            is_valid = false;
        }
    }
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
        report_mixed(report, draft, first, other);
        is_valid = false;
    }
    is_valid.then_some(first.domain)
}

fn report_wrong(report: &mut Report, draft: &Draft, given: &Given, wanted: Domain) {
    let (name, found) = (shown(given.input), given.domain);
    let message = format!("{name} takes a {wanted} field or material, found a {found} one");
    let error = report
        .error(
            Code::WrongDomain,
            message,
            given.span.clone(),
            format!("{found}"),
        )
        .in_node(&*draft.name)
        .expected(wanted, found);
    report.add(match wanted {
        Domain::Plane => error.hint("cut it first, for example with `slice_cut`"),
        _ => error.hint("link to what has not been cut"),
    });
}

fn report_mixed(report: &mut Report, draft: &Draft, first: &Given, other: &Given) {
    let (a, b) = (shown(first.input), shown(other.input));
    let message = format!(
        "node {} mixes a {} field ({a}) and a {} field ({b})",
        shown(&draft.name),
        first.domain,
        other.domain
    );
    report.add(
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
            .hint("cut the solid first, for example with `slice_cut`"),
    );
}
