//! What of a scene a preset's cells and steps follow from, read from a record in which much may be missing.

use super::Preset;
use crate::record::Record;
use crate::region;
use crate::validate::STANDARD_GRAVITY;

/// Poisson's ratio above which elastic material is taken to lock.
const NEARLY_INCOMPRESSIBLE: f64 = 0.45;
/// Steps at most that are filled in: more are the author's to ask for.
const MOST_STEPS: f64 = 1e8;

/// A case as far as it is written.
pub(super) struct Scene<'a> {
    root: &'a Record,
}

impl<'a> Scene<'a> {
    pub(super) fn of(root: &'a Record) -> Self {
        Self { root }
    }

    /// Edge of the cells as TOML, and why. Along an axis between two faces that stay they come out whole.
    pub(super) fn cell(&self, preset: &Preset) -> Option<(String, String)> {
        let (size, why) = self.size(preset)?;
        let (grid, boundary) = (self.root.record("grid")?, self.root.record("boundary")?);
        let (lower, upper) = (grid.pair("lower")?, grid.pair("upper")?);
        let faces = [["left", "right"], ["bottom", "top"]];
        let moved: Vec<&str> =
            self.root.records("prescribed").iter().filter_map(|motion| motion.word("face")).collect();
        let edge = |axis: usize| {
            let (length, faces) = (upper[axis] - lower[axis], faces[axis]);
            let gives_way = |face: &str| boundary.word(face) == Some("free") && !moved.contains(&face);
            if faces.into_iter().any(gives_way) { size } else { length / (length / size).round().max(1.0) }
        };
        let [x, y] = [edge(0), edge(1)];
        let sound = |edge: f64| edge > 0.0 && edge.is_finite();
        let value = if x == y { format!("{x:?}") } else { format!("[{x:?}, {y:?}]") };
        (sound(x) && sound(y)).then_some((value, why))
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

    /// Number of steps, and why.
    pub(super) fn steps(&self, preset: &Preset) -> Option<(u64, String)> {
        let analysis = self.root.record("analysis")?;
        let cell = self.shortest().or_else(|| self.size(preset).map(|(size, _)| size))?;
        let (steps, why) = if analysis.word("type")? == "dynamic" {
            let crossed = preset.crossed;
            (
                analysis.number("end")? * self.shear_wave()? / (crossed * cell),
                format!("a shear wave crosses {crossed} cells in each"),
            )
        } else {
            let (steps, advance) = (self.travel() / (preset.advance * cell), preset.advance);
            if steps > preset.steps {
                (steps, format!("what is moved moves {advance} cells in each"))
            } else {
                (preset.steps, "so many at least".to_owned())
            }
        };
        // Rounding makes no step more.
        let steps = (steps * (1.0 - 1e-9)).ceil().max(1.0);
        (steps <= MOST_STEPS).then_some((steps as u64, why))
    }

    /// What there is to lock, if any.
    pub(super) fn locks(&self) -> Option<&'static str> {
        let materials = || self.root.named("material").iter().map(|(_, material)| material);
        if materials().any(|material| material.word("model").is_some_and(|model| model != "hencky")) {
            return Some("plastic material locks without");
        }
        let stiff =
            |material: &Record| material.number("poisson").is_some_and(|poisson| poisson > NEARLY_INCOMPRESSIBLE);
        materials().any(stiff).then_some("nearly incompressible material locks without")
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
    fn shortest(&self) -> Option<f64> {
        let grid = self.root.record("grid")?;
        if let Some(cell) = grid.numbers("cell") {
            return cell.iter().copied().reduce(f64::min);
        }
        let knots = grid.record("knots")?;
        let axes = ["x", "y"].into_iter().filter_map(|axis| knots.numbers(axis));
        axes.flat_map(|axis| axis.windows(2).map(|pair| pair[1] - pair[0])).reduce(f64::min).filter(|edge| *edge > 0.0)
    }

    /// m  the longest way of what is moved
    fn travel(&self) -> f64 {
        let end = self.root.record("analysis").and_then(|analysis| analysis.number("end")).unwrap_or(1.0);
        let way = |record: &Record| -> f64 {
            let norm = |[x, y]: [f64; 2]| x.hypot(y);
            let rows = record.rows("path").unwrap_or_default();
            // A path may come back: its ways add up.
            let points = std::iter::once([0.0; 2]).chain(rows.iter().map(|row| [row.numbers[1], row.numbers[2]]));
            let along: Vec<[f64; 2]> = points.collect();
            let path: f64 = along.windows(2).map(|pair| norm([pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]])).sum();
            let straight = record.pair("displacement").map_or(0.0, norm);
            path + straight + record.pair("velocity").map_or(0.0, norm) * end
        };
        let moved = self.root.record("footing").into_iter().chain(self.root.records("prescribed"));
        moved.map(way).fold(0.0, f64::max)
    }

    /// m/s  fastest shear wave in the bodies' materials, at the stiffest height
    fn shear_wave(&self) -> Option<f64> {
        let [lower, upper] = self.bounds()?;
        let speed = |(_, material): &(String, Record)| {
            let density =
                material.number("density").or_else(|| Some(material.number("unit_weight")? / STANDARD_GRAVITY))?;
            let young =
                material.number("young").or_else(|| stiffest(material.record("young")?, [lower[1], upper[1]]))?;
            Some((young / (2.0 * (1.0 + material.number("poisson")?)) / density).sqrt())
        };
        self.root.named("material").iter().filter_map(speed).filter(|speed| speed.is_finite()).reduce(f64::max)
    }
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
