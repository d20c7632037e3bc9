//! Ground below footings, for [`super::limit_analysis`].

use super::limit_analysis::{Face, Mesh};
use std::collections::BTreeMap;

/// m  the spudcan of `cases/spudcan.toml` up to its widest section, which is at z = 0
pub const SPUDCAN: &[[f64; 2]] = &[[0.0, -0.4], [0.8, -0.25], [0.95, -0.15], [1.0, 0.0]];

/// m  a flat base
pub const FLAT: &[[f64; 2]] = &[[0.0, 0.0], [1.0, 0.0]];

/// A body, 2 m wide, wished in place in ground of 8 m on a bottom that stays, up to a smooth wall 8 m from the axis, in
/// plane strain 16 m. The upper 1 m are as strong as 1 Pa.
#[derive(Clone, Copy)]
pub struct Footing {
    pub round: bool,
    pub rough: bool,
    /// m  outline from the axis to the edge
    pub outline: &'static [[f64; 2]],
    /// m  from the surface to the widest section, with a hole as wide above it
    pub depth: f64,
    /// m  of the body's side above the widest section, beside which the hole does not close
    pub side: f64,
    /// Pa  of the lower ground
    pub below: f64,
}

const GROUND: f64 = 8.0;
const LAYER: f64 = 1.0;

impl Footing {
    /// Cells of four triangles, as large as `finest` at the edge, larger by `growth` of the distance near it and more
    /// of it far away.
    pub fn mesh(&self, finest: f64, growth: f64) -> Mesh {
        let [columns, rows] = self.lines(|x| finest + growth * x.abs() * (1.0 + x.abs() / 2.0));
        let mut mesh = Mesh {
            round: self.round,
            nodes: Vec::new(),
            triangles: Vec::new(),
            faces: BTreeMap::new(),
        };
        let mut placed = BTreeMap::new();
        for [i, j] in (1..columns.len()).flat_map(|i| (1..rows.len()).map(move |j| [i, j])) {
            let left = columns[i - 1];
            let right = columns[i];
            let top = rows[j];
            if right <= 1.0 && top > 0.0 {
                continue;
            }
            let around = [[i - 1, j - 1], [i, j - 1], [i, j], [i - 1, j]].map(|at @ [i, j]| {
                *placed
                    .entry(at)
                    .or_insert_with(|| mesh.add(self.place([columns[i], rows[j]])))
            });
            mesh.add_cell(around, if top > self.layer() { 1.0 } else { self.below });
            let body = |meets: bool| {
                if meets {
                    Face::Body { rough: self.rough }
                } else {
                    Face::Free
                }
            };
            let [above, beside] = [right <= 1.0 && top == 0.0, left == 1.0 && top > 0.0];
            let on = [
                (j == 1, Face::Held),
                (i + 1 == columns.len(), Face::Sliding),
                (above || j + 1 == rows.len(), body(above)),
                (
                    beside || i == 1,
                    if beside { body(top <= self.side) } else { Face::Sliding },
                ),
            ];
            for (k, (_, face)) in on.into_iter().enumerate().filter(|(_, (meets, _))| *meets) {
                let [a, b] = [around[k], around[(k + 1) % 4]];
                mesh.faces.insert([a.min(b), a.max(b)], face);
            }
        }
        mesh
    }

    /// r and z of the lines of cells, by their size at a distance from the edge.
    fn lines(&self, size: impl Fn(f64) -> f64) -> [Vec<f64>; 2] {
        let mut columns: Vec<f64> = self.outline.iter().map(|point| point[0]).collect();
        columns.push(if self.round { GROUND } else { 2.0 * GROUND });
        let mut rows = vec![
            self.depth - GROUND,
            self.flat(),
            self.layer(),
            0.0,
            self.side,
            self.depth,
        ];
        rows.retain(|&z| z <= self.depth);
        rows.sort_by(f64::total_cmp);
        rows.dedup();
        [lines(&columns, |r| size(r - 1.0)), lines(&rows, size)]
    }

    /// m  where the lower ground begins
    fn layer(&self) -> f64 {
        self.depth - LAYER
    }

    /// m  below this, lines of cells do not follow the outline
    fn flat(&self) -> f64 {
        if self.layer() < self.outline[0][1] {
            self.layer()
        } else {
            -1.0
        }
    }

    fn place(&self, [r, z]: [f64; 2]) -> [f64; 2] {
        let span = self.outline.windows(2).find(|ends| r <= ends[1][0]);
        let height = span.map_or(0.0, |e| {
            e[0][1] + (r - e[0][0]) / (e[1][0] - e[0][0]) * (e[1][1] - e[0][1])
        });
        let share = if z > 0.0 { 0.0 } else { (1.0 - z / self.flat()).max(0.0) };
        [r, z + height * share]
    }
}

impl Mesh {
    fn add(&mut self, node: [f64; 2]) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// A quadrilateral by its corners counter-clockwise.
    fn add_cell(&mut self, corners: [usize; 4], strength: f64) {
        let middle = [0, 1].map(|axis| corners.iter().map(|&node| self.nodes[node][axis]).sum::<f64>() / 4.0);
        let middle = self.add(middle);
        self.triangles
            .extend((0..4).map(|k| ([corners[k], corners[(k + 1) % 4], middle], strength)));
    }
}

/// Lines between fixed ones, about as far apart as `size` says for their place.
fn lines(fixed: &[f64], size: impl Fn(f64) -> f64) -> Vec<f64> {
    const STEPS: usize = 1000;
    let mut lines = vec![fixed[0]];
    for ends in fixed.windows(2) {
        let step = (ends[1] - ends[0]) / STEPS as f64;
        let at = |steps: f64| ends[0] + step * steps;
        let passed = |count: &mut f64, k: usize| {
            *count += step / size(at(k as f64 + 0.5));
            Some(*count)
        };
        let counts: Vec<f64> = (0..STEPS).scan(0.0, passed).collect();
        let cells = counts[STEPS - 1].round().max(1.0);
        for line in 1..cells as usize {
            let count = counts[STEPS - 1] * line as f64 / cells;
            lines.push(at(counts.partition_point(|&passed| passed < count) as f64 + 1.0));
        }
        lines.push(ends[1]);
    }
    lines
}
