//! Continues the files of a run after a restart.

use super::{Headings, RunWriter, first};
use crate::checkpoint::{CheckpointState, Files};
use crate::cli::Arguments;
use crate::restart::ResumedRun;
use bsmpm_io::Error;
use bsmpm_io::checkpoint::{self, FoundCheckpoint, Store};
use bsmpm_io::directory::{ExistingRunPolicy, HISTORY, OutputDirectory};
use bsmpm_io::failure::FAILURE;
use bsmpm_io::frames::Frames;
use bsmpm_io::manifest::{Manifest, ManifestRestart};
use bsmpm_io::residuals::RESIDUALS;
use bsmpm_io::steps::STEPS;
use bsmpm_io::table::{CsvTable, TableColumn, TableMark};
use bsmpm_scene::Case;
use std::fs;
use std::path::Path;

impl RunWriter {
    /// Goes on with the files of a run as they were at a checkpoint: what was written later goes. From a checkpoint in
    /// another directory a new run begins there with the older one's rows.
    pub fn resume(
        held: OutputDirectory,
        arguments: &Arguments,
        case: &Case,
        ranks: usize,
        columns: Vec<TableColumn>,
        resumed: &ResumedRun<'_>,
    ) -> Result<Self, Error> {
        let here = held.path().to_owned();
        let (mut manifest, mut news) = manifest(first::manifest(arguments, case, ranks), resumed);
        news.extend(held.note().map(str::to_owned));
        let headings = Headings::of(case, &columns);
        let directory = claim(held, &headings, &mut manifest, resumed)?;
        let known = news.len();
        let tables = headings.resume(&here, &resumed.state, &mut news)?;
        let older = manifest.warnings.clone();
        manifest
            .warnings
            .extend(news.iter().filter(|warning| !older.contains(warning)).cloned());
        Ok(Self {
            residuals: tables.residuals,
            water_flows: case.flow.is_some(),
            profiles: tables.profiles,
            history: tables.history,
            steps: tables.steps,
            frames: Frames::resume(&here, resumed.state.files.frames.clone())?,
            store: None,
            has_gaps: news.len() > known,
            news,
            keep: case.output.checkpoint.keep,
            end: case.analysis.end,
            dt: case.analysis.dt,
            criteria: bsmpm_scene::model::criteria(case),
            faces: bsmpm_scene::model::faces(case, resumed.state.progress.t),
            least_reaction: bsmpm_scene::model::least_reaction(case),
            judges_stiffness: case.analysis.kind.is_timeless() && !case.has_prescribed_motion(),
            begins_with_stress: case.initial.is_some(),
            whole: case.geometry.whole(),
            directory,
            manifest,
            columns,
        })
    }

    /// How far the files have come; all of them are on the disk then. The manifest is written with the names of the
    /// checkpoint of that step.
    pub fn files(&mut self, step: u64) -> Result<Files, Error> {
        checkpoint::names(step)
            .iter()
            .for_each(|name| self.manifest.name_output(name));
        self.write_manifest()?;
        Ok(Files {
            manifest: self.manifest.clone(),
            history: self.history.mark()?,
            steps: self.steps.mark()?,
            residuals: self.residuals.as_ref().map(CsvTable::mark).transpose()?,
            profiles: self.profiles.iter().map(CsvTable::mark).collect::<Result<_, _>>()?,
            frames: self.frames.entries().to_vec(),
        })
    }

    /// Where checkpoints go; made when the first one is written.
    pub fn store(&mut self) -> Result<&Store, Error> {
        let keep = usize::try_from(self.keep).unwrap_or(usize::MAX);
        match &mut self.store {
            Some(store) => Ok(store),
            none => Ok(none.insert(Store::open(self.directory.path(), keep)?)),
        }
    }

    /// Notes a checkpoint in the manifest, which names those no longer that are gone.
    pub fn checkpointed(&mut self, found: &FoundCheckpoint) -> Result<(), Error> {
        let path = self.directory.path();
        let folder = format!("{}/", checkpoint::FOLDER);
        self.manifest
            .outputs
            .retain(|output| !output.path.starts_with(&folder) || path.join(&output.path).exists());
        let name = found
            .path
            .strip_prefix(path)
            .ok()
            .map(|path| path.to_string_lossy().into_owned());
        for output in self
            .manifest
            .outputs
            .iter_mut()
            .filter(|output| Some(&output.path) == name.as_ref())
        {
            (output.bytes, output.blake3) = (Some(found.record.bytes), Some(found.record.blake3.clone()));
        }
        self.manifest.checkpoint = name;
        self.write_manifest()
    }
}

/// The tables of a run that goes on.
struct Tables {
    history: CsvTable,
    steps: CsvTable,
    residuals: Option<CsvTable>,
    profiles: Vec<CsvTable>,
}

/// The directory whose tables are gone on with.
struct TableResumption<'a> {
    directory: &'a Path,
    /// the step that is made first
    first: u64,
    news: &'a mut Vec<String>,
}

impl TableResumption<'_> {
    fn table(&mut self, name: &str, headings: &[TableColumn], mark: &TableMark) -> Result<CsvTable, Error> {
        let path = self.directory.join(name);
        if path.exists() {
            return CsvTable::resume(&path, headings, mark);
        }
        let first = self.first;
        self.news.push(format!(
            "W0738: the file `{name}` of the earlier steps is missing, so the new file begins with step {first}. \
             If you need the earlier steps, restore the old file from a copy."
        ));
        CsvTable::create(&path, headings)
    }
}

