//! Writes a checkpoint from all ranks.

use super::refusal::{Refusal, agree, broadcast};
use super::{GUESS, STATE, form, named};
use crate::launch;
use bsmpm::points::{Column, Number};
use bsmpm_io::checkpoint::{Facts, FoundCheckpoint, PendingCheckpoint, Phase, Store};
use bsmpm_io::exit;
use hdf5_collective::{Hdf5, Shape, Writer};
use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::topology::{Communicator, SimpleCommunicator};
use std::borrow::Cow;
use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};

/// What a checkpoint holds: this rank's rows, and a text that is the same on all ranks.
pub struct Contents<'a> {
    /// The columns by name, all with as many rows as this rank has points.
    pub columns: Vec<(&'static str, &'a mut dyn Column)>,
    /// The displacement of the nodes that this rank owns, m, layer by layer, or row by row where slabs have parts; and
    /// how many numbers one has.
    pub guess: (Cow<'a, [f64]>, usize),
    /// Everything else.
    pub state: &'a [u8],
}

/// Writes the checkpoint of a step, and returns it on the first rank, which is the one with a store. One of that step
/// that is good already is left as it is. `at` hears of every phase, those after [`Phase::Written`] on the first rank
/// only. Collective.
///
/// When HDF5 fails with the file open, this ends the job on all ranks: it might crash in a normal exit, or leave ranks
/// waiting.
///
/// # Errors
/// The same on all ranks, with nothing left of the new checkpoint and all older ones good: no room (74), trouble with
/// the file (74), a number that is not finite (81).
pub fn write(
    hdf5: &Hdf5<'_>,
    world: &SimpleCommunicator,
    store: Option<&Store>,
    facts: &Facts,
    contents: &Contents<'_>,
    at: &dyn Fn(Phase),
) -> Result<Option<FoundCheckpoint>, Refusal> {
    agree(world, finite(facts.step, contents))?;
    let shapes = shapes(world, contents);
    let room = hdf5_collective::room(shapes.iter().map(|&(_, shape)| shape));
    let begun = store.map(|store| begin(store, facts, room)).transpose();
    let (existing, pending) = match agree(world, begun)? {
        None => (None, None),
        Some(Begun::Existing(found)) => (Some(found), None),
        Some(Begun::Pending(pending)) => (None, Some(pending)),
    };
    let own = pending
        .as_ref()
        .map_or_else(Vec::new, |pending| pending.path().as_os_str().as_bytes().to_vec());
    let path = broadcast(world, 0, own);
    if path.is_empty() {
        return Ok(existing);
    }
    let path = PathBuf::from(OsStr::from_bytes(&path));
    visible(world, &path)?;
    let fill = Fill {
        hdf5,
        world,
        path: &path,
        at,
    };
    fill.all(pending.as_ref(), room, contents)?;
    let arrays = shapes.into_iter().map(|(name, shape)| named(name, shape)).collect();
    let committed = store
        .zip(pending)
        .map(|(store, pending)| store.commit(pending, facts, arrays, at));
    agree(world, committed.transpose().map_err(Refusal::from))
}

enum Begun {
    Existing(FoundCheckpoint),
    Pending(PendingCheckpoint),
}

fn begin(store: &Store, facts: &Facts, room: u64) -> Result<Begun, Refusal> {
    Ok(match store.existing(facts)? {
        Some(found) => Begun::Existing(found),
        None => Begun::Pending(store.begin(facts.step, room)?),
    })
}

/// Bytes of a checkpoint with these contents, rather too many. Collective.
pub(crate) fn room(world: &SimpleCommunicator, contents: &Contents<'_>) -> u64 {
    hdf5_collective::room(shapes(world, contents).into_iter().map(|(_, shape)| shape))
}

/// The arrays of all ranks. Collective.
fn shapes(world: &SimpleCommunicator, contents: &Contents<'_>) -> Vec<(&'static str, Shape)> {
    let mut own: Vec<u64> = contents
        .columns
        .iter()
        .map(|(_, column)| column.rows() as u64)
        .collect();
    let guess = &contents.guess.0;
    let width = contents.guess.1;
    own.push((guess.len() / width) as u64);
    let mut all = vec![0; own.len()];
    world.all_reduce_into(&own[..], &mut all[..], SystemOperation::sum());
    let layers = all.pop().unwrap_or_default();
    let mut shapes = Vec::new();
    for ((name, column), rows) in contents.columns.iter().zip(all) {
        let (number, width) = form(&**column);
        shapes.push((*name, Shape { number, rows, width }));
    }
    let text = Shape {
        number: hdf5_collective::Number::U8,
        rows: contents.state.len() as u64,
        width: 1,
    };
    let guess = Shape {
        number: hdf5_collective::Number::F64,
        rows: layers,
        width: width as u64,
    };
    shapes.extend([(GUESS, guess), (STATE, text)]);
    shapes
}

