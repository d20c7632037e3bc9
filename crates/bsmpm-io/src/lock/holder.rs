//! Identifies the process that locked an output directory, and checks whether this process still exists (Linux only).

use std::fmt::{self, Display, Formatter};
use std::fs;
use std::io::{self, Read};
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use crate::utc::utc;

/// Environment variables in which batch systems give the job id, which a restarted job keeps.
const JOBS: [&str; 3] = ["SLURM_JOB_ID", "PBS_JOBID", "LSB_JOBID"];
/// Environment variable in which Slurm gives the number of restarts of a job; the steps of one start share it.
const RESTARTS: &str = "SLURM_RESTART_COUNT";
/// Upper bound of the length of a holder's text (bytes).
const LONGEST: u64 = 4096;

/// Process that has a lock.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Holder {
    host: String,
    boot: String,      // of the host's kernel
    namespace: String, // PID namespace of `pid`
    pid: u32,
    started: Option<u64>, // ticks since `boot`; process numbers are reused
    job: Option<String>,
    #[serde(default)]
    restarts: u64, // of the job
    since: String, // UTC
}

/// State of a holder's process.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// The process exists.
    Alive,
    /// The process no longer exists, for this reason.
    Gone(&'static str),
    /// It cannot be determined from here.
    Unseen,
}

impl Holder {
    pub fn this_process() -> Self {
        let namespace = fs::read_link("/proc/self/ns/pid").unwrap_or_default();
        Self {
            host: trimmed_text("/proc/sys/kernel/hostname"),
            boot: trimmed_text("/proc/sys/kernel/random/boot_id"),
            namespace: namespace.to_string_lossy().into_owned(),
            pid: std::process::id(),
            started: start_of(std::process::id()),
            job: JOBS.iter().find_map(|name| job_of(name)),
            restarts: std::env::var(RESTARTS)
                .ok()
                .and_then(|count| count.parse().ok())
                .unwrap_or(0),
            since: utc(SystemTime::now()),
        }
    }

    /// Reads the holder from a file; none if the file is incomplete or was not written by this program.
    pub fn read(file: &mut impl Read) -> io::Result<Option<Self>> {
        let mut text = Vec::new();
        file.take(LONGEST).read_to_end(&mut text)?;
        Ok(serde_json::from_slice(&text).ok())
    }

    /// Returns the text of a lock file.
    pub fn text(&self) -> String {
        let text = serde_json::to_string_pretty(self).expect("text and whole numbers can be written");
        text + "\n"
    }

    /// Returns the state of this holder's process, as `own` can determine it; `owner` is the user who owns the file.
    pub fn fate(&self, own: &Self, owner: u32) -> Fate {
        match self.seen_from(own, owner) {
            Fate::Unseen if self.was_started_again(own) => Fate::Gone("this job has been started again"),
            fate => fate,
        }
    }

    /// Returns whether `own` belongs to a later start of this holder's job. Slurm counts the starts; for other batch
    /// systems it is assumed that a job does not run twice in one directory at the same time.
    fn was_started_again(&self, own: &Self) -> bool {
        let counted = self.job.as_ref().is_some_and(|job| job.starts_with(JOBS[0]));
        self.job.is_some() && self.job == own.job && (!counted || own.restarts > self.restarts)
    }

    fn seen_from(&self, own: &Self, owner: u32) -> Fate {
        if self.host != own.host || self.started.is_none() || own.started.is_none() {
            return Fate::Unseen;
        }
        if self.boot != own.boot {
            return Fate::Gone("the host has been restarted since");
        }
        if self.namespace != own.namespace {
            return Fate::Unseen; // another container, with processes of its own
        }
        match start_of(self.pid) {
            start if start == self.started => Fate::Alive,
            Some(_) => Fate::Gone("the process is gone, and another has its number"),
            // If /proc hides the processes of other users, the process may exist.
            None if fs::metadata("/proc/self").is_ok_and(|own| own.uid() == owner) => Fate::Gone("the process is gone"),
            None => Fate::Unseen,
        }
    }
}

impl Display for Holder {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "process {} on host {}", self.pid, self.host)?;
        if let Some(job) = &self.job {
            write!(f, " ({job})")?;
        }
        write!(f, ", since {}", self.since)
    }
}

/// Returns the trimmed text of a system file; empty if it cannot be read.
fn trimmed_text(path: &str) -> String {
    fs::read_to_string(path).unwrap_or_default().trim().to_owned()
}

