//! The manifest `run.json`: case, program version, progress and output files of a run.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::time::SystemTime;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::utc::utc;
use crate::{Error, atomic};

mod indicator;
pub mod parts;

pub use indicator::Indicator;
pub use parts::{
    BackgroundShares, Communication, EnergyBalance, GridExtent, ManifestCase, ManifestCheck, ManifestChoice,
    ManifestFailure, ManifestInitial, ManifestLimitLoad, ManifestOutflow, ManifestOutput, ManifestRestart,
    ManifestSettling, ManifestStage, SolverNames, Status, Summary, Worst,
};

/// Name of the file.
pub const MANIFEST: &str = "run.json";
/// Version of the file format. It increases when older readers would misunderstand a newer file.
pub const SCHEMA: u32 = 1;

/// Contents of `run.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the file format, [`SCHEMA`].
    pub schema: u32,
    /// State of the run.
    pub status: Status,
    /// Exit code of the program; none while it runs.
    pub exit_code: Option<u8>,
    /// Version of the program.
    pub version: String,
    /// Command line, with the program first.
    pub argv: Vec<String>,
    /// Case that was computed.
    pub case: ManifestCase,
    /// Versions of libraries and compilers, by name.
    #[serde(default)]
    pub versions: BTreeMap<String, String>,
    /// Number of processes.
    pub ranks: u32,
    /// Number of threads of each process.
    pub threads: u32,
    /// Derived counts: points, cells, active nodes, unknowns, ...
    #[serde(default)]
    pub sizes: BTreeMap<String, u64>,
    /// Extent of the grid, for pictures.
    #[serde(default)]
    pub grid: Option<GridExtent>,
    /// Times (s or pseudo-time) for which the case requests pictures.
    #[serde(default)]
    pub picture_times: Vec<f64>,
    /// Values that the program chose.
    #[serde(default)]
    pub choices: Vec<ManifestChoice>,
    /// All warnings that were issued.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// Start of the run, RFC 3339 in UTC.
    pub start: String,
    /// End of the run.
    pub end: Option<String>,
    /// Wall-clock time by phase (s).
    #[serde(default)]
    pub timers: BTreeMap<String, f64>,
    /// Messages between ranks, by kind.
    #[serde(default)]
    pub communication: BTreeMap<String, Communication>,
    /// Linear solvers by system: `stiffness` (which the secants correct), `newton` (Jacobian of Newton's method), and
    /// `water` (pore pressures).
    #[serde(default)]
    pub linear: BTreeMap<String, SolverNames>,
    /// Load balance of the ranks; none on one rank.
    #[serde(default)]
    pub balance: Option<EnergyBalance>,
    /// Totals of the run so far.
    #[serde(default)]
    pub summary: Summary,
    /// Indicators of the accuracy of the run, by name, once it has ended; only those that apply to the case.
    #[serde(default)]
    pub indicators: BTreeMap<String, Indicator>,
    /// Equilibrium of the initial state, if the case defines an initial stress.
    #[serde(default)]
    pub initial: Option<ManifestInitial>,
    /// Stages that have begun, in order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<ManifestStage>,
    /// Material that has left the grid through outflow boundaries.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outflow: Option<ManifestOutflow>,
    /// Checks of the case, once they were made.
    #[serde(default)]
    pub checks: Vec<ManifestCheck>,
    /// Limit loads, if the case seeks them, once the end of the case was reached.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub limit_loads: Vec<ManifestLimitLoad>,
    /// All files that the run wrote or is about to write, except this one.
    #[serde(default)]
    pub outputs: Vec<ManifestOutput>,
    /// Units of the frames' fields, by name, once a frame was written.
    #[serde(default)]
    pub frame_units: BTreeMap<String, String>,
    /// Names for the numbers in the frames' fields, by field, if the case requests such fields.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub frame_names: BTreeMap<String, Vec<String>>,
    /// Newest valid checkpoint, relative to the directory.
    pub checkpoint: Option<String>,
    /// Restarts of the run, the first one first.
    #[serde(default)]
    pub restarts: Vec<ManifestRestart>,
    /// Reason why the run ended early.
    pub failure: Option<ManifestFailure>,
}

impl Manifest {
    /// Creates the manifest of a run that begins now, on one rank and one thread until the caller changes that.
    pub fn begin(version: &str, argv: Vec<String>, case: ManifestCase) -> Self {
        Self {
            schema: SCHEMA,
            status: Status::Running,
            exit_code: None,
            version: version.to_owned(),
            argv,
            case,
            versions: BTreeMap::new(),
            ranks: 1,
            threads: 1,
            sizes: BTreeMap::new(),
            grid: None,
            picture_times: Vec::new(),
            choices: Vec::new(),
            warnings: Vec::new(),
            start: utc(SystemTime::now()),
            end: None,
            timers: BTreeMap::new(),
            communication: BTreeMap::new(),
            linear: BTreeMap::new(),
            balance: None,
            summary: Summary::default(),
            indicators: BTreeMap::new(),
            initial: None,
            stages: Vec::new(),
            outflow: None,
            checks: Vec::new(),
            limit_loads: Vec::new(),
            outputs: Vec::new(),
            frame_units: BTreeMap::new(),
            frame_names: BTreeMap::new(),
            checkpoint: None,
            restarts: Vec::new(),
            failure: None,
        }
    }

