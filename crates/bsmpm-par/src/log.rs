//! Writes the log of a run to stderr of rank 0, in a form for terminals, for batch jobs, or as JSON.

use crate::cli::{Arguments, LogFormat, ProgressForm};
use crate::launch;
use bsmpm::control::AcceptedStep;
use bsmpm::error::StepError;
use bsmpm_messages::{code_of, headed};
use bsmpm_scene::Case;
use serde_json::json;
use std::time::{Duration, Instant};

/// Time between two states of the line that is overwritten.
const REDRAWN: Duration = Duration::from_millis(100);
/// Time until the first line of progress in a batch job, and between later ones.
const FIRST: Duration = Duration::from_secs(10);
const LATER: Duration = Duration::from_secs(120);
/// Columns of the line that is overwritten: a longer one could not be removed from a narrow terminal.
const COLUMNS: usize = 78;

/// How much is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Verbosity {
    /// Warnings, and why the run does not end well.
    Warnings,
    /// Progress, events and the summary, too.
    Normal,
    /// Every step, too.
    Steps,
    /// Every attempt at a step that was rejected, too.
    Attempts,
}

/// How the progress is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Progress {
    /// By a line that is overwritten.
    Line,
    /// By a line every few minutes.
    Lines,
    Off,
}

/// Where log lines go; silent on all ranks but the first.
pub struct Log {
    speaks: bool,
    verbosity: Verbosity,
    format: LogFormat,
    progress: Progress,
    due: Instant, // the next line of progress
    end: f64,
    unit: &'static str, // of the time
}

impl Log {
    /// A log of the run of a case.
    pub fn new(speaks: bool, arguments: &Arguments, case: &Case) -> Self {
        let verbosity = match (arguments.quiet, arguments.verbose) {
            (true, _) => Verbosity::Warnings,
            (false, 0) => Verbosity::Normal,
            (false, 1) => Verbosity::Steps,
            (false, _) => Verbosity::Attempts,
        };
        let format = arguments.log_format;
        let is_watched = speaks && format == LogFormat::Text && launch::watch();
        let first = if is_watched { Duration::ZERO } else { FIRST };
        Self {
            speaks,
            verbosity,
            format,
            progress: if speaks {
                progress(arguments.progress, verbosity, is_watched)
            } else {
                Progress::Off
            },
            due: Instant::now() + first,
            end: case.analysis.end,
            unit: if case.analysis.kind.is_timeless() { "" } else { " s" },
        }
    }

    /// One accepted step, its number and the seconds since the start.
    pub fn step(&mut self, number: u64, accepted: &AcceptedStep, wall: f64) {
        self.rejected(number, &accepted.rejected);
        let report = &accepted.report;
        let done = accepted.t / self.end;
        match self.format {
            LogFormat::Json if self.shows(Verbosity::Normal) => launch::say(
                &json!({
                    "event": "step", "step": number, "time": accepted.t, "dt": accepted.dt,
                    "iterations": report.iterations, "residual": report.force,
                    "evaluations": accepted.counts.evaluations, "active_nodes": report.active_nodes, "wall": wall,
                })
                .to_string(),
            ),
            LogFormat::Text if self.shows(Verbosity::Steps) => launch::say(&format!(
                "step {number:>6}  t {:<10}  dt {:<10}  iterations {:>3}  residual {:.1e}  {:5.1} %  {}",
                short(accepted.t),
                short(accepted.dt),
                report.iterations,
                report.force,
                100.0 * done,
                clock(done, wall)
            )),
            _ => {}
        }
        self.show_progress(number, accepted.t, wall);
    }

    /// Attempts at a step that were rejected.
    pub fn rejected(&self, number: u64, errors: &[StepError]) {
        for error in errors {
            self.print(
                Verbosity::Attempts,
                "cut",
                &format!("step {number}: attempt rejected: {error}"),
            );
        }
    }

    /// How far the run is, if that is due.
    fn show_progress(&mut self, number: u64, t: f64, wall: f64) {
        let now = Instant::now();
        if self.progress == Progress::Off || self.format == LogFormat::Json || now < self.due {
            return;
        }
        let done = t / self.end;
        let unit = self.unit;
        let line = format!(
            "{:4.1} %, t = {} of {}{unit}, step {number}, {}",
            100.0 * done,
            short(t),
            short(self.end),
            clock(done, wall)
        );
        if self.progress == Progress::Line {
            launch::draw(&line.chars().take(COLUMNS).collect::<String>());
            self.due = now + REDRAWN;
        } else {
            launch::say(&line);
            self.due = now + LATER;
        }
    }

    /// An event of some kind.
    pub fn line(&self, kind: &str, text: &str) {
        self.print(Verbosity::Normal, kind, text);
    }