/// Returns the job in an environment variable, as `NAME=ID`.
fn job_of(variable: &str) -> Option<String> {
    let id = std::env::var(variable).ok().filter(|id| !id.is_empty())?;
    Some(format!("{variable}={id}"))
}

/// Returns the start of a process in ticks since the host started; none if it no longer exists or is a zombie.
fn start_of(pid: u32) -> Option<u64> {
    let stat = fs::read_to_string(Path::new("/proc").join(pid.to_string()).join("stat")).ok()?;
    // The name, in brackets, may contain anything. After it, the first field is the state, the 20th the start.
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace();
    let state = fields.next()?;
    if ["Z", "X"].contains(&state) {
        None
    } else {
        fields.nth(18)?.parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn user() -> u32 {
        fs::metadata("/proc/self").unwrap().uid()
    }

    #[test]
    fn a_holder_is_read_back_from_its_text() {
        let own = Holder::this_process();
        assert_eq!(Holder::read(&mut own.text().as_bytes()).unwrap(), Some(own.clone()));
        let half = &own.text().into_bytes()[..40];
        assert_eq!(Holder::read(&mut &half[..]).unwrap(), None);
        assert_eq!(Holder::read(&mut io::repeat(b' ')).unwrap(), None);
    }

    #[test]
    fn this_process_lives_and_one_that_started_at_another_time_does_not() {
        let own = Holder::this_process();
        assert_eq!(own.fate(&own, user()), Fate::Alive);
        let reused = Holder {
            started: own.started.map(|start| start + 1),
            ..own.clone()
        };
        assert!(matches!(reused.fate(&own, user()), Fate::Gone(_)));
        let earlier = Holder {
            boot: "another".into(),
            ..own.clone()
        };
        assert!(matches!(earlier.fate(&own, user()), Fate::Gone(_)));
    }

    #[test]
    fn a_dead_process_is_gone_also_before_its_parent_has_taken_it_away() {
        let own = Holder::this_process();
        let mut child = std::process::Command::new("sleep").arg("100").spawn().unwrap();
        let started = start_of(child.id());
        let holder = Holder {
            pid: child.id(),
            started,
            ..own.clone()
        };
        assert_eq!(holder.fate(&own, user()), Fate::Alive);
        child.kill().unwrap();
        while start_of(child.id()).is_some() {
            std::thread::yield_now();
        }
        assert!(matches!(holder.fate(&own, user()), Fate::Gone(_)), "a zombie");
        child.wait().unwrap();
        assert!(matches!(holder.fate(&own, user()), Fate::Gone(_)));
        assert_eq!(
            holder.fate(&own, user() + 1),
            Fate::Unseen,
            "another user's may be hidden"
        );
    }

    #[test]
    fn what_is_elsewhere_is_unseen_unless_this_job_has_been_started_again() {
        let own = Holder {
            job: Some("SLURM_JOB_ID=7".into()),
            restarts: 1,
            ..Holder::this_process()
        };
        let before = Holder {
            restarts: 0,
            ..own.clone()
        };
        for elsewhere in [
            Holder {
                host: "other".into(),
                ..before.clone()
            },
            Holder {
                namespace: "other".into(),
                ..before.clone()
            },
        ] {
            assert!(matches!(elsewhere.fate(&own, user()), Fate::Gone(_)));
            // Another step of the same start, which may go on.
            assert_eq!(
                Holder {
                    restarts: 1,
                    ..elsewhere.clone()
                }
                .fate(&own, user()),
                Fate::Unseen
            );
            let uncounted = Some("PBS_JOBID=7".to_owned());
            let [then, now] = [&elsewhere, &own].map(|holder| Holder {
                job: uncounted.clone(),
                ..holder.clone()
            });
            assert!(matches!(
                Holder { restarts: 1, ..then }.fate(&now, user()),
                Fate::Gone(_)
            ));
            for job in [None, Some("SLURM_JOB_ID=8".to_owned())] {
                assert_eq!(
                    Holder {
                        job,
                        ..elsewhere.clone()
                    }
                    .fate(&own, user()),
                    Fate::Unseen
                );
            }
            let jobless = Holder {
                job: None,
                ..own.clone()
            };
            assert_eq!(
                Holder {
                    job: None,
                    ..elsewhere.clone()
                }
                .fate(&jobless, user()),
                Fate::Unseen
            );
        }
    }
}
