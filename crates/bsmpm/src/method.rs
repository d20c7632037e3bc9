//! Options of the nonlinear solution: methods and convergence criteria (chapter 5 of the theory manual).

/// How equilibrium is sought.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Nonlinear {
    /// All recent secants, and Newton's method where they stall.
    #[default]
    Auto,
    /// One quasi-Newton method, to the limit of iterations.
    QuasiNewton(QuasiNewton),
    /// Newton's method from the start.
    Newton,
}

/// What gave the direction of one iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Secants on the stiffness at `u`, where they start.
    QuasiNewton(QuasiNewton),
    /// The complete derivative.
    Newton,
}

/// How the stiffness K_0 is corrected from iteration to iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum QuasiNewton {
    /// All recent secants in the least-squares sense (Anderson, 1965).
    #[default]
    Multisecant,
    /// The paper's rank-one update (Broyden, 1965).
    Broyden,
}

/// When a step is in equilibrium: both measures must hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criteria {
    /// |du_k . f_k| / |du_0 . f_0| (step 9)
    pub energy: f64,
    /// |f_oob| / max(|f_ext|, |f_int|, |M a|, |reaction|): the energy product alone is no norm. Of all nodes, and of
    /// those that one material alone touches
    pub force: f64,
    /// quasi-Newton iterations of one attempt
    pub max_iterations: usize,
}

impl Criteria {
    /// Both measures beside their tolerances, in words; the force measure with the number of the material that it is
    /// of.
    pub fn judged(&self, energy: f64, force: f64, material: Option<usize>) -> String {
        let of = material.map_or_else(String::new, |material| format!(" of material {material}"));
        format!(
            "energy residual {}, force residual{of} {}",
            against(energy, self.energy),
            against(force, self.force)
        )
    }

    /// What the measure of the water must be below, where it flows: |R| over the largest of what is stored, flows and
    /// leaves.
    pub fn water(&self) -> f64 {
        WATER.min(self.force)
    }

    /// That measure beside its tolerance, in words that follow those of [`Criteria::judged`].
    pub fn judged_water(&self, water: f64) -> String {
        format!(", water residual {}", against(water, self.water()))
    }
}

/// Largest part of the water that is stored, flows or leaves that may be out of balance: the forces' tolerance where
/// that is smaller.
const WATER: f64 = 1e-4;

fn against(measure: f64, tolerance: f64) -> String {
    format!("{measure:.1e} (tolerance {tolerance:e})")
}
