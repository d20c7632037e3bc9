//! Fills in the keys that `analysis.purpose = "limit-load"` implies.

use super::scene::PresetScene;
use super::{Choice, Completion, ORDER, Preset, quoted};
use crate::document::DocumentTable;
use crate::report::Report;
use crate::schema::Draft;
use crate::source::Source;
use crate::words::{Accuracy, Purpose, Word};
use bsmpm::stabilisation::Stabilisation;

const KEY: &str = "analysis.purpose";
/// Points along each axis of a cell: three lock soil that dilates, where N_gamma is 19 % higher with them.
const POINTS: u64 = 2;
/// Equal steps: with 20 of them a strip on sand with a friction angle of 35 degrees ends 17 % above the extrapolated
/// load, as its steps are cut and each cut adds the drag of the background; with 40 none is cut.
const STEPS: &str = "40";
/// Energy and force measure of convergence: with a force measure of 1e-3 loads are 2 to 7 % higher.
const TOLERANCES: [&str; 2] = ["1e-8", "1e-4"];
/// Coefficient of the background: between 2e-6 and 2e-4 loads differ by up to 0.2 %. 1e-3 is 1 % too high, and with
/// 1e-5 steps are cut for a friction angle of 35 degrees.
const BACKGROUND: &str = "2e-5";

/// Fills in what the purpose stands for, if the case has one; whether anything was.
pub(super) fn fill(
    document: &mut DocumentTable,
    source: &Source<'_>,
    overrides: &[String],
    report: &mut Report<'_>,
) -> bool {
    let Some((purpose, origin)) = document.word::<Purpose>(KEY) else {
        return false;
    };
    // Its errors are reported when the filled document is read.
    let draft = Draft::read(document, &mut Report::new(source, overrides));
    let scene = PresetScene::of(&draft);
    let choice = Choice {
        key: KEY,
        word: purpose.word(),
        origin,
    };
    let mut filling = Completion {
        document,
        choice,
        report,
        filled: false,
    };
    filling.put(&["grid.degree"], &quoted(ORDER), "");
    filling.points(POINTS);
    filling.put(
        &["analysis.steps", "analysis.dt"],
        STEPS,
        "with fewer, steps near failure do not converge and are halved",
    );
    let (method, why) = match scene.dilates() {
        true => (
            Stabilisation::None,
            "averages of the volumetric strain are wrong in dilating soil",
        ),
        false => (
            Stabilisation::ConsistentFBar,
            "prevents volumetric locking of plastic flow without dilation",
        ),
    };
    filling.put(&["stabilisation.method"], &quoted(method), why);
    let [energy, force] = match draft.accuracy.get() {
        Some(Accuracy::Reference) => Preset::of(Accuracy::Reference).tolerances,
        _ => TOLERANCES,
    };
    filling.put(&["solver.tolerance"], energy, "");
    filling.put(&["solver.force_tolerance"], force, "");
    filling.put(
        &["solver.background"],
        BACKGROUND,
        "small enough that the limit load does not depend on it",
    );
    filling.filled
}
