//! Warnings that a run gives once, also over restarts: of each its code, and what it concerns.

use bsmpm_scene::Case;
use bsmpm_scene::surfaces::{name_of_drain, name_of_drained_face, name_of_strip};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A warning that was given.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IssuedWarning {
    /// Its code, such as `W0705`.
    pub code: String,
    /// The footing, segment, drain or rigid body that it concerns, as the case calls it.
    pub subject: String,
}

impl IssuedWarning {
    /// Names a warning.
    pub fn new(code: &str, subject: &str) -> Self {
        Self {
            code: code.to_owned(),
            subject: subject.to_owned(),
        }
    }
}

/// Numbers of footings and drains of a case, with which older checkpoints number warnings.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceCounts {
    /// Footings and segments.
    pub strips: usize,
    /// Drains and inflows with surface points.
    pub drains: usize,
}

/// The warning about a footing, segment, drain or inflow with this number in a checkpoint of an older version: three
/// kinds of strips, two of drains, then two for every drained face in turn.
fn numbered_surface(case: &Case, counts: SurfaceCounts, number: usize) -> IssuedWarning {
    let SurfaceCounts { strips, drains } = counts;
    let codes_of_strips = ["W0705", "W0706", "W0707"];
    if number < 3 * strips {
        return IssuedWarning::new(codes_of_strips[number / strips], &name_of_strip(case, number % strips));
    }
    let number = number - 3 * strips;
    let codes_of_drains = ["W0708", "W0709"];
    if number < 2 * drains {
        return IssuedWarning::new(codes_of_drains[number / drains], &name_of_drain(case, number % drains));
    }
    let number = number - 2 * drains;
    let code = ["W0711", "W0710"][number % 2];
    IssuedWarning::new(code, &name_of_drained_face(case, number / 2))
}

/// The warning about a rigid body with this number in a checkpoint of an older version: two kinds for every body in
/// turn, then pairs of bodies, which no warning concerns any more, then bodies that passed through a boundary.
fn numbered_body(case: &Case, number: usize) -> Option<IssuedWarning> {
    let count = case.rigid.len();
    let named = |code: &str, body: usize| Some(IssuedWarning::new(code, &case.rigid.get(body)?.name));
    if number < 2 * count {
        return named(["W0702", "W0703"][number % 2], number / 2);
    }
    named("W0704", number.checked_sub(2 * count + count * count)?)
}

/// All warnings with these numbers in a checkpoint of an older version.
pub(super) fn numbered(
    case: &Case,
    counts: SurfaceCounts,
    surfaces: &BTreeSet<usize>,
    bodies: &BTreeSet<usize>,
) -> BTreeSet<IssuedWarning> {
    let surfaces = surfaces.iter().map(|number| numbered_surface(case, counts, *number));
    let bodies = bodies.iter().filter_map(|number| numbered_body(case, *number));
    surfaces.chain(bodies).collect()
}

#[cfg(test)]
mod tests {
    use super::{BTreeSet, Case, IssuedWarning, SurfaceCounts, numbered};

    const CASE: &str = include_str!("../../../bsmpm-scene/tests/full.toml");

    /// Older versions added multiples of the numbers of strips, drains and bodies for the kinds of warnings.
    #[test]
    fn numbers_of_older_checkpoints_become_codes_and_names() {
        let case = Case::from_text("full", CASE, &[]).expect("a valid case");
        assert!(case.footing.is_some() && case.prescribed.len() == 2);
        let [plough, pipe] = &case.rigid[..] else {
            panic!("two rigid bodies")
        };
        let counts = SurfaceCounts { strips: 3, drains: 1 };
        let surfaces = BTreeSet::from([0, 4, 8, 9, 10, 11, 12]);
        // Number 5 is of a pair of bodies that met, which no warning concerns any more.
        let bodies = BTreeSet::from([1, 2, 5, 9]);
        let expected = [
            ("W0705", "footing"),
            ("W0706", "prescribed.0"),
            ("W0707", "prescribed.1"),
            ("W0708", "inflow.0"),
            ("W0709", "inflow.0"),
            ("W0711", "drain.0"),
            ("W0710", "drain.0"),
            ("W0703", plough.name.as_str()),
            ("W0702", pipe.name.as_str()),
            ("W0704", pipe.name.as_str()),
        ];
        let expected = expected.map(|(code, subject)| IssuedWarning::new(code, subject));
        assert_eq!(numbered(&case, counts, &surfaces, &bodies), BTreeSet::from(expected));
    }
}
