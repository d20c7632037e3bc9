//! `residuals.csv`: convergence measures of each iteration.

use std::path::Path;

use crate::Error;
use crate::table::{self, Cell, TableColumn};

/// The file's name.
pub const RESIDUALS: &str = "residuals.csv";

/// What gave the direction of an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResidualMethod {
    /// All recent secants.
    Multisecant,
    /// Broyden's update.
    Broyden,
    /// The complete derivative.
    Newton,
}

impl ResidualMethod {
    const ALL: [Self; 3] = [Self::Multisecant, Self::Broyden, Self::Newton];

    fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.word() == word)
    }

    /// As the file writes it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Multisecant => "multisecant",
            Self::Broyden => "broyden",
            Self::Newton => "newton",
        }
    }
}

/// One row: a state on the way from the guess that led to convergence, and the direction found there. The last state
/// has no direction where its forces are balanced to round-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iterate {
    /// The step's number.
    pub step: u64,
    /// s (pseudo-time in a quasi-static analysis)  at its end.
    pub time: f64,
    /// The number of the iteration within the step; the first one, 1, is at the guess.
    pub iteration: u64,
    /// What gave its direction; an empty cell without one.
    pub method: Option<ResidualMethod>,
    /// The energy measure; an empty cell without a direction.
    pub energy: f64,
    /// The force measure.
    pub force: f64,
    /// The measure of the water, where some flows; NaN where none flows.
    pub water: f64,
}

impl Iterate {
    /// The file's columns, the last one where water flows; `time_unit` is `s`, or `-` for pseudo-time.
    pub fn columns(time_unit: &str, flows: bool) -> Vec<TableColumn> {
        let all = ["step", "time", "iteration", "method", "energy", "force", "water"];
        all[..6 + usize::from(flows)]
            .iter()
            .map(|&name| TableColumn::new(name, if name == "time" { time_unit } else { "-" }))
            .collect()
    }

    /// The iteration as a row under [`Iterate::columns`].
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

/// The cell of a measure, empty for one that is not finite.
fn measure_cell(value: f64) -> Cell {
    if value.is_finite() {
        Cell::Float(value)
    } else {
        Cell::Empty
    }
}

/// Reads a measure, which is NaN in an empty cell; `None` for what is no number.
fn parse_measure(cell: &str) -> Option<f64> {
    if cell.is_empty() {
        Some(f64::NAN)
    } else {
        cell.parse().ok()
    }
}

/// Reads the rows; a last line without its end is one that is being written, and left out.
///
/// # Errors
/// [`Error::File`] when the system refuses, [`Error::Format`] with the line for what is no row.
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
