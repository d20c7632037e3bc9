//! Energy bound of dynamic runs, theory-manual equation (T10.4).

use super::StoredEnergy;
use crate::error::StepError;

/// Fraction of the peak energy by which a correct run may seem to gain energy, because mean forces, transferred
/// accelerations and velocities below the grid's resolution are exact only in the limit. The short collapse reaches
/// 0.0013 (0.025 with steps of 10 ms, which do not resolve its elastic waves; 0.012 with dilation = 5 degrees). A run
/// that creates energy passes 0.05 and continues to several times its total energy.
const SLACK: f64 = 0.05;

/// Energy terms of a step, and the stored energy after it (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turnover {
    /// Work of gravity, loads and prescribed motion, without half the work of friction and dashpots at faces: their
    /// forces are known at the end of the step only, and in the first step of a growing load they are there twice their
    /// mean.
    pub external: f64,
    /// Dissipation by plastic flow, damping and seepage.
    pub plastic: f64,
    /// Part of the dissipation that is due to damping.
    pub damped: f64,
    /// Energy of the points; the elastic part belongs to the stress in equilibrium, before any smoothing.
    pub stored: StoredEnergy,
    /// Energy that counts as round-off: that of a strain of 1e-12 in all points.
    pub round_off: f64,
}

/// Energy bound of a run, sufficient to restart it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyBound {
    /// Initial kinetic and elastic energy (J). If it was zero, the apparent energy gain of the first step is added.
    pub start: f64,
    /// Work of gravity, loads and prescribed motion so far (J).
    pub external: f64,
    /// Dissipation so far (J).
    pub plastic: f64,
    /// Dissipation by damping in the last step (J).
    pub damped: f64,
    /// Peak energy so far (J): the largest of start + external, and of kinetic, elastic and dissipated energy together.
    pub largest: f64,
    /// Largest excess of the energy over start + external so far, divided by the peak energy at that time (-).
    pub growth: f64,
}

impl EnergyBound {
    /// Opens the bound in a state.
    pub fn open(stored: StoredEnergy) -> Self {
        let start = stored.kinetic + stored.elastic;
        Self {
            start,
            largest: start,
            ..Self::default()
        }
    }

    /// Returns all numbers of the bound.
    pub fn numbers(&self) -> [f64; 6] {
        [
            self.start,
            self.external,
            self.plastic,
            self.damped,
            self.largest,
            self.growth,
        ]
    }

    /// Adds a step. The step is ignored while all energies are round-off, for example in soil at rest below a falling
    /// rigid body.
    pub fn enter(&mut self, step: &Turnover) {
        let stored = step.stored.kinetic + step.stored.elastic;
        let present = [self.start, self.external, step.external, step.plastic, stored];
        if present.into_iter().all(|energy| energy.abs() <= step.round_off) {
            return;
        }
        self.external += step.external;
        // Damping d is evaluated at the end of a step, external work by the mean of both ends. They differ where rates
        // grow: by a tenth of the total energy in the second step of a damped column that is released. The mean is
        // (d + sqrt(d d_last))/2, which is correct for equal steps with proportional rates.
        self.plastic += step.plastic - 0.5 * (step.damped - (step.damped * self.damped).max(0.0).sqrt());
        self.damped = step.damped;
        let energy = step.stored.kinetic + step.stored.elastic + self.plastic;
        if self.largest == 0.0 {
            // The mean of a force that grows from zero is not the work that numerical damping uses. For masses without
            // springs, the energy exceeds this work by 4 % after the first step at a spectral radius of 0.9 and by 15 %
            // at 0.5; by 1 % after the second step.
            self.start = self.start.max(energy - self.external);
        }
        let given = self.start + self.external;
        self.largest = self.largest.max(given).max(energy);
        if self.largest > 0.0 {
            self.growth = self.growth.max((energy - given) / self.largest);
        }
    }

    /// Accounts for points that left the grid, after their step was added: energy before and after they were removed.
    pub fn exchange(&mut self, [before, after]: &[StoredEnergy; 2]) {
        self.start += (after.kinetic + after.elastic) - (before.kinetic + before.elastic);
    }

    /// Rejects further steps once the energy has grown beyond the work done.
    ///
    /// # Errors
    /// Energy has grown by more than a correct run allows.
    pub fn require(&self) -> Result<(), StepError> {
        let given = self.start + self.external;
        let grown = StepError::EnergyMade {
            growth: self.growth,
            given,
            slack: SLACK,
        };
        if self.growth > SLACK { Err(grown) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A step that took that in, J, and what there is after it.
    fn turnover(external: f64, kinetic: f64) -> Turnover {
        Turnover {
            external,
            stored: StoredEnergy {
                kinetic,
                ..StoredEnergy::default()
            },
            ..Turnover::default()
        }
    }

    #[test]
    fn round_off_of_ground_at_rest_is_no_growth() {
        let mut budget = EnergyBound::open(StoredEnergy::default());
        let at_rest = Turnover {
            round_off: 1e-17,
            ..turnover(1e-26, 5e-26)
        };
        budget.enter(&at_rest);
        assert_eq!(budget, EnergyBound::default());
        budget.enter(&Turnover {
            stored: StoredEnergy {
                kinetic: 2e-17,
                ..StoredEnergy::default()
            },
            ..at_rest
        });
        budget.enter(&Turnover {
            stored: StoredEnergy {
                kinetic: 4e-17,
                ..StoredEnergy::default()
            },
            ..at_rest
        });
        assert!(budget.require().is_err(), "{budget:?}");
    }

    #[test]
    fn a_first_step_from_nothing_opens_the_books_and_what_is_made_later_is_found() {
        let mut budget = EnergyBound::open(StoredEnergy::default());
        // A mass under a force that grows by 1 N a second, steps of 1 s, spectral radius 0.5.
        for step in [turnover(0.1667, 0.1953), turnover(2.02, 2.2)] {
            budget.enter(&step);
            assert!(budget.require().is_ok(), "{budget:?}");
        }
        budget.enter(&turnover(0.0, 2.4));
        assert!(budget.require().is_err(), "{budget:?}");
        // A mass of 1 on a dashpot of 30 under 1 N, in steps of 0.1 s.
        let mut damped = EnergyBound::open(StoredEnergy::default());
        let mut v = 0.0;
        let mut a = 1.0;
        let dt = 0.1;
        for _ in 0..20 {
            let du: f64 = (1.0 + 4.0 / dt * v + a) / (4.0 / (dt * dt) + 30.0 / dt);
            let next = 4.0 / (dt * dt) * du - 4.0 / dt * v - a;
            v += 0.5 * dt * (a + next);
            a = next;
            let taken = 30.0 * du * du / dt;
            damped.enter(&Turnover {
                plastic: taken,
                damped: taken,
                ..turnover(du, 0.5 * v * v)
            });
            assert!(damped.growth <= 1e-12, "{damped:?}");
        }
        let mut moving = EnergyBound::open(StoredEnergy {
            kinetic: 1.0,
            ..StoredEnergy::default()
        });
        moving.enter(&turnover(0.0, 1.1));
        assert!(moving.require().is_err());
    }
}
