//! Round-off of the out-of-balance force at each node. Smaller out-of-balance forces count as zero.

use crate::field::Field;
use crate::kinematics::Kinematics;
use crate::nodal::Nodal;
use crate::parallel::over_layers;
use crate::step::problem::Problem;
use crate::step::residual::Balance;

/// Round-off of the internal force, relative to E h^(D-1) x 1 m^(3-D).
const INTERNAL: f64 = 1e-13;
/// Round-off of the inertia, relative to |4/dt M v| (with numerical damping: the factor of M v): a few rounding errors.
const CANCELLED: f64 = 4.0 * f64::EPSILON;

/// Round-off of the forces in one step. Each node has its own, so that the stiffest material does not hide
/// out-of-balance forces in the softest.
#[derive(Clone, Debug)]
pub struct RoundOff {
    force: Vec<f64>, // per component (N): 1e-13 E h^(D-1), E the largest at the node, plus inertia
    norm: f64,       // of all nodes (N)
    apart: Vec<f64>, // of the nodes of each single material (N); empty with one material
    field: f64,      // of the balance of the second field
}

impl RoundOff {
    /// Computes the round-off of a step. One reduction, and one exchange with the neighbours if moduli differ.
    pub fn of<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>) -> Self {
        let nodes = problem.nodes;
        let area = problem.model.grid.smallest_edge().powi(D as i32 - 1);
        let young = largest_moduli(problem);
        let mut force: Vec<f64> = young.iter().flat_map(|young| [INTERNAL * young * area; D]).collect();
        if let Some(inertia) = &nodes.inertia {
            for (c, force) in force.iter_mut().enumerate() {
                *force += CANCELLED
                    * inertia.newmark.pulse(inertia.dt)
                    * nodes.weight[Nodal::<D>::node(c)]
                    * inertia.v[c].abs();
            }
        }
        force
            .iter_mut()
            .zip(&nodes.constraints.free)
            .filter(|(_, free)| !**free)
            .for_each(|(force, _)| *force = 0.0);
        let mut sums = vec![over_layers(problem.halo, D, |c| force[c].powi(2))];
        sums.extend(
            nodes
                .constraints
                .apart
                .iter()
                .flat_map(|apart| apart.sums(problem.halo, D, |c| [force[c].powi(2)])),
        );
        let sums = problem.halo.reproducible_sum(&sums);
        let norm = sums[0].sqrt();
        let apart = sums[1..].iter().map(|sum| sum.sqrt()).collect();
        let field = nodes.field.as_ref().map_or(0.0, Field::<K, D>::round_off);
        Self {
            force,
            norm,
            apart,
            field,
        }
    }

    /// Returns the norm of the round-off of all nodes' forces (N).
    pub fn norm(&self) -> f64 {
        self.norm
    }

    /// Returns the norm of the round-off of the balance of the second field.
    pub fn of_field(&self) -> f64 {
        self.field
    }

    /// Returns the force measure (-): the largest of |f_oob| / largest force over all nodes and over each single
    /// material's nodes, where it exceeds round-off. Also returns the number of the material, if it is the largest.
    pub fn measure(&self, balance: &Balance) -> (f64, Option<usize>) {
        let parts = balance.apart.iter().zip(&self.apart).enumerate();
        let apart = parts
            .filter(|(_, ([norm, _], round_off))| norm > round_off)
            .map(|(material, ([norm, scale], _))| (norm / scale, Some(material)));
        apart.fold(
            (balance.measure(), None),
            |most, part| if part.0 > most.0 { part } else { most },
        )
    }

    /// Returns whether at every node the out-of-balance force is round-off. All ranks must call this together. One
    /// reduction, only if the norm does not already exceed its round-off.
    pub fn covers<K, const D: usize>(&self, balance: &Balance, problem: &Problem<'_, K, D>) -> bool {
        if balance.norm > self.norm {
            return false;
        }
        let mut own = problem.halo.owned().places::<D>();
        let mut beyond = [f64::from(u8::from(own.any(|c| balance.f_oob[c].abs() > self.force[c])))];
        problem.halo.all_reduce_max(&mut beyond);
        beyond[0] == 0.0
    }
}

/// Returns the largest Young's modulus of the points in the cells of each node (Pa).
fn largest_moduli<K: Kinematics<D>, const D: usize>(problem: &Problem<'_, K, D>) -> Vec<f64> {
    let model = problem.model;
    let shape = problem.shape;
    let points = problem.points;
    let number = problem.nodes.weight.len();
    if model.is_uniformly_stiff() {
        return vec![model.stiffest(); number];
    }
    let mut moduli = vec![0.0_f64; number];
    for patch in shape.patches() {
        let young = patch.points.clone().map(|p| model.young(points, p)).fold(0.0, f64::max);
        for offset in shape.offsets() {
            let node = &mut moduli[patch.first_node + offset];
            *node = node.max(young);
        }
    }
    problem.halo.ghost_max(&mut moduli, 1);
    moduli
}
