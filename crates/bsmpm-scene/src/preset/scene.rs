//! What of a scene a preset's cells and steps follow from, read from a record in which much may be missing.

use super::Preset;
use crate::record::Record;
use crate::region;
use crate::schema::LawName;
use crate::validate::{NEARLY_INCOMPRESSIBLE, STANDARD_GRAVITY};
use crate::words::{Side, Support, Word};
use bsmpm::model::Regime;

/// Cells that a preset chooses.
pub(super) struct Cells {
    /// the key that says so, and its rival
    pub keys: [&'static str; 2],
    /// TOML
    pub value: String,
    /// m  the shorter edge
    pub edge: f64,
    pub why: String,
}

/// What cells follow from.
pub(super) const CELLS: &str = "the size of the bodies, or the length of the shortest strip or loaded segment, the grid's corners \
                                and [boundary]";
/// What steps follow from.
pub(super) const STEPS: &str = "`type`, the cells and, in dynamics, `end` and young, poisson and density of the bodies' \
                                materials, in statics what is moved; 1e8 at most";

/// Steps at most that are filled in: more are the author's to ask for.
const MOST_STEPS: f64 = 1e8;

/// A case as far as it is written.
pub(super) struct PresetScene<'a> {
    root: &'a Record,
}

impl<'a> PresetScene<'a> {
    pub(super) fn of(root: &'a Record) -> Self {
        Self { root }
    }

    /// The cells. Along an axis between two faces that stay they come out whole.
    pub(super) fn cells(&self, preset: &Preset) -> Option<Cells> {
        let (size, why) = self.size(preset)?;
        let (grid, boundary) = (self.root.record("grid")?, self.root.record("boundary")?);
        let (lower, upper) = (grid.pair("lower")?, grid.pair("upper")?);
        let moved: Vec<Side> =
            self.root.records("prescribed").iter().filter_map(|motion| motion.word("face")).collect();
        let edge = |axis: usize| {
            let length = upper[axis] - lower[axis];
            let gives_way = |side: Side| boundary.word(side.word()) == Some(Support::Free) && !moved.contains(&side);
            if Side::ALL[axis].into_iter().any(gives_way) { size } else { length / (length / size).round().max(1.0) }
        };
        let [x, y] = [edge(0), edge(1)];
        let sound = |edge: f64| edge > 0.0 && edge.is_finite();
        if !sound(x) || !sound(y) {
            return None;
        }
        let wanted = self.wanted();
        let on_line = |axis: usize, edge: f64| {
            let off = |at: &f64| ((at - lower[axis]) / edge - ((at - lower[axis]) / edge).round()).abs();
            let inside = |at: &&f64| (lower[axis]..=upper[axis]).contains(*at);
            wanted[axis].iter().filter(inside).all(|at| off(at) <= ON_LINE)
        };
        if on_line(0, x) && on_line(1, y) {
            let value = if x == y { format!("{x:?}") } else { format!("[{x:?}, {y:?}]") };
            return Some(Cells { keys: ["cell", "knots"], value, edge: x.min(y), why });
        }
        let knots = [0, 1].map(|axis| knots([lower[axis], upper[axis]], [x, y][axis], &wanted[axis]));
        let shortest = |knots: &Vec<f64>| knots.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let edge = shortest(&knots[0]).min(shortest(&knots[1]));
        let why = format!("{why}, moved by up to half a cell to where materials meet and strips and loads end");
        let value = format!("{{ x = {:?}, y = {:?} }}", knots[0], knots[1]);
        (edge > 0.0).then_some(Cells { keys: ["knots", "cell"], value, edge, why })
    }

    /// m  places along x and y at which a grid line is wanted: ends of strips and loaded segments, then sides of
    /// bodies, if these are of several materials.
    fn wanted(&self) -> [Vec<f64>; 2] {
        let mut wanted = [Vec::new(), Vec::new()];
        for [from, to] in self.segments() {
            let along = [0, 1].into_iter().find(|&axis| from[1 - axis] == to[1 - axis]);
            along.into_iter().for_each(|axis| wanted[axis].extend([from[axis], to[axis]]));
        }
        if self.materials().count() > 1 {
            for (a, b) in self.root.records("body").iter().flat_map(sides) {
                let across = [0, 1].into_iter().find(|&axis| a[axis] == b[axis]);
                across.into_iter().for_each(|axis| wanted[axis].push(a[axis]));
            }
        }
        wanted
    }

