//! Places C0 lines (repeated breakpoints, across which strains may jump) at material interfaces and at ends of footings
//! and loads.

mod ends;
mod faces;

use crate::case::{Case, NamedMaterial};
use crate::grid::Line;
use crate::report::Report;
use crate::rounding::brief;
use crate::schema::{Draft, FootingTable, PrescribedTable, TractionTable};
use crate::words::C0Lines;
use bsmpm_shapes::Edge;
use std::collections::BTreeMap;

/// Parts of a cell by which a place may miss a grid line: rounding.
const ROUNDING: f64 = 1e-6;
/// Places along an edge at which both sides are looked at.
const SAMPLES: usize = 33;
/// Parts of the shortest cell by which a place lies beside an edge, and beyond an end.
const BESIDE: f64 = 1e-3;
const BEYOND: f64 = 0.25;
/// Relative difference of two moduli, Poisson's ratios or densities that is none: strains jump by no more.
const EQUAL: f64 = 0.02;
/// Ratio of two moduli, or of two densities, from which there is a warning of an interface inside cells.
const UNLIKE: f64 = 1.5;
/// Ratio of two densities from which there is a warning of averages on either side of a line.
const DENSER: f64 = 2.0;
/// Ratio of two moduli up to which a stiff body on yielding soil was shown to be right once it has left its grid line.
const SHOWN: f64 = 100.0;
/// Parts of the shortest cell that a strip may go before there is a warning of lost volume under water at its lines.
const CROSSED: f64 = 0.25;
const NAMES: [&str; 3] = ["x", "y", "z"];

/// Adds the lines to a case's grid, notes where and why, and warns of places where none can be. Returns the names of
/// what ends inside a cell.
pub(super) fn place(case: &mut Case, draft: &Draft, report: &mut Report<'_>) -> Vec<String> {
    if case.grid.order == 1 {
        return Vec::new(); // Every grid line is one.
    }
    let mut found = FoundLine::at_interfaces(case);
    if case.grid.dims() == 2 {
        ends::segments(case, &mut found);
    }
    ends::corners(case, &mut found);
    ends::plates(case, &mut found);
    for (table, number, message) in std::mem::take(&mut found.narrow) {
        let site = match table {
            "footing" => draft.footing.value().map(FootingTable::site),
            "prescribed" => draft.prescribed.items().get(number).map(PrescribedTable::site),
            _ => draft.traction.items().get(number).map(TractionTable::site),
        };
        if let Some(site) = site {
            site.end().error(message, report);
        }
    }
    let lines = std::mem::take(&mut found.lines);
    let chosen = draft
        .grid
        .value()
        .and_then(|grid| grid.c0_lines.get())
        .unwrap_or(C0Lines::Automatic);
    // Where water flows, ground loses volume as it moves through them: they are at the ends of strips only.
    let (placed, left): (Vec<_>, Vec<_>) = lines.into_iter().partition(|(place, _)| {
        chosen == C0Lines::Automatic && (case.flow.is_none() || found.held.contains_key(place))
    });
    if let Some(((axis, line), reason)) = left.iter().find(|((axis, line), _)| !has(case, *axis, *line)) {
        warn_of_smoothing(&place_of(case, *axis, *line), reason, chosen, report);
    }
    let mut crossed = own(case);
    let jumps = crossed.or(placed.first().map(|(place, _)| *place));
    if let Some(((axis, line), name)) = jumps.zip(undrained_with_friction(case, draft)) {
        report.warn(format!(
            "W0218: the undrained strength of material.{name} depends on the mean stress, which is inaccurate at {} \
             (end of a load or interface). Limit loads can be off by 4 %. Compare model = \"tresca\".",
            place_of(case, axis, line)
        ));
    }
    for ((axis, line), reason) in placed {
        if found
            .held
            .get(&(axis, line))
            .is_some_and(|far| *far > CROSSED * case.grid.axes[axis].shortest())
        {
            crossed = crossed.or(Some((axis, line)));
        }
        insert(case, axis, line);
        report.note("grid.c0_lines", place_of(case, axis, line), reason);
    }
    if let Some((axis, line)) = crossed.filter(|_| case.flow.is_some()) {
        report.warn(format!(
            "W0219: grid.c0_lines: saturated soil loses volume at the C0 line (where strains may jump) at {}, so \
             loads become too small. Increase points_per_cell, or set grid.c0_lines = \"none\".",
            place_of(case, axis, line)
        ));
    }
    found.doubts.into_values().for_each(|doubt| report.warn(doubt));
    found.inside
}

