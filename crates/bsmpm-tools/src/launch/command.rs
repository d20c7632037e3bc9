//! The command that starts the solver.

use std::env;
use std::thread;

use crate::Error;

/// The words that were given; without such the solver beside this program, under mpirun where there are several ranks.
pub(crate) fn words(given: &[String], ranks: usize) -> Vec<String> {
    match (given.is_empty(), ranks) {
        (false, _) => given.to_vec(),
        (true, 1) => vec![own_solver()],
        (true, ranks) => vec!["mpirun".to_owned(), "-n".to_owned(), ranks.to_string(), own_solver()],
    }
}

/// The solver beside this program; where there is none, that of PATH.
pub(crate) fn own_solver() -> String {
    let name = "bsmpm-par";
    let beside = env::current_exe()
        .ok()
        .and_then(|program| Some(program.parent()?.join(name)));
    beside
        .filter(|solver| solver.is_file())
        .map_or_else(|| name.to_owned(), |solver| solver.display().to_string())
}

/// The ranks that a launcher is asked for: the number after -n, -np, -c or --ntasks; one where it does not say.
pub(crate) fn ranks(command: &[String]) -> usize {
    let launcher = &command[..command.len().saturating_sub(1)];
    let options = ["-n", "-np", "-c", "--np", "--ntasks"];
    let after = launcher
        .windows(2)
        .find(|pair| options.contains(&&*pair[0]))
        .map(|pair| &*pair[1]);
    let mut words = launcher.iter();
    let joined = words.find_map(|word| word.strip_prefix("--ntasks=").or(word.strip_prefix("-n")));
    after
        .or(joined)
        .and_then(|number| number.parse().ok())
        .filter(|&ranks| ranks > 0)
        .unwrap_or(1)
}

/// How many commands run at a time: what is asked for, or as many as their ranks leave cores for.
///
/// # Errors
/// [`Error::Usage`] for none at all.
pub(crate) fn jobs(asked: Option<usize>, command: &[String]) -> Result<usize, Error> {
    if asked == Some(0) {
        return Err(Error::Usage {
            reason: "E0809: --jobs is 0, so no run would start. Give a number of at least 1.".to_owned(),
        });
    }
    let cores = thread::available_parallelism().map_or(1, usize::from);
    Ok(asked.unwrap_or_else(|| (cores / ranks(command)).max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(command: &str) -> Vec<String> {
        command.split(' ').map(str::to_owned).collect()
    }

    #[test]
    fn the_launcher_s_ranks_are_read() {
        let of = |command: &str| ranks(&split(command));
        assert_eq!(
            (
                of("bsmpm-par"),
                of("mpirun -n 2 bsmpm-par"),
                of("mpirun -np 4 ./bsmpm-par")
            ),
            (1, 2, 4)
        );
        assert_eq!(
            (
                of("srun --ntasks=8 bsmpm-par"),
                of("srun -n3 bsmpm-par"),
                of("srun bsmpm-par")
            ),
            (8, 3, 1)
        );
        assert_eq!((of("mpirun -n 0 bsmpm-par"), of("mpirun -n x bsmpm-par")), (1, 1));
    }

    #[test]
    fn several_ranks_get_a_launcher_unless_one_is_given() {
        assert_eq!(words(&[], 1).len(), 1);
        assert_eq!(ranks(&words(&[], 3)), 3);
        assert_eq!(words(&split("srun bsmpm-par"), 1), split("srun bsmpm-par"));
    }
}
