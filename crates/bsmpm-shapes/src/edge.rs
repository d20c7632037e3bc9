//! One edge of the outline of a body: a straight line or a semicircle.

/// An edge, from left to right: a straight line, or half of a circle. Coordinates are in m from the lower corner of the
/// grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Left end.
    pub a: [f64; 2],
    /// Right end; a vertical edge has both ends at the same x.
    pub b: [f64; 2],
    /// Number of the shape to which the edge belongs.
    pub shape: usize,
    arc: Option<Arc>,
}

/// Half of a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Arc {
    center: [f64; 2],
    radius: f64,
    upper: bool,
}

/// What lies between an edge and its chord.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bulge {
    /// m²
    pub(crate) area: f64,
    /// m³
    pub(crate) moment: [f64; 2],
}

impl std::ops::Sub for Bulge {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        let moment = [self.moment[0] - other.moment[0], self.moment[1] - other.moment[1]];
        Self {
            area: self.area - other.area,
            moment,
        }
    }
}

impl Edge {
    /// Returns the straight edge between two positions.
    pub fn line(p: [f64; 2], q: [f64; 2], shape: usize) -> Self {
        let (a, b) = if p[0] <= q[0] { (p, q) } else { (q, p) };
        Self { a, b, shape, arc: None }
    }

    /// Returns the lower and the upper half of a circle.
    pub fn circle(center: [f64; 2], radius: f64, shape: usize) -> [Self; 2] {
        let [a, b] = [-radius, radius].map(|reach| [center[0] + reach, center[1]]);
        [false, true].map(|upper| Self {
            a,
            b,
            shape,
            arc: Some(Arc { center, radius, upper }),
        })
    }

    /// Returns whether the edge is straight.
    pub fn is_straight(&self) -> bool {
        self.arc.is_none()
    }

    /// Returns whether the edge is straight and parallel to an axis: 0 is horizontal, 1 is vertical.
    pub fn is_along(&self, axis: usize) -> bool {
        self.arc.is_none() && self.a[1 - axis] == self.b[1 - axis]
    }

    /// Returns the same edge as one of another shape.
    pub fn of(self, shape: usize) -> Self {
        Self { shape, ..self }
    }

    /// The same edge, moved by some way.
    pub(crate) fn moved(self, by: [f64; 2]) -> Self {
        let moved = |at: [f64; 2]| [at[0] + by[0], at[1] + by[1]];
        let arc = self.arc.map(|arc| Arc {
            center: moved(arc.center),
            ..arc
        });
        Self {
            a: moved(self.a),
            b: moved(self.b),
            arc,
            ..self
        }
    }

    /// Returns the y of the edge at `x`; beyond its ends that of the nearer end.
    pub fn y(&self, x: f64) -> f64 {
        match self.arc {
            Some(Arc { center, radius, upper }) => {
                let dx = (x - center[0]).clamp(-radius, radius);
                let rise = ((radius - dx) * (radius + dx)).sqrt();
                if upper { center[1] + rise } else { center[1] - rise }
            }
            None if x <= self.a[0] => self.a[1],
            None if x >= self.b[0] => self.b[1],
            None => self.a[1] + (x - self.a[0]) * ((self.b[1] - self.a[1]) / (self.b[0] - self.a[0])),
        }
    }

    /// Lowest and highest y of the whole edge.
    pub(crate) fn heights(&self) -> [f64; 2] {
        self.span([self.a[0], self.b[0]]).unwrap_or([self.a[1], self.b[1]])
    }

    /// Lowest and highest y where x lies in an interval, its ends included; none if the edge is not there.
    pub(crate) fn span(&self, [left, right]: [f64; 2]) -> Option<[f64; 2]> {
        if self.b[0] < left || self.a[0] > right {
            return None;
        }
        let mut p = self.y(left.max(self.a[0]));
        let mut q = self.y(right.min(self.b[0]));
        match self.arc {
            None if self.a[0] == self.b[0] => (p, q) = (self.a[1], self.b[1]),
            Some(Arc { center, radius, upper }) if (left..=right).contains(&center[0]) => {
                let top = if upper { center[1] + radius } else { center[1] - radius };
                (p, q) = (p.min(q).min(top), p.max(q).max(top));
            }
            _ => {}
        }
        Some([p.min(q), p.max(q)])
    }