impl Headings {
    /// The tables as far as they were; one that is not there begins again, which is reported in the `news`.
    fn resume(&self, directory: &Path, state: &CheckpointState, news: &mut Vec<String>) -> Result<Tables, Error> {
        let files = &state.files;
        let mut resumption = TableResumption {
            directory,
            first: state.steps + 1,
            news,
        };
        let mut profiles = Vec::new();
        for ((file, headings), mark) in self.profiles.iter().zip(&files.profiles) {
            profiles.push(resumption.table(file, headings, mark)?);
        }
        let residuals = self.residuals.as_ref().zip(files.residuals.as_ref());
        Ok(Tables {
            profiles,
            residuals: residuals
                .map(|(headings, mark)| resumption.table(RESIDUALS, headings, mark))
                .transpose()?,
            history: resumption.table(HISTORY, &self.history, &files.history)?,
            steps: resumption.table(STEPS, &self.steps, &files.steps)?,
        })
    }

    /// Nothing of a run is touched whose tables are not those of the checkpoint.
    fn verify(&self, directory: &Path, files: &Files) -> Result<(), Error> {
        let marked = [
            (HISTORY, Some(&self.history), Some(&files.history)),
            (STEPS, Some(&self.steps), Some(&files.steps)),
        ];
        let residuals = (RESIDUALS, self.residuals.as_ref(), files.residuals.as_ref());
        let profiles = self
            .profiles
            .iter()
            .zip(&files.profiles)
            .map(|((file, of), mark)| (&**file, Some(of), Some(mark)));
        for (name, headings, mark) in marked.into_iter().chain([residuals]).chain(profiles) {
            let path = directory.join(name);
            if let (Some(headings), Some(mark), true) = (headings, mark, path.exists()) {
                CsvTable::verify(&path, headings, mark)?;
            }
        }
        Ok(())
    }
}

/// Makes a directory that of the run that goes on, with its tables as far as they were: nothing is touched before they
/// were found to be the ones of the checkpoint. Files that were written later go.
fn claim(
    held: OutputDirectory,
    headings: &Headings,
    manifest: &mut Manifest,
    resumed: &ResumedRun<'_>,
) -> Result<OutputDirectory, Error> {
    let here = held.path().to_owned();
    if resumed.is_in(&here) {
        headings.verify(&here, &resumed.state.files)?;
        checkpoint::forget_beyond(&here, resumed.state.steps)?;
        return held.go_on(manifest);
    }
    let there = resumed.directory();
    there
        .as_ref()
        .map_or(Ok(()), |there| headings.verify(there, &resumed.state.files))?;
    manifest.outputs.retain(|output| !output.path.contains('/'));
    let directory = held.claim(ExistingRunPolicy::Refuse, manifest)?;
    there.map_or(Ok(()), |there| copy_tables(&there, &here, headings))?;
    Ok(directory)
}

/// The manifest of a run that goes on, the new one with all that the older one has counted and warned of; and the
/// warnings of this start.
fn manifest(new: Manifest, resumed: &ResumedRun<'_>) -> (Manifest, Vec<String>) {
    let old = resumed.state.files.manifest.clone();
    let mut checks = new.checks.clone();
    for check in &mut checks {
        let same = old
            .checks
            .iter()
            .find(|past| past.quantity == check.quantity && past.at == check.at);
        check.value = same.and_then(|past| past.value);
    }
    let news = new
        .warnings
        .iter()
        .filter(|warning| !old.warnings.contains(warning))
        .chain(&resumed.warnings);
    let news: Vec<String> = news.cloned().collect();
    let mut sizes = old.sizes;
    sizes.extend(new.sizes.clone());
    let path = &resumed.found.path;
    let checkpoint = resumed
        .directory()
        .and_then(|there| path.strip_prefix(there).ok().map(Path::to_owned));
    let checkpoint = checkpoint.as_ref().unwrap_or(path).to_string_lossy().into_owned();
    let mut restarts = resumed.restarts.clone();
    restarts.push(ManifestRestart {
        checkpoint: checkpoint.clone(),
        step: resumed.state.steps,
        ranks_before: old.ranks,
        ranks: new.ranks,
        start: new.start.clone(),
        changed: resumed.changed.clone(),
    });
    let mut outputs = old.outputs;
    outputs.retain(|output| output.path != FAILURE);
    let manifest = Manifest {
        start: old.start,
        timers: old.timers,
        communication: old.communication,
        linear: old.linear,
        balance: old.balance,
        summary: old.summary,
        initial: old.initial,
        stages: old.stages,
        outflow: old.outflow,
        outputs,
        checkpoint: Some(checkpoint),
        restarts,
        warnings: old.warnings,
        sizes,
        checks,
        ..new
    };
    (manifest, news)
}

/// Copies the tables of a run to a directory that has none.
fn copy_tables(from: &Path, to: &Path, headings: &Headings) -> Result<(), Error> {
    let profiles = headings.profiles.iter().map(|(file, _)| &**file);
    for name in [HISTORY, STEPS, RESIDUALS].into_iter().chain(profiles) {
        let from = from.join(name);
        let to = to.join(name);
        if from.is_file() {
            fs::copy(&from, &to).map_err(Error::file("copy", &from))?;
        }
    }
    Ok(())
}
