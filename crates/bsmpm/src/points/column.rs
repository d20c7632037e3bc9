//! Treats each array of the material points (one per quantity, one row per point) as rows of bytes, so that sorting,
//! migration between ranks and checkpoints need not know the type of the quantity.

use super::packed::{Components, PackedTensors};
use crate::tensor::Symmetric;
use nalgebra::SMatrix;
use rayon::prelude::*;

/// Number format of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// Unsigned 16-bit integer.
    U16,
    /// Unsigned 64-bit integer.
    U64,
    /// Double-precision float.
    F64,
}

/// Array of one quantity of the points, of any type, one row per point.
pub trait Column: Send {
    /// Returns the number format.
    fn number(&self) -> Number;
    /// Returns the count of numbers of a row.
    fn width(&self) -> usize;
    /// Returns the number of rows.
    fn rows(&self) -> usize;
    /// Returns the bytes of a row in a message or a file. Tensors have all their components there, in two dimensions,
    /// too.
    fn bytes(&self) -> usize;
    /// Returns the bytes of a row in memory.
    fn memory(&self) -> usize;
    /// Returns whether a row of a message or a file can be stored without loss: components that are not stored are
    /// zero.
    fn fits(&self, row: &[u8]) -> bool;
    /// Appends the numbers of row `p`.
    fn show(&self, p: usize, numbers: &mut Vec<f64>);
    /// Keeps the rows in `order`, in that order, and drops the others.
    fn reorder(&mut self, order: &[u32]);
    /// Appends row `p` to a message.
    fn put(&self, p: usize, message: &mut Vec<u8>);
    /// Appends the first row of `message` to the column and advances `message` past it. Panics if the message is
    /// shorter than a row.
    fn take(&mut self, message: &mut &[u8]);
}

/// Rows of floats whose width is set at run time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    pub(super) width: usize,
    pub(super) numbers: Vec<f64>,
}

impl Rows {
    /// Creates an array without rows.
    pub fn of(width: usize) -> Self {
        Self {
            width,
            numbers: Vec::new(),
        }
    }

    /// Appends a row of zeros.
    pub(super) fn push_zeros(&mut self) {
        self.numbers.resize(self.numbers.len() + self.width, 0.0);
    }

    /// Returns row `p`.
    #[inline]
    pub fn of_point(&self, p: usize) -> &[f64] {
        &self.numbers[p * self.width..][..self.width]
    }

    /// Iterates in parallel over all rows for changes. The width must not be 0.
    pub fn par_rows_mut(&mut self) -> impl IndexedParallelIterator<Item = &mut [f64]> {
        self.numbers.par_chunks_exact_mut(self.width)
    }

    /// Returns row `p` for changes.
    #[inline]
    pub fn of_point_mut(&mut self, p: usize) -> &mut [f64] {
        &mut self.numbers[p * self.width..][..self.width]
    }
}

impl Column for Rows {
    fn number(&self) -> Number {
        Number::F64
    }
    fn width(&self) -> usize {
        self.width
    }
    fn rows(&self) -> usize {
        self.numbers.len() / self.width.max(1)
    }
    fn bytes(&self) -> usize {
        8 * self.width
    }
    fn memory(&self) -> usize {
        8 * self.width
    }
    fn fits(&self, _row: &[u8]) -> bool {
        true
    }
    fn show(&self, p: usize, numbers: &mut Vec<f64>) {
        numbers.extend_from_slice(self.of_point(p));
    }
    fn reorder(&mut self, order: &[u32]) {
        let mut numbers = Vec::with_capacity(order.len() * self.width);
        order
            .iter()
            .for_each(|&p| numbers.extend_from_slice(self.of_point(p as usize)));
        self.numbers = numbers;
    }
    fn put(&self, p: usize, message: &mut Vec<u8>) {
        self.of_point(p).iter().for_each(|number| number.put(message));
    }
    fn take(&mut self, message: &mut &[u8]) {
        let (row, rest) = message.split_at(self.bytes());
        self.numbers.extend(row.chunks_exact(8).map(f64::take));
        *message = rest;
    }
}

