//! The log of rank 0 on stderr: one line a step, and on a terminal a progress bar with the time that is left.

use crate::cli::LogFormat;
use crate::launch::say;
use bsmpm::control::Accepted;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;
use std::io::IsTerminal;
use std::time::Duration;

/// Divisions of the progress bar: simulated time is no whole number.
const DIVISIONS: f64 = 10_000.0;

/// Where log lines go; silent on all ranks but the first.
pub struct Log {
    speaks: bool,
    quiet: bool,
    verbose: bool,
    format: LogFormat,
    bar: ProgressBar,
    end: f64,
}

impl Log {
    /// A log of a run to time `end`.
    pub fn new(speaks: bool, quiet: bool, verbose: bool, format: LogFormat, end: f64) -> Self {
        let quiet = quiet || !speaks;
        let shown = !quiet && format == LogFormat::Text && std::io::stderr().is_terminal();
        let target = if shown { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(Some(DIVISIONS as u64), target);
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent} %  {elapsed} passed, {eta} left  {msg}") {
            bar.set_style(style);
        }
        Self { speaks, quiet, verbose, format, bar, end }
    }

    /// One accepted step, its number and the seconds since the start.
    pub fn step(&self, number: u64, accepted: &Accepted, wall: f64) {
        let report = &accepted.report;
        for error in &accepted.rejected {
            self.line("cut", &format!("step {number} cut: {error}"));
        }
        match self.format {
            LogFormat::Json => self.print(
                &json!({
                    "event": "step", "step": number, "time": accepted.t, "dt": accepted.dt,
                    "iterations": report.iterations, "residual": report.force,
                    "evaluations": accepted.counts.evaluations, "active_nodes": report.active_nodes, "wall": wall,
                })
                .to_string(),
            ),
            LogFormat::Text => self.print(&format!(
                "step {number:>6}  t {:<10.6} dt {:<9.3e} iterations {:>3}  residual {:.1e}  active nodes {:>6}  {}",
                accepted.t,
                accepted.dt,
                report.iterations,
                report.force,
                report.active_nodes,
                progress(accepted.t / self.end, wall)
            )),
        }
        self.bar.set_position((accepted.t / self.end * DIVISIONS) as u64);
    }

    /// A remark of some kind.
    pub fn line(&self, kind: &str, text: &str) {
        match self.format {
            LogFormat::Json => self.print(&json!({ "event": kind, "message": text }).to_string()),
            LogFormat::Text => self.print(text),
        }
    }

    /// A remark for those who asked for more.
    pub fn detail(&self, text: &str) {
        if self.verbose {
            self.line("detail", text);
        }
    }

    /// A failure: told however quiet the run is.
    pub fn failure(&self, text: &str) {
        self.bar.finish_and_clear();
        if self.speaks {
            match self.format {
                LogFormat::Json => say(&json!({ "event": "failure", "message": text }).to_string()),
                LogFormat::Text => say(&format!("bsmpm-par: {text}")),
            }
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn print(&self, line: &str) {
        if self.quiet {
            return;
        }
        self.bar.suspend(|| say(line));
    }
}

/// How far the run is and how long it will take at the present pace: mpirun hides the terminal, so that lines must tell
/// what the bar would.
fn progress(done: f64, wall: f64) -> String {
    let left = HumanDuration(Duration::from_secs_f64(wall * (1.0 / done - 1.0).clamp(0.0, 1e6)));
    format!("{:4.1} % in {wall:.1} s, {left:#} left", 100.0 * done)
}
