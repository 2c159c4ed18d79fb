//! Ids that stay the same from bake to bake where names alone do not suffice.

use crate::artefact::StableId;
use std::collections::HashMap;

/// Makes ids unique: the second `a` becomes `a#2`, the third `a#3`, in the order given.
pub fn unique_ids(ids: impl IntoIterator<Item = StableId>) -> Vec<StableId> {
    let ids: Vec<StableId> = ids.into_iter().collect();
    let mut taken: std::collections::HashSet<String> = ids.iter().map(|id| id.as_str().to_owned()).collect();
    let mut seen: HashMap<String, usize> = HashMap::new();
    ids.into_iter()
        .map(|id| {
            let count = seen.entry(id.as_str().to_owned()).or_insert(0);
            *count += 1;
            if *count == 1 {
                return id;
            }
            loop {
                let candidate = format!("{}#{}", id.as_str(), count);
                if taken.insert(candidate.clone()) {
                    return StableId::new(candidate);
                }
                *count += 1;
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_names_get_numbers_that_collide_with_nothing() {
        let ids = ["a", "b", "a", "a#2", "a"].map(StableId::new);
        let unique: Vec<_> = unique_ids(ids).iter().map(|id| id.as_str().to_owned()).collect();
        assert_eq!(unique, ["a", "b", "a#3", "a#2", "a#4"]);
    }
}
