//! Warns of unsupported bodies in a quasi-static analysis.

use crate::case::{Case, Stage};
use crate::connected::{near_pairs, pieces_of_pairs};
use crate::record::CaseTable;
use crate::report::{Report, listed};
use crate::schema::Draft;
use crate::validate::gap::are_apart;
use crate::validate::physics::holds_at_rest;
use bsmpm::model::Regime;

/// Pieces of material apart from each other that are looked at.
const MOST: usize = 200;

/// Warns of bodies that no support holds along an axis, from the start or from a stage on.
pub(super) fn bodies(case: &Case, draft: &Draft, report: &mut Report<'_>) {
    if case.analysis.regime != Regime::QuasiStatic {
        return;
    }
    let mut known: Vec<usize> = Vec::new();
    let later = case
        .stages
        .iter()
        .filter(|stage| !stage.add.is_empty() || !stage.remove.is_empty());
    for stage in std::iter::once(None).chain(later.map(Some)) {
        let there: Vec<usize> = (0..case.bodies.len())
            .filter(|&body| case.is_there(body, stage.map_or(0.0, |stage| stage.at)))
            .collect();
        let pieces = pieces(case, &there);
        if pieces.len() < 2 || pieces.len() > MOST {
            continue;
        }
        let mut alone = case.clone();
        for piece in pieces {
            alone.bodies = piece.iter().map(|&body| case.bodies[body].clone()).collect();
            let free: Vec<&str> = (0..case.grid.dims())
                .filter(|axis| !holds_at_rest(&alone, *axis, None))
                .map(|axis| ["x", "y", "z"][axis])
                .collect();
            if free.is_empty() || piece.iter().any(|body| known.contains(body)) {
                continue;
            }
            known.extend(&piece);
            warn(draft, &piece, &free, stage, report);
        }
    }
}

fn warn(draft: &Draft, piece: &[usize], free: &[&str], stage: Option<&Stage>, report: &mut Report<'_>) {
    let records = piece.iter().map(|body| &draft.body.items()[*body]);
    let names = records.map(|record| match record.name.text() {
        Some(name) => format!("{} `{name}`", record.location().path),
        None => record.location().path.clone(),
    });
    let names: Vec<String> = names.collect();
    let since = stage.map_or(String::new(), |stage| format!(" from t = {} on", stage.at));
    report.warn(format!(
        "W0107: nothing restrains {} along {}{since}, so a quasi-static analysis has no solution. Move the body onto \
         another one, support the body, or use type = \"dynamic\".",
        listed(&names),
        free.join(" and ")
    ));
}

/// Bodies that are less than a cell apart, so that they act on each other.
fn pieces(case: &Case, there: &[usize]) -> Vec<Vec<usize>> {
    let bounds: Vec<[[f64; 3]; 2]> = there.iter().map(|&body| case.bodies[body].region.corners()).collect();
    let reach = case.grid.axes.iter().map(|axis| axis.longest()).fold(0.0, f64::max);
    let mut work = 0;
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for (one, other) in near_pairs(&bounds, reach) {
        let [a, b] = [&bounds[one], &bounds[other]];
        let is_near =
            (0..case.grid.dims()).all(|axis| a[0][axis].max(b[0][axis]) - a[1][axis].min(b[1][axis]) <= reach);
        if is_near && !are_apart(case, [there[one], there[other]], &mut work) {
            pairs.push([one, other]);
        }
    }
    let pieces = pieces_of_pairs(there.len(), pairs.into_iter());
    pieces
        .into_iter()
        .map(|piece| piece.into_iter().map(|number| there[number]).collect())
        .collect()
}