impl<T: MessageRow> Column for Vec<T> {
    fn number(&self) -> Number {
        T::NUMBER
    }
    fn width(&self) -> usize {
        T::WIDTH
    }
    fn rows(&self) -> usize {
        self.len()
    }
    fn bytes(&self) -> usize {
        T::BYTES
    }
    fn memory(&self) -> usize {
        size_of::<T>()
    }
    fn fits(&self, _row: &[u8]) -> bool {
        true
    }
    fn show(&self, p: usize, numbers: &mut Vec<f64>) {
        self[p].show(numbers);
    }
    fn reorder(&mut self, order: &[u32]) {
        *self = order.iter().map(|&p| self[p as usize]).collect();
    }
    fn put(&self, p: usize, message: &mut Vec<u8>) {
        self[p].put(message);
    }
    fn take(&mut self, message: &mut &[u8]) {
        let (row, rest) = message.split_at(T::BYTES);
        self.push(T::take(row));
        *message = rest;
    }
}

impl<const D: usize, T: MessageRow + Components> Column for PackedTensors<D, T> {
    fn number(&self) -> Number {
        T::NUMBER
    }
    fn width(&self) -> usize {
        T::WIDTH
    }
    fn rows(&self) -> usize {
        self.len()
    }
    fn bytes(&self) -> usize {
        T::BYTES
    }
    fn memory(&self) -> usize {
        Self::memory_of_one()
    }
    fn fits(&self, row: &[u8]) -> bool {
        Self::holds(&T::take(row))
    }
    fn show(&self, p: usize, numbers: &mut Vec<f64>) {
        self.at(p).show(numbers);
    }
    fn reorder(&mut self, order: &[u32]) {
        *self = order.iter().map(|&p| self.at(p as usize)).collect();
    }
    fn put(&self, p: usize, message: &mut Vec<u8>) {
        self.at(p).put(message);
    }
    fn take(&mut self, message: &mut &[u8]) {
        let (row, rest) = message.split_at(T::BYTES);
        self.push(T::take(row));
        *message = rest;
    }
}

/// Row of fixed size that is sent between ranks bit by bit (little-endian).
trait MessageRow: Copy + Send {
    const NUMBER: Number;
    const WIDTH: usize;
    const BYTES: usize;
    fn show(&self, numbers: &mut Vec<f64>);
    fn put(&self, message: &mut Vec<u8>);
    fn take(row: &[u8]) -> Self;
}

macro_rules! number_rows {
    ($($number:ty, $kind:ident);*) => {$(
        impl MessageRow for $number {
            const NUMBER: Number = Number::$kind;
            const WIDTH: usize = 1;
            const BYTES: usize = size_of::<$number>();
            fn show(&self, numbers: &mut Vec<f64>) {
                numbers.push(*self as f64);
            }
            fn put(&self, message: &mut Vec<u8>) {
                message.extend_from_slice(&self.to_le_bytes());
            }
            fn take(row: &[u8]) -> Self {
                let mut bytes = [0; Self::BYTES];
                bytes.copy_from_slice(row);
                Self::from_le_bytes(bytes)
            }
        }
    )*};
}
number_rows!(u16, U16; u64, U64; f64, F64);

impl<const R: usize, const C: usize> MessageRow for SMatrix<f64, R, C> {
    const NUMBER: Number = Number::F64;
    const WIDTH: usize = R * C;
    const BYTES: usize = 8 * R * C;
    fn show(&self, numbers: &mut Vec<f64>) {
        numbers.extend(self.iter());
    }
    fn put(&self, message: &mut Vec<u8>) {
        self.iter().for_each(|entry| entry.put(message));
    }
    fn take(row: &[u8]) -> Self {
        Self::from_iterator(row.chunks_exact(8).map(f64::take))
    }
}

impl MessageRow for Symmetric {
    const NUMBER: Number = Number::F64;
    const WIDTH: usize = 6;
    const BYTES: usize = 48;
    fn show(&self, numbers: &mut Vec<f64>) {
        numbers.extend(self.0);
    }
    fn put(&self, message: &mut Vec<u8>) {
        self.0.iter().for_each(|entry| entry.put(message));
    }
    fn take(row: &[u8]) -> Self {
        let mut components = [0.0; 6];
        for (component, bytes) in components.iter_mut().zip(row.chunks_exact(8)) {
            *component = f64::take(bytes);
        }
        Self(components)
    }
}
