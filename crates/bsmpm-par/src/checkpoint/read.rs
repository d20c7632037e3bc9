//! Finding and reading a checkpoint, on any number of ranks.

use super::refusal::{Refusal, agree, broadcast};
use super::{STATE, form, named};
use crate::exit;
use bsmpm::points::Column;
use bsmpm_io::checkpoint::{self, Found, Record};
use hdf5_collective::{Hdf5, Reader, Shape};
use mpi::topology::{Communicator, SimpleCommunicator};
use std::ffi::OsString;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::path::Path;

/// Which checkpoint is to be gone on from.
#[derive(Clone, Copy, Debug)]
pub enum Wanted<'a> {
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
pub fn find(world: &SimpleCommunicator, wanted: Wanted<'_>) -> Result<(Option<Found>, Vec<String>), Refusal> {
    let first = world.rank() == 0;
    let looked = if first { look(wanted) } else { Ok((None, Vec::new())) };
    let (found, passed_over) = agree(world, looked)?;
    let (record, path) = found.as_ref().map_or_else(Default::default, |found| {
        let record = serde_json::to_vec(&found.record).unwrap_or_default();
        (record, found.path.as_os_str().as_bytes().to_vec())
    });
    let (record, path) = (broadcast(world, 0, record), broadcast(world, 0, path));
    let record: Option<Record> = serde_json::from_slice(&record).ok();
    Ok((record.map(|record| Found { path: OsString::from_vec(path).into(), record }), passed_over))
}

fn look(wanted: Wanted<'_>) -> Result<(Option<Found>, Vec<String>), Refusal> {
    Ok(match wanted {
        Wanted::Newest(folder) => {
            let (found, damaged) = checkpoint::newest(folder)?;
            (found, damaged.iter().map(ToString::to_string).collect())
        }
        Wanted::Named(path) => (Some(checkpoint::named(path)?), Vec::new()),
    })
}

/// Reads an equal share of the rows of every column, in the order of the ranks, behind those that the columns hold, and
/// returns the text. Collective.
///
/// # Errors
/// The same on all ranks (76): the file holds other arrays than its record says or than are wanted, or cannot be read.
pub fn read(
    (hdf5, world): (&Hdf5<'_>, &SimpleCommunicator),
    found: &Found,
    columns: Vec<(&'static str, &mut dyn Column)>,
) -> Result<Vec<u8>, Refusal> {
    let refused = |reason: String| {
        Refusal::new(exit::CHECKPOINT, format!("the checkpoint {} cannot be used: {reason}", found.path.display()))
    };
    let library = |error: hdf5_collective::Error| refused(error.to_string());
    let reader = Reader::open(hdf5, &found.path).map_err(library);
    let reader = agree(world, reader)?;
    let arrays = reader.arrays().map_err(library);
    let arrays = agree(world, arrays.and_then(|arrays| expected(&arrays, found, &columns).map_err(refused)))?;
    for ((name, column), shape) in columns.into_iter().zip(arrays.columns) {
        let bytes = agree(world, reader.share(name, shape).map_err(library))?;
        let mut rest = &bytes[..];
        while !rest.is_empty() {
            column.take(&mut rest);
        }
    }
    let state = agree(world, reader.whole(STATE, arrays.state).map_err(library))?;
    agree(world, reader.close().map_err(library))?;
    Ok(state)
}

/// Shapes of the arrays of a file that are to be read.
struct Expected {
    columns: Vec<Shape>,
    state: Shape,
}

/// The file's arrays are those of the record, and the columns are all of them but the text.
fn expected(
    arrays: &[(String, Shape)],
    found: &Found,
    columns: &[(&'static str, &mut dyn Column)],
) -> Result<Expected, String> {
    let recorded = |(name, shape): &&(String, Shape)| found.record.array(name) == Some(&named(name, *shape));
    if let Some((name, _)) = arrays.iter().find(|array| !recorded(array)) {
        return Err(format!("the array {name} is not as its record says"));
    }
    if arrays.len() != found.record.arrays.len() || arrays.len() != columns.len() + 1 {
        let names: Vec<&str> = arrays.iter().map(|(name, _)| name.as_str()).collect();
        return Err(format!("it holds the arrays {}, which are not those that are needed", names.join(", ")));
    }
    let shape = |name: &str| {
        let array = arrays.iter().find(|(held, _)| held == name);
        array.map(|&(_, shape)| shape).ok_or_else(|| format!("it holds no array {name}"))
    };
    let state = shape(STATE)?;
    let rows = columns.first().map_or(Ok(0), |(name, _)| shape(name).map(|shape| shape.rows))?;
    let column = |(name, column): &(&'static str, &mut dyn Column)| {
        let (number, width) = form(&**column);
        let wanted = Shape { number, rows, width };
        shape(name).and_then(|found| {
            if found == wanted { Ok(found) } else { Err(format!("the array {name} is of another kind")) }
        })
    };
    let shapes = columns.iter().map(column).collect::<Result<_, _>>()?;
    let text = Shape { number: hdf5_collective::Number::U8, width: 1, ..state };
    if state == text { Ok(Expected { columns: shapes, state }) } else { Err(format!("the array {STATE} is no text")) }
}
