//! Validates tractions, point loads and initial stress.

use super::material::profile;
use super::place::{along, at_body, at_volume, beyond, is_at, is_beyond, ring};
use super::sheet::pieces;
use super::site::{AroundStrip, places, plate, segment};
use crate::case::{
    Body, Case, Gravity, Initial, LoadedLine, NamedMaterial, PointLoad, Push, Rigid, Shares, Site, Traction,
};
use crate::record::{CaseTable, Field, ListRow, Record};
use crate::report::Report;
use crate::schema::{Draft, InitialTable, LawName};
use crate::words::{Geometry, Settled, Start};
use bsmpm::material::Profile;
use bsmpm::model::Regime;
use bsmpm::tensor::Vector;

/// All tractions in the order of the file, without those that have an error.
pub(super) fn tractions(draft: &Draft, around: AroundStrip<'_>, report: &mut Report<'_>) -> Vec<Traction> {
    let records = draft.traction.items().iter();
    records.filter_map(|record| traction(record, around, report)).collect()
}

/// A traction; `None` after an error.
fn traction(record: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Traction> {
    let line = line(record, around, report);
    let push = push(record, around, report);
    let line = line?;
    let (push, (ramp, amplitude)) = push?;
    let traction = Traction {
        line,
        push,
        ramp,
        amplitude,
    };
    let keys = ["pressure", "stress_path", "pressure_path"];
    let key = keys.into_iter().find(|key| record.gives(key)).unwrap_or("stress");
    warn_of_nothing(record, key, [traction.largest(); 3], report);
    Some(traction)
}

/// Where a traction acts: on a body everywhere.
fn line(record: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<LoadedLine> {
    if record.gives("circle") {
        let (center, radius, places) = circle(record, around, report)?;
        acts_on_body(record, "circle", places.into_iter(), around, report);
        return Some(LoadedLine::Circle { center, radius });
    }
    if let Some(key) = ["rectangle", "disc"].into_iter().find(|key| record.gives(key)) {
        let grid = around.grid?;
        let bodies = around.bodies?;
        let plate = plate(record, grid, report)?;
        let mut places = places(Site::Plate(plate), grid).into_iter();
        if let Some(at) = places.find(|at| beyond(grid, *at).is_none() && !at_volume(bodies, grid, *at)) {
            record.consequence(key, no_body(&at), &["body"], report);
            return None;
        }
        return Some(LoadedLine::Plate(plate));
    }
    if record.gives("surface") || record.gives("sphere") {
        return Some(LoadedLine::Triangles(pieces(record, around, report)?));
    }
    let [from, to] = segment(record, around, report)?;
    acts_on_body(record, "from", along([from, to]), around, report);
    Some(LoadedLine::Segment { from, to })
}

/// Centre, radius and places of a circle, some of which are inside the grid.
pub(super) fn circle(
    record: &Record,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) -> Option<([f64; 2], f64, Vec<[f64; 2]>)> {
    let circle = record.record("circle")?;
    let center = circle.pair("centre")?;
    let radius = circle.number("radius")?;
    let lower = around.grid?.lower();
    let upper = around.grid?.upper();
    let places: Vec<[f64; 2]> = ring(center, radius)
        .filter(|at| (0..2).all(|axis| lower[axis] <= at[axis] && at[axis] <= upper[axis]))
        .collect();
    if places.is_empty() {
        let message =
            "E0201: no part of the circle is inside the grid. Move the circle into the grid, or enlarge the grid.";
        record.error("circle", message, report);
        return None;
    }
    Some((center, radius, places))
}

/// A stress along the axes, by depth.
fn stresses(record: &Record) -> Option<[Profile; 3]> {
    let Some(table) = record.record("stress") else {
        return record.vector("stress").map(|of| of.map(Profile::constant));
    };
    let value = table.vector("value")?;
    let at = table.number("at_y")?;
    let growth = table.vector("per_metre")?;
    Some([0, 1, 2].map(|axis| Profile {
        value: value[axis],
        at,
        per_metre: growth[axis],
    }))
}

/// What a traction is; on which side of a pressure bodies lie follows from the whole case only ([`super::side`]).
fn push(record: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<(Push, (f64, Shares))> {
    let side = 0.0;
    if record.gives("pressure_path") {
        let (largest, shares) = path(record, "pressure_path", around, report)?;
        let profile = Profile::constant(largest[0]);
        return Some((Push::Pressure { profile, side }, (0.0, shares)));
    }
    if record.gives("stress_path") {
        let (largest, shares) = path(record, "stress_path", around, report)?;
        return Some((Push::Stress(largest.map(Profile::constant)), (0.0, shares)));
    }
    let course = course(record, around, report);
    let push = match record.gives("pressure") {
        true => Push::Pressure {
            profile: profile(record, "pressure")?,
            side,
        },
        false => Push::Stress(stresses(record)?),
    };
    Some((push, course?))
}

/// All point loads in the order of the file, without those that have an error.
pub(super) fn point_loads(draft: &Draft, around: AroundStrip<'_>, report: &mut Report<'_>) -> Vec<PointLoad> {
    let records = draft.point_load.items().iter();
    records
        .filter_map(|record| point_load(record, around, report))
        .collect()
}

/// A point load; `None` after an error.
fn point_load(record: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<PointLoad> {
    let at = record.vector("at")?;
    let force = force(record, around, report);
    let grid = around.grid?;
    let bodies = around.bodies?;
    if let Some(message) = is_beyond(grid, at) {
        record.error("at", message, report);
    } else if !is_at(bodies, grid, at) {
        record.consequence("at", no_body(&at[..grid.dims()]), &["body"], report);
    }
    let (force, (ramp, amplitude)) = force?;
    let key = if record.gives("force_path") {
        "force_path"
    } else {
        "force"
    };
    warn_of_nothing(record, key, force, report);
    Some(PointLoad {
        at,
        force,
        ramp,
        amplitude,
    })
}

/// A force along the axes that exist, and what of it acts in time.
pub(super) fn force(
    record: &Record,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) -> Option<([f64; 3], (f64, Shares))> {
    if record.gives("force_path") {
        let (largest, shares) = path(record, "force_path", around, report)?;
        return Some((largest, (0.0, shares)));
    }
    let course = course(record, around, report);
    let force = if record.gives("force") {
        record.vector("force")?
    } else {
        [0.0; 3]
    };
    Some((force, course?))
}

fn warn_of_nothing(record: &Record, key: &str, load: [f64; 3], report: &mut Report<'_>) {
    if load == [0.0; 3] {
        report.warn(format!(
            "W0401: {}: this load is zero and has no effect. Give a value, or delete the load.",
            record.path_of(key)
        ));
    }
}

/// Says that no body lies at a place of a load, m.
fn no_body(at: &[f64]) -> String {
    format!(
        "E0401: no body lies at {at:.3?} m at the start, so nothing carries this load. Move the load to \
         the surface of a body."
    )
}

/// A load has a body under every part of it.
fn acts_on_body(
    record: &Record,
    key: &str,
    mut places: impl Iterator<Item = [f64; 2]>,
    around: AroundStrip<'_>,
    report: &mut Report<'_>,
) {
    let Some(grid) = around.grid else { return };
    let Some(bodies) = around.bodies else { return };
    if let Some(at) = places.find(|at| !at_body(bodies, grid, *at)) {
        record.consequence(key, no_body(&at), &["body"], report);
    }
}

/// Ramp and amplitude of a load, of which one holds.
fn course(record: &Record, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<(f64, Shares)> {
    if !record.gives("amplitude") {
        let ramp = record.number("ramp")?;
        if let Some(end) = around.end.filter(|end| ramp > *end) {
            let path = record.path_of("ramp");
            report.warn(format!(
                "W0402: {path}: the load grows until t = {ramp}, but the analysis ends at t = {end}, so the load \
                 never acts in full. Reduce `ramp`, or increase analysis.end."
            ));
        }
        return Some((ramp, Vec::new()));
    }
    let rows = in_time(record, "amplitude", around, report)?;
    Some((
        0.0,
        rows.into_iter()
            .map(|row| (row[0], Vector::from_element(row[1])))
            .collect(),
    ))
}

/// Rows of what acts in time; warned of what of them the steps do not meet.
fn in_time(record: &Record, key: &str, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<Vec<Vec<f64>>> {
    let rows: Vec<Vec<f64>> = increasing(&record.rows_field(key), report)?
        .map(<[f64]>::to_vec)
        .collect();
    let path = record.path_of(key);
    warn_of_late(&path, rows.iter().map(|row| row[0]), around.end, report);
    coarse(&path, rows.iter().map(|row| row[0]), around.dt, report);
    Some(rows)
}

/// The largest load of a path along each axis, by size, and the shares of it; an axis along which nothing acts has
/// those of one along which something does.
fn path(record: &Record, key: &str, around: AroundStrip<'_>, report: &mut Report<'_>) -> Option<([f64; 3], Shares)> {
    let rows = in_time(record, key, around, report)?;
    let largest = [0, 1, 2].map(|axis| {
        let components = rows.iter().map(|row| component(row, axis));
        components.fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a })
    });
    let acting = [0, 1, 2].into_iter().find(|axis| largest[*axis] != 0.0).unwrap_or(0);
    let of = [0, 1, 2].map(|axis| if largest[axis] == 0.0 { acting } else { axis });
    let shares = rows.iter().map(|row| {
        let shares = of.map(|axis| part_of(component(row, axis), largest[axis]));
        (row[0], Vector::from(shares))
    });
    Some((largest, shares.collect()))
}

/// A value in parts of the largest one; 0 where that is 0.
fn part_of(value: f64, largest: f64) -> f64 {
    if largest == 0.0 { 0.0 } else { value / largest }
}

/// Component along an axis of a row with a time and a vector; 0 along an axis that it does not give.
fn component(row: &[f64], axis: usize) -> f64 {
    row.get(1 + axis).copied().unwrap_or(0.0)
}

/// Warns of the first time of rows that is after the end of the analysis.
pub(super) fn warn_of_late(
    path: &str,
    mut times: impl Iterator<Item = f64>,
    end: Option<f64>,
    report: &mut Report<'_>,
) {
    let Some(end) = end else { return };
    if let Some(t) = times.find(|t| *t > end) {
        report.warn(format!(
            "W0403: {path}: the row at t = {t} is after the end of the analysis at t = {end}, so its values are \
             never reached. Increase analysis.end, or delete the row."
        ));
    }
}

/// Warns of steps that are longer than the time between two rows.
fn coarse(path: &str, times: impl Iterator<Item = f64> + Clone, dt: Option<f64>, report: &mut Report<'_>) {
    let intervals = times.clone().skip(1).zip(times).map(|(later, earlier)| later - earlier);
    let interval = intervals.fold(f64::INFINITY, f64::min);
    if let Some(dt) = dt.filter(|dt| interval < 0.999 * dt) {
        report.warn(format!(
            "W0404: {path}: rows are {interval} apart in time, but a step is {dt} long, so peaks between two steps \
             are missed. Set analysis.dt = {interval}."
        ));
    }
}

/// Says that the first number of a row, called `name`, is not larger than that of the row before.
pub(super) fn not_increasing(name: &str, value: f64, before: f64) -> String {
    format!(
        "E0402: {name} = {value} in this row is not larger than {before} in the row before. Sort the rows by {name}, \
         and delete repeated rows."
    )
}

/// Rows whose first number, a time, increases; at least one.
pub(super) fn increasing<'a>(
    key: &'a Field<Vec<ListRow>>,
    report: &mut Report<'_>,
) -> Option<impl Iterator<Item = &'a [f64]> + use<'a>> {
    let rows = key.value()?;
    if rows.is_empty() {
        key.error("E0435: this list of rows is empty. Give at least one row.", report);
        return None;
    }
    if let Some(late) = (1..rows.len()).find(|&k| rows[k].numbers[0] <= rows[k - 1].numbers[0]) {
        let name = match key.name() {
            "line" => "x",
            "curve" => "the suction",
            _ => "t",
        };
        let [value, before] = [late, late - 1].map(|row| rows[row].numbers[0]);
        report.error(rows[late].origin, key.path(), not_increasing(name, value, before));
        return None;
    }
    Some(rows.iter().map(|row| &row.numbers[..]))
}

/// The stress at the start, if any: the whole gravity acts from time 0 then.
pub(super) fn initial(
    draft: &Draft,
    materials: Option<&[NamedMaterial]>,
    bodies: Option<&[Body]>,
    gravity: Option<&Gravity>,
    regime: Option<Regime>,
    report: &mut Report<'_>,
) -> Option<Initial> {
    let record = draft.initial.value();
    let elastic = record.is_some_and(|record| record.gravity.is_given());
    if record.is_none() || elastic {
        let (what, instead) = match elastic {
            true => (
                "initial.gravity = \"elastic\" replaces initial stresses from k0",
                "delete initial.gravity",
            ),
            false => ("the case has no [initial]", "add a table [initial]"),
        };
        for (_, material) in draft.material.items() {
            let key = ["k0", "ocr"]
                .into_iter()
                .find(|key| material.gives(key) && (*key == "k0" || is_of_k0(material)));
            if let Some(key) = key {
                let message = format!("E0405: `{key}` has no effect, because {what}. Delete `{key}`, or {instead}.");
                material.error(key, message, report);
            }
        }
    }
    let record = record?;
    loaded(draft, record, materials, bodies, gravity, report);
    if elastic {
        return record.gravity.get().map(|start| match start {
            Start::Elastic => Initial::Elastic,
        });
    }
    let dims = draft.geometry.get()?.dims();
    if let Some(gravity) = gravity.filter(|of| !of.acts_down(dims, regime)) {
        let message = format!(
            "E0406: gravity.acceleration = {:?} m/s2 is not vertical, but initial stresses from k0 are in equilibrium \
             with vertical gravity only. Correct this vector, or use initial.gravity = \"elastic\".",
            &gravity.acceleration[..dims]
        );
        draft.gravity.value()?.acceleration.error(message, report);
    }
    at_rest(draft, record, bodies?, report).map(Initial::AtRest)
}

/// Rows of the ground's acceleration; none without it, or after an error. The run ends and steps by the second numbers.
pub(super) fn shaking(
    draft: &Draft,
    regime: Option<Regime>,
    times: Option<(f64, f64)>,
    report: &mut Report<'_>,
) -> Vec<(f64, [f64; 3])> {
    let Some(shaking) = draft.shaking.value() else {
        return Vec::new();
    };
    if regime == Some(Regime::QuasiStatic) {
        let message = "E0414: a quasi-static analysis has no inertia, so [shaking] has no effect. Use analysis.type \
                       = \"dynamic\", or give gravity.acceleration a horizontal component (pseudo-static).";
        shaking.location().error(message, report);
    }
    let acceleration = &shaking.acceleration;
    let Some(rows) = increasing(acceleration, report) else {
        return Vec::new();
    };
    let rows: Vec<(f64, [f64; 3])> = rows
        .map(|row| (row[0], [0, 1, 2].map(|axis| component(row, axis))))
        .collect();
    if rows.iter().all(|(_, ground)| *ground == [0.0; 3]) {
        acceleration.error(
            "E0415: all accelerations are zero, so the ground does not shake. Delete [shaking].",
            report,
        );
        return Vec::new();
    }
    let Some((end, dt)) = times else { return rows };
    let path = acceleration.path();
    warn_of_late(path, rows.iter().map(|row| row.0), Some(end), report);
    coarse(path, rows.iter().map(|row| row.0), Some(dt), report);
    rows
}

/// Whether the case starts without stress, whatever its [initial] says.
pub(super) fn is_unloaded(draft: &Draft) -> bool {
    draft
        .strength_reduction
        .value()
        .and_then(|reduction| reduction.unloaded.get())
        .unwrap_or(false)
}

/// Lets every load that acts at once grow until `end`.
pub(super) fn grow(
    gravity: Option<&mut Gravity>,
    tractions: &mut [Traction],
    loads: &mut [PointLoad],
    rigid: &mut [Rigid],
    end: f64,
    report: &mut Report<'_>,
) {
    let gravity = gravity.map(|gravity| ("gravity.ramp".to_owned(), &mut gravity.ramp));
    let tractions = tractions
        .iter_mut()
        .enumerate()
        .filter(|(_, load)| load.amplitude.is_empty());
    let tractions = tractions.map(|(k, load)| (format!("traction.{k}.ramp"), &mut load.ramp));
    let loads = loads
        .iter_mut()
        .enumerate()
        .filter(|(_, load)| load.amplitude.is_empty());
    let loads = loads.map(|(k, load)| (format!("point_load.{k}.ramp"), &mut load.ramp));
    let rigid = rigid
        .iter_mut()
        .enumerate()
        .filter(|(_, of)| of.force != [0.0; 3] && of.amplitude.is_empty());
    let rigid = rigid.map(|(k, of)| (format!("rigid.{k}.ramp"), &mut of.ramp));
    let all = gravity.into_iter().chain(tractions).chain(loads).chain(rigid);
    for (key, ramp) in all.filter(|(_, ramp)| **ramp == 0.0) {
        *ramp = end;
        let reason = "strength_reduction.unloaded: every load grows from zero until the end of the analysis";
        report.note(key, format!("{end:?}"), reason);
    }
}

/// Warns of loads that act in full from the start: a state by k0 knows the weight alone.
pub(super) fn sudden(case: &Case, report: &mut Report<'_>) {
    if case.settles || !matches!(case.initial, Some(Initial::AtRest(_))) {
        return;
    }
    for load in case.sudden_loads() {
        report.warn(format!(
            "W0405: {load}: the first step applies the whole load at once, because initial stresses from k0 balance \
             the weight only. Give the load a `ramp`."
        ));
    }
}

/// Gravity must act from the start, on something.
fn loaded(
    draft: &Draft,
    record: &InitialTable,
    materials: Option<&[NamedMaterial]>,
    bodies: Option<&[Body]>,
    gravity: Option<&Gravity>,
    report: &mut Report<'_>,
) {
    if !draft.gravity.is_given() {
        record.location().error(
            "E0407: initial stresses follow from the weight of the soil, but the case has no gravity. Add [gravity].",
            report,
        );
    }
    let dims = draft.geometry.get().map_or(3, Geometry::dims);
    if let (Some(gravity), Some(written)) = (gravity, draft.gravity.value())
        && gravity.ramp > 0.0
        && gravity.is_straight(dims)
    {
        let message = format!(
            "E0409: [initial] gives the stresses of the full weight at t = 0, but gravity.ramp increases gravity from \
             zero until t = {}. Delete gravity.ramp, or delete [initial].",
            gravity.ramp
        );
        written.ramp.error(message, report);
    }
    if let (Some(materials), Some(bodies)) = (materials, bodies)
        && bodies.iter().all(|body| materials[body.material].density.is_none())
    {
        let message = "E0408: initial stresses follow from the weight of the soil, but no body has weight. Give \
                       `density` or `unit_weight` in [material].";
        record.location().error(message, report);
    }
}

/// Whether the stress at the start is led to equilibrium.
pub(super) fn settles(draft: &Draft) -> bool {
    draft.initial.value().and_then(|initial| initial.equilibrium.get()) == Some(Settled::Plastic)
}

/// Whether a material's ocr stands for its k0: not that of Cam-clay, which is of its yield surface.
fn is_of_k0(material: &Record) -> bool {
    material.gives("ocr") && material.word("model") != Some(LawName::CamClay)
}

/// K0 = (1 - sin φ) OCR^sin φ (Mayne and Kulhawy, 1982), below passive pressure.
fn overconsolidated(material: &Record, report: &mut Report<'_>) -> Option<f64> {
    let ocr = material.number("ocr")?;
    let friction = profile(material, "friction_angle")?;
    if friction.per_metre != 0.0 {
        let message = "E0410: k0 from `ocr` depends on the friction angle, which varies with depth here, but a \
             material has one k0. Give `k0`, or divide the soil into layers with a constant friction angle.";
        material.error("ocr", message, report);
        return None;
    }
    let sine = friction.value.to_radians().sin();
    let k0 = (1.0 - sine) * ocr.powf(sine);
    let passive = (1.0 + sine) / (1.0 - sine);
    let cohesion = profile(material, "cohesion")?;
    if k0 > passive && cohesion.value == 0.0 && cohesion.per_metre == 0.0 {
        let message = format!(
            "E0411: `ocr` = {ocr} gives k0 = {k0:.4}, above the passive limit Kp = {passive:.4}, so the soil would \
             fail at the start. Reduce `ocr`."
        );
        material.error("ocr", message, report);
        return None;
    }
    let reason = format!("from ocr = {ocr}: k0 = (1 - sin(phi)) ocr^sin(phi) (Mayne and Kulhawy, 1982)");
    report.note(material.path_of("k0"), format!("{k0}"), reason);
    Some(k0)
}

/// The coefficient of every material; 0 for those without that no body is made of.
fn at_rest(draft: &Draft, record: &InitialTable, bodies: &[Body], report: &mut Report<'_>) -> Option<Vec<f64>> {
    if record.k0.is_given() && record.k0.get().is_none() {
        return None;
    }
    let named = draft.material.items();
    let mut found = Vec::with_capacity(named.len());
    for (number, (name, material)) in named.iter().enumerate() {
        let own = match material.gives("k0") {
            true => Some(material.number("k0")?),
            false if is_of_k0(material) => Some(overconsolidated(material, report)?),
            false => record.k0.get(),
        };
        if material.gives("k0") && is_of_k0(material) {
            material.error(
                "ocr",
                "E0412: `ocr` and `k0` are both given, but `ocr` already determines k0. Delete one of the two.",
                report,
            );
        }
        if own.is_none() && bodies.iter().any(|body| body.material == number) {
            let message = format!(
                "E0413: material `{name}` has no k0, so its initial horizontal stress is unknown. Give initial.k0, \
                 material.{name}.k0, or initial.gravity = \"elastic\"."
            );
            record.location().error(message, report);
            return None;
        }
        found.push(own.unwrap_or(0.0));
    }
    Some(found)
}
