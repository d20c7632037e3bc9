//! Runs tasks in parallel, within free cores and memory.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc;
use std::thread;

/// What one of them takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PoolLoad {
    /// bytes
    pub memory: u64,
    /// In any unit: those with the most begin first, so that no long one is left for the end.
    pub work: f64,
}

/// What all of them may take together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Limits {
    /// At a time.
    pub jobs: usize,
    /// bytes
    pub memory: u64,
}

/// The results of `work` for every load, in their order; `report` gets each as soon as it is there. A load beyond the
/// memory of all runs alone: whether it is begun at all is the caller's choice.
pub(crate) fn all<T: Send>(
    loads: &[PoolLoad],
    limits: Limits,
    work: impl Fn(usize) -> T + Sync,
    mut report: impl FnMut(usize, &T),
) -> Vec<T> {
    let mut waiting: Vec<usize> = (0..loads.len()).collect();
    waiting.sort_by(|&a, &b| loads[b].work.total_cmp(&loads[a].work));
    let mut running: Vec<usize> = Vec::new();
    let mut made: Vec<Option<T>> = loads.iter().map(|_| None).collect();
    let (sender, receiver) = mpsc::channel();
    let work = &work;
    thread::scope(|scope| {
        while !(waiting.is_empty() && running.is_empty()) {
            while let Some(place) = next(&waiting, &running, loads, limits) {
                let index = waiting.remove(place);
                running.push(index);
                let sender = sender.clone();
                scope.spawn(move || {
                    let result = catch_unwind(AssertUnwindSafe(|| work(index)));
                    // Nobody listens where the caller has given up.
                    let _ = sender.send((index, result));
                });
            }
            let (index, result) = receiver.recv().expect("the other end is held here");
            running.retain(|&other| other != index);
            // A fault of the program ends all of it, once the runs under way have ended.
            let result = result.unwrap_or_else(|fault| resume_unwind(fault));
            report(index, &result);
            made[index] = Some(result);
        }
    });
    made.into_iter().flatten().collect()
}

/// The place among the waiting ones of the next that fits beside the running ones.
fn next(waiting: &[usize], running: &[usize], loads: &[PoolLoad], limits: Limits) -> Option<usize> {
    if running.is_empty() {
        return (!waiting.is_empty()).then_some(0);
    }
    if running.len() >= limits.jobs {
        return None;
    }
    let used = running
        .iter()
        .fold(0_u64, |sum, &index| sum.saturating_add(loads[index].memory));
    waiting
        .iter()
        .position(|&index| used.saturating_add(loads[index].memory) <= limits.memory)
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;
    use std::time::Duration;

    use super::*;

    /// Results, the order in which they began, and the most jobs and memory at a time.
    fn run(loads: &[PoolLoad], limits: Limits) -> (Vec<usize>, Vec<usize>, usize, u64) {
        let state = Mutex::new((Vec::new(), Vec::<usize>::new(), 0, 0));
        let results = all(
            loads,
            limits,
            |index| {
                let mut now = state.lock().unwrap();
                now.0.push(index);
                now.1.push(index);
                let memory = now.1.iter().map(|&index| loads[index].memory).sum();
                (now.2, now.3) = (now.2.max(now.1.len()), now.3.max(memory));
                drop(now);
                thread::sleep(Duration::from_millis(2));
                state.lock().unwrap().1.retain(|&other| other != index);
                10 * index
            },
            |index, result| assert_eq!(10 * index, *result),
        );
        let (began, _, jobs, memory) = state.into_inner().unwrap();
        (results, began, jobs, memory)
    }

    #[test]
    fn neither_jobs_nor_memory_are_exceeded_and_the_longest_begin() {
        let loads: Vec<PoolLoad> = (0..12)
            .map(|index| PoolLoad {
                memory: 10 + index % 5,
                work: (index * 7 % 12) as f64,
            })
            .collect();
        let (results, _, jobs, memory) = run(&loads, Limits { jobs: 3, memory: 25 });
        assert_eq!(results, (0..12).map(|index| 10 * index).collect::<Vec<_>>());
        assert!(jobs == 2 && memory <= 25, "{jobs} {memory}");
        let (_, began, jobs, _) = run(
            &loads,
            Limits {
                jobs: 1,
                memory: u64::MAX,
            },
        );
        let sorted: Vec<usize> = (0..12)
            .rev()
            .map(|work| (0..12).find(|index| index * 7 % 12 == work).unwrap())
            .collect();
        assert_eq!((began, jobs), (sorted, 1));
    }

    #[test]
    fn what_is_too_large_for_any_neighbour_runs_alone() {
        let loads = [1, 100, 1].map(|memory| PoolLoad {
            memory,
            work: memory as f64,
        });
        let (results, _, _, memory) = run(&loads, Limits { jobs: 4, memory: 50 });
        assert_eq!((results.len(), memory), (3, 100));
        assert!(run(&[], Limits { jobs: 4, memory: 50 }).0.is_empty());
    }
}
