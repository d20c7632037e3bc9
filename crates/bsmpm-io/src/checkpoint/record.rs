//! The record of a checkpoint: a JSON file with hashes of the HDF5 file and of itself, to detect damage.

use std::collections::BTreeSet;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::Error;

/// Version of the checkpoint format. It increases when older readers would misunderstand a newer file.
pub const SCHEMA: u32 = 1;
/// Text before the hash, between hash and record, and after the record.
const FRAME: [&str; 3] = ["{\"blake3\":\"", "\",\"record\":", "}\n"];
/// Number of hexadecimal digits of a BLAKE3 hash.
const DIGITS: usize = 64;

/// Number format of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ArrayNumber {
    /// Byte.
    U8,
    /// Unsigned 16-bit integer.
    U16,
    /// Unsigned 64-bit integer.
    U64,
    /// Double-precision float.
    F64,
}

impl ArrayNumber {
    /// Returns the bytes of one number.
    pub fn bytes(self) -> u64 {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::U64 | Self::F64 => 8,
        }
    }
}

/// Array of a checkpoint, with one row per point, or per byte of a text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedArray {
    /// Name.
    pub name: String,
    /// Number format.
    pub number: ArrayNumber,
    /// Number of rows over all ranks.
    pub rows: u64,
    /// Count of numbers of a row.
    pub width: u64,
}

impl RecordedArray {
    /// Returns the bytes of all rows; `None` on overflow.
    pub fn bytes(&self) -> Option<u64> {
        self.number.bytes().checked_mul(self.width)?.checked_mul(self.rows)
    }
}

/// Record that makes a checkpoint file valid.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckpointRecord {
    /// Version of the checkpoint format, [`SCHEMA`].
    pub schema: u32,
    /// Version of the program that wrote it.
    pub version: String,
    /// Number of steps so far.
    pub step: u64,
    /// Bits of the time (s or pseudo-time).
    pub time_bits: u64,
    /// BLAKE3 hash of the case's text, in hexadecimal.
    pub case: String,
    /// Number of ranks that wrote it.
    pub ranks: u32,
    /// Size of the file in bytes.
    pub bytes: u64,
    /// BLAKE3 hash of the file, in hexadecimal.
    pub blake3: String,
    /// Arrays in the order in which they were written.
    pub arrays: Vec<RecordedArray>,
}

impl CheckpointRecord {
    /// Returns the time (s or pseudo-time).
    pub fn time(&self) -> f64 {
        f64::from_bits(self.time_bits)
    }

    /// Returns the array with the given name.
    pub fn array(&self, name: &str) -> Option<&RecordedArray> {
        self.arrays.iter().find(|array| array.name == name)
    }

    /// Returns the text of the record's file.
    pub(super) fn text(&self) -> serde_json::Result<String> {
        let body = serde_json::to_string_pretty(self)?;
        let [before, between, after] = FRAME;
        Ok(format!(
            "{before}{}{between}{body}{after}",
            blake3::hash(body.as_bytes()).to_hex()
        ))
    }

    /// Reads a record from a file's bytes, and checks its hash, format version and plausibility.
    pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Self, Error> {
        Self::read(bytes).map_err(|reason| Error::checkpoint(path, reason))
    }

    /// Reads a record as [`CheckpointRecord::parse`] does; the error is a text.
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let (hash, body) = split(bytes).ok_or("it is not the record of a checkpoint, or damaged")?;
        let found = blake3::hash(body);
        if found.to_hex().as_bytes() != hash {
            return Err("it is damaged (its checksum is wrong)".into());
        }
        #[derive(Deserialize)]
        struct RecordForm {
            schema: u32,
        }
        let RecordForm { schema } = serde_json::from_slice(body).map_err(|error| error.to_string())?;
        if schema != SCHEMA {
            return Err(format!(
                "it has format {schema}, and this program reads format {SCHEMA}"
            ));
        }
        let record: Self = serde_json::from_slice(body).map_err(|error| error.to_string())?;
        record.sense()?;
        Ok(record)
    }

    /// Checks the record for plausibility. Nothing is compressed, so the file's size limits that of its arrays.
    fn sense(&self) -> Result<(), String> {
        let mut names = BTreeSet::new();
        if let Some(array) = self.arrays.iter().find(|array| !names.insert(&array.name)) {
            return Err(format!("it names the array \"{}\" twice", array.name));
        }
        if let Some(array) = self.arrays.iter().find(|array| array.width == 0) {
            return Err(format!("rows of the array \"{}\" hold nothing", array.name));
        }
        let sum = self
            .arrays
            .iter()
            .try_fold(0_u64, |sum, array| sum.checked_add(array.bytes()?));
        match sum.filter(|&sum| sum <= self.bytes) {
            Some(_) if self.time().is_finite() => Ok(()),
            Some(_) => Err(format!("its time is {}", self.time())),
            None => Err(format!("its arrays cannot be in a file of {} bytes", self.bytes)),
        }
    }
}

/// Returns hash and body of a record's file.
fn split(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let [before, between, after] = FRAME.map(str::as_bytes);
    let (hash, rest) = bytes.strip_prefix(before)?.split_at_checked(DIGITS)?;
    Some((hash, rest.strip_prefix(between)?.strip_suffix(after)?))
}