/// Warns that strains jump at a place where no line is placed.
fn warn_of_smoothing(place: &str, reason: &str, chosen: C0Lines, report: &mut Report<'_>) {
    report.warn(match chosen {
        C0Lines::None => format!(
            "W0216: {reason}, at {place}. Without a C0 line the grid smooths this, so stresses within three cells \
             can be off by tens of per cent. Set grid.c0_lines = \"automatic\"."
        ),
        C0Lines::Automatic => format!(
            "W0217: {reason}, at {place}. In an analysis with pore-water flow the grid smooths this, so stresses \
             nearby can be off by tens of per cent. Use smaller cells there."
        ),
    });
}

/// Soil whose strength friction makes, and in which no water flows although it fills it.
fn undrained_with_friction<'a>(case: &Case, draft: &'a Draft) -> Option<&'a str> {
    let soils = &case.flow.as_ref()?.soils;
    for (number, ((name, of), soil)) in draft.material.items().iter().zip(soils).enumerate() {
        let is_made = case.bodies.iter().any(|body| body.material == number);
        let is_undrained = soil.as_ref().is_some_and(|soil| soil.permeability.is_none());
        let has_friction = of.friction_angle.plain().is_some_and(|friction| friction > 0.0);
        if is_made && is_undrained && has_friction {
            return Some(name);
        }
    }
    None
}

/// The first line of the grid's own knots across which strains may jump.
fn own(case: &Case) -> Option<(usize, usize)> {
    let mut lines = (0..case.grid.dims()).flat_map(|axis| case.grid.lines[axis].iter().map(move |line| (axis, line)));
    let (axis, line) = lines.find(|(_, line)| line.multiplicity >= case.grid.order)?;
    Some((axis, line.breakpoint))
}

