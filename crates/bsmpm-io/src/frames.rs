//! The frames of a run: `frames/step_*.vtu`, and `frames.pvd`, which gives each its time and is what ParaView opens.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::frame::{Frame, Parts};
use crate::relative::is_plain_relative;
use crate::xml::tags;
use crate::{Error, atomic, vtu};

/// The file that lists the frames.
pub const COLLECTION: &str = "frames.pvd";

/// One line of the list of frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// s, or the pseudo-time of a quasi-static analysis.
    pub time: f64,
    /// The frame's file, relative to the output directory, with `/` between its parts.
    pub file: String,
}

/// Writes the frames of one run.
#[derive(Debug)]
pub struct Frames {
    directory: PathBuf,
    entries: Vec<Entry>,
}

impl Frames {
    /// Makes the folder `frames` in an output directory. The list appears with the first frame.
    ///
    /// # Errors
    /// [`Error::File`] when the folder cannot be made.
    pub fn create(directory: &Path) -> Result<Self, Error> {
        let folder = directory.join("frames");
        fs::create_dir_all(&folder).map_err(Error::file("create", &folder))?;
        Ok(Self { directory: directory.to_owned(), entries: Vec::new() })
    }

    /// Goes on with the frames of a run, those of `entries` that are there, and lists them anew.
    ///
    /// # Errors
    /// [`Error::File`] when the folder cannot be made or the list not written.
    pub fn resume(directory: &Path, entries: Vec<Entry>) -> Result<Self, Error> {
        let mut frames = Self::create(directory)?;
        frames.entries = entries;
        frames.entries.retain(|entry| is_plain_relative(&entry.file) && directory.join(&entry.file).is_file());
        write_collection(&directory.join(COLLECTION), &frames.entries)?;
        Ok(frames)
    }

    /// Where the frame of a step is written, relative to the output directory: for the manifest, which must name an
    /// output before it is there.
    pub fn file(step: u64) -> String {
        format!("frames/step_{step:09}.vtu")
    }

    /// Writes a frame, then the list with the frame in it. A frame of the same step replaces the one before.
    ///
    /// # Errors
    /// Those of [`vtu::write`]; the list then names the frames before only.
    pub fn write(&mut self, frame: &Frame) -> Result<(), Error> {
        vtu::write(&self.directory.join(Self::file(frame.step)), frame)?;
        self.list(frame)
    }

    /// The same of a frame whose points come part by part.
    ///
    /// # Errors
    /// Those of [`vtu::write_parts`]; the list then names the frames before only.
    pub fn write_parts(&mut self, parts: Parts<'_>) -> Result<(), Error> {
        let head = parts.head.clone();
        vtu::write_parts(&self.directory.join(Self::file(head.step)), parts)?;
        self.list(&head)
    }

    fn list(&mut self, frame: &Frame) -> Result<(), Error> {
        let file = Self::file(frame.step);
        self.entries.retain(|entry| entry.file != file);
        self.entries.push(Entry { time: frame.time, file });
        write_collection(&self.directory.join(COLLECTION), &self.entries)
    }

    /// The frames written so far, in their order.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }
}

fn write_collection(path: &Path, entries: &[Entry]) -> Result<(), Error> {
    atomic::replace(path, |list| {
        writeln!(list, "<?xml version=\"1.0\"?>")?;
        writeln!(list, "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>")?;
        for Entry { time, file } in entries {
            writeln!(list, "    <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{file}\"/>")?;
        }
        writeln!(list, "  </Collection>\n</VTKFile>")
    })
}

/// The frames that an output directory lists, in their order.
///
/// # Errors
/// [`Error::File`] without a readable `frames.pvd`; [`Error::Format`] for one that is not ours, or that names files
/// outside the directory.
pub fn read_collection(directory: &Path) -> Result<Vec<Entry>, Error> {
    let path = directory.join(COLLECTION);
    let text = fs::read_to_string(&path).map_err(Error::file("read", &path))?;
    tags(&text)
        .filter(|tag| tag.name == "DataSet")
        .map(|tag| {
            let time = tag.attribute("timestep").and_then(|time| time.parse::<f64>().ok());
            let file = tag.attribute("file").filter(|file| is_plain_relative(file));
            match (time.filter(|time| time.is_finite()), file) {
                (Some(time), Some(file)) => Ok(Entry { time, file: file.to_owned() }),
                _ => Err(Error::format(&path, "a DataSet has no good timestep or file")),
            }
        })
        .collect()
}