/// Refuses a file that not all ranks see: the library would wait for a rank that cannot open it, or each host would
/// fill one of its own. Collective.
fn visible(world: &SimpleCommunicator, path: &Path) -> Result<(), Refusal> {
    let opened = std::fs::File::options().write(true).open(path);
    let outcome = opened.map(drop).map_err(|error| {
        let rank = world.rank();
        let path = path.display();
        let reason = format!(
            "E0717: rank {rank} cannot write to the checkpoint `{path}`: {error}. The checkpoint is incomplete. Use \
             an output directory that all hosts share."
        );
        Refusal::new(exit::WRITE, reason)
    });
    agree(world, outcome)
}

/// No number that is not finite ever reaches a file.
fn finite(step: u64, contents: &Contents<'_>) -> Result<(), Refusal> {
    for (name, column) in contents
        .columns
        .iter()
        .filter(|(_, column)| column.number() == Number::F64)
    {
        if let Some((point, value)) = infinite(&**column) {
            let reason = format!(
                "E0725: the checkpoint of step {step} cannot be written: `{name}` of material point {point} is {value}. The run ends. \
                 Continue from the last checkpoint with smaller steps."
            );
            return Err(Refusal::new(exit::LEFT, reason));
        }
    }
    match contents.guess.0.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(value) => Err(Refusal::new(
            exit::LEFT,
            format!(
                "E0725: the checkpoint of step {step} cannot be written: a nodal displacement is {value}. The run ends. Continue from the \
                 last checkpoint with smaller steps."
            ),
        )),
    }
}

/// The first row of a column of floats that holds a number which is not finite, and that number.
pub(super) fn infinite(column: &dyn Column) -> Option<(usize, f64)> {
    let bytes = rows(column);
    let mut numbers = bytes
        .chunks_exact(8)
        .map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap_or_default()));
    let at = numbers.clone().position(|value| !value.is_finite())?;
    Some((at / column.width(), numbers.nth(at)?))
}

/// All rows of a column in little-endian bytes.
fn rows(column: &dyn Column) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(column.rows() * column.bytes());
    (0..column.rows()).for_each(|p| column.put(p, &mut bytes));
    bytes
}

/// The file while it is filled.
struct Fill<'a> {
    hdf5: &'a Hdf5<'a>,
    world: &'a SimpleCommunicator,
    path: &'a Path,
    at: &'a dyn Fn(Phase),
}

impl Fill<'_> {
    fn all(&self, pending: Option<&PendingCheckpoint>, room: u64, contents: &Contents<'_>) -> Result<(), Refusal> {
        let created = Writer::create(self.hdf5, self.path);
        let mut writer = created.map_err(|error| Refusal::new(exit::WRITE, self.reason(&error)))?;
        // HDF5 has emptied the file, and given the room back.
        let reserved = pending.map_or(Ok(()), |pending| pending.reserve(room));
        agree(self.world, reserved.map_err(Refusal::from)).unwrap_or_else(|refusal| self.end(&refusal.reason));
        (self.at)(Phase::Opened);
        let filled = self.columns(&mut writer, contents).and_then(|()| {
            (self.at)(Phase::Written);
            writer.close()
        });
        filled.unwrap_or_else(|error| self.end(&self.reason(&error)));
        Ok(())
    }

    fn columns(&self, writer: &mut Writer<'_>, contents: &Contents<'_>) -> hdf5_collective::Result<()> {
        let half = contents.columns.len() / 2;
        for (index, (name, column)) in contents.columns.iter().enumerate() {
            if index == half {
                (self.at)(Phase::Midway);
            }
            let (number, width) = form(&**column);
            writer.write(name, number, width, &rows(&**column))?;
        }
        let guess = &contents.guess.0;
        let width = contents.guess.1;
        let bytes: Vec<u8> = guess.iter().flat_map(|value| value.to_le_bytes()).collect();
        writer.write(GUESS, hdf5_collective::Number::F64, width as u64, &bytes)?;
        let text = if self.world.rank() == 0 { contents.state } else { &[] };
        writer.write(STATE, hdf5_collective::Number::U8, 1, text).map(|_| ())
    }

    fn reason(&self, error: &hdf5_collective::Error) -> String {
        let path = self.path.display();
        format!(
            "E0718: checkpoint `{path}` cannot be written: {error}. The run ends. Check the disk, and continue with `--restart auto`."
        )
    }

    /// Removes the file and ends the job.
    fn end(&self, reason: &str) -> ! {
        // Another rank may have been faster.
        let _ = std::fs::remove_file(self.path);
        launch::end(self.world, exit::WRITE, &reason)
    }
}
