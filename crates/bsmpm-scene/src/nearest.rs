//! Finds the known name nearest to a misspelt one.

use crate::report::shortened;

/// The known name that `word` most likely means: few edits away, case and `_`/`-` being equal. `None` if none is near.
pub(crate) fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 64;
    let word = folded(word);
    let length = word.chars().count();
    if length > LONGEST {
        return None;
    }
    let allowed = (length / 3).clamp(1, 4);
    // With one edit a word of two letters is any other: they may only be exchanged.
    let known = known
        .into_iter()
        .filter(|name| length > 2 || sorted(&word) == sorted(&folded(name)));
    let rated = known.map(|name| (strsim::osa_distance(&word, &folded(name)), name));
    rated
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

fn sorted(word: &str) -> Vec<char> {
    let mut letters: Vec<char> = word.chars().collect();
    letters.sort_unstable();
    letters
}

/// `; did you mean ...?`, or nothing.
pub(crate) fn hint<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, known).map_or(String::new(), |name| format!("; did you mean `{name}`?"))
}

/// The error of a `name` that nothing of a `kind` has, with the nearest one of the `known` names.
pub(crate) fn unknown_name<'a>(kind: &str, name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let written = shortened(name);
    match nearest(name, known) {
        Some(near) => format!("E0612: there is no {kind} with the name `{written}`; did you mean `{near}`?"),
        None => format!("E0612: there is no {kind} with the name `{written}`. Correct the name."),
    }
}

fn folded(word: &str) -> String {
    word.to_ascii_lowercase().replace('_', "-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typos_find_their_name() {
        let known = ["young", "poisson", "points_per_cell", "friction"];
        assert_eq!(nearest("yuong", known), Some("young"));
        assert_eq!(nearest("Poisson", known), Some("poisson"));
        assert_eq!(nearest("points-per-cells", known), Some("points_per_cell"));
        assert_eq!(
            (nearest("td", ["dt", "tol"]), nearest("nu", ["ru", "mu"])),
            (Some("dt"), None)
        );
        assert_eq!(nearest("viscosity", known), None);
        assert_eq!(nearest(&"x".repeat(100_000), known), None);
    }
}
