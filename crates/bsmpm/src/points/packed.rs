//! Stores tensors without the components that are zero in two dimensions.

use crate::tensor::{Symmetric, Tensor};
use crate::threads;
use std::marker::PhantomData;
use std::sync::Mutex;

/// Numbers that a whole tensor consists of.
pub trait Components: Copy + Send {
    /// Places of those that a plane and its normal have, ascending.
    const IN_PLANE: &'static [usize];
    /// Places of all.
    const ALL: &'static [usize];

    /// All of them.
    fn numbers(&self) -> &[f64];

    /// The tensor with these `numbers` at `places`, and zeros elsewhere.
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

/// An array of tensors: 5 numbers of 9, and 4 of 6 symmetric ones, if `D` is 2, else all. The sign of a zero that is
/// not held is lost.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PackedTensors<const D: usize, T> {
    numbers: Vec<f64>, // those that are held, tensor by tensor
    whole: PhantomData<T>,
}

impl<const D: usize, T: Components> PackedTensors<D, T> {
    /// Places of the numbers that are held.
    const PLACES: &'static [usize] = if D == 2 { T::IN_PLANE } else { T::ALL };
    /// Numbers from one tensor to the next.
    const STRIDE: usize = Self::PLACES.len();

    /// Number of tensors.
    pub fn len(&self) -> usize {
        self.numbers.len() / Self::STRIDE
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// Bytes that a tensor takes.
    pub(super) const fn memory_of_one() -> usize {
        Self::STRIDE * size_of::<f64>()
    }

    /// Whether a tensor is zero wherever nothing is held.
    pub fn holds(tensor: &T) -> bool {
        let mut others = tensor
            .numbers()
            .iter()
            .enumerate()
            .filter(|(place, _)| !Self::PLACES.contains(place));
        others.all(|(_, &number)| number == 0.0)
    }

    /// Whether nothing is lost with what is not held: it is zero, or what is held is not finite either, which no step
    /// takes.
    fn sends_all(tensor: &T) -> bool {
        Self::holds(tensor) || Self::PLACES.iter().any(|&place| !tensor.numbers()[place].is_finite())
    }

    /// The tensor of point `p`.
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

    /// Gives point `p` the tensor `tensor`, which must be zero where nothing is held.
    #[inline(always)]
    pub fn set(&mut self, p: usize, tensor: T) {
        Self::keep(&mut self.numbers, p, tensor);
    }

    /// The tensors by chunks of points, each for a thread at a time.
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

    /// Adds a tensor for a further point, which must be zero where nothing is held.
    #[inline(always)]
    pub fn push(&mut self, tensor: T) {
        debug_assert!(Self::sends_all(&tensor), "of {:?} not all is held", tensor.numbers());
        self.numbers
            .extend(Self::PLACES.iter().map(|&place| tensor.numbers()[place]));
    }

    /// Gives every point the tensor `tensor`, which must be zero where nothing is held.
    pub fn fill(&mut self, tensor: T) {
        (0..self.len()).for_each(|p| self.set(p, tensor));
    }

    /// All tensors, point by point.
    pub fn iter(&self) -> impl Iterator<Item = T> {
        (0..self.len()).map(|p| self.at(p))
    }
}

/// Some tensors, one after another.
#[derive(Debug)]
pub struct PackedChunk<'a, const D: usize, T> {
    numbers: &'a mut [f64],
    whole: PhantomData<T>,
}

impl<const D: usize, T: Components> PackedChunk<'_, D, T> {
    /// The tensor `k` of them.
    #[inline(always)]
    pub fn at(&self, k: usize) -> T {
        PackedTensors::<D, T>::read(self.numbers, k)
    }

    /// Puts a tensor in the place `k`, which must be zero where nothing is held.
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
    /// Components XX, YY, ZZ, XY of every tensor, where these are all that there is.
    #[inline(always)]
    pub fn planar(&self) -> Option<&[[f64; 4]]> {
        (D == 2).then(|| self.numbers.as_chunks().0)
    }

    /// All components of every tensor, where none is known to be zero.
    #[inline(always)]
    pub fn whole(&self) -> Option<&[[f64; 6]]> {
        (D != 2).then(|| self.numbers.as_chunks().0)
    }
}
