//! Strict bounds of the limit load of a footing on Tresca clay, by finite-element limit analysis (Sloan, 1988 and 1989;
//! Makrodimopoulos and Martin, 2006 and 2007).
//!
//! In axisymmetry the products of stress and radius r are linear in each triangle. Velocities follow from a quadratic
//! stream function psi: u = psi_z/r along r, w = -psi_r/r along the axis z (subscripts: derivatives).

use super::conic::{Program, Sum};
use std::collections::BTreeMap;

/// What an edge of the ground meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Face {
    /// nothing
    Free,
    /// a smooth wall, or the axis
    Sliding,
    /// ground that stays
    Held,
    /// the body, which goes down; it pulls nowhere, and shears the clay up to its strength or not at all
    Body { rough: bool },
}

/// Triangles of clay.
pub struct Mesh {
    /// about z as the axis, or plane
    pub round: bool,
    /// m  r and z
    pub nodes: Vec<[f64; 2]>,
    /// nodes counter-clockwise, and strength, Pa
    pub triangles: Vec<([usize; 3], f64)>,
    /// what edges of one triangle meet, by their nodes, the lower number first
    pub faces: BTreeMap<[usize; 2], Face>,
}

/// By their nodes: the one or two triangles at every edge.
type Edges = BTreeMap<[usize; 2], Vec<usize>>;

impl Mesh {
    /// Pa  No more than the mean pressure on a body that is 2 m wide.
    pub fn lower_bound(&self) -> f64 {
        let mut program = Program::default();
        let stress: Vec<_> = (0..self.triangles.len())
            .map(|triangle| self.stress(&mut program, triangle))
            .collect();
        for (nodes, triangles) in self.edges() {
            let (length, normal) = self.normal(nodes, triangles[0]);
            for node in nodes {
                let traction = |triangle: usize| {
                    let [r, z, shear] = &stress[triangle][self.corner(triangle, node)];
                    [
                        &(r * normal[0]) + &(shear * normal[1]),
                        &(shear * normal[0]) + &(z * normal[1]),
                    ]
                };
                let [r, z] = traction(triangles[0]);
                let along = &(&z * normal[0]) - &(&r * normal[1]);
                match self.faces.get(&nodes) {
                    None => traction(triangles[1])
                        .iter()
                        .zip([r, z])
                        .for_each(|(a, b)| program.zero(&b - a)),
                    Some(Face::Free) => [r, z].into_iter().for_each(|part| program.zero(part)),
                    Some(Face::Sliding) => program.zero(along),
                    Some(Face::Held) => (),
                    Some(Face::Body { rough }) => {
                        program.cost(&(&z * (length / 2.0)));
                        program.positive(&(&r * -normal[0]) - &(&z * normal[1]));
                        if !rough {
                            program.zero(along);
                        }
                    }
                }
            }
        }
        -program.minimum().0 / self.falling(1.0)
    }

    /// Pa  No less than that.
    pub fn upper_bound(&self) -> f64 {
        let mut program = Program::default();
        let edges = self.edges();
        let flow = Flow {
            mesh: self,
            stream: self.stream(&mut program, &edges),
        };
        let mut work: Vec<Work> = (0..self.triangles.len())
            .flat_map(|triangle| flow.shear(triangle))
            .collect();
        work.extend(edges.iter().flat_map(|(&nodes, triangles)| flow.slip(nodes, triangles)));
        for part in &work {
            part.state(&mut program);
        }
        let variables = program.minimum().1;
        work.iter().map(|part| part.value(&variables)).sum::<f64>() / self.falling(1.0)
    }

    /// r of a node, or 1
    fn weight(&self, node: usize) -> f64 {
        if self.round { self.nodes[node][0] } else { 1.0 }
    }

    /// Stream function of a body that goes down by 1 m/s; at its edge it is the volume, over 2 pi in the round.
    fn falling(&self, r: f64) -> f64 {
        if self.round { r * r / 2.0 } else { r }
    }