    /// m  the shorter side of the thinnest body's rectangle
    pub(super) fn thinnest(&self) -> Option<f64> {
        let side = |[lower, upper]: [[f64; 2]; 2]| (upper[0] - lower[0]).min(upper[1] - lower[1]);
        self.root.records("body").iter().filter_map(around).map(side).reduce(f64::min)
    }

    /// m  what the preset wants, and why
    fn size(&self, preset: &Preset) -> Option<(f64, String)> {
        let [lower, upper] = self.bounds()?;
        let side = (upper[0] - lower[0]).min(upper[1] - lower[1]);
        let of_bodies = side / preset.across;
        let strip = self.segments().map(|[from, to]| (to[0] - from[0]).hypot(to[1] - from[1])).reduce(f64::min);
        Some(match strip.map(|length| (length, length / preset.along)).filter(|(_, size)| *size < of_bodies) {
            Some((length, size)) => (size, format!("{} along the strip or load of {length} m", preset.along)),
            None => (of_bodies, format!("{} across the {side} m of the bodies", preset.across)),
        })
    }

    /// Number of steps for cells whose shorter edge is `chosen` (m), unless the case gives its own, and why.
    pub(super) fn steps(&self, preset: &Preset, chosen: Option<f64>) -> Option<(u64, String)> {
        let analysis = self.root.record("analysis")?;
        let cell = self.shortest().or(chosen)?;
        let (steps, why) = match analysis.word("type")? {
            Regime::Dynamic => {
                let (crossed, way) = (preset.crossed, analysis.number("end")? * self.shear_wave()?);
                (way / (crossed * cell), format!("a shear wave crosses {crossed} cells in each"))
            }
            Regime::QuasiStatic => {
                let (steps, advance) = (self.fastest() / (preset.advance * cell), preset.advance);
                if steps > preset.steps {
                    (steps, format!("what is moved moves {advance} cells in each at most"))
                } else {
                    (preset.steps, "so many at least".to_owned())
                }
            }
        };
        // Rounding makes no step more.
        let steps = (steps * (1.0 - 1e-9)).ceil().max(1.0);
        (steps <= MOST_STEPS).then_some((steps as u64, why))
    }

    /// What there is to lock, if any.
    pub(super) fn locks(&self) -> Option<&'static str> {
        if self.materials().filter_map(|material| material.word("model")).any(LawName::is_plastic) {
            return Some("plastic material locks without");
        }
        let stiff =
            |material: &Record| material.number("poisson").is_some_and(|poisson| poisson > NEARLY_INCOMPRESSIBLE);
        self.materials().any(stiff).then_some("nearly incompressible material locks without")
    }

    /// m  corners of the rectangle around all bodies, whatever is cut out of them
    fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        let corners: Option<Vec<[[f64; 2]; 2]>> = self.root.records("body").iter().map(around).collect();
        let corners = corners?.concat();
        (!corners.is_empty()).then(|| region::bounds(&corners))
    }

    /// Ends of strips and loaded segments.
    fn segments(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        let listed = ["prescribed", "traction"].into_iter().flat_map(|table| self.root.records(table));
        let ends = |record: &Record| Some([record.pair("from")?, record.pair("to")?]);
        self.root.record("footing").into_iter().chain(listed).filter_map(ends)
    }

    /// m  shortest edge of the cells that the case gives, if it does
    pub(super) fn shortest(&self) -> Option<f64> {
        let grid = self.root.record("grid")?;
        if let Some(cell) = grid.numbers("cell") {
            return cell.iter().copied().reduce(f64::min);
        }
        let knots = grid.record("knots")?;
        let axes = ["x", "y"].into_iter().filter_map(|axis| knots.numbers(axis));
        axes.flat_map(|axis| axis.windows(2).map(|pair| pair[1] - pair[0])).reduce(f64::min).filter(|edge| *edge > 0.0)
    }

    /// m  what is moved at its fastest would come so far in the whole run
    fn fastest(&self) -> f64 {
        let end = self.root.record("analysis").and_then(|analysis| analysis.number("end")).unwrap_or(1.0);
        let norm = |[x, y]: [f64; 2]| x.hypot(y);
        let way = |record: &Record| -> f64 {
            let rows = record.rows("path").unwrap_or_default().iter().map(|row| &row.numbers[..]);
            let places: Vec<&[f64]> = std::iter::once(&[0.0; 3][..]).chain(rows).collect();
            let speed = |pair: &[&[f64]]| {
                let [t, x, y] = [0, 1, 2].map(|k| pair[1][k] - pair[0][k]);
                if t > 0.0 && pair[0][0] < end { norm([x, y]) / t } else { 0.0 }
            };
            let path = places.windows(2).map(speed).fold(0.0, f64::max) * end;
            let steady = record.pair("velocity").map_or(0.0, norm) * end;
            path + steady + record.pair("displacement").map_or(0.0, norm)
        };
        let moved = self.root.record("footing").into_iter().chain(self.root.records("prescribed"));
        moved.map(way).fold(0.0, f64::max)
    }

    /// Materials that bodies are made of.
    fn materials(&self) -> impl Iterator<Item = &Record> {
        let bodies = self.root.records("body");
        let is_used = move |name: &str| bodies.iter().any(|body| body.text("material") == Some(name));
        self.root.named("material").iter().filter(move |(name, _)| is_used(name)).map(|(_, material)| material)
    }

    /// m/s  fastest shear wave in the bodies' materials, at the stiffest height
    fn shear_wave(&self) -> Option<f64> {
        let [lower, upper] = self.bounds()?;
        let speed = |material: &Record| {
            let density =
                material.number("density").or_else(|| Some(material.number("unit_weight")? / STANDARD_GRAVITY))?;
            let young =
                material.number("young").or_else(|| stiffest(material.record("young")?, [lower[1], upper[1]]))?;
            Some((young / (2.0 * (1.0 + material.number("poisson")?)) / density).sqrt())
        };
        self.materials().filter_map(speed).filter(|speed| speed.is_finite()).reduce(f64::max)
    }
}

