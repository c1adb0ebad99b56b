//! Equations of a net of links, in which what flows along each link goes with the difference of its ends.

/// The links of a net: its two nodes and how well it leads.
pub(crate) type Link = (u32, u32, f64);

/// Steps of one solution, at most.
const STEPS: usize = 20_000;

/// How much of the sources may be left.
const REST: f64 = 1e-10;

/// The potentials at which each node gives away what its source brings, by conjugate gradients that are scaled by the diagonal
/// (Hestenes & Stiefel 1952). What sources bring must add up to 0; potentials are about 0. `go_on` is asked now and
/// then.
///
/// # Errors
/// What `go_on` says.
pub(crate) fn potentials<E>(
    links: &[Link],
    sources: &[f64],
    go_on: &mut dyn FnMut() -> Result<(), E>,
) -> Result<Vec<f64>, E> {
    let diagonal = diagonal(links, sources.len());
    let scaled = |rest: &[f64]| scaled(rest, &diagonal);
    let mut found = vec![0.0; sources.len()];
    // What rounding leaves of the sum has nowhere to go.
    let over = sources.iter().sum::<f64>() / sources.len().max(1) as f64;
    let mut rest: Vec<f64> = sources.iter().map(|source| source - over).collect();
    let mut along = scaled(&rest);
    let mut size = dot(&rest, &along);
    let enough = REST * REST * size;
    for step in 0..STEPS {
        if step.is_multiple_of(16) {
            go_on()?;
        }
        let flow = flow(links, &along);
        let steep = dot(&along, &flow);
        if size <= enough || steep <= 0.0 {
            break;
        }
        let length = size / steep;
        add(&mut found, length, &along);
        add(&mut rest, -length, &flow);
        let next = scaled(&rest);
        let new_size = dot(&rest, &next);
        let kept = new_size / size;
        along
            .iter_mut()
            .zip(&next)
            .for_each(|(along, next)| *along = next + kept * *along);
        size = new_size;
    }
    let mean = found.iter().sum::<f64>() / found.len().max(1) as f64;
    found.iter_mut().for_each(|potential| *potential -= mean);
    Ok(found)
}

/// How well all links of each node lead.
fn diagonal(links: &[Link], nodes: usize) -> Vec<f64> {
    let mut diagonal = vec![0.0; nodes];
    for (a, b, leads) in links {
        diagonal[*a as usize] += leads;
        diagonal[*b as usize] += leads;
    }
    diagonal
}

fn scaled(rest: &[f64], diagonal: &[f64]) -> Vec<f64> {
    let pairs = rest.iter().zip(diagonal);
    let share = |(rest, all): (&f64, &f64)| if *all > 0.0 { rest / all } else { 0.0 };
    pairs.map(share).collect()
}

/// What each node gives away.
fn flow(links: &[Link], potentials: &[f64]) -> Vec<f64> {
    let mut flow = vec![0.0; potentials.len()];
    for (a, b, leads) in links {
        let (a, b) = (*a as usize, *b as usize);
        let along = leads * (potentials[a] - potentials[b]);
        flow[a] += along;
        flow[b] -= along;
    }
    flow
}

fn add(to: &mut [f64], share: f64, what: &[f64]) {
    to.iter_mut()
        .zip(what)
        .for_each(|(to, what)| *to += share * what);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[test]
    fn a_ring_of_unequal_links_divides_what_flows() {
        // From the first node to the third: over the second with 1/1 + 1/2, over the fourth with 1/3 + 1/6.
        let links = [(0, 1, 1.0), (1, 2, 2.0), (2, 3, 3.0), (3, 0, 6.0)];
        let Ok(found) = potentials(&links, &[1.0 + 1e-9, 0.0, -1.0, 0.0], &mut || {
            Ok::<(), Infallible>(())
        });
        // Conductances 2/3 and 2 side by side.
        assert!((found[0] - found[2] - 1.0 / (2.0 / 3.0 + 2.0)).abs() < 1e-8);
        assert!(found.iter().sum::<f64>().abs() < 1e-12);
        let flow = flow(&links, &found);
        assert!((flow[0] - 1.0).abs() < 1e-8 && flow[1].abs() < 1e-8);
    }
}
