//! The cases, by group.

mod distance;
mod energy;
mod images;
mod lobes;
mod place;
mod rays;
mod samples;
mod triangles;

use crate::case::{Case, Group, Verdict};
use std::collections::HashSet;

/// What happens in several groups without the bound on a ray's start.
const SELF_SHADOW: &str = "walls meet the rays that leave them";

/// Every case with its group.
pub fn all() -> Vec<(Group, &'static Case)> {
    Group::ALL.into_iter().flat_map(|group| of(group).map(move |case| (group, case))).collect()
}

/// The cases of a group, by theme.
pub fn of(group: Group) -> impl Iterator<Item = &'static Case> {
    let themes: &[&[Case]] = match group {
        Group::Rays => &[rays::CASES],
        Group::Place => place::CASES,
        Group::Distance => distance::CASES,
        Group::Triangles => triangles::CASES,
        Group::Energy => energy::CASES,
        Group::Lobes => lobes::CASES,
        Group::Images => images::CASES,
        Group::Samples => &[samples::CASES],
    };
    themes.iter().copied().flatten()
}

/// Whether the catalogue is one: enough cases, each with a name of its own, and every text said.
pub fn are_sound() -> Verdict {
    let cases = all();
    let names: HashSet<String> = cases.iter().map(|(group, case)| case.full_name(*group)).collect();
    if names.len() != cases.len() {
        return Err("two cases share a name".into());
    }
    for (group, case) in &cases {
        for text in [case.name, case.hard, case.elsewhere, case.holds, case.without, case.guard.name, case.guard.does] {
            if text.is_empty() || text.contains(['|', '\n']) || text.ends_with('.') {
                return Err(format!("{}: \"{text}\" does not fit a table", case.full_name(*group)));
            }
        }
    }
    Ok(())
}