    fn edges(&self) -> Edges {
        let mut edges = Edges::new();
        for (triangle, (corners, _)) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                edges
                    .entry(pair(corners[k], corners[(k + 1) % 3]))
                    .or_default()
                    .push(triangle);
            }
        }
        edges
    }

    fn corner(&self, triangle: usize, node: usize) -> usize {
        self.triangles[triangle]
            .0
            .iter()
            .position(|&other| other == node)
            .expect("a node of the triangle")
    }

    /// Area, and gradients of the area coordinates.
    fn shape(&self, triangle: usize) -> (f64, [[f64; 2]; 3]) {
        let p = self.triangles[triangle].0.map(|node| self.nodes[node]);
        let twice = (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[2][0] - p[0][0]) * (p[1][1] - p[0][1]);
        let gradient = |k: usize| {
            let a = p[(k + 1) % 3];
            let b = p[(k + 2) % 3];
            [(a[1] - b[1]) / twice, (b[0] - a[0]) / twice]
        };
        (twice / 2.0, [0, 1, 2].map(gradient))
    }

    /// Length of an edge, and its normal out of a triangle.
    fn normal(&self, nodes: [usize; 2], triangle: usize) -> (f64, [f64; 2]) {
        let forwards = self.triangles[triangle].0[(self.corner(triangle, nodes[0]) + 1) % 3] == nodes[1];
        let [a, b] = if forwards { nodes } else { [nodes[1], nodes[0]] }.map(|node| self.nodes[node]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        (length, [(b[1] - a[1]) / length, (a[0] - b[0]) / length])
    }

    /// S_r, S_z and T at the corners of a triangle, in equilibrium and nowhere beyond its strength.
    fn stress(&self, program: &mut Program, triangle: usize) -> [[Sum; 3]; 3] {
        let (corners, strength) = self.triangles[triangle];
        let by = self.shape(triangle).1;
        let weights = corners.map(|node| self.weight(node));
        let stress = weights.map(|weight| {
            [(); 3].map(|()| {
                if weight > 0.0 {
                    &program.variable(0.0) * weight
                } else {
                    Sum::default()
                }
            })
        });
        let divergence = |of: usize, and: usize| -> Sum {
            (0..3)
                .map(|k| &(&stress[k][of] * by[k][0]) + &(&stress[k][and] * by[k][1]))
                .sum()
        };
        let hoop = divergence(0, 2);
        program.zero(divergence(2, 1));
        if !self.round {
            program.zero(hoop.clone());
        }
        for ([r, z, shear], weight) in stress.iter().zip(weights).filter(|at| at.1 > 0.0) {
            let half = &(r - z) * 0.5;
            let most = Sum::constant(strength * weight);
            if !self.round {
                program.cone(vec![most, half, shear.clone()]);
                continue;
            }
            let radius = program.variable(0.0);
            let left = &most - &radius;
            let off = &(&hoop * weight) - &(&(r + z) * 0.5);
            program.cone(vec![radius, half, shear.clone()]);
            [&off, &(&off * -1.0)]
                .into_iter()
                .for_each(|off| program.positive(&(&left + &most) + off));
            program.positive(left);
        }
        stress
    }

    /// The stream function at every node and in the middle of every edge; away from the axis it begins with r^2.
    fn stream(&self, program: &mut Program, edges: &Edges) -> BTreeMap<[usize; 2], Sum> {
        let mut stream = BTreeMap::new();
        for (&[a, b], face) in self.faces.iter().filter(|of| *of.1 != Face::Free) {
            for (p, q) in [(a, a), (b, b), (a, b)] {
                let r = (self.nodes[p][0] + self.nodes[q][0]) / 2.0;
                let moves = matches!(face, Face::Body { .. });
                stream.insert(
                    [p, q],
                    if moves {
                        Sum::constant(self.falling(r))
                    } else {
                        Sum::default()
                    },
                );
            }
        }
        for node in 0..self.nodes.len() {
            stream.entry([node; 2]).or_insert_with(|| program.variable(0.0));
        }
        for &[a, b] in edges
            .keys()
            .filter(|nodes| !self.faces.get(*nodes).is_some_and(|face| *face != Face::Free))
        {
            let outer = if self.weight(a) == 0.0 { b } else { a };
            let from_axis = self.weight(a) * self.weight(b) == 0.0;
            let middle = if from_axis {
                &stream[&[outer; 2]] * 0.25
            } else {
                program.variable(0.0)
            };
            stream.insert([a, b], middle);
        }
        stream
    }
}

/// Velocities by their stream function.
struct Flow<'a> {
    mesh: &'a Mesh,
    stream: BTreeMap<[usize; 2], Sum>,
}

/// Factor, Pa m, of the strain rates at a place: half the difference of those along r and z, shear, and hoop strain.
struct Work {
    factor: f64,
    rates: [Sum; 3],
}

