//! Finds time-dependent inputs of a case that cause waves.

use crate::record::{CaseTable, Field, ListRow, OrTable, vector};
use crate::schema::{Draft, SiteKey, SupportTable, TractionTable};
use crate::spectrum::{InputKind, Signal};
use crate::words::{Side, Support};
use bsmpm::dynamics::mass::MassMatrix;
use bsmpm_shapes::polygon;

/// Cells a wavelength at which the speed of a wave is wrong by 2 %, by splines of order 1 to 3. Rounded up from a bar
/// with two and three points along each axis of a cell and 100 steps a period (trials of `waves`).
const LUMPED: [f64; 3] = [18.0, 24.0, 28.0];
const CONSISTENT: [f64; 3] = [9.0, 8.0, 8.0];

/// Cells a wavelength that waves need for 2 % of error in their speed, with splines of an order.
pub(crate) fn fewest_cells(mass: MassMatrix, order: usize) -> f64 {
    let of_order = match mass {
        MassMatrix::Lumped => LUMPED,
        MassMatrix::Consistent => CONSISTENT,
    };
    of_order[order - 1]
}

/// An input of waves.
#[derive(Clone, Debug)]
pub(crate) struct WaveInput {
    /// Key of its table.
    pub name: String,
    /// Hz  below which [`crate::spectrum::SHARE`] of the energy of its velocity lies
    pub frequency: f64,
    /// The axis along which it compresses a bar that rollers guide; `None`: it makes shear waves.
    pub axis: Option<usize>,
}

impl WaveInput {
    /// The input of the rows of a table in a run until `end` (s); `None` of what makes no wave.
    fn of(path: &str, kind: InputKind, rows: &[ListRow], axis: Option<usize>, end: f64) -> Option<Self> {
        let rows = rows.iter().map(|row| (row.numbers[0], row.numbers[1..].to_vec()));
        let rows = rows.collect();
        let frequency = Signal { kind, rows }.frequency(end)?;
        let name = path.to_owned();
        Some(Self { name, frequency, axis })
    }
}

/// The inputs of a case, but for those that make no wave. Rigid bodies are left out: in contact material flows more
/// than it swings.
pub(crate) fn inputs(draft: &Draft) -> Vec<WaveInput> {
    let Some(end) = draft.analysis.value().and_then(|analysis| analysis.end.get()) else {
        return Vec::new();
    };
    let mut found = Vec::new();
    if let Some(shaking) = draft.shaking.value()
        && let Some(rows) = shaking.acceleration.value()
    {
        let axis = guided(draft, LoadedPart::Everything, columns(rows));
        let path = &shaking.location().path;
        found.extend(WaveInput::of(path, InputKind::Acceleration, rows, axis, end));
    }
    for load in draft.traction.items() {
        for key in load.courses() {
            let Some(rows) = key.value() else { continue };
            let along = match key.path() == load.amplitude.path() {
                true => stress(load),
                false => columns(rows),
            };
            let axis = guided(draft, LoadedPart::of(load.site()), pressure(load).or(along));
            found.extend(WaveInput::of(&load.location().path, InputKind::Force, rows, axis, end));
        }
    }
    for load in draft.point_load.items() {
        for rows in [&load.amplitude, &load.force_path].into_iter().filter_map(Field::value) {
            found.extend(WaveInput::of(&load.location().path, InputKind::Force, rows, None, end));
        }
    }
    for motion in draft.prescribed.items() {
        if let Some(rows) = motion.path.value() {
            let axis = guided(draft, LoadedPart::of(motion.site()), columns(rows));
            found.extend(WaveInput::of(
                &motion.location().path,
                InputKind::Motion,
                rows,
                axis,
                end,
            ));
        }
    }
    if let Some(footing) = draft.footing.value()
        && let Some(rows) = footing.path.value()
    {
        found.extend(WaveInput::of(
            &footing.location().path,
            InputKind::Motion,
            rows,
            None,
            end,
        ));
    }
    found
}

/// The only axis along which numbers are not zero.
fn only(is_along: impl Fn(usize) -> bool) -> Option<usize> {
    let along: Vec<usize> = (0..3).filter(|&axis| is_along(axis)).collect();
    (along.len() == 1).then(|| along[0])
}

/// The only axis along which rows `[t, x, y, ...]` do anything.
fn columns(rows: &[ListRow]) -> Option<usize> {
    only(|axis| {
        rows.iter()
            .any(|row| row.numbers.get(1 + axis).is_some_and(|number| *number != 0.0))
    })
}

/// The only axis along which a traction acts.
fn stress(load: &TractionTable) -> Option<usize> {
    let OrTable::Value(stress) = load.stress.value()? else {
        return None;
    };
    let stress = vector(stress);
    only(|axis| stress[axis] != 0.0)
}

/// The axis that is normal to a segment under a pressure.
fn pressure(load: &TractionTable) -> Option<usize> {
    let is_pressure = load.pressure.is_given() || load.pressure_path.is_given();
    let [from, to] = load.site().ends().filter(|_| is_pressure)?;
    (0..2).find(|&axis| from[axis] == to[axis])
}

/// The axis along which an input acts if its waves are of compression alone: rollers hold all faces along it, and it
/// acts on a whole section of the bodies, in whose plane, or everywhere.
fn guided(draft: &Draft, part: LoadedPart, along: Option<usize>) -> Option<usize> {
    let axis = along?;
    let boundary = draft.boundary.value()?;
    let sides = Side::of(draft.geometry.get()?).iter().enumerate();
    let mut others = sides.filter(|(of, _)| *of != axis).flat_map(|(_, sides)| sides);
    let is_guided = others.all(|side| boundary.face(*side).plain() == Some(Support::Roller));
    let is_whole = match part {
        LoadedPart::Everything => true,
        LoadedPart::Segment(ends) => axis < 2 && covers(draft, ends, 1 - axis),
        LoadedPart::Unknown => false,
    };
    (is_guided && is_whole).then_some(axis)
}

/// What an input acts on.
enum LoadedPart {
    Everything, // a face of the grid, or the ground
    Segment([[f64; 2]; 2]),
    Unknown,
}

impl LoadedPart {
    fn of(site: SiteKey<'_>) -> Self {
        match site {
            SiteKey::Face(_) => Self::Everything,
            site => site.ends().map_or(Self::Unknown, Self::Segment),
        }
    }
}

/// Whether a segment reaches across all bodies along an axis, in a plane.
fn covers(draft: &Draft, ends: [[f64; 2]; 2], across: usize) -> bool {
    let corners: Option<Vec<[[f64; 2]; 2]>> = draft.body.items().iter().map(crate::preset::around).collect();
    let Some(corners) = corners.filter(|corners| !corners.is_empty()) else {
        return false;
    };
    let bounds = polygon::bounds(&corners.concat());
    let [lower, upper] = [
        ends[0][across].min(ends[1][across]),
        ends[0][across].max(ends[1][across]),
    ];
    let slack = 1e-9 * (bounds[1][across] - bounds[0][across]);
    lower <= bounds[0][across] + slack && upper >= bounds[1][across] - slack
}