/// Lines by axis and breakpoint with their reasons, and what cannot be on one.
#[derive(Default)]
struct FoundLine {
    lines: BTreeMap<(usize, usize), String>,
    held: BTreeMap<(usize, usize), f64>, // those of them at the ends of strips: how far these go, m
    doubts: BTreeMap<String, String>,
    narrow: Vec<(&'static str, usize, String)>,
    inside: Vec<String>, // names of what ends inside a cell
}

impl FoundLine {
    /// The grid lines on which unlike materials meet, and doubts about those that meet elsewhere.
    fn at_interfaces(case: &Case) -> Self {
        let mut found = Self::default();
        match case.grid.dims() {
            2 => interfaces(case, &mut found),
            _ => faces::interfaces(case, &mut found),
        }
        found
    }
}

/// Whether strains may jump on a grid line on which unlike materials meet: a C0 line, as of linear splines all are.
pub(super) fn has_interface(case: &Case) -> bool {
    FoundLine::at_interfaces(case)
        .lines
        .keys()
        .any(|(axis, line)| case.grid.order == 1 || has(case, *axis, *line))
}

/// Where the grid line of an axis with a number is, in words.
fn place_of(case: &Case, axis: usize, line: usize) -> String {
    let along = &case.grid.axes[axis];
    format!("{} = {} m", NAMES[axis], along.lower() + along.breakpoint(line))
}

fn has(case: &Case, axis: usize, line: usize) -> bool {
    case.grid.lines[axis]
        .iter()
        .any(|own| own.breakpoint == line && own.multiplicity == case.grid.order)
}

fn insert(case: &mut Case, axis: usize, breakpoint: usize) {
    let lines = &mut case.grid.lines[axis];
    let multiplicity = case.grid.order;
    match lines.binary_search_by_key(&breakpoint, |line| line.breakpoint) {
        Ok(at) => lines[at].multiplicity = multiplicity,
        Err(at) => lines.insert(
            at,
            Line {
                breakpoint,
                multiplicity,
            },
        ),
    }
}

/// The axis across an edge and the grid line that the edge lies on, if there is one.
pub(super) fn line_of(case: &Case, edge: &Edge) -> Option<(usize, usize)> {
    let axis = [0, 1].into_iter().find(|&axis| edge.is_along(1 - axis))?;
    Some((axis, grid_line(case, axis, edge.a[axis])?))
}

/// The grid line at `x` (m from the first) along an axis, if there is one.
fn grid_line(case: &Case, axis: usize, x: f64) -> Option<usize> {
    let axis = &case.grid.axes[axis];
    let after = axis.first_cell(|i| axis.breakpoint(i + 1) >= x);
    let mut lines = [after, after + 1].into_iter().filter(|i| *i <= axis.cells());
    lines.find(|i| (axis.breakpoint(*i) - x).abs() <= ROUNDING * axis.shortest())
}

/// Where bodies of unlike stiffness or density meet.
fn interfaces(case: &Case, found: &mut FoundLine) {
    let used: Vec<usize> = case.bodies.iter().map(|body| body.material).collect();
    if used
        .iter()
        .all(|material| differ(case, used[0], *material, None).is_none())
    {
        return;
    }
    for body in &case.bodies {
        for edge in body.region.edges(&case.grid.axes).0 {
            let line = line_of(case, &edge);
            if line.is_some_and(|(axis, line)| line == 0 || line == case.grid.axes[axis].cells()) {
                continue;
            }
            let Some(Interface { at, materials, ratios }) = unlike(case, &edge) else {
                continue;
            };
            let [a, b] = materials.map(|material| &case.materials[material]);
            if let Some(line) = line {
                found.lines.entry(line).or_insert_with(|| interface_of(a, b));
            }
            let averages = case.stabilisation.averages();
            if let Some(doubt) = doubt([a, b], line.is_some(), averages, &at, ratios) {
                found.doubts.entry(format!("{} {}", a.name, b.name)).or_insert(doubt);
            }
        }
    }
}

fn interface_of(a: &NamedMaterial, b: &NamedMaterial) -> String {
    format!("strains jump at the interface of `{}` and `{}`", a.name, b.name)
}

/// What is doubtful about an interface of two materials whose moduli and densities have these ratios.
fn doubt(
    [a, b]: [&NamedMaterial; 2],
    on_line: bool,
    averages: bool,
    at: &[f64],
    [moduli, densities]: [f64; 2],
) -> Option<String> {
    let yields = [a, b].iter().any(|named| named.material.yields());
    let [a, b] = [&a.name, &b.name];
    if on_line && yields && moduli > SHOWN {
        return Some(format!(
            "W0220: the stiffness of material.{a} and material.{b} differs by a factor of {} (limit {SHOWN}). \
             Stresses in the stiffer one are wrong after yielding. Reduce the larger `young`.",
            brief(moduli)
        ));
    }
    if on_line && averages && densities >= DENSER {
        return Some(format!(
            "W0221: the density of material.{a} and material.{b} differs by a factor of {}. Stresses in the cells \
             next to their interface at {} are inaccurate. Use smaller cells at the interface.",
            brief(densities),
            coordinates(at)
        ));
    }
    if !on_line && moduli.max(densities) >= UNLIKE {
        return Some(format!(
            "W0222: the interface of material.{a} and material.{b} is not on a grid line, first at {at:.3?} m. Stresses \
             within three cells are off by tens of per cent. Put a grid line there (grid.knots)."
        ));
    }
    None
}

/// The coordinates of a place in words.
fn coordinates(at: &[f64]) -> String {
    let all: Vec<String> = NAMES
        .iter()
        .zip(at)
        .map(|(axis, value)| format!("{axis} = {value:.3} m"))
        .collect();
    all.join(", ")
}

/// An interface: a place on it (m), the materials on both sides, the ratios of their moduli and densities.
struct Interface {
    at: [f64; 2],
    materials: [usize; 2],
    ratios: [f64; 2],
}

impl Interface {
    /// The larger of its ratios.
    fn largest_ratio(&self) -> f64 {
        self.ratios[0].max(self.ratios[1])
    }
}

/// The place along an edge where the materials on both sides are least alike, if they are not.
fn unlike(case: &Case, edge: &Edge) -> Option<Interface> {
    let lower = case.grid.lower()[1];
    let unlike = beside(case, edge).filter_map(|(at, (a, b))| {
        let ratios = differ(case, a, b, Some(at[1] - lower))?;
        let materials = [a, b];
        Some(Interface { at, materials, ratios })
    });
    unlike.reduce(|worst, next| {
        // Of equal ones the first.
        let is_worse = next.largest_ratio() > worst.largest_ratio();
        if is_worse { next } else { worst }
    })
}

/// Places along an edge that has ground on both sides, and the materials there.
pub(super) fn beside(case: &Case, edge: &Edge) -> impl Iterator<Item = ([f64; 2], (usize, usize))> {
    let lower = case.grid.lower();
    let aside = BESIDE * case.grid.shortest();
    let normal = usize::from(!edge.is_along(1)); // aside along x of a vertical edge, else along y
    (0..SAMPLES).filter_map(move |k| {
        let [x, y] = sample(edge, k);
        let at = [lower[0] + x, lower[1] + y];
        let before = material_beside(case, at, normal, -aside)?;
        let beyond = material_beside(case, at, normal, aside)?;
        Some((at, (before, beyond)))
    })
}

/// The place along an edge with a number, m from the grid's lower corner.
fn sample(edge: &Edge, k: usize) -> [f64; 2] {
    let part = (k as f64 + 0.5) / SAMPLES as f64;
    let x = edge.a[0] + part * (edge.b[0] - edge.a[0]);
    let y = if edge.is_along(1) {
        edge.a[1] + part * (edge.b[1] - edge.a[1])
    } else {
        edge.y(x)
    };
    [x, y]
}

/// The material at a place that is shifted along an axis (m), if there is any.
fn material_beside(case: &Case, mut at: [f64; 2], axis: usize, shift: f64) -> Option<usize> {
    at[axis] += shift;
    case.bodies
        .iter()
        .find(|body| body.region.contains(at))
        .map(|body| body.material)
}

/// Whether two materials differ in stiffness or density, at a height (m from the grid's lower corner) or anywhere: the
/// ratios of their moduli and densities.
fn differ(case: &Case, a: usize, b: usize, height: Option<f64>) -> Option<[f64; 2]> {
    if a == b {
        return None;
    }
    let [a, b] = [a, b].map(|material| &case.materials[material]);
    let young =
        [a, b].map(|named| height.map_or(named.material.elastic().young, |height| named.material.young_at(height)));
    let graded = height.is_none() && [a, b].iter().any(|named| named.material.is_graded());
    let poisson = [a, b].map(|named| named.material.elastic().poisson);
    let density = [a, b].map(|named| named.density.unwrap_or(0.0));
    let differs = graded
        || [young, poisson, density]
            .iter()
            .any(|[a, b]| (a - b).abs() > EQUAL * a.abs().max(b.abs()));
    differs.then(|| [young, density].map(|[a, b]| if a.min(b) > 0.0 { a.max(b) / a.min(b) } else { 1.0 }))
}
