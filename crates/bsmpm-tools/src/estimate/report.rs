//! Prints an estimate as a table and as JSON.

use std::fmt::Write;
use std::path::Path;

use bsmpm_scene::Case;
use serde::Serialize;

use super::against::Actual;
use super::sizes::{self, Bytes};
use super::stored::StoredEstimate;
use super::work::Effort;
use crate::report::mebibytes;

/// An estimate.
#[derive(Clone, Debug, Serialize)]
pub(super) struct EstimateReport {
    case: String,
    ranks: usize,
    useful_ranks: u64,
    points: u64,
    /// of the first steps, where such were made; else those that the bodies' cells touch at the start
    unknowns: u64,
    /// pore pressures, unknowns besides; where water flows
    #[serde(skip_serializing_if = "Option::is_none")]
    pressures: Option<u64>,
    /// entries of the stiffness
    non_zeros: u64,
    /// bytes  of each rank; the same once a step needs Newton's method
    memory_per_rank: [u64; 2],
    frames: u64,
    checkpoints: u64,
    /// bytes  of one of each
    sizes: Bytes,
    /// bytes  of all that is there at the end
    disk: u64,
    work: Effort,
    /// s  of processor time, all ranks together
    cpu_seconds: EstimateBand,
    /// s  by the clock, where nobody else uses the cores
    seconds: EstimateBand,
    /// time of this machine for the same computation, over that of the machine of reference
    speed: f64,
    basis: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    actual: Option<Actual>,
    /// estimated over actual processor seconds
    #[serde(skip_serializing_if = "Option::is_none")]
    ratio: Option<f64>,
}

/// A number, and between which ones it is expected.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct EstimateBand {
    value: f64,
    low: f64,
    high: f64,
}

impl EstimateBand {
    fn of(value: f64, factor: f64) -> Self {
        Self {
            value,
            low: value / factor,
            high: value * factor,
        }
    }
}

impl EstimateReport {
    /// Of a run of a case on so many ranks; `speed` is that of this machine.
    pub fn of(path: &Path, case: &Case, ranks: usize, speed: f64, found: &StoredEstimate) -> Self {
        let estimate = case.estimate(ranks);
        let steps = found.work.steps;
        let frames = sizes::frames(case, steps);
        let cpu = found.seconds(frames);
        let seconds = cpu / ranks as f64;
        let checkpoints = sizes::checkpoints(case, steps, seconds);
        let bytes = found.bytes;
        let tables = (bytes.step as f64 * steps) as u64;
        Self {
            case: path.display().to_string(),
            ranks,
            useful_ranks: estimate.useful_ranks,
            points: estimate.points,
            unknowns: found.unknowns.unwrap_or(estimate.active),
            pressures: Some(estimate.pressures).filter(|pressures| *pressures > 0),
            non_zeros: estimate.entries,
            memory_per_rank: [estimate.bytes, estimate.bytes_with_newton].map(|all| all / ranks as u64),
            frames,
            checkpoints,
            sizes: bytes,
            disk: frames * bytes.frame + checkpoints * bytes.checkpoint + tables,
            work: found.work,
            cpu_seconds: EstimateBand::of(cpu, found.band),
            seconds: EstimateBand::of(seconds, found.band),
            speed,
            basis: found.basis.clone(),
            actual: None,
            ratio: None,
        }
    }

    /// Sets what a run has taken beside it.
    pub fn compare(&mut self, actual: &Actual) {
        self.ratio = (actual.cpu_seconds > 0.0).then(|| self.cpu_seconds.value / actual.cpu_seconds);
        self.actual = Some(actual.clone());
    }

    /// As JSON.
    pub fn json(&self) -> String {
        let text = serde_json::to_string_pretty(self).expect("a report is numbers and texts with names");
        format!("{text}\n")
    }

