//! Presets: the key `accuracy` chooses the cell size, theory-manual equation (T11.1), the steps (T11.2) and the
//! tolerances that the case does not give. The completed case is then compared with the schema.

mod axis;
mod cells;
mod concentration;
mod limit_load;
mod rigid;
mod scene;
mod table;
mod waves;

use crate::document::{self, DocumentEntry, DocumentTable, Node, Value};
use crate::error::Origin;
use crate::report::Report;
use crate::rounding::brief;
use crate::schema::Draft;
use crate::source::Source;
use crate::words::{Accuracy, Geometry, Order, Word};
use bsmpm::stabilisation::Stabilisation;
use cells::Cells;
use scene::PresetScene;
pub(crate) use scene::around;
pub(crate) use table::preset_table;

/// The key.
const ACCURACY: &str = "accuracy";

/// A discretisation in terms of what a scene is made of.
struct Preset {
    /// Cells along the shorter side of the rectangle around all bodies.
    across: f64,
    /// Cells along the width of a strip or loaded segment, where these are smaller.
    along: f64,
    /// Parts of that width as far as which cells around it are as small.
    reach: f64,
    /// Cells across a hole or a notch, where these are smaller.
    opening: f64,
    /// Edge of a cell over that of the cells at a steep re-entrant corner.
    corner: f64,
    /// Edge of a cell over that of the next smaller one, farther away.
    growth: f64,
    /// Points along each axis of a cell.
    points: u64,
    /// Cells that a shear wave crosses in a step of dynamics.
    crossed: f64,
    /// Part of a cell that a face may move in a quasi-static step.
    advance: f64,
    /// Quasi-static steps at least.
    steps: f64,
    /// Energy and force measure of convergence, TOML.
    tolerances: [&'static str; 2],
}

impl Preset {
    fn of(accuracy: Accuracy) -> Self {
        match accuracy {
            Accuracy::Draft => Self {
                across: 10.0,
                along: 8.0,
                reach: 0.125,
                opening: 8.0,
                corner: 2.0,
                growth: 1.5,
                points: 2,
                crossed: 4.0,
                advance: 0.25,
                steps: 10.0,
                tolerances: ["1e-6", "1e-3"],
            },
            Accuracy::Standard => Self {
                across: 20.0,
                along: 16.0,
                reach: 0.25,
                opening: 12.0,
                corner: 4.0,
                growth: 1.2,
                points: 3,
                crossed: 4.0,
                advance: 0.25,
                steps: 10.0,
                tolerances: ["1e-8", "1e-4"],
            },
            Accuracy::Reference => Self {
                across: 40.0,
                along: 24.0,
                reach: 0.5,
                opening: 24.0,
                corner: 4.0,
                growth: 1.1,
                points: 4,
                crossed: 2.0,
                advance: 0.125,
                steps: 20.0,
                tolerances: ["1e-10", "1e-5"],
            },
        }
    }
}

/// Points along each axis at least of cells of several sizes: with two the strains under a strip move them so far apart
/// that iterations stall.
const GRADED_POINTS: u64 = 3;

/// Cells across the thinnest body below which there is a warning.
const FEWEST: f64 = 2.0;

/// Of every preset: splines of this order, and where a material could lock this against it.
const ORDER: Order = Order::Quadratic;
const METHOD: Stabilisation = Stabilisation::ConsistentFBar;

/// A table's keys and values that are filled in follow from a word of the case.
#[derive(Clone, Copy)]
struct Choice {
    key: &'static str,
    word: &'static str,
    origin: Origin,
}

impl Choice {
    /// Of a key that depends on something that the case does not give.
    fn cannot_choose(&self, key: &str, basis: &str) -> String {
        let word = self.word;
        format!(
            "E0253: the preset \"{word}\" cannot choose {key} from {basis}. Complete or correct these, or give {key}."
        )
    }
}

/// Fills in what the document's purpose and `accuracy` stand for, in this order; whether anything was. What cannot be
/// derived from the rest of the case is an error, which says what it depends on.
pub(crate) fn fill(
    document: &mut DocumentTable,
    source: &Source<'_>,
    overrides: &[String],
    report: &mut Report<'_>,
) -> bool {
    let accuracy = document.word::<Accuracy>(ACCURACY);
    let is_filled = limit_load::fill(document, source, overrides, report);
    let Some((accuracy, origin)) = accuracy else {
        return is_filled;
    };
    let choice = Choice {
        key: ACCURACY,
        word: accuracy.word(),
        origin,
    };
    fill_accuracy(document, accuracy, choice, source, overrides, report) || is_filled
}

/// Fills in what `accuracy` stands for.
fn fill_accuracy(
    document: &mut DocumentTable,
    accuracy: Accuracy,
    choice: Choice,
    source: &Source<'_>,
    overrides: &[String],
    report: &mut Report<'_>,
) -> bool {
    let preset = &Preset::of(accuracy);
    // Its errors are reported when the filled document is read.
    let draft = Draft::read(document, &mut Report::new(source, overrides));
    if draft.geometry.get() == Some(Geometry::Solid) {
        let message = "E0226: the presets of `accuracy` are not available in 3-D. Delete `accuracy`, and give \
             grid.cell, points_per_cell, analysis.steps and the tolerances of [solver].";
        report.error(choice.origin, ACCURACY, message);
        return false;
    }
    let scene = PresetScene::of(&draft);
    let mut filling = Completion {
        document,
        choice,
        report,
        filled: false,
    };
    filling.put(&["grid.degree"], &quoted(ORDER), "");
    let cells = scene.cells(preset);
    filling.cells(cells.as_ref(), &scene, preset);
    filling.steps(cells.as_ref(), &scene, preset);
    if let Some(why) = scene.locks() {
        filling.put(&["stabilisation.method"], &quoted(METHOD), why);
    }
    let [energy, force] = preset.tolerances;
    filling.put(&["solver.tolerance"], energy, "");
    filling.put(&["solver.force_tolerance"], force, "");
    let filled = filling.filled;
    if filled && draft.rigid.items().iter().any(|rigid| rigid.free.is_given()) {
        report.warn(format!(
            "W0201: {ACCURACY}: the preset does not know the speed of free rigid bodies, so its steps may be too \
             long. Set analysis.steps so that these bodies move less than a cell in a step."
        ));
    }
    // With a purpose every key may be given because the purpose has filled it in.
    if !filled && !scene.seeks_limit_load() {
        report.warn(format!(
            "W0202: {ACCURACY}: the preset has no effect, because the case gives all keys that the preset would \
             choose. Delete the preset, or the keys that it should choose."
        ));
    }
    // The document is complete: under another word it would still be this case.
    document.entries.retain(|entry| entry.key != ACCURACY);
    filled
}

/// A word as TOML.
fn quoted(choice: impl Word) -> String {
    format!("\"{}\"", choice.word())
}

/// A document on its way to be complete.
struct Completion<'a, 'r> {
    document: &'a mut DocumentTable,
    choice: Choice,
    report: &'a mut Report<'r>,
    filled: bool,
}

impl Completion<'_, '_> {
    /// Gives the first of these keys of one table the value, unless one of them is given; whether it did.
    fn put(&mut self, keys: &[&str], value: &str, why: &str) -> bool {
        let origin = self.choice.origin;
        let Some((table, key)) = keys[0].split_once('.').filter(|_| !self.is_given(keys)) else {
            return false;
        };
        if self.document.get(table).is_none() {
            let node = Node {
                origin,
                value: Value::Table(DocumentTable::default()),
            };
            self.document.entries.push(DocumentEntry {
                key: table.to_owned(),
                origin,
                node,
            });
        }
        let entry = self.document.get_mut(table).map(|entry| &mut entry.node.value);
        let Some(Value::Table(inner)) = entry else {
            return false;
        };
        let put = insert(inner, key, value, origin);
        if put {
            self.tell(keys[0], value, why);
        }
        put
    }