/// Parts of a cell by which a place may miss a grid line: rounding.
const ON_LINE: f64 = 1e-6;

/// m  breakpoints from the one end of an axis to the other, about `cell` apart, with one at every wanted place that is
/// half a cell from those before it in the list, and from the ends.
fn knots([lower, upper]: [f64; 2], cell: f64, wanted: &[f64]) -> Vec<f64> {
    let mut fixed = vec![lower, upper];
    for &at in wanted.iter().filter(|at| (lower..=upper).contains(*at)) {
        if fixed.iter().all(|other| (at - other).abs() >= 0.5 * cell) {
            fixed.push(at);
        }
    }
    fixed.sort_by(f64::total_cmp);
    let mut knots = vec![lower];
    for pair in fixed.windows(2) {
        let cells = ((pair[1] - pair[0]) / cell).round().max(1.0) as usize;
        let inner = (1..cells).map(|k| pair[0] + (pair[1] - pair[0]) * (k as f64 / cells as f64));
        knots.extend(inner.chain([pair[1]]));
    }
    knots
}

/// m  ends of the straight sides of a body
fn sides(body: &Record) -> Vec<([f64; 2], [f64; 2])> {
    let corners: Vec<[f64; 2]> = match (body.record("box"), body.rows("polygon")) {
        (Some(shape), _) => {
            let (Some(lower), Some(upper)) = (shape.pair("lower"), shape.pair("upper")) else { return Vec::new() };
            vec![lower, [upper[0], lower[1]], upper, [lower[0], upper[1]]]
        }
        (None, Some(rows)) => rows.iter().map(|row| [row.numbers[0], row.numbers[1]]).collect(),
        (None, None) => Vec::new(),
    };
    (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()])).collect()
}

/// m  corners of a body's rectangle
fn around(body: &Record) -> Option<[[f64; 2]; 2]> {
    if let Some(shape) = body.record("box") {
        return Some([shape.pair("lower")?, shape.pair("upper")?]);
    }
    if let Some(circle) = body.record("circle") {
        let (center, radius) = (circle.pair("center")?, circle.number("radius")?);
        return Some([-radius, radius].map(|reach| center.map(|x| x + reach)));
    }
    let corners: Vec<[f64; 2]> = body.rows("polygon")?.iter().map(|row| [row.numbers[0], row.numbers[1]]).collect();
    (!corners.is_empty()).then(|| region::bounds(&corners))
}

/// Pa  the largest value of a profile between two heights
fn stiffest(profile: &Record, heights: [f64; 2]) -> Option<f64> {
    let (value, at, growth) = (profile.number("value")?, profile.number("at_y")?, profile.number("per_metre")?);
    heights.map(|y| value + growth * (at - y)).into_iter().reduce(f64::max)
}
