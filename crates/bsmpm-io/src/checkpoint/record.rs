//! The record of a checkpoint: a JSON file with hashes of the HDF5 file and of itself, to detect damage.

use std::collections::BTreeSet;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::Error;

/// The number of this form of checkpoints; it grows when older readers would misunderstand a newer file.
pub const SCHEMA: u32 = 1;
/// What stands before the hash, between hash and record, and after the record.
const FRAME: [&str; 3] = ["{\"blake3\":\"", "\",\"record\":", "}\n"];
/// Hexadecimal digits of a BLAKE3.
const DIGITS: usize = 64;

/// What a number of an array is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ArrayNumber {
    /// A byte.
    U8,
    /// 16 bits without a sign.
    U16,
    /// 64 bits without a sign.
    U64,
    /// A float of double precision.
    F64,
}

impl ArrayNumber {
    /// Bytes of one.
    pub fn bytes(self) -> u64 {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::U64 | Self::F64 => 8,
        }
    }
}

/// One array of a checkpoint: a row for each point, or for each byte of a text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedArray {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub number: ArrayNumber,
    /// Rows of all ranks.
    pub rows: u64,
    /// Numbers of a row.
    pub width: u64,
}

impl RecordedArray {
    /// Bytes of all rows; none where they are more than can be counted.
    pub fn bytes(&self) -> Option<u64> {
        self.number.bytes().checked_mul(self.width)?.checked_mul(self.rows)
    }
}

/// What makes a checkpoint's file count.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckpointRecord {
    /// The form of the checkpoint, [`SCHEMA`].
    pub schema: u32,
    /// The version of the program that wrote it.
    pub version: String,
    /// Steps that were made.
    pub step: u64,
    /// The bits of the time that was reached (s or pseudo-time).
    pub time_bits: u64,
    /// BLAKE3 of the case's text, in hexadecimal.
    pub case: String,
    /// Ranks that wrote it.
    pub ranks: u32,
    /// Bytes of the file.
    pub bytes: u64,
    /// BLAKE3 of the file, in hexadecimal.
    pub blake3: String,
    /// Its arrays, in the order in which they were written.
    pub arrays: Vec<RecordedArray>,
}

impl CheckpointRecord {
    /// The time that was reached, s or pseudo-time.
    pub fn time(&self) -> f64 {
        f64::from_bits(self.time_bits)
    }

    /// The array of that name.
    pub fn array(&self, name: &str) -> Option<&RecordedArray> {
        self.arrays.iter().find(|array| array.name == name)
    }

    /// The text of the record's file.
    pub(super) fn text(&self) -> serde_json::Result<String> {
        let body = serde_json::to_string_pretty(self)?;
        let [before, between, after] = FRAME;
        Ok(format!(
            "{before}{}{between}{body}{after}",
            blake3::hash(body.as_bytes()).to_hex()
        ))
    }

    /// The record that a file's bytes hold, if they are the bytes that were written, of this form, and make sense.
    pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Self, Error> {
        Self::read(bytes).map_err(|reason| Error::checkpoint(path, reason))
    }

    /// The same; says in words what is wrong with the bytes.
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

    /// Nothing is compressed, so that the file's size bounds what its arrays can hold.
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

/// Hash and body of a record's file.
fn split(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let [before, between, after] = FRAME.map(str::as_bytes);
    let (hash, rest) = bytes.strip_prefix(before)?.split_at_checked(DIGITS)?;
    Some((hash, rest.strip_prefix(between)?.strip_suffix(after)?))
}
