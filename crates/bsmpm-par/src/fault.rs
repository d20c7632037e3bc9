//! Injects faults into a run, for tests. The environment variable `BSMPM_FAULT` selects one:
//!
//! - `panic:rank=R,step=N` causes a panic on rank R in step N;
//! - `kill:phase=P,step=N` kills the rank that writes the checkpoint of step N, in phase P of writing;
//! - `reject:step=N` rejects and repeats the converged step N.

use bsmpm_io::checkpoint::Phase;

/// The fault that the environment asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    place: FaultPlace,
    step: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FaultPlace {
    Rank(usize),
    Phase(Phase),
    Convergence,
}

impl Fault {
    /// Reads this rank's `BSMPM_FAULT` for a run on so many ranks; `Err` says what is wrong with it.
    pub fn from_environment(ranks: usize) -> Result<Option<Self>, String> {
        let Some(text) = std::env::var_os("BSMPM_FAULT") else {
            return Ok(None);
        };
        match Self::parse(&text.to_string_lossy())? {
            Self {
                place: FaultPlace::Rank(rank),
                ..
            } if rank >= ranks => Err(format!(
                "E0708: BSMPM_FAULT (environment variable for program tests) names an MPI rank that this run of \
                 {ranks} rank(s) does not have. Nothing was run. Unset BSMPM_FAULT, or name a rank below {ranks}."
            )),
            fault => Ok(Some(fault)),
        }
    }

    fn read(text: &str) -> Option<Self> {
        let (kind, places) = text.split_once(':')?;
        let (place, step) = places.rsplit_once(',').unwrap_or(("", places));
        let place = match kind {
            "panic" => FaultPlace::Rank(place.strip_prefix("rank=")?.parse().ok()?),
            "kill" => FaultPlace::Phase(phase(place.strip_prefix("phase=")?)?),
            "reject" if place.is_empty() => FaultPlace::Convergence,
            _ => return None,
        };
        Some(Self {
            place,
            step: step.strip_prefix("step=")?.parse().ok()?,
        })
    }

    fn parse(text: &str) -> Result<Self, String> {
        let forms = "panic:rank=R,step=N, kill:phase=P,step=N or reject:step=N";
        Self::read(text).ok_or_else(|| {
            format!(
                "E0709: BSMPM_FAULT (environment variable for program tests) has an unknown value, \"{text}\". \
                 Nothing was run. Unset BSMPM_FAULT, or use one of: {forms}."
            )
        })
    }

    /// Whether this step is to be rejected when it has converged.
    pub fn rejects(self, step: u64) -> bool {
        (FaultPlace::Convergence, step) == (self.place, self.step)
    }

    /// Panics if this is the rank and the step.
    pub fn strike(self, rank: usize, step: u64) {
        assert!(
            (FaultPlace::Rank(rank), step) != (self.place, self.step),
            "injected by BSMPM_FAULT at step {step}"
        );
    }

    /// Kills the process, with no chance to clean up, if it writes the checkpoint of this step and is in this phase.
    pub fn strike_in(self, writes: bool, step: u64, phase: Phase) {
        if writes && (FaultPlace::Phase(phase), step) == (self.place, self.step) {
            let _ = signal_hook::low_level::raise(signal_hook::consts::SIGKILL);
        }
    }
}

fn phase(name: &str) -> Option<Phase> {
    Phase::ALL
        .into_iter()
        .find(|phase| format!("{phase:?}").to_lowercase() == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_names_rank_or_phase_and_step() {
        assert_eq!(
            Fault::parse("panic:rank=1,step=20"),
            Ok(Fault {
                place: FaultPlace::Rank(1),
                step: 20
            })
        );
        let fault = Fault {
            place: FaultPlace::Phase(Phase::Midway),
            step: 4,
        };
        assert_eq!(Fault::parse("kill:phase=midway,step=4"), Ok(fault));
        assert_eq!(
            Fault::parse("reject:step=7"),
            Ok(Fault {
                place: FaultPlace::Convergence,
                step: 7
            })
        );
        for wrong in [
            "reject:rank=1,step=2",
            "",
            "panic",
            "panic:rank=1",
            "panic:step=1,rank=2",
            "panic:rank=x,step=1",
            "hang:rank=1,step=2",
        ] {
            assert!(Fault::parse(wrong).is_err(), "{wrong}");
        }
        assert!(Fault::parse("kill:phase=never,step=1").is_err() && Fault::parse("kill:rank=1,step=1").is_err());
    }
}
