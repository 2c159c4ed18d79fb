//! Words for a scene that is no longer the one that was baked.

use crate::artefact::{Change, StableId};

/// What is said once of all that has changed.
pub(super) fn sentence(changed: &[(StableId, Change)]) -> String {
    /// As many as a person reads.
    const NAMED: usize = 3;
    let named = changed.iter().take(NAMED).map(|(id, change)| match change {
        Change::Moved => format!("\"{id}\" is elsewhere"),
        Change::Look => format!("\"{id}\" has another material or shines otherwise"),
    });
    let rest = changed.len().saturating_sub(NAMED);
    let rest = if rest > 0 { format!(", and so on with {rest} more") } else { String::new() };
    let named = named.collect::<Vec<_>>().join(", ");
    format!("the scene has changed since it was baked, so that its light may be wrong: {named}{rest}; bake it again")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_are_named_and_the_rest_is_counted() {
        let changed: Vec<(StableId, Change)> = ["a", "b", "c", "d", "e"]
            .into_iter()
            .zip([Change::Moved, Change::Look, Change::Look, Change::Moved, Change::Moved])
            .map(|(id, change)| (StableId::new(id), change))
            .collect();
        assert_eq!(
            sentence(&changed),
            "the scene has changed since it was baked, so that its light may be wrong: \"a\" is elsewhere, \"b\" has \
             another material or shines otherwise, \"c\" has another material or shines otherwise, and so on with 2 \
             more; bake it again"
        );
        assert!(sentence(&changed[..1]).ends_with("\"a\" is elsewhere; bake it again"));
    }
}