    /// Whether the case gives one of the keys.
    fn is_given(&self, keys: &[&str]) -> bool {
        keys.iter().any(|key| self.document.node(key).is_some())
    }

    /// Reports an error that no value can be chosen for these keys, unless one of them is given.
    fn miss(&mut self, keys: &[&str], message: String) {
        if !self.is_given(keys) {
            self.report
                .consequence(self.choice.origin, self.choice.key, message, scene::BASIS);
        }
    }

    /// Gives the grid cells, unless it has some, reports their sizes, and gives bodies points to suit them.
    fn cells(&mut self, cells: Option<&Cells>, scene: &PresetScene<'_>, preset: &Preset) {
        let mut points = preset.points;
        match cells {
            Some(cells) => {
                if self.put(&cells.keys, &cells.value, &cells.why) {
                    cells
                        .sizes
                        .iter()
                        .for_each(|(value, why)| self.tell("grid.knots", value, why));
                    if let Some((side, cell)) = cells.too_thin(scene, FEWEST) {
                        self.doubt(side, cell);
                    }
                    points = if cells.is_graded() {
                        points.max(GRADED_POINTS)
                    } else {
                        points
                    };
                }
            }
            None => self.miss(
                &["grid.cell", "grid.knots"],
                self.choice.cannot_choose("grid.cell", cells::CELLS),
            ),
        }
        self.points(points);
    }

