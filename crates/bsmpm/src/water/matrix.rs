//! Pressure matrix S of the fixed-stress split, theory-manual equation (T8.17).

use crate::error::SolveError;
use crate::grid::transfer::scalars::{self, MOST_FUNCTIONS};
use crate::kinematics::Kinematics;
use crate::parallel::{LinearSolver, Symmetry};
use crate::step::problem::Problem;
use crate::tensor::Vector;
use crate::water::nodes::{Pores, SHORTEST_WAVE};

/// Assembles S at the state of the step's start into `solver` and factorises it; pores empty and seepage faces are open
/// as under the nodal excess pressures `p`, Pa.
pub fn assemble<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &Pores<D>,
    p: &[f64],
    solver: &mut dyn LinearSolver,
) -> Result<(), SolveError> {
    let Problem { model, points, .. } = *problem;
    let Some((water, flow)) = model
        .water
        .as_ref()
        .and_then(|water| Some((water, water.flow.as_ref()?)))
    else {
        return Ok(());
    };
    solver.begin(&pores.free);
    let pressures = if flow.retains() {
        scalars::scalars(&pores.shape, p, |_, value, _| value)
    } else {
        Vec::new()
    };
    let wave = model.grid.smallest_edge().powi(2) / SHORTEST_WAVE;
    let size = pores.shape.offsets().len();
    let mut block = vec![0.0; size * size];
    let mut functions = [(0.0, Vector::zeros()); MOST_FUNCTIONS];
    for patch in pores.shape.patches() {
        block.fill(0.0);
        for p in patch.points.clone() {
            let Some(wet) = &pores.wet[p] else { continue };
            scalars::functions_of(&pores.shape, p, &mut functions);
            // What gives way to a pressure of the wave number k, k^2/(M k^2 + rho a), by its tangent at the shortest
            // wave: a part as at rest, and one that grows with k^2.
            let [at_rest, in_waves] = [wet.stiffness - wet.inertia, wave * wet.inertia]
                .map(|part| wet.volume * wet.J.powi(2) * part / wet.stiffness.powi(2));
            let mut gives_way = 1.0;
            let mut conductivity = flow
                .permeability(points.material[p], wet.mean_J)
                .unwrap_or_else(Vector::zeros);
            let mut stored = wet.volume * wet.content / flow.bulk;
            let mut tau = wet.tau;
            let soil = flow.soils[usize::from(points.material[p])].as_ref();
            if let Some(soil) = soil.filter(|soil| soil.retention.is_some()) {
                let (whole, weight) = (pressures[p] + wet.ambient, water.unit_weight);
                let (retained, pores) = (soil.retained(whole, weight), soil.pores(wet.mean_J));
                let chord = soil.chord(wet.pressure, whole, weight);
                gives_way = retained.effective * retained.saturation;
                let empties = pores * chord.max(retained.slope);
                stored = wet.volume * (wet.content / flow.bulk + empties);
                conductivity *= retained.permeability;
                tau *= wet.lumped(soil, chord);
            }
            stored += gives_way * at_rest;
            let flows = conductivity * (pores.duration * wet.volume * wet.J / water.unit_weight);
            let along = (tau + flows).add_scalar(gives_way * in_waves);
            for (row, (A, gradient)) in block.chunks_exact_mut(size).zip(&functions) {
                let (A, gradient) = (A * stored, gradient.component_mul(&along));
                row.iter_mut()
                    .zip(&functions)
                    .for_each(|(entry, (B, other))| *entry += A * B + gradient.dot(other));
            }
        }
        solver.add(patch.first_node, &block);
    }
    pores.drainage.assemble(p, solver);
    pores.ties.assemble(problem.halo, solver);
    solver.finish(Symmetry::Definite)
}
