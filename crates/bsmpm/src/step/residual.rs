//! Step (5): internal force, inertia and the out-of-balance force.

use crate::grid::transfer;
use crate::kinematics::Kinematics;
use crate::step::equilibrium::Scene;
use crate::step::trial::Trial;
use crate::tensor::Square;

/// Forces of the points under a nodal displacement, balanced at the nodes.
#[derive(Clone, Debug)]
pub struct Residual {
    /// deformation that they follow from
    pub trial: Trial,
    /// the nodes
    pub balance: Balance,
    /// the first point of this rank that inverted or is not finite
    pub first_inverted: Option<usize>,
}

/// Step (5b): what is out of balance at the nodes, with the norms that judge it.
#[derive(Clone, Debug)]
pub struct Balance {
    /// N  f_ext + strips - f_int - M a - background (a: `Inertia::acting`), zero at components that are not free
    pub f_oob: Vec<f64>,
    /// N  force of the supports on the body, zero at components that are not prescribed
    pub reaction: Vec<f64>,
    /// N  |f_oob|
    pub norm: f64,
    /// N  max(|f_ext|, |f_int|, |M a|, |reaction, strips|)
    pub scale: f64,
    /// points inverted or not finite, over all ranks
    pub inverted: u64,
    /// no norm overflowed
    finite: bool,
}

impl Residual {
    /// Evaluates the forces under `u`: one exchange with the neighbours, one more each for F-bar and strips, and one
    /// reduction.
    pub fn of<K: Kinematics<D>, const D: usize>(scene: &Scene<'_, K, D>, u: &[f64]) -> Self {
        let Scene { model, shape, nodes, points, halo, .. } = *scene;
        let trial = Trial::of(model, shape, nodes, points, u, halo);
        let (mut inverted, mut first_inverted) = (0_u64, None);
        let mut f_int = vec![0.0; u.len()];
        transfer::divergence(shape, &mut f_int, |p| match trial.respond(model, points, p) {
            Ok(response) => K::flux(&response.tau(), &trial.dF[p]) * points.volume[p],
            Err(_) => {
                inverted += 1;
                first_inverted.get_or_insert(p);
                Square::zeros()
            }
        });
        if let Some(background) = &nodes.background {
            background.multiply::<D>(shape, u, &mut f_int);
        }
        halo.sum(&mut f_int, D);
        Self { trial, balance: Balance::of(scene, u, &f_int, inverted), first_inverted }
    }
}

impl Balance {
    /// Balance of an internal force that is summed over the ranks, with `inverted` points on this one.
    pub fn of<K: Kinematics<D>, const D: usize>(
        scene: &Scene<'_, K, D>,
        u: &[f64],
        f_int: &[f64],
        inverted: u64,
    ) -> Self {
        let mut f_strips = vec![0.0; if scene.model.boundary.strips.is_empty() { 0 } else { u.len() }];
        if !f_strips.is_empty() {
            scene.grips.add_forces(u, &mut f_strips);
            scene.halo.sum(&mut f_strips, D);
        }
        let forces = Forces::of(scene, u, f_int, &f_strips);
        let mut sums =
            [inverted as f64, forces.unbalanced, forces.external, forces.internal, forces.inertial, forces.supporting];
        scene.halo.reduce(&mut sums);
        Self {
            f_oob: forces.f_oob,
            reaction: forces.reaction,
            norm: sums[1].sqrt(),
            scale: sums[2..].iter().copied().fold(0.0, f64::max).sqrt(),
            inverted: sums[0] as u64,
            finite: sums.iter().all(|sum| sum.is_finite()),
        }
    }

    /// |f_oob| / largest force; zero where no force acts at all.
    pub fn measure(&self) -> f64 {
        if self.norm == 0.0 { 0.0 } else { self.norm / self.scale }
    }

    /// No point inverted and no number overflowed, on any rank.
    pub fn is_sound(&self) -> bool {
        self.inverted == 0 && self.finite
    }
}

/// Step (5b) with the squared norms of its terms over this rank's own nodes.
#[derive(Default)]
struct Forces {
    f_oob: Vec<f64>,
    reaction: Vec<f64>,
    unbalanced: f64,
    external: f64,
    internal: f64,
    inertial: f64,
    supporting: f64,
}

impl Forces {
    fn of<K: Kinematics<D>, const D: usize>(
        scene: &Scene<'_, K, D>,
        u: &[f64],
        f_int: &[f64],
        f_strips: &[f64],
    ) -> Self {
        let nodes = scene.nodes;
        let owned = scene.halo.owned();
        let owned = owned.start * D..owned.end * D;
        let mut forces = Self { f_oob: vec![0.0; u.len()], reaction: vec![0.0; u.len()], ..Self::default() };
        for component in 0..u.len() {
            if !nodes.active[component / D] {
                continue;
            }
            let inertial = nodes
                .inertia
                .as_ref()
                .map_or(0.0, |inertia| nodes.weight[component / D] * inertia.acting(component, u[component]));
            let held = f_strips.get(component).copied().unwrap_or(0.0);
            let balance = nodes.f_ext[component] + held - f_int[component] - inertial;
            if nodes.free[component] {
                forces.f_oob[component] = balance;
            } else if nodes.prescribed[component].is_some() {
                forces.reaction[component] = -balance;
            }
            if owned.contains(&component) {
                forces.external += nodes.f_ext[component].powi(2);
                forces.internal += f_int[component].powi(2);
                forces.inertial += inertial.powi(2);
                forces.unbalanced += forces.f_oob[component].powi(2);
                forces.supporting += forces.reaction[component].powi(2) + held.powi(2);
            }
        }
        forces
    }
}
