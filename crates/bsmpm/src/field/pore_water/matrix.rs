//! Pressure matrix S of the fixed-stress split, theory-manual equation (T8.17).

use crate::error::SolveError;
use crate::field::pore_water::Water;
use crate::field::pore_water::flow::Flow;
use crate::field::pore_water::nodes::{PorePressureField, SHORTEST_WAVE};
use crate::field::pore_water::split::system;
use crate::grid::transfer::scalars::{self, FunctionAtPoint, MOST_FUNCTIONS};
use crate::kinematics::Kinematics;
use crate::linear::{LinearSolver, MatrixAssembly, Symmetry};
use crate::step::problem::Problem;
use crate::tensor::Vector;

/// Assembles S as [`assemble`] does, and factorises it. Fails if `solver` has no system of the pressures, too.
pub fn factorise<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PorePressureField<D>,
    p: &[f64],
    solver: &mut dyn LinearSolver,
) -> Result<(), SolveError> {
    let solver = system(solver)?;
    assemble(problem, pores, p, solver.matrix());
    solver.factorise(Symmetry::Definite)
}

/// Assembles S. It uses the geometry at the start of the step; saturation and open seepage faces are those of the nodal
/// excess pressures `p` (Pa).
pub fn assemble<K: Kinematics<D>, const D: usize>(
    problem: &Problem<'_, K, D>,
    pores: &PorePressureField<D>,
    p: &[f64],
    matrix: &mut dyn MatrixAssembly,
) {
    let model = problem.model;
    let Some((water, flow)) = model
        .water
        .as_ref()
        .and_then(|water| Some((water, water.flow.as_ref()?)))
    else {
        return;
    };
    matrix.reinit(&pores.free);
    let pressures = if flow.retains() {
        scalars::scalars(&pores.shape, p, |_, value, _| value)
    } else {
        Vec::new()
    };
    let wave = model.grid.smallest_edge().powi(2) / SHORTEST_WAVE;
    let size = pores.shape.offsets().len();
    let mut block = vec![0.0; size * size];
    let mut functions = [FunctionAtPoint::zero(); MOST_FUNCTIONS];
    for patch in pores.shape.patches() {
        block.fill(0.0);
        for p in patch.points.clone() {
            let Some(factors) = MatrixFactors::of(problem, pores, water, flow, &pressures, wave, p) else {
                continue;
            };
            scalars::functions_of(&pores.shape, p, &mut functions);
            for (row, function) in block.chunks_exact_mut(size).zip(&functions) {
                let A = function.value * factors.stored;
                let gradient = function.gradient.component_mul(&factors.along);
                row.iter_mut()
                    .zip(&functions)
                    .for_each(|(entry, other)| *entry += A * other.value + gradient.dot(&other.gradient));
            }
        }
        matrix.add_block(patch.first_node, &block);
    }
    pores.drainage.assemble(p, matrix);
    pores.ties.assemble(problem.halo, matrix);
}

/// Contributions of a point to S.
struct MatrixFactors<const D: usize> {
    stored: f64,      // factor of the product of two functions (m3/Pa)
    along: Vector<D>, // factors of the product of their gradients along the axes (m5/Pa)
}

impl<const D: usize> MatrixFactors<D> {
    /// Returns the contributions of point `p`; `None` without pore-water flow. `pressures` are the excess pressures of
    /// the points if soils retain water (Pa), and `wave` is 1/k^2 of the shortest wave (m2).
    fn of<K: Kinematics<D>>(
        problem: &Problem<'_, K, D>,
        pores: &PorePressureField<D>,
        water: &Water<D>,
        flow: &Flow<D>,
        pressures: &[f64],
        wave: f64,
        p: usize,
    ) -> Option<Self> {
        let material = problem.points.material[p];
        let wet = pores.wet[p].as_ref()?;
        // Volume change of the ground under a pressure of wave number k: k^2/(M k^2 + rho a), linearised in k^2 at the
        // shortest wave. The result is a static part and a part proportional to k^2.
        let [at_rest, in_waves] = [wet.stiffness - wet.inertia, wave * wet.inertia]
            .map(|part| wet.volume * wet.J.powi(2) * part / wet.stiffness.powi(2));
        let mut gives_way = 1.0;
        let mut conductivity = flow.permeability(material, wet.mean_J).unwrap_or_else(Vector::zeros);
        let mut stored = wet.volume * wet.content / flow.bulk;
        let mut tau = wet.tau;
        let soil = flow.soils[usize::from(material)].as_ref();
        if let Some(soil) = soil.filter(|soil| soil.retention.is_some()) {
            let whole = pressures[p] + wet.ambient;
            let weight = water.unit_weight;
            let retained = soil.retained(whole, weight);
            let pores = soil.pores(wet.mean_J);
            let chord = soil.chord(wet.pressure, whole, weight);
            gives_way = retained.effective * retained.saturation;
            let empties = pores * chord.max(retained.slope);
            stored = wet.volume * (wet.content / flow.bulk + empties);
            conductivity *= retained.permeability;
            tau *= wet.lumped(soil, chord);
        }
        stored += gives_way * at_rest;
        let flows = conductivity * (pores.duration * wet.volume * wet.J / water.unit_weight);
        Some(Self {
            stored,
            along: (tau + flows).add_scalar(gives_way * in_waves),
        })
    }
}