    /// Where it may cross the height `y`: the x, perhaps beyond its ends.
    pub(crate) fn levels(&self, y: f64) -> [Option<f64>; 2] {
        match self.arc {
            Some(Arc { center, radius, .. }) => {
                let dy = y - center[1];
                both(center[0], (radius - dy) * (radius + dy))
            }
            None if self.a[1] == self.b[1] => [None; 2],
            None => [
                Some(self.a[0] + (y - self.a[1]) * ((self.b[0] - self.a[0]) / (self.b[1] - self.a[1]))),
                None,
            ],
        }
    }

    /// Where it may cross another edge: the x, perhaps beyond the ends of one.
    pub(crate) fn crossings(&self, other: &Self) -> [Option<f64>; 2] {
        match (self.arc, other.arc) {
            (None, None) => [line_and_line(self, other), None],
            (None, Some(arc)) => line_and_circle(self, &arc),
            (Some(arc), None) => line_and_circle(other, &arc),
            (Some(arc), Some(other)) => circle_and_circle(&arc, &other),
        }
    }

    /// Area between the edge and its chord from `x[0]` to `x[1]`, m², and its first moments, m³; negative where the
    /// edge lies below.
    pub(crate) fn bulge(&self, x: [f64; 2]) -> Bulge {
        let Some(Arc { center, radius, upper }) = self.arc else {
            return Bulge::default();
        };
        let sign = if upper { 1.0 } else { -1.0 };
        let along = [x[1] - x[0], self.y(x[1]) - self.y(x[0])];
        let chord = along[0].hypot(along[1]);
        let angle = 2.0 * (chord / (2.0 * radius)).min(1.0).asin();
        let area = sign * 0.5 * radius * radius * (angle - angle.sin());
        // About the centre of its circle a segment has chord³/12 along its axis, which is across the chord.
        let about_center = [-along[1], along[0]].map(|across| across * chord * chord / 12.0);
        Bulge {
            area,
            moment: [0, 1].map(|axis| about_center[axis] + center[axis] * area),
        }
    }

    /// Returns the distance of a position from the edge (m), for half of a circle that from the whole circle.
    pub fn distance(&self, at: [f64; 2]) -> f64 {
        if let Some(Arc { center, radius, .. }) = self.arc {
            return ((at[0] - center[0]).hypot(at[1] - center[1]) - radius).abs();
        }
        let along = [self.b[0] - self.a[0], self.b[1] - self.a[1]];
        let from = [at[0] - self.a[0], at[1] - self.a[1]];
        let part = (from[0] * along[0] + from[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        let part = part.clamp(0.0, 1.0);
        (from[0] - part * along[0]).hypot(from[1] - part * along[1])
    }
}

/// `middle` plus and minus the root of `square`.
fn both(middle: f64, square: f64) -> [Option<f64>; 2] {
    if square < 0.0 {
        [None; 2]
    } else {
        [Some(middle - square.sqrt()), Some(middle + square.sqrt())]
    }
}

fn line_and_line(one: &Edge, other: &Edge) -> Option<f64> {
    let d = [one.b[0] - one.a[0], one.b[1] - one.a[1]];
    let e = [other.b[0] - other.a[0], other.b[1] - other.a[1]];
    let cross = d[0] * e[1] - d[1] * e[0];
    if cross == 0.0 {
        return None;
    }
    let from = [other.a[0] - one.a[0], other.a[1] - one.a[1]];
    let part = (from[0] * e[1] - from[1] * e[0]) / cross;
    (0.0..=1.0).contains(&part).then(|| one.a[0] + part * d[0])
}

fn line_and_circle(line: &Edge, arc: &Arc) -> [Option<f64>; 2] {
    let d = [line.b[0] - line.a[0], line.b[1] - line.a[1]];
    let length = d[0].hypot(d[1]);
    let unit = [d[0] / length, d[1] / length];
    let from = [line.a[0] - arc.center[0], line.a[1] - arc.center[1]];
    let off = from[0] * unit[1] - from[1] * unit[0];
    let nearest = from[0] * unit[0] + from[1] * unit[1];
    let along = both(-nearest, (arc.radius - off) * (arc.radius + off));
    along.map(|along| along.map(|along| line.a[0] + along * unit[0]))
}

fn circle_and_circle(one: &Arc, other: &Arc) -> [Option<f64>; 2] {
    let d = [other.center[0] - one.center[0], other.center[1] - one.center[1]];
    let distance = d[0].hypot(d[1]);
    if distance == 0.0 {
        return [None; 2];
    }
    let along = 0.5 * (distance + (one.radius - other.radius) * (one.radius + other.radius) / distance);
    let [minus, plus] = both(0.0, (one.radius - along) * (one.radius + along));
    [minus, plus].map(|aside| aside.map(|aside| one.center[0] + (along * d[0] - aside * d[1]) / distance))
}
