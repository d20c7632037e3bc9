//! A fault on demand, in every build: `BSMPM_FAULT=panic:rank=R,step=N` panics on rank R when step N begins.

/// The fault that the environment asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    rank: usize,
    step: u64,
}

impl Fault {
    /// Reads this rank's `BSMPM_FAULT` for a run on so many ranks; `Err` says what is wrong with it.
    pub fn from_environment(ranks: usize) -> Result<Option<Self>, String> {
        let Some(text) = std::env::var_os("BSMPM_FAULT") else { return Ok(None) };
        let fault = Self::parse(&text.to_string_lossy())?;
        if fault.rank < ranks { Ok(Some(fault)) } else { Err(format!("BSMPM_FAULT: there are {ranks} ranks only")) }
    }

    fn parse(text: &str) -> Result<Self, String> {
        let wrong = || format!("BSMPM_FAULT={text}: expected panic:rank=R,step=N");
        let places = text.strip_prefix("panic:").ok_or_else(wrong)?;
        let (rank, step) = places.split_once(',').ok_or_else(wrong)?;
        let number = |part: &str, key: &str| part.strip_prefix(key)?.parse().ok();
        let rank: u64 = number(rank, "rank=").ok_or_else(wrong)?;
        Ok(Self { rank: rank as usize, step: number(step, "step=").ok_or_else(wrong)? })
    }

    /// Panics if this is the rank and the step.
    pub fn strike(self, rank: usize, step: u64) {
        assert!((rank, step) != (self.rank, self.step), "injected by BSMPM_FAULT at step {step}");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_names_rank_and_step() {
        assert_eq!(Fault::parse("panic:rank=1,step=20"), Ok(Fault { rank: 1, step: 20 }));
        for wrong in ["", "panic", "panic:rank=1", "panic:step=1,rank=2", "panic:rank=x,step=1", "hang:rank=1,step=2"] {
            assert!(Fault::parse(wrong).is_err(), "{wrong}");
        }
    }
}
