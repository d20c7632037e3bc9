//! Writes frames (`frames/step_*.vtu`: all material points at one time) and their list (`frames.pvd`) on a separate
//! thread.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::thread::{self, JoinHandle};

use serde::{Deserialize, Serialize};

use crate::atomic::{self, FilledFile};
use crate::frame::{Frame, Parts};
use crate::manifest::{Manifest, ManifestOutput};
use crate::relative::is_plain_relative;
use crate::xml::tags;
use crate::{Error, vtu};

/// File that lists the frames.
pub const COLLECTION: &str = "frames.pvd";

/// Entry of the list of frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Time (s, or the pseudo-time of a quasi-static analysis).
    pub time: f64,
    /// File of the frame, relative to the output directory, with `/` as separator.
    pub file: String,
}

/// Largest number of frames that wait for the thread; each keeps a file open.
const MOST_FILLED: usize = 16;

/// Writer of the frames of one run.
#[derive(Debug)]
pub struct Frames {
    directory: PathBuf,
    entries: Vec<Entry>,        // listed frames
    filled: Vec<FilledFrame>,   // frames for the next thread, under temporary names
    manifest: Option<Manifest>, // contains their names
    ending: Option<FrameThread>,
}

/// Frame in a file that still has a temporary name.
#[derive(Debug)]
struct FilledFrame {
    file: FilledFile,
    entry: Entry,
}

/// Thread that completes frames.
#[derive(Debug)]
struct FrameThread {
    entries: Vec<Entry>, // listed frames after the thread has ended
    thread: JoinHandle<Result<Vec<ManifestOutput>, Error>>,
}

impl Frames {
    /// Creates the folder `frames` in an output directory, and removes incomplete files of a killed run. The list is
    /// created with the first frame.
    ///
    /// # Errors
    /// [`Error::File`] if the folder cannot be created.
    pub fn create(directory: &Path) -> Result<Self, Error> {
        let folder = directory.join("frames");
        fs::create_dir_all(&folder).map_err(Error::file("create", &folder))?;
        atomic::remove_temporaries(&folder).map_err(Error::file("clear", &folder))?;
        let directory = directory.to_owned();
        Ok(Self {
            directory,
            entries: Vec::new(),
            filled: Vec::new(),
            manifest: None,
            ending: None,
        })
    }

    /// Continues the frames of a run: lists those of `entries` that exist.
    ///
    /// # Errors
    /// [`Error::File`] if the folder cannot be created or the list not written.
    pub fn resume(directory: &Path, entries: Vec<Entry>) -> Result<Self, Error> {
        let mut frames = Self::create(directory)?;
        frames.entries = entries;
        frames
            .entries
            .retain(|entry| is_plain_relative(&entry.file) && directory.join(&entry.file).is_file());
        write_collection(&directory.join(COLLECTION), &frames.entries)?;
        Ok(frames)
    }

    /// Returns the file of a step's frame, relative to the output directory. The manifest must list an output before it
    /// is written.
    pub fn file(step: u64) -> String {
        format!("frames/step_{step:09}.vtu")
    }

    /// Writes a frame, then the list with the frame in it. The frame replaces one of the same step.
    ///
    /// # Errors
    /// The errors of [`vtu::write`]; the list then contains only the previous frames.
    pub fn write(&mut self, frame: &Frame) -> Result<(), Error> {
        vtu::write(&self.directory.join(Self::file(frame.step)), frame)?;
        enter(
            &mut self.entries,
            Entry {
                time: frame.time,
                file: Self::file(frame.step),
            },
        );
        write_collection(&self.directory.join(COLLECTION), &self.entries)
    }

    /// Writes a frame under a temporary name from points that are supplied in parts. A thread then writes the
    /// `manifest`, which lists the frame, renames the file and adds it to the list. [`Frames::ended`] reports when this
    /// is done.
    ///
    /// # Errors
    /// The errors of [`vtu::write_parts`], and of the thread with earlier frames.
    pub fn begin(&mut self, parts: Parts<'_>, manifest: &Manifest) -> Result<Vec<ManifestOutput>, Error> {
        let entry = Entry {
            time: parts.head.time,
            file: Self::file(parts.head.step),
        };
        // Two frames with the same name would have the same temporary name.
        let listed = self
            .ending
            .iter()
            .flat_map(|ending| &ending.entries)
            .chain(&self.entries);
        let is_there = self
            .filled
            .iter()
            .map(|frame| &frame.entry)
            .chain(listed)
            .any(|one| one.file == entry.file);
        let mut ended = self.ended(is_there || self.filled.len() >= MOST_FILLED)?;
        let file = vtu::filled(&self.directory.join(&entry.file), parts)?;
        self.filled.push(FilledFrame { file, entry });
        self.manifest = Some(manifest.clone());
        ended.extend(self.ended(false)?);
        Ok(ended)
    }