    /// Warns of a body whose shorter side (m) has too few cells of an edge (m).
    fn doubt(&mut self, side: f64, cell: f64) {
        self.report.warn(format!(
            "W0203: {ACCURACY}: a body with a thickness of {} m has fewer than {FEWEST} cells of {} m across. The \
             stresses in this body are inaccurate. Set grid.cell to at most {} m.",
            brief(side),
            brief(cell),
            brief(side / FEWEST)
        ));
    }

    /// Gives the analysis steps, unless it has some, or says why none can be chosen. The cells that a case gives by
    /// hand count, too.
    fn steps(&mut self, cells: Option<&Cells>, scene: &PresetScene<'_>, preset: &Preset) {
        const KEYS: [&str; 2] = ["analysis.steps", "analysis.dt"];
        match scene.steps(preset, cells.map(|cells| cells.edge)) {
            Some((steps, why)) => {
                self.put(&KEYS, &steps.to_string(), &why);
            }
            None if scene.is_consolidation() => {
                let message = "E0254: a preset cannot choose the time steps of a consolidation analysis. Give \
                               analysis.dt and analysis.growth.";
                self.miss(&KEYS, message.into());
            }
            None if cells.is_some() || scene.shortest().is_some() => {
                let message = self.choice.cannot_choose("analysis.steps", scene::STEPS);
                self.miss(&KEYS, message);
            }
            None => {} // an error of the cells
        }
    }

    /// Gives every body that has none its points.
    fn points(&mut self, points: u64) {
        const BODY: &str = "body";
        const KEY: &str = "points_per_cell";
        let origin = self.choice.origin;
        let value = points.to_string();
        let entry = self.document.get_mut(BODY).map(|entry| &mut entry.node.value);
        let Some(Value::List(bodies)) = entry else {
            return;
        };
        let mut any = false;
        for body in bodies {
            if let Value::Table(body) = &mut body.value {
                any |= body.get(KEY).is_none() && insert(body, KEY, &value, origin);
            }
        }
        if any {
            self.tell(
                &format!("{BODY}.*.{KEY}"),
                &value,
                "of bodies without a value of their own",
            );
        }
    }

    fn tell(&mut self, key: &str, value: &str, why: &str) {
        self.filled = true;
        let colon = if why.is_empty() { "" } else { ": " };
        let Choice { key: by, word, .. } = self.choice;
        self.report.note(key, value, format!("{by} = \"{word}\"{colon}{why}"));
    }
}

fn insert(table: &mut DocumentTable, key: &str, value: &str, origin: Origin) -> bool {
    let Ok(node) = document::parse_value(value, origin) else {
        return false;
    };
    table.entries.push(DocumentEntry {
        key: key.to_owned(),
        origin,
        node,
    });
    true
}
