//! Stores tensors without the components that are zero in two dimensions.

use crate::tensor::{Symmetric, Tensor};
use crate::threads;
use std::marker::PhantomData;
use std::sync::Mutex;

/// Tensor as an array of numbers.
pub trait Components: Copy + Send {
    /// Positions of the components in a plane and along its normal, ascending.
    const IN_PLANE: &'static [usize];
    /// Positions of all components.
    const ALL: &'static [usize];

    /// Returns all components.
    fn numbers(&self) -> &[f64];

    /// Creates a tensor from `numbers` at the positions `places`, and zeros elsewhere.
    fn with(places: &[usize], numbers: &[f64]) -> Self;
}

impl Components for Tensor {
    const IN_PLANE: &'static [usize] = &[0, 1, 3, 4, 8]; // xx, yx, xy, yy, zz: by columns
    const ALL: &'static [usize] = &[0, 1, 2, 3, 4, 5, 6, 7, 8];

    #[inline(always)]
    fn numbers(&self) -> &[f64] {
        self.as_slice()
    }

    #[inline(always)]
    fn with(places: &[usize], numbers: &[f64]) -> Self {
        let mut whole = Self::zeros();
        places
            .iter()
            .zip(numbers)
            .for_each(|(&place, &number)| whole[place] = number);
        whole
    }
}

impl Components for Symmetric {
    const IN_PLANE: &'static [usize] = &[0, 1, 2, 3]; // XX, YY, ZZ, XY
    const ALL: &'static [usize] = &[0, 1, 2, 3, 4, 5];

    #[inline(always)]
    fn numbers(&self) -> &[f64] {
        &self.0
    }

    #[inline(always)]
    fn with(places: &[usize], numbers: &[f64]) -> Self {
        let mut whole = Self::default();
        places
            .iter()
            .zip(numbers)
            .for_each(|(&place, &number)| whole.0[place] = number);
        whole
    }
}

/// Array of tensors. For `D` = 2 only 5 of 9 components, or 4 of 6 of a symmetric tensor, are stored; otherwise all
/// are. The sign of a zero component that is not stored is lost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PackedTensors<const D: usize, T> {
    numbers: Vec<f64>, // stored components, tensor by tensor
    whole: PhantomData<T>,
}

impl<const D: usize, T: Components> PackedTensors<D, T> {
    /// Positions of the stored components.
    const PLACES: &'static [usize] = if D == 2 { T::IN_PLANE } else { T::ALL };
    /// Number of stored components per tensor.
    const STRIDE: usize = Self::PLACES.len();

    /// Returns the number of tensors.
    pub fn len(&self) -> usize {
        self.numbers.len() / Self::STRIDE
    }

    /// Returns whether there are no tensors.
    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// Returns the bytes of one tensor in memory.
    pub(super) const fn memory_of_one() -> usize {
        Self::STRIDE * size_of::<f64>()
    }

    /// Returns whether all components of a tensor that are not stored are zero.
    pub fn holds(tensor: &T) -> bool {
        let mut others = tensor
            .numbers()
            .iter()
            .enumerate()
            .filter(|(place, _)| !Self::PLACES.contains(place));
        others.all(|(_, &number)| number == 0.0)
    }

    /// Returns whether storing a tensor loses nothing that matters: the other components are zero, or a stored
    /// component is not finite, so that the step will be rejected.
    fn sends_all(tensor: &T) -> bool {
        Self::holds(tensor) || Self::PLACES.iter().any(|&place| !tensor.numbers()[place].is_finite())
    }

    /// Returns the tensor of point `p`.
    #[inline(always)]
    pub fn at(&self, p: usize) -> T {
        Self::read(&self.numbers, p)
    }

    #[inline(always)]
    fn read(numbers: &[f64], p: usize) -> T {
        T::with(Self::PLACES, &numbers[p * Self::STRIDE..][..Self::STRIDE])
    }

    #[inline(always)]
    fn keep(numbers: &mut [f64], p: usize, tensor: T) {
        debug_assert!(Self::sends_all(&tensor), "of {:?} not all is held", tensor.numbers());
        let row = &mut numbers[p * Self::STRIDE..][..Self::STRIDE];
        row.iter_mut()
            .zip(Self::PLACES)
            .for_each(|(number, &place)| *number = tensor.numbers()[place]);
    }

    /// Sets the tensor of point `p`. Components that are not stored must be zero.
    #[inline(always)]
    pub fn set(&mut self, p: usize, tensor: T) {
        Self::keep(&mut self.numbers, p, tensor);
    }

    /// Returns the tensors in chunks of points, each for one thread at a time.
    pub fn apart(&mut self) -> Vec<Mutex<PackedChunk<'_, D, T>>> {
        let chunks = self.numbers.chunks_mut(Self::STRIDE * threads::CHUNK);
        chunks
            .map(|numbers| {
                Mutex::new(PackedChunk {
                    numbers,
                    whole: PhantomData,
                })
            })
            .collect()
    }

    /// Appends the tensor of a new point. Components that are not stored must be zero.
    #[inline(always)]
    pub fn push(&mut self, tensor: T) {
        debug_assert!(Self::sends_all(&tensor), "of {:?} not all is held", tensor.numbers());
        self.numbers
            .extend(Self::PLACES.iter().map(|&place| tensor.numbers()[place]));
    }

    /// Sets the tensor of every point. Components that are not stored must be zero.
    pub fn fill(&mut self, tensor: T) {
        (0..self.len()).for_each(|p| self.set(p, tensor));
    }

    /// Iterates over all tensors, point by point.
    pub fn iter(&self) -> impl Iterator<Item = T> {
        (0..self.len()).map(|p| self.at(p))
    }
}

/// Chunk of consecutive tensors of [`PackedTensors`].
#[derive(Debug)]
pub struct PackedChunk<'a, const D: usize, T> {
    numbers: &'a mut [f64],
    whole: PhantomData<T>,
}

impl<const D: usize, T: Components> PackedChunk<'_, D, T> {
    /// Returns tensor `k` of the chunk.
    #[inline(always)]
    pub fn at(&self, k: usize) -> T {
        PackedTensors::<D, T>::read(self.numbers, k)
    }

    /// Sets tensor `k` of the chunk. Components that are not stored must be zero.
    #[inline(always)]
    pub fn set(&mut self, k: usize, tensor: T) {
        PackedTensors::<D, T>::keep(self.numbers, k, tensor);
    }
}

impl<const D: usize, T: Components> FromIterator<T> for PackedTensors<D, T> {
    fn from_iter<I: IntoIterator<Item = T>>(tensors: I) -> Self {
        let tensors = tensors.into_iter();
        let numbers = Vec::with_capacity(tensors.size_hint().0 * Self::STRIDE);
        let mut held = Self {
            numbers,
            whole: PhantomData,
        };
        tensors.for_each(|tensor| held.push(tensor));
        held
    }
}

impl<const D: usize> PackedTensors<D, Symmetric> {
    /// Returns the components XX, YY, ZZ, XY of every tensor if `D` = 2.
    #[inline(always)]
    pub fn planar(&self) -> Option<&[[f64; 4]]> {
        (D == 2).then(|| self.numbers.as_chunks().0)
    }

    /// Returns all components of every tensor if `D` is not 2.
    #[inline(always)]
    pub fn whole(&self) -> Option<&[[f64; 6]]> {
        (D != 2).then(|| self.numbers.as_chunks().0)
    }
}
