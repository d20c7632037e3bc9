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

/// The manifest's file.
pub const MANIFEST: &str = "run.json";
/// The number of this form of the manifest; it grows when older readers would misunderstand a newer file.
pub const SCHEMA: u32 = 1;

/// Everything that `run.json` says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// The form of the file, [`SCHEMA`].
    pub schema: u32,
    /// How the run stands.
    pub status: Status,
    /// The program's exit code; none while it runs.
    pub exit_code: Option<u8>,
    /// The program's version.
    pub version: String,
    /// The command line, the program first.
    pub argv: Vec<String>,
    /// What was solved.
    pub case: ManifestCase,
    /// Versions of libraries and compilers, by name.
    #[serde(default)]
    pub versions: BTreeMap<String, String>,
    /// Processes of the run.
    pub ranks: u32,
    /// Threads of each process.
    pub threads: u32,
    /// Derived numbers of things: points, cells, active nodes, unknowns, ...
    #[serde(default)]
    pub sizes: BTreeMap<String, u64>,
    /// The region of the grid, for pictures.
    #[serde(default)]
    pub grid: Option<GridExtent>,
    /// Times (s or pseudo-time) whose pictures the case asks for.
    #[serde(default)]
    pub picture_times: Vec<f64>,
    /// What the program chose by itself.
    #[serde(default)]
    pub choices: Vec<ManifestChoice>,
    /// Every warning that was given.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// When the run began, RFC 3339 in UTC.
    pub start: String,
    /// When it ended.
    pub end: Option<String>,
    /// s  by the clock, by phase.
    #[serde(default)]
    pub timers: BTreeMap<String, f64>,
    /// What the ranks sent each other, by kind.
    #[serde(default)]
    pub communication: BTreeMap<String, Communication>,
    /// What solved the linear systems: `stiffness`, which the secants correct, `newton`, Newton's general ones, and
    /// `water`, those of the pore pressures.
    #[serde(default)]
    pub linear: BTreeMap<String, SolverNames>,
    /// How evenly the work lay on them; none on one rank.
    #[serde(default)]
    pub balance: Option<EnergyBalance>,
    /// Totals of the run so far.
    #[serde(default)]
    pub summary: Summary,
    /// Measures of how far the run can be trusted, by name, once it has ended; of what the scene contains.
    #[serde(default)]
    pub indicators: BTreeMap<String, Indicator>,
    /// How the state at the start was balanced, if the case gives it a stress.
    #[serde(default)]
    pub initial: Option<ManifestInitial>,
    /// The stages of the case that have begun, in the order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<ManifestStage>,
    /// What has left the grid through faces with outflow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outflow: Option<ManifestOutflow>,
    /// The case's checks, once they were made.
    #[serde(default)]
    pub checks: Vec<ManifestCheck>,
    /// The limit loads of a case that seeks them, once it has come to its end.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub limit_loads: Vec<ManifestLimitLoad>,
    /// Every file that the run wrote or is about to write, but for this one.
    #[serde(default)]
    pub outputs: Vec<ManifestOutput>,
    /// Units of the frames' fields, by name, once a frame was written.
    #[serde(default)]
    pub frame_units: BTreeMap<String, String>,
    /// Names of what the frames' fields number, by field, where frames have fields on request.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub frame_names: BTreeMap<String, Vec<String>>,
    /// The newest good checkpoint, relative to the directory.
    pub checkpoint: Option<String>,
    /// Where the run went on after it had stopped, first one first.
    #[serde(default)]
    pub restarts: Vec<ManifestRestart>,
    /// Why the run ended early.
    pub failure: Option<ManifestFailure>,
}

impl Manifest {
    /// The manifest of a run that begins now, on one rank and thread until the caller says otherwise.
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

    /// Names a file, relative to the directory, that is about to be written; a name that is there already stays once.
    pub fn name_output(&mut self, path: &str) {
        if !self.outputs.iter().any(|output| output.path == path) {
            self.outputs.push(ManifestOutput {
                path: path.to_owned(),
                bytes: None,
                blake3: None,
            });
        }
    }

    /// Notes the size and hash of named outputs that are complete, so that the end of the run need not read them again.
    pub fn complete(&mut self, written: Vec<ManifestOutput>) {
        for output in &mut self.outputs {
            if let Some(written) = written.iter().find(|written| written.path == output.path) {
                output.clone_from(written);
            }
        }
    }

    /// Notes the size and hash of every named output as it now stands in `directory`; one that is not there has none,
    /// and one that was complete and has kept its size is not read again.
    ///
    /// # Errors
    /// [`Error::File`] when a file cannot be read.
    pub fn seal(&mut self, directory: &Path) -> Result<(), Error> {
        self.outputs.iter_mut().try_for_each(|output| output.seal(directory))
    }

    /// Writes `run.json` into `directory`, replacing it in one go.
    ///
    /// # Errors
    /// [`Error::NotFinite`] with the key, before anything is written; [`Error::File`] when the system refuses.
    pub fn write(&self, directory: &Path) -> Result<(), Error> {
        let path = directory.join(MANIFEST);
        self.check(&path)?;
        atomic::replace(&path, |file| self.print(file))
    }

    fn print(&self, file: &mut impl Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut *file, self)?;
        file.write_all(b"\n")
    }

    /// JSON has no infinite numbers, and serde would write `null` for them.
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

    /// Every float of the manifest with its key.
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
    /// [`Error::File`] when there is none or the system refuses, [`Error::Format`] when it is not ours, or of a newer
    /// form.
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
