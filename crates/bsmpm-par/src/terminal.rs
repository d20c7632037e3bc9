//! Finds whether stderr of this process or `mpirun` is a terminal. If so, progress lines are printed (Linux only).

use std::fs::{self, File, OpenOptions};
use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};

/// Beginnings of the names of programs that print what their children say.
const LAUNCHERS: [&str; 5] = ["mpirun", "mpiexec", "orterun", "prterun", "hydra_pmi_proxy"];
/// Processes between a rank and the terminal, at most: shells and wrappers included.
const MOST_PARENTS: usize = 8;

/// Where a line can be overwritten.
#[derive(Debug)]
pub enum Terminal {
    /// This process's stderr.
    Own,
    /// The stderr of the launcher.
    OfLauncher(File),
}

/// The terminal that shows what this process prints to stderr, if there is one.
pub fn find() -> Option<Terminal> {
    if stderr().is_terminal() {
        return Some(Terminal::Own);
    }
    of_launcher().map(Terminal::OfLauncher)
}

/// Follows the pipe from this process's stderr to the launcher that reads it, and on from there.
fn of_launcher() -> Option<File> {
    let mut pipe = pipe(Path::new("/proc/self/fd/2"))?;
    let mut process = std::os::unix::process::parent_id();
    for _ in 0..MOST_PARENTS {
        if is_launcher(process) && reads(process, &pipe) {
            let own = PathBuf::from(format!("/proc/{process}/fd/2"));
            match self::pipe(&own) {
                Some(next) => pipe = next,
                None => return terminal(&own),
            }
        }
        process = parent(process)?;
    }
    None
}

/// The pipe behind a descriptor, `None` if something else is behind it.
fn pipe(descriptor: &Path) -> Option<PathBuf> {
    fs::read_link(descriptor)
        .ok()
        .filter(|target| target.to_string_lossy().starts_with("pipe:"))
}

fn terminal(descriptor: &Path) -> Option<File> {
    let target = fs::read_link(descriptor).ok()?;
    if !target.starts_with("/dev") {
        return None;
    }
    let file = OpenOptions::new().write(true).open(descriptor).ok()?;
    file.is_terminal().then_some(file)
}

fn is_launcher(process: u32) -> bool {
    let name = fs::read_to_string(format!("/proc/{process}/comm")).unwrap_or_default();
    LAUNCHERS.iter().any(|launcher| name.starts_with(launcher))
}

/// Whether a process has an end of a pipe.
fn reads(process: u32, pipe: &Path) -> bool {
    let Ok(descriptors) = fs::read_dir(format!("/proc/{process}/fd")) else {
        return false;
    };
    let mut targets = descriptors.flatten().map(|descriptor| fs::read_link(descriptor.path()));
    targets.any(|target| target.is_ok_and(|target| target == pipe))
}

/// The parent of a process.
fn parent(process: u32) -> Option<u32> {
    let status = fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("PPid:"))?;
    line.trim().parse().ok().filter(|&parent| parent > 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pipe_and_the_parent_of_a_process_are_read_from_the_system() {
        let (reader, writer) = std::io::pipe().unwrap();
        let ends = [&reader as &dyn std::os::fd::AsRawFd, &writer].map(|end| end.as_raw_fd());
        let [read, written] = ends.map(|end| pipe(Path::new(&format!("/proc/self/fd/{end}"))));
        assert!(read.is_some() && read == written, "{read:?}, {written:?}");
        assert!(reads(std::process::id(), &read.unwrap()) && !reads(std::process::id(), Path::new("pipe:[0]")));
        assert_eq!(parent(std::process::id()), Some(std::os::unix::process::parent_id()));
        assert!(!is_launcher(std::process::id()));
    }
}
