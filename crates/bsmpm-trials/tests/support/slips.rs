//! Upper bounds of limit loads of undrained clay, by discontinuity layout optimisation (Smith and Gilbert, 2007).

use super::conic::{Program, Sum};

/// What an edge of the ground meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge {
    /// nothing
    Free,
    /// the axis of symmetry: slides for nothing, and does not come off
    Axis,
    /// ground that stays
    Held,
    /// a smooth body that moves so, m, and that the ground comes off at once
    Pushed([f64; 2]),
}

/// Ground: a polygon with the ground on its left, edge by edge with what the edge that begins there meets.
pub struct Ground {
    /// m
    pub corners: Vec<([f64; 2], Edge)>,
    /// m, Pa  layers from the top down: where each ends, and its strength
    pub layers: Vec<(f64, f64)>,
    /// N/m3
    pub unit_weight: f64,
    /// m  longest slip that is tried
    pub longest: f64,
}

/// A slip that may be: between two nodes, with what its edge meets, or within the ground.
struct Slip {
    nodes: [usize; 2],
    along: [f64; 2], // from the one to the other, m
    edge: Option<Edge>,
    cost: f64,   // J/m of a slip of 1 m
    weight: f64, // N/m of the ground above it
}

const CLOSE: f64 = 1e-9;

impl Ground {
    /// Work of the cheapest mechanism, J/m, with nodes at the corners, on the edges, and on a lattice of that spacing,
    /// m; of ground with a weight over the work of that, the factor of safety.
    pub fn least_work(&self, spacing: f64) -> f64 {
        let nodes = self.nodes(spacing);
        let slips = self.slips(&nodes);
        mechanism(nodes.len(), &slips, self.unit_weight > 0.0)
    }

    fn edges(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2], Edge)> {
        let next = |k: usize| self.corners[(k + 1) % self.corners.len()].0;
        self.corners
            .iter()
            .enumerate()
            .map(move |(k, &(corner, edge))| (corner, next(k), edge))
    }

    fn nodes(&self, spacing: f64) -> Vec<[f64; 2]> {
        let mut nodes: Vec<[f64; 2]> = self.corners.iter().map(|corner| corner.0).collect();
        for (from, to, _) in self.edges() {
            let parts = (distance(from, to) / spacing).round().max(1.0);
            nodes.extend((1..parts as usize).map(|k| between(from, to, k as f64 / parts)));
        }
        let range = |axis: usize| {
            let all = || self.corners.iter().map(move |corner| corner.0[axis] / spacing);
            let [low, high] = [
                all().fold(f64::MAX, f64::min).ceil(),
                all().fold(f64::MIN, f64::max).floor(),
            ];
            (low as i64..=high as i64).map(move |k| k as f64 * spacing)
        };
        for point in range(0).flat_map(|x| range(1).map(move |y| [x, y])) {
            let clear = self.edges().all(|(from, to, _)| off(from, to, point) > spacing / 4.0);
            if clear && self.holds(point) {
                nodes.push(point);
            }
        }
        nodes
    }

    /// Whether a point that lies on no edge is in the ground.
    fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let crossed = |&(from, to, _): &([f64; 2], [f64; 2], Edge)| {
            (from[1] > y) != (to[1] > y) && x < from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0])
        };
        self.edges().filter(crossed).count() % 2 == 1
    }

    fn slips(&self, nodes: &[[f64; 2]]) -> Vec<Slip> {
        let near = |(a, b): ([f64; 2], [f64; 2])| distance(a, b) < self.longest + CLOSE;
        let pairs = (0..nodes.len()).flat_map(|i| (i + 1..nodes.len()).map(move |j| (i, j)));
        let pairs = pairs.filter(|&(i, j)| near((nodes[i], nodes[j])));
        let others = |i, j| {
            nodes
                .iter()
                .enumerate()
                .filter(move |&(k, _)| k != i && k != j)
                .map(|(_, node)| *node)
        };
        let shortest = pairs.filter(|&(i, j)| others(i, j).all(|node| off(nodes[i], nodes[j], node) > CLOSE));
        shortest
            .filter_map(|(i, j)| self.slip([i, j], [nodes[i], nodes[j]]))
            .collect()
    }

    /// Along an edge with the ground on its left, or within the ground.
    fn slip(&self, nodes: [usize; 2], [a, b]: [[f64; 2]; 2]) -> Option<Slip> {
        let lies_on = |from: [f64; 2], to: [f64; 2]| [a, b].iter().all(|&node| off(from, to, node) < CLOSE);
        let cost = self.cost(a, b);
        let weight = self.unit_weight * self.above(a, b);
        let inner = Slip {
            nodes,
            along: minus(b, a),
            edge: None,
            cost,
            weight,
        };
        let Some((from, to, edge)) = self.edges().find(|&(from, to, _)| lies_on(from, to)) else {
            return (self.holds(between(a, b, 0.5)) && self.clears(a, b)).then_some(inner);
        };
        let outer = Slip {
            edge: Some(edge),
            cost: if edge == Edge::Held { cost } else { 0.0 },
            ..inner
        };
        let turned = dot(minus(b, a), minus(to, from)) < 0.0;
        let back = |slip: Slip| Slip {
            nodes: [nodes[1], nodes[0]],
            along: minus(a, b),
            ..slip
        };
        Some(if turned { back(outer) } else { outer })
    }

    /// J/m  of a slip of 1 m; between two layers it goes through the weaker one.
    fn cost(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        let [low, high] = [a[1].min(b[1]), a[1].max(b[1])];
        let tops = std::iter::once(f64::INFINITY).chain(self.layers.iter().map(|layer| layer.0));
        let within = tops
            .zip(&self.layers)
            .filter(|&(top, layer)| low < top + CLOSE && high > layer.0 - CLOSE);
        let shares = within.map(|(top, layer)| ((high.min(top) - low.max(layer.0)) / (high - low), layer.1));
        let strength = match high - low < CLOSE {
            true => shares.map(|(_, cohesion)| cohesion).fold(f64::INFINITY, f64::min),
            false => shares.map(|(share, cohesion)| share.max(0.0) * cohesion).sum(),
        };
        strength * distance(a, b)
    }

    /// m2  between a line and the surface above it
    fn above(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        let [left, right] = if a[0] < b[0] { [a, b] } else { [b, a] };
        let mut places: Vec<f64> = self.corners.iter().map(|corner| corner.0[0]).collect();
        places.retain(|&x| left[0] < x && x < right[0]);
        places.extend([left[0], right[0]]);
        places.sort_by(f64::total_cmp);
        let height =
            |x: f64, from: [f64; 2], to: [f64; 2]| from[1] + (x - from[0]) / (to[0] - from[0]) * (to[1] - from[1]);
        let over = |x: f64| {
            let spans = self.edges().filter(|(from, to, _)| (from[0] < x) != (to[0] < x));
            spans.map(|(from, to, _)| height(x, from, to)).fold(f64::MIN, f64::max) - height(x, left, right)
        };
        places
            .windows(2)
            .filter(|ends| ends[1] > ends[0])
            .map(|ends| over((ends[0] + ends[1]) / 2.0) * (ends[1] - ends[0]))
            .sum()
    }

    /// Whether a line between two nodes leaves the ground nowhere.
    fn clears(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        self.edges().all(|(from, to, _)| {
            let side = |from: [f64; 2], to: [f64; 2], at: [f64; 2]| cross(minus(to, from), minus(at, from));
            let edge = side(from, to, a) * side(from, to, b);
            let line = side(a, b, from) * side(a, b, to);
            edge > -CLOSE || line > -CLOSE
        })
    }
}