    /// Notes that the run ends now.
    pub fn finish(&mut self, status: Status, exit_code: u8) {
        self.status = status;
        self.exit_code = Some(exit_code);
        self.end = Some(utc(SystemTime::now()));
    }

    /// Lists a file, relative to the directory, that is about to be written. A name is listed once.
    pub fn name_output(&mut self, path: &str) {
        if !self.outputs.iter().any(|output| output.path == path) {
            self.outputs.push(ManifestOutput {
                path: path.to_owned(),
                bytes: None,
                blake3: None,
            });
        }
    }

    /// Records size and hash of listed outputs that are complete, so that they are not read again at the end of the
    /// run.
    pub fn complete(&mut self, written: Vec<ManifestOutput>) {
        for output in &mut self.outputs {
            if let Some(written) = written.iter().find(|written| written.path == output.path) {
                output.clone_from(written);
            }
        }
    }

    /// Records size and hash of every listed output in `directory`. A missing file has none. A file that was complete
    /// and has the same size is not read again.
    ///
    /// # Errors
    /// [`Error::File`] if a file cannot be read.
    pub fn seal(&mut self, directory: &Path) -> Result<(), Error> {
        self.outputs.iter_mut().try_for_each(|output| output.seal(directory))
    }

    /// Writes `run.json` to `directory`, replacing it atomically.
    ///
    /// # Errors
    /// [`Error::NotFinite`] with the key, before anything is written; [`Error::File`] for an error of the system.
    pub fn write(&self, directory: &Path) -> Result<(), Error> {
        let path = directory.join(MANIFEST);
        self.check(&path)?;
        atomic::replace(&path, |file| self.print(file))
    }

    fn print(&self, file: &mut impl Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut *file, self)?;
        file.write_all(b"\n")
    }

    /// Checks that all numbers are finite: JSON has no others, and serde would write `null` for them.
    fn check(&self, path: &Path) -> Result<(), Error> {
        match self.numbers().find(|(_, value)| !value.is_finite()) {
            Some((item, value)) => Err(Error::NotFinite {
                path: path.to_owned(),
                item,
                value,
            }),
            None => Ok(()),
        }
    }

    /// Iterates over all floats of the manifest with their keys.
    fn numbers(&self) -> impl Iterator<Item = (String, f64)> {
        let timers = self
            .timers
            .iter()
            .map(|(name, &value)| (format!("timers.{name}"), value));
        let times = self
            .picture_times
            .iter()
            .map(|&time| ("picture_times".to_owned(), time));
        let grid = self
            .grid
            .iter()
            .flat_map(GridExtent::numbers)
            .map(|value| ("grid".to_owned(), value));
        let checks = self.checks.iter().flat_map(|check| {
            let numbers = [check.at, check.value, check.min, check.max].into_iter().flatten();
            numbers.map(|value| (format!("checks.{}", check.quantity), value))
        });
        let failure = self
            .failure
            .iter()
            .flat_map(ManifestFailure::numbers)
            .map(|value| ("failure".to_owned(), value));
        let cpu = [("summary.cpu_seconds".to_owned(), self.summary.cpu_seconds)];
        let balance = self.balance.iter().flat_map(|balance| [balance.mean, balance.largest]);
        let balance = balance.map(|value| ("balance".to_owned(), value));
        let indicators = self.indicators.iter().flat_map(|(name, indicator)| {
            indicator
                .numbers()
                .map(move |value| (format!("indicators.{name}"), value))
        });
        let limit_loads = self.limit_loads.iter().flat_map(|load| [load.value, load.change]);
        let limit_loads = limit_loads.map(|value| ("limit_loads".to_owned(), value));
        let run = timers
            .chain(times)
            .chain(grid)
            .chain(checks)
            .chain(failure)
            .chain(cpu)
            .chain(balance);
        run.chain(indicators).chain(limit_loads)
    }

    /// Reads the `run.json` of `directory`.
    ///
    /// # Errors
    /// [`Error::File`] if there is none, or for an error of the system; [`Error::Format`] if this program did not write
    /// it, or if its format is newer.
    pub fn read(directory: &Path) -> Result<Self, Error> {
        #[derive(Deserialize)]
        struct ManifestForm {
            schema: u32,
        }
        let path = directory.join(MANIFEST);
        let text = fs::read_to_string(&path).map_err(Error::file("read", &path))?;
        let ManifestForm { schema } = parse(&path, &text)?;
        if schema != SCHEMA {
            return Err(Error::format(
                &path,
                format!("it has format {schema}, and this program reads format {SCHEMA}"),
            ));
        }
        parse(&path, &text)
    }
}

fn parse<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T, Error> {
    serde_json::from_str(text).map_err(|error| Error::format(path, error.to_string()))
}
