//! Compares a case's estimated memory with `--max-memory` and the host's memory before a run.

use crate::cli::Arguments;
use crate::launch::{complain, say};
use bsmpm_io::exit;
use bsmpm_messages::headed;
use bsmpm_scene::Case;
use mpi::collective::Root;
use mpi::topology::{Communicator, SimpleCommunicator};
use std::fmt::{self, Display};
use std::fs;
use std::path::{Path, PathBuf};

const GIB: f64 = (1_u64 << 30) as f64;
/// Bytes that OpenBLAS reserves for its buffers. Where a limit of the process refuses them, it asks again for ever.
const RESERVED: u64 = 1 << 27;

/// Memory that a case would need, and that there is less of.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Shortage {
    needed: u64,
    ranks: usize,
    allowed: u64,
    by: Limit,
}

/// What bounds the memory of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Limit {
    /// of all ranks: `--max-memory`
    Asked,
    /// of the ranks of a host: MemAvailable
    Free,
    /// of the ranks of a host: memory.max, or memory.limit_in_bytes, of the control group
    Group,
    /// of each rank: what ulimit -v and -d leave to it
    Process,
}

/// Memory that a limit allows, in bytes.
struct MemoryLimit {
    by: Limit,
    allowed: u64,
}

impl Display for Shortage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let needed = self.needed as f64 / GIB;
        let allowed = self.allowed as f64 / GIB;
        write!(f, "about {needed:.1} GiB ")?;
        let ranks = self.ranks;
        match self.by {
            Limit::Asked => write!(f, "on {ranks} rank(s), and --max-memory allows {allowed:.1} GiB"),
            Limit::Process => write!(f, "on each of {ranks} rank(s), and `ulimit` allows {allowed:.1} GiB"),
            Limit::Free => write!(
                f,
                "on this computer ({ranks} rank(s)), where {allowed:.1} GiB are available"
            ),
            Limit::Group => {
                write!(
                    f,
                    "on this computer ({ranks} rank(s)), whose control group allows {allowed:.1} GiB"
                )
            }
        }
    }
}

impl Shortage {
    /// Why the case is not run.
    fn refusal(&self) -> String {
        match self.by {
            Limit::Asked => format!(
                "E0702: the case needs too much memory: {self}. Nothing was run. Increase `grid.cell`, reduce \
                 `body.points_per_cell`, or increase `--max-memory`."
            ),
            Limit::Free | Limit::Group | Limit::Process => format!(
                "E0702: the case needs too much memory: {self}. Nothing was run. Increase `grid.cell`, reduce \
                 `body.points_per_cell`, or use more computers."
            ),
        }
    }
}

/// Refuses a case that needs more than the first rank's host or the command line allows, which that rank says; `Err`
/// holds the exit code, the same on all ranks. What is only checked may be meant for another host. Collective.
pub fn admit(world: &SimpleCommunicator, arguments: &Arguments, case: &Case) -> Result<(), u8> {
    let ranks = world.size().unsigned_abs() as usize;
    let here = world.split_shared(world.rank()).size().unsigned_abs() as usize;
    let mut code = exit::DONE;
    if world.rank() == 0 {
        let estimate = case.estimate(ranks);
        let limits = limits(arguments.max_memory);
        let [shortage, shortage_with_newton] = [estimate.bytes, estimate.bytes_with_newton].map(|needed| {
            let mut limits = limits.iter();
            limits.find_map(|limit| short(needed, ranks, here, limit.by, limit.allowed))
        });
        if let (None, Some(shortage)) = (&shortage, shortage_with_newton) {
            let text = format!(
                "W0723: Newton's method, which the program uses if a step converges badly, needs too much memory: \
                 {shortage}. The operating system may then end the run. Increase `grid.cell`, or use more computers."
            );
            say(&headed(&text, "warning"));
        }
        match shortage {
            Some(shortage) if arguments.check && shortage.by != Limit::Asked => {
                let text = format!(
                    "W0724: the case needs too much memory: {shortage}. This computer cannot run it. Increase `grid.cell`, \
                     reduce `body.points_per_cell`, or use more computers."
                );
                say(&headed(&text, "warning"));
            }
            Some(shortage) => {
                complain(&shortage.refusal());
                code = exit::MEMORY;
            }
            None => {}
        }
    }
    world.process_at_rank(0).broadcast_into(&mut code);
    if code == exit::DONE { Ok(()) } else { Err(code) }
}

/// `ranks` in all and `here`, on this host.
fn short(needed: u64, ranks: usize, here: usize, by: Limit, allowed: u64) -> Option<Shortage> {
    let each = needed / ranks as u64;
    let (needed, ranks) = match by {
        Limit::Asked => (needed, ranks),
        Limit::Process => (each, ranks),
        Limit::Free | Limit::Group => (each * here as u64, here),
    };
    (needed > allowed).then_some(Shortage {
        needed,
        ranks,
        allowed,
        by,
    })
}