impl Flow<'_> {
    /// Gradient of the stream function at a corner of a triangle.
    fn gradient(&self, triangle: usize, node: usize) -> [Sum; 2] {
        let corners = self.mesh.triangles[triangle].0;
        let by = self.mesh.shape(triangle).1;
        [0, 1].map(|axis| {
            let part = |(corner, by): (usize, [f64; 2])| {
                let factor = if corner == node { 3.0 } else { -1.0 };
                let end = &self.stream[&[corner; 2]] * (factor * by[axis]);
                if corner == node {
                    end
                } else {
                    &end + &(&self.stream[&pair(corner, node)] * (4.0 * by[axis]))
                }
            };
            corners.into_iter().zip(by).map(part).sum()
        })
    }

    /// Of what is sheared in a triangle; at the axis r^2 times the rates are none.
    fn shear(&self, triangle: usize) -> Vec<Work> {
        let (corners, strength) = self.mesh.triangles[triangle];
        let (area, by) = self.mesh.shape(triangle);
        let gradients = corners.map(|node| self.gradient(triangle, node));
        let second = |of: usize, along: usize| -> Sum { (0..3).map(|k| &gradients[k][of] * by[k][along]).sum() };
        let mixed = second(0, 1);
        let bent = &second(1, 1) - &second(0, 0);
        let weights = corners.map(|node| self.mesh.weight(node));
        let (count, turned) = weights
            .iter()
            .filter(|&&r| r > 0.0)
            .fold((0.0, 0.0), |(n, sum), r| (n + 1.0, sum + 1.0 / r));
        let at = |([along_r, along_z], r): (&[Sum; 2], f64)| {
            if !self.mesh.round {
                return Work {
                    factor: 2.0 * strength * area / 3.0,
                    rates: [mixed.clone(), &bent * 0.5, Sum::default()],
                };
            }
            // 1/r is convex: no more than what lies linearly between the corners
            let share = area / (count * (count + 1.0)) * (turned + 1.0 / r);
            let rates = [
                &(&mixed * r) - &(along_z * 0.5),
                &(&(&bent * r) + along_r) * 0.5,
                along_z.clone(),
            ];
            Work {
                factor: 2.0 * strength * share,
                rates,
            }
        };
        gradients.iter().zip(weights).filter(|at| at.1 > 0.0).map(at).collect()
    }

    /// Of what slips along an edge.
    fn slip(&self, nodes: [usize; 2], triangles: &[usize]) -> Vec<Work> {
        let mesh = self.mesh;
        let (length, normal) = mesh.normal(nodes, triangles[0]);
        let strength = triangles
            .iter()
            .map(|&triangle| mesh.triangles[triangle].1)
            .fold(f64::INFINITY, f64::min);
        let at = |node: usize| {
            let slope = |triangle: usize| {
                let [r, z] = self.gradient(triangle, node);
                &(&r * normal[0]) + &(&z * normal[1])
            };
            let other = match mesh.faces.get(&nodes) {
                None => slope(triangles[1]),
                Some(Face::Held) => Sum::default(),
                Some(Face::Body { rough: true }) => Sum::constant(normal[0] * mesh.weight(node)),
                Some(_) => return None,
            };
            let rates = [Sum::default(), &slope(triangles[0]) - &other, Sum::default()];
            Some(Work {
                factor: strength * length / 2.0,
                rates,
            })
        };
        nodes
            .into_iter()
            .filter(|&node| mesh.weight(node) > 0.0)
            .filter_map(at)
            .collect()
    }
}

impl Work {
    /// As a cost: the largest principal strain rate, radius of Mohr's circle in the section and half the hoop strain or
    /// all of the hoop strain, times the factor.
    fn state(&self, program: &mut Program) {
        let [half, shear, hoop] = &self.rates;
        let radius = program.variable(self.factor);
        program.cone(vec![radius.clone(), half.clone(), shear.clone()]);
        if !hoop.is_zero() {
            let size = program.variable(self.factor / 2.0);
            for sign in [1.0, -1.0] {
                program.positive(&radius + &(hoop * (0.5 * sign)));
                program.positive(&size + &(hoop * sign));
            }
        }
    }

    fn value(&self, variables: &[f64]) -> f64 {
        let [half, shear, hoop] = [0, 1, 2].map(|k| self.rates[k].value(variables));
        self.factor * (half.hypot(shear).max(hoop.abs() / 2.0) + hoop.abs() / 2.0)
    }
}

fn pair(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}
