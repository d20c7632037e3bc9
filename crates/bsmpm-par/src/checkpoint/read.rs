//! Finds and reads a checkpoint on any number of ranks.

use super::refusal::{Refusal, agree, broadcast};
use super::{GUESS, STATE, form, named};
use bsmpm::points::Column;
use bsmpm_io::checkpoint::{self, CheckpointRecord, FoundCheckpoint};
use bsmpm_io::exit;
use hdf5_collective::{Hdf5, Reader, Shape};
use mpi::topology::{Communicator, SimpleCommunicator};
use std::ffi::OsString;
use std::ops::Range;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::{Path, PathBuf};

/// Which checkpoint is to be gone on from.
#[derive(Clone, Copy, Debug)]
pub enum CheckpointChoice<'a> {
    /// The newest good one in a folder.
    Newest(&'a Path),
    /// This one and no other.
    Named(&'a Path),
}

/// The checkpoint, if there is one, with every byte of it verified; and on the first rank what is wrong with newer ones
/// that had to be passed over. Collective.
///
/// # Errors
/// The same on all ranks: a checkpoint that was named is missing or damaged (76).
pub fn find(
    world: &SimpleCommunicator,
    wanted: CheckpointChoice<'_>,
) -> Result<(Option<FoundCheckpoint>, Vec<String>), Refusal> {
    let first = world.rank() == 0;
    let looked = if first { look(wanted) } else { Ok((None, Vec::new())) };
    let (found, passed_over) = agree(world, looked)?;
    let record = serde_json::to_vec(&found.as_ref().map(|found| &found.record));
    let record = agree(world, record.map_err(|error| unsent(&error)))?;
    let path = found
        .as_ref()
        .map_or_else(Vec::new, |found| found.path.as_os_str().as_bytes().to_vec());
    let record = broadcast(world, 0, record);
    let path = broadcast(world, 0, path);
    let record = serde_json::from_slice::<Option<CheckpointRecord>>(&record);
    let record = agree(world, record.map_err(|error| unsent(&error)))?;
    Ok((
        record.map(|record| FoundCheckpoint {
            path: OsString::from_vec(path).into(),
            record,
        }),
        passed_over,
    ))
}

fn unsent(error: &serde_json::Error) -> Refusal {
    Refusal::new(exit::BUG, format!("a record cannot be sent to all ranks: {error}"))
}

fn look(wanted: CheckpointChoice<'_>) -> Result<(Option<FoundCheckpoint>, Vec<String>), Refusal> {
    Ok(match wanted {
        CheckpointChoice::Newest(folder) => {
            let (found, damaged) = checkpoint::newest(folder)?;
            (found, damaged.iter().map(ToString::to_string).collect())
        }
        CheckpointChoice::Named(path) => (Some(checkpoint::named(path)?), Vec::new()),
    })
}

/// A checkpoint whose arrays are those of its record.
pub struct OpenCheckpoint<'h> {
    reader: Reader<'h>,
    world: SimpleCommunicator,
    arrays: Vec<(String, Shape)>,
    path: PathBuf,
}

impl<'h> OpenCheckpoint<'h> {
    /// Opens a checkpoint that was found. Collective.
    ///
    /// # Errors
    /// The same on all ranks (76): the file holds other arrays than its record says, or cannot be read.
    pub fn new(hdf5: &'h Hdf5<'h>, world: SimpleCommunicator, found: &FoundCheckpoint) -> Result<Self, Refusal> {
        visible(&world, found)?;
        let reader = Reader::open(hdf5, &found.path);
        let reader = agree(&world, reader.map_err(|error| unread(&found.path, &error)))?;
        let arrays = agree(&world, recorded(&reader, found))?;
        Ok(Self {
            reader,
            world,
            arrays,
            path: found.path.clone(),
        })
    }

    /// The text. Collective.
    ///
    /// # Errors
    /// The same on all ranks (76): it is no text, or cannot be read.
    pub fn state(&self) -> Result<Vec<u8>, Refusal> {
        let shape = self.shape(STATE, |found| Shape {
            number: hdf5_collective::Number::U8,
            rows: found.rows,
            width: 1,
        })?;
        self.read(self.reader.range(STATE, shape, 0..shape.rows))
    }

