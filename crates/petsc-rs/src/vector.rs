//! Distributed vectors. Each rank owns a contiguous part, in the order of the ranks.

use std::ops::Range;
use std::{ptr, slice};

use crate::error::{Result, check, indices, int, same_length};
use crate::ffi;
use crate::petsc::Petsc;

/// A vector of f64, distributed by contiguous parts.
pub struct Vector<'p> {
    petsc: &'p Petsc<'p>,
    raw: ffi::Vec,
    owned: Range<usize>,
    global: usize,
}

impl<'p> Vector<'p> {
    /// A zero vector of which this rank owns `local` entries (0 is allowed). Collective.
    pub fn new(petsc: &'p Petsc, local: usize) -> Result<Self> {
        let global = petsc.total("vector length", local)?;
        let local = int("vector length", local)?;
        let length = int("vector length", global)?;
        let mut vector = Self {
            petsc,
            raw: ptr::null_mut(),
            owned: 0..0,
            global,
        };
        // SAFETY: PETSc runs; the handle is created before it is used; null handles are destroyable.
        check(unsafe { ffi::VecCreate(petsc.comm(), &mut vector.raw) })?;
        // SAFETY: the handle is valid; the type's name is NUL-terminated.
        check(unsafe { ffi::VecSetSizes(vector.raw, local, length) })?;
        // SAFETY: as above.
        check(unsafe { ffi::VecSetType(vector.raw, c"standard".as_ptr()) })?;
        let mut from = 0;
        let mut to = 0;
        // SAFETY: the vector is set up; the pointers are valid.
        check(unsafe { ffi::VecGetOwnershipRange(vector.raw, &mut from, &mut to) })?;
        vector.owned = from.unsigned_abs() as usize..to.unsigned_abs() as usize;
        vector.fill(0.0)?;
        Ok(vector)
    }

    /// Global numbers of the entries that this rank owns.
    pub fn owned_range(&self) -> Range<usize> {
        self.owned.clone()
    }

    /// Number of entries that this rank owns.
    pub fn local_len(&self) -> usize {
        self.owned.len()
    }

    /// Number of entries of all ranks.
    pub fn global_len(&self) -> usize {
        self.global
    }

    pub(crate) fn raw(&self) -> ffi::Vec {
        self.raw
    }

    /// Gives the entries of this rank to `use_entries`.
    pub fn read<R>(&self, use_entries: impl FnOnce(&[f64]) -> R) -> Result<R> {
        let mut array = ptr::null();
        // SAFETY: the vector is set up; the array is given back below.
        check(unsafe { ffi::VecGetArrayRead(self.raw, &mut array) })?;
        let result = match self.local_len() {
            0 => use_entries(&[]),
            // SAFETY: PETSc's array holds the owned entries; `&self` keeps writers away.
            length => use_entries(unsafe { slice::from_raw_parts(array, length) }),
        };
        // SAFETY: the array of the call above, once.
        check(unsafe { ffi::VecRestoreArrayRead(self.raw, &mut array) })?;
        Ok(result)
    }

    /// Lets `change_entries` change the entries of this rank. To be called on every rank, also
    /// where nothing is owned, so that PETSc's record of changes agrees.
    pub fn write<R>(&mut self, change_entries: impl FnOnce(&mut [f64]) -> R) -> Result<R> {
        let mut array = ptr::null_mut();
        // SAFETY: the vector is set up; the array is given back below.
        check(unsafe { ffi::VecGetArray(self.raw, &mut array) })?;
        let result = match self.local_len() {
            0 => change_entries(&mut []),
            // SAFETY: PETSc's array holds the owned entries; `&mut self` excludes every alias.
            length => change_entries(unsafe { slice::from_raw_parts_mut(array, length) }),
        };
        // SAFETY: the array of the call above, once.
        check(unsafe { ffi::VecRestoreArray(self.raw, &mut array) })?;
        Ok(result)
    }

    /// Takes the entries of this rank from `values`, of length `local_len`.
    pub fn copy_from(&mut self, values: &[f64]) -> Result<()> {
        same_length("values", values.len(), self.local_len())?;
        self.write(|entries| entries.copy_from_slice(values))
    }

    /// Puts the entries of this rank into `values`, of length `local_len`.
    pub fn copy_to(&self, values: &mut [f64]) -> Result<()> {
        same_length("values", values.len(), self.local_len())?;
        self.read(|entries| values.copy_from_slice(entries))
    }

    /// Sets every entry to `value`. Collective.
    pub fn fill(&mut self, value: f64) -> Result<()> {
        // SAFETY: the vector is set up.
        check(unsafe { ffi::VecSet(self.raw, value) })
    }

    /// Sets entries by their global number, those of other ranks too; where several are given for
    /// one entry it is open which one stays. Collective.
    pub fn insert(&mut self, entries: &[usize], values: &[f64]) -> Result<()> {
        let checked = same_length("values", values.len(), entries.len()).and_then(|()| {
            let count = int("number of entries", entries.len())?;
            Ok((count, indices("entries", entries, self.global)?))
        });
        let (count, places) = self.petsc.agree(checked)?;
        // SAFETY: both arrays hold `count` elements, every index is below the global length.
        let inserted =
            check(unsafe { ffi::VecSetValues(self.raw, count, places.as_ptr(), values.as_ptr(), ffi::INSERT_VALUES) });
        self.petsc.agree(inserted)?;
        // SAFETY: the vector is set up; the two calls belong together.
        check(unsafe { ffi::VecAssemblyBegin(self.raw) })?;
        // SAFETY: as above.
        check(unsafe { ffi::VecAssemblyEnd(self.raw) })
    }

    /// self += factor * other. Collective.
    pub fn add_scaled(&mut self, factor: f64, other: &Vector) -> Result<()> {
        self.agree_length("other", other)?;
        // SAFETY: two set-up vectors of equal layout, distinct because of the borrows.
        check(unsafe { ffi::VecAXPY(self.raw, factor, other.raw) })
    }

    /// Euclidean norm over all ranks. Collective.
    pub fn norm(&self) -> Result<f64> {
        self.norm_of(ffi::NORM_2)
    }

    /// Largest magnitude over all ranks; a NaN may be lost in it. Collective.
    pub fn norm_max(&self) -> Result<f64> {
        self.norm_of(ffi::NORM_INFINITY)
    }

    fn norm_of(&self, kind: ffi::NormType) -> Result<f64> {
        let mut norm = 0.0;
        // SAFETY: the vector is set up; the pointer is valid.
        check(unsafe { ffi::VecNorm(self.raw, kind, &mut norm) })?;
        Ok(norm)
    }

    /// Scalar product over all ranks; its last digits depend on the number of ranks. Collective.
    pub fn dot(&self, other: &Vector) -> Result<f64> {
        self.agree_length("other", other)?;
        let mut product = 0.0;
        // SAFETY: two set-up vectors of equal layout; the pointer is valid.
        check(unsafe { ffi::VecDot(self.raw, other.raw, &mut product) })?;
        Ok(product)
    }

    fn agree_length(&self, what: &'static str, other: &Vector) -> Result<()> {
        let checked = same_length(what, other.local_len(), self.local_len());
        self.petsc.agree(checked)
    }
}

impl Drop for Vector<'_> {
    fn drop(&mut self) {
        // SAFETY: PETSc runs (borrowed); the handle is valid or null, and not used again.
        let _ = check(unsafe { ffi::VecDestroy(&mut self.raw) });
    }
}