/// What was asked for, or what this host and its control groups tell; and what the process's own limits do.
fn limits(asked: Option<u64>) -> Vec<MemoryLimit> {
    let process = left(&read("/proc/self/limits"), &read("/proc/self/status"));
    let mut limits = match asked {
        Some(_) => vec![(Limit::Asked, asked)],
        None => vec![
            (
                Limit::Group,
                group(Path::new("/sys/fs/cgroup"), &read("/proc/self/cgroup")),
            ),
            (Limit::Free, kilobytes(&read("/proc/meminfo"), "MemAvailable:")),
        ],
    };
    limits.push((Limit::Process, process));
    let known = limits.into_iter();
    known
        .filter_map(|(by, allowed)| Some(MemoryLimit { by, allowed: allowed? }))
        .collect()
}

/// The text of a file of the system; empty if it cannot be read.
fn read(path: &str) -> String {
    fs::read_to_string(path).unwrap_or_default()
}

fn kilobytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()? * 1024)
}

/// What the limits of address space and of data leave to a process besides what it has and what its BLAS reserves.
fn left(limits: &str, status: &str) -> Option<u64> {
    let bounded = [("Max address space", "VmSize:"), ("Max data size", "VmData:")].into_iter();
    let left = bounded.filter_map(|(name, size)| {
        let line = limits.lines().find_map(|line| line.strip_prefix(name))?;
        let limit = line.split_whitespace().next()?.parse::<u64>().ok()?; // none where it is "unlimited"
        Some(limit.saturating_sub(kilobytes(status, size).unwrap_or(0) + RESERVED))
    });
    left.min()
}

/// The least limit of the process's control groups of either version and of those around them; `membership` is
/// /proc/self/cgroup. In a container its own group may be what is mounted.
fn group(mounted: &Path, membership: &str) -> Option<u64> {
    membership
        .lines()
        .filter_map(|line| limit_of_group(mounted, line))
        .min()
}

/// The least limit of the group that a line of /proc/self/cgroup names, and of those around it.
fn limit_of_group(mounted: &Path, line: &str) -> Option<u64> {
    let mut parts = line.splitn(3, ':').skip(1);
    let controllers = parts.next()?;
    let path = parts.next()?;
    let (below, file): (&[&str], _) = match controllers {
        "" => (&["", "unified"], "memory.max"),
        named if named.split(',').any(|name| name == "memory") => (&["memory"], "memory.limit_in_bytes"),
        _ => return None,
    };
    let own = PathBuf::from(path.trim_start_matches('/'));
    let files = below
        .iter()
        .flat_map(|below| own.ancestors().map(move |group| mounted.join(below).join(group)));
    files
        .filter_map(|group| fs::read_to_string(group.join(file)).ok()?.trim().parse::<u64>().ok())
        .min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_system_reports_is_read() {
        let memory = "MemTotal: 5 kB\nMemAvailable:   22661120 kB\n";
        assert_eq!(kilobytes(memory, "MemAvailable:"), Some(22_661_120 * 1024));
        let limits =
            |data: &str, space: &str| format!("Max data size  {data} 1 bytes\nMax address space  {space} 1 bytes\n");
        let status = "VmSize:\t  1000 kB\nVmData:\t 500 kB\n";
        let rest = |limit: u64, size: u64| Some(limit - 1024 * size - RESERVED);
        assert_eq!(left(&limits("unlimited", "614400000"), status), rest(614_400_000, 1000));
        assert_eq!(left(&limits("300000000", "614400000"), status), rest(300_000_000, 500));
        assert_eq!(left(&limits("unlimited", "unlimited"), status), None);
        assert_eq!(left(&limits("1000", "unlimited"), status), Some(0));
        assert_eq!((kilobytes("", "VmSize:"), left("", "")), (None, None));
    }

    #[test]
    fn the_least_limit_of_all_control_groups_around_holds() {
        let mounted = tempfile::tempdir().unwrap();
        let put = |path: &str, text: &str| {
            let path = mounted.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        put("job/step/memory.max", "max\n");
        put("job/memory.max", "4000000000\n");
        assert_eq!(group(mounted.path(), "0::/job/step\n"), Some(4_000_000_000));
        put("memory/slurm/job/memory.limit_in_bytes", "3000000000\n");
        assert_eq!(
            group(mounted.path(), "4:memory:/slurm/job\n0::/job/step\n"),
            Some(3_000_000_000)
        );
        assert_eq!(group(mounted.path(), "4:cpu:/slurm/job\n"), None);
        assert_eq!(group(mounted.path(), "nonsense"), None);
    }

    #[test]
    fn each_limit_is_held_against_what_it_bounds() {
        let is_short = |by, allowed| short(4 << 30, 4, 2, by, allowed).is_some();
        assert!(is_short(Limit::Asked, 3 << 30) && !is_short(Limit::Asked, 4 << 30));
        assert!(is_short(Limit::Free, 1 << 30) && !is_short(Limit::Group, 2 << 30));
        assert!(is_short(Limit::Process, 1 << 29) && !is_short(Limit::Process, 1 << 30));
        let said = short(4 << 30, 4, 2, Limit::Free, 1 << 30).unwrap().to_string();
        assert!(
            said.contains("about 2.0 GiB on this computer (2 rank(s)), where 1.0 GiB are available"),
            "{said}"
        );
    }
}
