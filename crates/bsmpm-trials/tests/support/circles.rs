//! Factors of safety by slip circles; for soil with friction, by Bishop's simplified method (1955).

/// A fill with a straight slope on level clay whose strength grows with depth; m, Pa, N/m3, degrees.
pub struct Embankment {
    /// m  level of the clay's top, and x of the toe
    pub toe: [f64; 2],
    /// m  height of the crest above the clay, and width of the slope
    pub slope: [f64; 2],
    /// unit weight, cohesion, friction angle
    pub fill: [f64; 3],
    /// unit weight, cohesion at its top, growth of the cohesion per metre
    pub clay: [f64; 3],
    /// m  bounds of x within which circles must stay
    pub within: [f64; 2],
}

const SLICES: usize = 60;

/// One slice: weight, sine of the base's slope, cohesion and tangent of the friction there.
struct Slice {
    weight: f64,
    sine: f64,
    cohesion: f64,
    friction: f64,
}

impl Embankment {
    fn surface(&self, x: f64) -> f64 {
        let [height, width] = self.slope;
        self.toe[1] + ((x - self.toe[0]) / width * height).clamp(0.0, height)
    }

    /// The least factor of circles with centres between two corners and lowest points `lowest`, on `n` places along
    /// each; with the circle: x and y of its centre, radius.
    pub fn least_factor(&self, corners: [[f64; 2]; 2], lowest: [f64; 2], n: usize) -> (f64, [f64; 3]) {
        let along = |from: f64, to: f64| (0..=n).map(move |i| from + (to - from) * i as f64 / n as f64);
        let mut best = (f64::INFINITY, [0.0; 3]);
        for x in along(corners[0][0], corners[1][0]) {
            for y in along(corners[0][1], corners[1][1]) {
                for low in along(lowest[0], lowest[1]) {
                    let circle = [x, y, y - low];
                    if let Some(factor) = self.factor(circle).filter(|factor| *factor < best.0) {
                        best = (factor, circle);
                    }
                }
            }
        }
        best
    }

    /// The factor of a circle; `None` where it does not turn the fill, or leaves the bounds.
    fn factor(&self, circle: [f64; 3]) -> Option<f64> {
        let [x, y, radius] = circle;
        let base = |at: f64| y - (radius * radius - (at - x) * (at - x)).max(0.0).sqrt();
        let scan = 400;
        let places = (0..=scan).map(|i| x - radius + 2.0 * radius * f64::from(i) / f64::from(scan));
        let inside: Vec<f64> = places.filter(|&at| base(at) < self.surface(at) - 1e-9).collect();
        let from = *inside.first()?;
        let to = *inside.last()?;
        if from < self.within[0] || to > self.within[1] {
            return None;
        }
        let width = (to - from) / SLICES as f64;
        let slices: Vec<Slice> = (0..SLICES)
            .map(|i| from + (i as f64 + 0.5) * width)
            .filter(|&at| base(at) < self.surface(at))
            .map(|at| self.slice(at, base(at), width, (at - x) / radius))
            .collect();
        let turning: f64 = slices.iter().map(|slice| slice.weight * slice.sine).sum();
        (turning > 0.0).then(|| {
            let holding = |slice: &Slice, factor: f64| {
                let cosine = (1.0 - slice.sine * slice.sine).sqrt();
                let own = slice.cohesion * width + slice.weight * slice.friction;
                own / (cosine + slice.sine * slice.friction / factor)
            };
            let again = |factor: f64| slices.iter().map(|slice| holding(slice, factor)).sum::<f64>() / turning;
            (0..30).fold(1.5, |factor, _| again(factor))
        })
    }

    fn slice(&self, x: f64, base: f64, width: f64, sine: f64) -> Slice {
        let top = self.surface(x);
        let level = self.toe[1];
        let weight = width * (self.fill[0] * (top - base.max(level)) + self.clay[0] * (level - base).max(0.0));
        let (cohesion, friction) = if base < level {
            (self.clay[1] + self.clay[2] * (level - base), 0.0)
        } else {
            (self.fill[1], self.fill[2].to_radians().tan())
        };
        Slice {
            weight,
            sine,
            cohesion,
            friction,
        }
    }
}

/// Pressure over the strength of the upper clay under a strip of width 2 on a layer of clay, thick `height`, on clay of
/// `ratio` of its strength, both without weight: the least over circles through one end of the strip (Button, 1953).
/// The strip may turn with them; as it is loaded in its middle, one that cannot carries no more.
pub fn strip_on_two_clays(height: f64, ratio: f64) -> f64 {
    const WIDTH: f64 = 2.0;
    const PLACES: usize = 200;
    let along = |most: f64| (1..=PLACES).map(move |i| most * i as f64 / PLACES as f64);
    let pressure = |ahead: f64, up: f64| {
        let radius = ahead.hypot(up);
        let [whole, below] = [up, up + height].map(|depth| (depth / radius).min(1.0).acos());
        2.0 * radius * radius * (whole - below + ratio * below) / (WIDTH * (ahead - WIDTH / 2.0))
    };
    let centres = along(3.0 * WIDTH)
        .filter(|&ahead| ahead > 0.6 * WIDTH)
        .flat_map(|x| along(2.0 * WIDTH).map(move |y| (x, y)));
    centres.map(|(x, y)| pressure(x, y)).fold(f64::INFINITY, f64::min)
}
