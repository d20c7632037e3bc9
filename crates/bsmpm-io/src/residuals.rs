//! `residuals.csv`: convergence measures of each iteration.

use std::path::Path;

use crate::Error;
use crate::table::{self, Cell, TableColumn};

/// Name of the file.
pub const RESIDUALS: &str = "residuals.csv";

/// Method that computed the direction of an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResidualMethod {
    /// Quasi-Newton with multiple secants.
    Multisecant,
    /// Broyden's update.
    Broyden,
    /// Newton's method with the complete derivative.
    Newton,
}

impl ResidualMethod {
    const ALL: [Self; 3] = [Self::Multisecant, Self::Broyden, Self::Newton];

    fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.word() == word)
    }

    /// Returns the method as the file writes it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Multisecant => "multisecant",
            Self::Broyden => "broyden",
            Self::Newton => "newton",
        }
    }
}

/// Row of the file: one iterate of a converged step, and the direction computed there. The last iterate has no
/// direction if its forces are balanced to round-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iterate {
    /// Number of the step.
    pub step: u64,
    /// Time at the end of the step (s, or pseudo-time in a quasi-static analysis).
    pub time: f64,
    /// Number of the iteration within the step; iteration 1 is at the predictor.
    pub iteration: u64,
    /// Method of its direction; an empty cell without one.
    pub method: Option<ResidualMethod>,
    /// Energy measure (-); an empty cell without a direction.
    pub energy: f64,
    /// Force measure (-).
    pub force: f64,
    /// Measure of the pore water (-) with transient seepage; NaN without.
    pub water: f64,
}

impl Iterate {
    /// Returns the columns of the file, the last one only if there is transient seepage; `time_unit` is `s`, or `-` for
    /// pseudo-time.
    pub fn columns(time_unit: &str, flows: bool) -> Vec<TableColumn> {
        let all = ["step", "time", "iteration", "method", "energy", "force", "water"];
        all[..6 + usize::from(flows)]
            .iter()
            .map(|&name| TableColumn::new(name, if name == "time" { time_unit } else { "-" }))
            .collect()
    }

    /// Returns the iteration as a row for [`Iterate::columns`].
    pub fn cells(&self, flows: bool) -> Vec<Cell> {
        let mut cells = vec![
            Cell::Int(self.step),
            Cell::Float(self.time),
            Cell::Int(self.iteration),
            self.method.map_or(Cell::Empty, |method| Cell::Word(method.word())),
            measure_cell(self.energy),
            measure_cell(self.force),
        ];
        cells.extend(flows.then(|| measure_cell(self.water)));
        cells
    }

    fn parse(line: &str) -> Option<Self> {
        let cells: Vec<&str> = line.split(',').collect();
        let [step, time, iteration, method, energy, force, ref water @ ..] = cells[..] else {
            return None;
        };
        Some(Self {
            step: step.parse().ok()?,
            time: time.parse().ok()?,
            iteration: iteration.parse().ok()?,
            method: if method.is_empty() {
                None
            } else {
                Some(ResidualMethod::of(method)?)
            },
            energy: parse_measure(energy)?,
            force: parse_measure(force)?,
            water: match water {
                [] => f64::NAN,
                [water] => parse_measure(water)?,
                _ => return None,
            },
        })
    }
}

/// Returns the cell of a measure; empty if it is not finite.
fn measure_cell(value: f64) -> Cell {
    if value.is_finite() {
        Cell::Float(value)
    } else {
        Cell::Empty
    }
}

/// Reads a measure, NaN from an empty cell; `None` if the text is not a number.
fn parse_measure(cell: &str) -> Option<f64> {
    if cell.is_empty() {
        Some(f64::NAN)
    } else {
        cell.parse().ok()
    }
}

/// Reads the rows. An unfinished last line, which is being written, is ignored.
///
/// # Errors
/// [`Error::File`] for an error of the system; [`Error::Format`] with the line that is not a row.
pub fn read(path: &Path) -> Result<Vec<Iterate>, Error> {
    let text = table::whole_lines(path)?;
    let rows = text
        .lines()
        .enumerate()
        .skip(1)
        .filter(|(_, line)| !line.starts_with('#'));
    rows.map(|(index, line)| {
        Iterate::parse(line).ok_or_else(|| Error::format(path, format!("line {}: no row of residuals", index + 1)))
    })
    .collect()
}