    /// An event of some kind, for those who asked for more.
    pub fn detail(&self, kind: &str, text: &str) {
        self.print(Verbosity::Steps, kind, text);
    }

    /// A warning, which begins with its code (the code of an indicator is that of a warning).
    pub fn warning(&self, kind: &str, text: &str) {
        self.print(Verbosity::Warnings, kind, &headed(text, "warning"));
    }

    /// Why a run does not end well: printed however quiet it is.
    pub fn cause(&self, kind: &str, text: &str) {
        self.print(Verbosity::Warnings, kind, text);
    }

    /// A failure, which begins with its code.
    pub fn failure(&self, text: &str) {
        let text = &if code_of(text).is_some() {
            format!("error {text}")
        } else {
            format!("error: {text}")
        };
        match self.format {
            LogFormat::Json => self.print(Verbosity::Warnings, "failure", text),
            LogFormat::Text => self.print(Verbosity::Warnings, "failure", &format!("bsmpm-par: {text}")),
        }
    }

    /// Removes the line of progress.
    pub fn finish(&self) {
        if self.speaks {
            launch::erase();
        }
    }

    /// Whether it prints what is for such a verbosity.
    fn shows(&self, least: Verbosity) -> bool {
        self.speaks && self.verbosity >= least
    }

    /// A log of JSON has all events, unless it is quiet.
    fn print(&self, least: Verbosity, kind: &str, text: &str) {
        match self.format {
            LogFormat::Json if self.shows(least.min(Verbosity::Normal)) => {
                launch::say(&json!({ "event": kind, "message": text }).to_string());
            }
            LogFormat::Text if self.shows(least) => launch::say(text),
            _ => {}
        }
    }
}

/// How the progress is shown where it was left open: by the lines of the steps, if they are wanted.
fn progress(wanted: ProgressForm, verbosity: Verbosity, is_watched: bool) -> Progress {
    let is_dumb = std::env::var_os("TERM").is_some_and(|name| name == "dumb");
    match wanted {
        _ if verbosity == Verbosity::Warnings => Progress::Off,
        ProgressForm::Off => Progress::Off,
        ProgressForm::Line => Progress::Line,
        ProgressForm::Log => Progress::Lines,
        ProgressForm::Auto if verbosity > Verbosity::Normal => Progress::Off,
        ProgressForm::Auto if is_watched && !is_dumb => Progress::Line,
        ProgressForm::Auto => Progress::Lines,
    }
}

/// How long the run has taken and will take at its mean pace.
fn clock(done: f64, wall: f64) -> String {
    let left = wall * (1.0 / done - 1.0).max(0.0);
    format!("{} elapsed, about {} left", duration(wall), duration(left))
}

/// A time in words, with two units at most.
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "an unknown time".into();
    }
    if seconds < 9.95 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds.round() as u64;
    let minutes = whole / 60;
    let hours = whole / 3600;
    let days = whole / 86_400;
    match (days, hours, minutes) {
        (0, 0, 0) => format!("{whole} s"),
        (0, 0, _) => format!("{minutes} min {} s", whole % 60),
        (0, _, _) => format!("{hours} h {} min", minutes % 60),
        (_, _, _) => format!("{days} d {} h", hours % 24),
    }
}

/// A number with four digits.
pub fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.3e}").parse().unwrap_or(number);
    let size = rounded.abs();
    if size == 0.0 || (1e-3..1e6).contains(&size) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_have_two_units_at_most() {
        let spoken = [0.04, 9.96, 61.0, 3599.6, 7260.0, 93_600.0, f64::INFINITY].map(duration);
        let expected = [
            "0.0 s",
            "10 s",
            "1 min 1 s",
            "1 h 0 min",
            "2 h 1 min",
            "1 d 2 h",
            "an unknown time",
        ];
        assert_eq!(spoken, expected);
    }

    #[test]
    fn numbers_have_four_digits_and_a_leading_zero() {
        let written = [0.607, 1.0 / 3.0, 86_400.0, 1e-4, 2.345_678e7, 0.0].map(short);
        assert_eq!(written, ["0.607", "0.3333", "86400", "1e-4", "2.346e7", "0"]);
    }

    #[test]
    fn the_line_that_is_overwritten_is_for_those_who_watch() {
        let shown = |verbosity, is_watched| progress(ProgressForm::Auto, verbosity, is_watched);
        assert_eq!(shown(Verbosity::Normal, false), Progress::Lines);
        assert_eq!(shown(Verbosity::Steps, true), Progress::Off);
        assert_eq!(shown(Verbosity::Warnings, true), Progress::Off);
        assert_eq!(progress(ProgressForm::Line, Verbosity::Normal, false), Progress::Line);
    }
}