/// Jumps across slips: what they add up to around every node, and the work of the weight.
struct Jumps {
    program: Program,
    around: Vec<[Sum; 2]>,
    work: Sum,
}

impl Jumps {
    /// A jump of 1 m of the left of a slip over its right.
    fn add(&mut self, slip: &Slip, jump: [f64; 2], cost: f64) -> Sum {
        let column = self.program.variable(cost);
        let [from, to] = slip.nodes;
        for (axis, part) in jump.into_iter().enumerate() {
            self.around[from][axis] += &column * part;
            self.around[to][axis] += &column * -part;
        }
        self.work += &column * (-slip.weight * jump[1] * slip.along[0].signum());
        column
    }
}

/// The least work of jumps that add up to none around every node, or, `loaded`, that over the work of the weight. That
/// of an edge is the ground's motion.
fn mechanism(nodes: usize, slips: &[Slip], loaded: bool) -> f64 {
    let none = || [Sum::default(), Sum::default()];
    let mut jumps = Jumps {
        program: Program::default(),
        around: vec![none(); nodes],
        work: Sum::default(),
    };
    for slip in slips {
        let length = slip.along[0].hypot(slip.along[1]);
        let along = slip.along.map(|x| x / length);
        let back = along.map(|x| -x);
        let across = [-along[1], along[0]];
        let forwards = jumps.add(slip, along, slip.cost);
        if slip.cost > 0.0 {
            let backwards = jumps.add(slip, back, slip.cost);
            [forwards, backwards]
                .into_iter()
                .for_each(|size| jumps.program.positive(size));
        }
        if let Some(Edge::Free | Edge::Pushed(_)) = slip.edge {
            let off = jumps.add(slip, across, 0.0);
            if let Some(Edge::Pushed(by)) = slip.edge {
                jumps.program.positive(&off - &Sum::constant(dot(by, across)));
            }
        }
    }
    let Jumps {
        mut program,
        around,
        work,
    } = jumps;
    around.into_iter().flatten().for_each(|sum| program.zero(sum));
    if loaded {
        program.zero(&work - &Sum::constant(1.0));
    }
    program.minimum().0
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn between(a: [f64; 2], b: [f64; 2], share: f64) -> [f64; 2] {
    [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share]
}

/// m  from a line between two points
fn off(a: [f64; 2], b: [f64; 2], point: [f64; 2]) -> f64 {
    let along = minus(b, a);
    let share = (dot(minus(point, a), along) / dot(along, along)).clamp(0.0, 1.0);
    distance(between(a, b, share), point)
}
