//! The nearest known name to a mistyped one.

/// The known name that `word` most likely means: few edits away, case and `_`/`-` being equal. `None` if none is near.
pub(crate) fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 64;
    let word: Vec<char> = folded(word).take(LONGEST + 1).collect();
    if word.len() > LONGEST {
        return None;
    }
    let allowed = (word.len() / 3).clamp(1, 4);
    let rated = known.into_iter().map(|name| (edits(&word, &folded(name).collect::<Vec<_>>()), name));
    rated.filter(|(distance, _)| *distance <= allowed).min_by_key(|(distance, _)| *distance).map(|(_, name)| name)
}

/// `; did you mean ...?`, or nothing.
pub(crate) fn hint<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, known).map_or(String::new(), |name| format!("; did you mean `{name}`?"))
}

fn folded(word: &str) -> impl Iterator<Item = char> {
    word.chars().map(|c| if c == '_' { '-' } else { c.to_ascii_lowercase() })
}

/// Insertions, deletions, substitutions and swaps of neighbours that lead from `a` to `b`.
fn edits(a: &[char], b: &[char]) -> usize {
    let mut rows = vec![(0..=b.len()).collect::<Vec<usize>>()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let substituted = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut fewest = substituted.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                fewest = fewest.min(rows[i - 2][j - 2] + 1);
            }
            row.push(fewest);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
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
        assert_eq!(nearest("viscosity", known), None);
        assert_eq!(nearest(&"x".repeat(100_000), known), None);
    }
}
