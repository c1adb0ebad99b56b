//! Progress as a listener hears it.

use super::*;

#[test]
fn progress_never_falls_and_ends_with_every_output() {
    let workshop = without_store();
    workshop.run(PAIR);
    let run = workshop.render(PAIR, &[], Cancel::new(), &|_| {});
    let mut ends = vec![];
    let mut before = 0.0;
    for event in &run.events {
        let Event::Progress {
            output,
            done,
            total,
            maps_done,
            maps_total,
            fraction,
            seconds_left,
        } = event
        else {
            continue;
        };
        assert_eq!((*total, *maps_total), (9, 2));
        assert!(*fraction >= before && *fraction <= 1.0 && done <= total);
        before = *fraction;
        assert_eq!(*seconds_left == Some(0.0), *fraction == 1.0, "{fraction}");
        if done == total {
            ends.push((output.as_str(), *maps_done, *fraction));
        }
    }
    assert_eq!(ends, [("pale", 0, 0.5), ("deep", 1, 1.0)]);
}

#[test]
fn what_need_not_be_painted_is_no_progress() {
    let workshop = with_store();
    workshop.run(PAIR);
    let recipe = edit(PAIR, "#805030", "#905030");
    let run = workshop.render(&recipe, &[], Cancel::new(), &|_| {});
    let mut progress = run.events.iter().filter_map(|event| match event {
        Event::Progress {
            maps_done,
            maps_total,
            fraction,
            ..
        } => Some((*maps_done, *maps_total, *fraction)),
        _ => None,
    });
    assert_eq!(progress.next_back(), Some((1, 2, 1.0)));
}
