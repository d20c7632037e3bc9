//! Round-off of the out-of-balance force at each node. Smaller out-of-balance forces count as zero.

use crate::kinematics::Kinematics;
use crate::nodal::Nodal;
use crate::parallel::over_layers;
use crate::step::problem::Problem;
use crate::step::residual::Balance;

/// Round-off of the internal force, relative to E h^(D-1) x 1 m^(3-D).
const INTERNAL: f64 = 1e-13;
/// Round-off of the inertia, relative to |4/dt M v| (with numerical damping: its factor): a few roundings.
const CANCELLED: f64 = 4.0 * f64::EPSILON;

/// Round-off of the forces in one step. Each node has its own: the stiffest material of a scene must not excuse what is
/// out of balance in the softest.
#[derive(Clone, Debug)]
pub struct RoundOff {
    force: Vec<f64>, // N  1e-13 E h^(D-1), E the largest at the node, and of 4/dt^2 u, 4/dt v, which cancel if dt is tiny
    norm: f64,       // N  of all nodes
    apart: Vec<f64>, // N  of each material's own nodes; empty in a scene of one material
    water: f64,      // m3  in the balance of the water
}

impl RoundOff {
    /// Of the forces of a step, D numbers a node; one reduction, and one exchange where moduli differ.
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
            .zip(&nodes.free)
            .filter(|(_, free)| !**free)
            .for_each(|(force, _)| *force = 0.0);
        let mut sums = vec![over_layers(problem.halo, D, |c| force[c].powi(2))];
        sums.extend(
            nodes
                .apart
                .iter()
                .flat_map(|apart| apart.sums(problem.halo, D, |c| [force[c].powi(2)])),
        );
        let sums = problem.halo.reproducible_sum(&sums);
        let norm = sums[0].sqrt();
        let apart = sums[1..].iter().map(|sum| sum.sqrt()).collect();
        let water = nodes.pores.as_ref().map_or(0.0, |pores| pores.round_off);
        Self {
            force,
            norm,
            apart,
            water,
        }
    }

    /// Norm of the round-off of all nodes' forces, N.
    pub fn norm(&self) -> f64 {
        self.norm
    }

    /// Norm of the round-off of the water's balance, m3.
    pub fn of_water(&self) -> f64 {
        self.water
    }

    /// The force measure: the larger of |f_oob| / largest force of all nodes and that of any material's own nodes,
    /// where it is not round-off; with the number of the material that it is of.
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

    /// Whether no node is further out of balance than by round-off. All ranks must ask; they share an exchange only
    /// where the norm leaves a doubt.
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

/// Largest Young's modulus of the points in the cells of each node, Pa.
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