    /// Returns the frames that were completed since the last call, with sizes and hashes. With `wait`, it waits for all
    /// frames.
    ///
    /// # Errors
    /// The errors of the thread; frames that it had not received yet are lost.
    pub fn ended(&mut self, wait: bool) -> Result<Vec<ManifestOutput>, Error> {
        let mut ended = Vec::new();
        loop {
            if let Some(FrameThread { entries, thread }) =
                self.ending.take_if(|ending| wait || ending.thread.is_finished())
            {
                let outputs = thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
                ended.extend(outputs.inspect_err(|_| self.filled.clear())?);
                self.entries = entries;
            }
            if self.ending.is_some() || self.filled.is_empty() {
                return Ok(ended);
            }
            let filled = std::mem::take(&mut self.filled);
            let manifest = self.manifest.take();
            let mut entries = self.entries.clone();
            filled.iter().for_each(|frame| enter(&mut entries, frame.entry.clone()));
            let directory = self.directory.clone();
            let all = entries.clone();
            let thread = thread::spawn(move || end(&directory, filled, manifest, &all));
            self.ending = Some(FrameThread { entries, thread });
        }
    }

    /// Returns the listed frames in their order.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }
}

/// Adds a frame to the list, replacing one of the same step.
fn enter(entries: &mut Vec<Entry>, entry: Entry) {
    entries.retain(|other| other.file != entry.file);
    entries.push(entry);
}

/// Renames frames after writing the manifest that lists them, and writes the list of frames.
fn end(
    directory: &Path,
    filled: Vec<FilledFrame>,
    manifest: Option<Manifest>,
    entries: &[Entry],
) -> Result<Vec<ManifestOutput>, Error> {
    manifest.map_or(Ok(()), |manifest| manifest.write(directory))?;
    let mut outputs = Vec::new();
    for FilledFrame { file, entry } in filled {
        file.give_name()?;
        outputs.push(ManifestOutput {
            path: entry.file,
            bytes: None,
            blake3: None,
        });
    }
    let first = outputs.first().map(|output| directory.join(&output.path));
    first.map_or(Ok(()), |first| {
        atomic::sync_folder(&first).map_err(Error::file("write", &first))
    })?;
    write_collection(&directory.join(COLLECTION), entries)?;
    outputs.iter_mut().try_for_each(|output| output.complete(directory))?;
    Ok(outputs)
}

fn write_collection(path: &Path, entries: &[Entry]) -> Result<(), Error> {
    atomic::replace(path, |list| {
        writeln!(list, "<?xml version=\"1.0\"?>")?;
        writeln!(
            list,
            "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>"
        )?;
        for Entry { time, file } in entries {
            writeln!(list, "    <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{file}\"/>")?;
        }
        writeln!(list, "  </Collection>\n</VTKFile>")
    })
}

/// Returns the frames listed in an output directory, in their order.
///
/// # Errors
/// [`Error::File`] without a readable `frames.pvd`; [`Error::Format`] if this program did not write it, or if it lists
/// files outside the directory.
pub fn read_collection(directory: &Path) -> Result<Vec<Entry>, Error> {
    let path = directory.join(COLLECTION);
    let text = fs::read_to_string(&path).map_err(Error::file("read", &path))?;
    tags(&text)
        .filter(|tag| tag.name == "DataSet")
        .map(|tag| {
            let time = tag.attribute("timestep").and_then(|time| time.parse::<f64>().ok());
            let file = tag.attribute("file").filter(|file| is_plain_relative(file));
            match (time.filter(|time| time.is_finite()), file) {
                (Some(time), Some(file)) => Ok(Entry {
                    time,
                    file: file.to_owned(),
                }),
                _ => Err(Error::format(&path, "a DataSet has no good timestep or file")),
            }
        })
        .collect()
}