    /// An equal share of the rows of every column of the points, in the order of the ranks, behind those that the
    /// columns hold. Collective.
    ///
    /// # Errors
    /// The same on all ranks (76): the file holds other columns than are wanted, or numbers that the columns leave out;
    /// or they cannot be read.
    pub fn points(&self, columns: Vec<(&'static str, &mut dyn Column)>) -> Result<(), Refusal> {
        let held = self
            .arrays
            .iter()
            .filter(|(name, _)| ![STATE, GUESS].contains(&name.as_str()));
        if held.count() != columns.len() {
            let names: Vec<&str> = self.arrays.iter().map(|(name, _)| name.as_str()).collect();
            let reason = format!(
                "it holds the arrays {}, which are not those that are needed",
                names.join(", ")
            );
            return Err(refused(&self.path, &reason));
        }
        let rows = self.rows(columns.first().map_or(STATE, |(name, _)| name))?;
        for (name, column) in columns {
            let (number, width) = form(column);
            let shape = self.shape(name, |_| Shape { number, rows, width })?;
            let bytes = self.read(self.reader.share(name, shape))?;
            let fits = bytes.chunks_exact(column.bytes()).all(|row| column.fits(row));
            let outcome = if fits {
                Ok(())
            } else {
                let reason = format!("the array {name} has components out of the plane");
                Err(refused(&self.path, &reason))
            };
            agree(&self.world, outcome)?;
            let mut rest = &bytes[..];
            while !rest.is_empty() {
                column.take(&mut rest);
            }
        }
        Ok(())
    }

    /// Some `rows` of the nodal displacement from which the next step starts, which has as many as are given, `width`
    /// numbers each. Collective.
    ///
    /// # Errors
    /// The same on all ranks (76): it is not there, is of other nodes, or cannot be read.
    pub fn guess(&self, count: usize, width: usize, rows: Range<usize>) -> Result<Vec<f64>, Refusal> {
        let held = Shape {
            number: hdf5_collective::Number::F64,
            rows: count as u64,
            width: width as u64,
        };
        let shape = self.shape(GUESS, |_| held)?;
        let bytes = self.read(self.reader.range(GUESS, shape, rows.start as u64..rows.end as u64))?;
        Ok(bytes
            .chunks_exact(8)
            .map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap_or_default()))
            .collect())
    }

    /// Closes the file. Collective.
    ///
    /// # Errors
    /// The same on all ranks (76) if HDF5 cannot.
    pub fn close(self) -> Result<(), Refusal> {
        let Self {
            reader, world, path, ..
        } = self;
        agree(&world, reader.close().map_err(|error| unread(&path, &error)))
    }

    fn read(&self, read: hdf5_collective::Result<Vec<u8>>) -> Result<Vec<u8>, Refusal> {
        agree(&self.world, read.map_err(|error| unread(&self.path, &error)))
    }

    fn find(&self, name: &str) -> Result<Shape, Refusal> {
        let found = self
            .arrays
            .iter()
            .find(|(held, _)| held == name)
            .map(|&(_, shape)| shape);
        found.ok_or_else(|| refused(&self.path, &format!("it holds no array {name}")))
    }

    fn rows(&self, name: &str) -> Result<u64, Refusal> {
        self.find(name).map(|shape| shape.rows)
    }

    /// The shape of an array, if it is the one that is wanted.
    fn shape(&self, name: &str, wanted: impl Fn(Shape) -> Shape) -> Result<Shape, Refusal> {
        let found = self.find(name)?;
        if found == wanted(found) {
            Ok(found)
        } else {
            Err(refused(&self.path, &format!("the array {name} is of another kind")))
        }
    }
}

/// Refuses a file that not all ranks see as the first one has: the library would wait for a rank that cannot open it,
/// or each would read another. Collective.
fn visible(world: &SimpleCommunicator, found: &FoundCheckpoint) -> Result<(), Refusal> {
    let size = std::fs::File::open(&found.path)
        .and_then(|file| file.metadata())
        .map(|there| there.len());
    let own = match size {
        Ok(bytes) if bytes == found.record.bytes => Ok(()),
        Ok(bytes) => Err(format!(
            "rank {} sees {bytes} bytes, its record says {}",
            world.rank(),
            found.record.bytes
        )),
        Err(error) => Err(format!("rank {} cannot read it: {error}", world.rank())),
    };
    agree(world, own.map_err(|reason| refused(&found.path, &reason)))
}

fn refused(path: &Path, reason: &str) -> Refusal {
    Refusal::unusable(path, reason)
}

fn unread(path: &Path, error: &hdf5_collective::Error) -> Refusal {
    refused(path, &error.to_string())
}

/// The file's arrays, if they are those of the record. Collective.
fn recorded(reader: &Reader<'_>, found: &FoundCheckpoint) -> Result<Vec<(String, Shape)>, Refusal> {
    let path = &found.path;
    let arrays = reader.arrays().map_err(|error| unread(path, &error))?;
    for (name, shape) in &arrays {
        if found.record.array(name) != Some(&named(name, *shape)) {
            return Err(refused(path, &format!("the array {name} is not as its record says")));
        }
    }
    if arrays.len() == found.record.arrays.len() {
        Ok(arrays)
    } else {
        Err(refused(path, "arrays of its record are missing"))
    }
}