    /// As a table.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for [what, estimate, actual] in self.rows() {
            let _ = writeln!(text, "{}", format!("{what:<28} {estimate:<44} {actual}").trim_end());
        }
        let _ = writeln!(text, "from {}", self.basis);
        text
    }

    fn rows(&self) -> Vec<[String; 3]> {
        let [memory, newton] = self.memory_per_rank;
        let memory = match newton > memory {
            true => format!(
                "{}, with Newton's method {}",
                in_mebibytes(memory),
                in_mebibytes(newton)
            ),
            false => in_mebibytes(memory),
        };
        let disk = format!(
            "{}: {} frame(s), {} checkpoint(s), tables",
            in_mebibytes(self.disk),
            self.frames,
            self.checkpoints
        );
        let mut rows = vec![
            row("", "estimate", self.title()),
            row(
                "points",
                &self.points.to_string(),
                self.beside(|actual| actual.points.to_string()),
            ),
            row(
                "unknowns",
                &self.unknowns.to_string(),
                self.beside(|actual| actual.unknowns.to_string()),
            ),
            row("non-zeros of the stiffness", &self.non_zeros.to_string(), String::new()),
            row(
                "memory of each rank",
                &memory,
                self.beside(|actual| in_mebibytes(actual.memory)),
            ),
            row("disk", &disk, self.beside(|actual| in_mebibytes(actual.disk))),
            row(
                "steps",
                &format!("{:.0}", self.work.steps),
                self.beside(|actual| actual.steps.to_string()),
            ),
            row(
                "evaluations",
                &format!("{:.0}", self.work.evaluations),
                self.beside(|actual| actual.evaluations.to_string()),
            ),
            row(
                "processor time",
                &reports(self.cpu_seconds),
                self.beside(|actual| seconds(actual.cpu_seconds)),
            ),
            row(
                &format!("time on {} rank(s)", self.ranks),
                &reports(self.seconds),
                self.beside(|actual| seconds(actual.seconds)),
            ),
            row("ranks of use", &format!("up to {}", self.useful_ranks), String::new()),
        ];
        if let Some(pressures) = self.pressures {
            rows.insert(3, row("pore pressures besides", &pressures.to_string(), String::new()));
        }
        rows.extend(self.ratio.map(|ratio| {
            row(
                "estimated / actual",
                &format!("{ratio:.2} (processor time)"),
                String::new(),
            )
        }));
        rows
    }

    /// The heading of the column of the run.
    fn title(&self) -> String {
        self.beside(|actual| match actual.complete {
            true => format!("actual, {} rank(s)", actual.ranks),
            false => format!("actual, {} rank(s), ended early", actual.ranks),
        })
    }

    /// What stands in the column of the run, which is empty without one.
    fn beside(&self, number: fn(&Actual) -> String) -> String {
        self.actual.as_ref().map_or_else(String::new, number)
    }
}

fn in_mebibytes(bytes: u64) -> String {
    format!("{:.1} MiB", mebibytes(bytes))
}

fn row(what: &str, estimate: &str, actual: String) -> [String; 3] {
    [what.to_owned(), estimate.to_owned(), actual]
}

fn reports(band: EstimateBand) -> String {
    format!(
        "{} ({} to {})",
        seconds(band.value),
        seconds(band.low),
        seconds(band.high)
    )
}

/// A time as people say it.
fn seconds(value: f64) -> String {
    match value {
        value if value < 10.0 => format!("{value:.2} s"),
        value if value < 600.0 => format!("{value:.0} s"),
        value if value < 36_000.0 => format!("{:.0} min", value / 60.0),
        value => format!("{:.1} h", value / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::super::stored;
    use super::*;

    const COLUMN: &str = include_str!("../../../../cases/short/column_collapse.toml");

    fn report() -> EstimateReport {
        let case = Case::from_text("column", COLUMN, &[]).unwrap();
        EstimateReport::of(Path::new("column.toml"), &case, 2, 1.0, &stored::guess(&case, 2, 1.0))
    }

    #[test]
    fn two_ranks_share_the_processor_time_and_the_band_holds_the_estimate() {
        let report = report();
        assert_eq!(report.seconds.value, report.cpu_seconds.value / 2.0);
        assert!(
            report.cpu_seconds.low < report.cpu_seconds.value && report.cpu_seconds.value < report.cpu_seconds.high
        );
        assert_eq!((report.points, report.frames, report.checkpoints), (800, 35, 0));
        assert_eq!(report.disk, 35 * report.sizes.frame + report.sizes.step * 1214);
        // What it took: 16,566 evaluations, 5 s.
        assert!(
            report.cpu_seconds.low < 5.0 && report.cpu_seconds.high > 5.0,
            "{:?}",
            report.cpu_seconds
        );
    }

    #[test]
    fn what_a_run_took_stands_beside_it() {
        let mut report = report();
        let points = 800;
        let unknowns = 300;
        let steps = 1214;
        let evaluations = 16_000;
        let actual = Actual {
            complete: true,
            ranks: 2,
            points,
            unknowns,
            memory: 60 << 20,
            disk: 1 << 20,
            steps,
            evaluations,
            cpu_seconds: 2.0 * report.cpu_seconds.value,
            seconds: 3.0,
            text: String::new(),
        };
        report.compare(&actual);
        assert_eq!(report.ratio, Some(0.5));
        let text = report.text();
        assert!(
            text.contains("actual, 2 rank(s)\n") && text.contains("60.0 MiB") && text.contains("0.50"),
            "{text}"
        );
        let json: serde_json::Value = serde_json::from_str(&report.json()).unwrap();
        assert_eq!(
            (json["actual"]["evaluations"].as_u64(), json["ratio"].as_f64()),
            (Some(16_000), Some(0.5))
        );
    }

    #[test]
    fn times_are_reported_as_people_say_them() {
        let reported = [0.051, 9.99, 12.3, 700.0, 40_000.0].map(seconds);
        assert_eq!(reported, ["0.05 s", "9.99 s", "12 s", "12 min", "11.1 h"]);
    }
}
