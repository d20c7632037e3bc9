//! Sparse square matrices, distributed by contiguous rows in the order of the ranks. The sparsity pattern is given
//! once, as coordinates (COO) or rows (CSR); the values can be replaced any number of times. Values at repeated
//! coordinates are added, bitwise identically on the same number of ranks.

use std::ops::Range;
use std::{ptr, slice};

use crate::error::{Error, Result, check, indices, int, same_length};
use crate::ffi;
use crate::petsc::Petsc;
use crate::vector::Vector;

/// What is known of a matrix and of all its later values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Symmetry {
    /// equal to its transpose
    Symmetric,
    /// symmetric and positive definite: Cholesky may do without pivoting
    PositiveDefinite,
}

#[derive(Clone, Copy)]
enum Pattern {
    Coo,
    Csr,
}

/// A sparse square matrix of f64, distributed by contiguous rows.
pub struct Matrix<'p> {
    petsc: &'p Petsc<'p>,
    raw: ffi::Mat,
    owned: Range<usize>,
    global: usize,
    block: usize,
    pattern: Pattern,
    entries: usize,
}

impl<'p> Matrix<'p> {
    /// A matrix of which this rank owns `local_rows` rows, in blocks of `block` unknowns per node,
    /// with entries at (`rows[k]`, `columns[k]`), global numbers from 0, all values zero. A pair may
    /// be repeated (its values are added) and may lie in another rank's rows. Collective.
    pub fn from_coo(
        petsc: &'p Petsc,
        local_rows: usize,
        block: usize,
        rows: &[usize],
        columns: &[usize],
    ) -> Result<Self> {
        let mut matrix = Self::empty(petsc, local_rows, block, Pattern::Coo)?;
        let checked = same_length("columns", columns.len(), rows.len()).and_then(|()| {
            int("number of entries", rows.len())?;
            let rows = indices("rows", rows, matrix.global)?;
            Ok((rows, indices("columns", columns, matrix.global)?))
        });
        let (mut rows, mut columns) = petsc.agree(checked)?;
        matrix.entries = rows.len();
        let count = rows.len() as ffi::PetscCount;
        // SAFETY: both arrays hold `count` indices below the global size; PETSc may reorder them.
        check(unsafe { ffi::MatSetPreallocationCOO(matrix.raw, count, rows.as_mut_ptr(), columns.as_mut_ptr()) })?;
        matrix.set_values(&vec![0.0; matrix.entries])?;
        matrix.find_owned()?;
        Ok(matrix)
    }

    /// A matrix of which this rank owns `local_rows` rows: row i holds `values[k]` in the global
    /// column `columns[k]`, strictly ascending in a row, for k in `row_starts[i]..row_starts[i+1]`.
    /// Collective.
    pub fn from_csr(
        petsc: &'p Petsc,
        local_rows: usize,
        block: usize,
        row_starts: &[usize],
        columns: &[usize],
        values: &[f64],
    ) -> Result<Self> {
        let mut matrix = Self::empty(petsc, local_rows, block, Pattern::Csr)?;
        let checked = same_length("row_starts", row_starts.len(), local_rows + 1)
            .and_then(|()| same_length("values", values.len(), columns.len()))
            .and_then(|()| check_rows(row_starts, columns))
            .and_then(|()| {
                int("number of entries", columns.len())?;
                let starts = indices("row_starts", row_starts, columns.len() + 1)?;
                Ok((starts, indices("columns", columns, matrix.global)?))
            });
        let (starts, columns) = petsc.agree(checked)?;
        matrix.entries = columns.len();
        let i = starts.as_ptr();
        let j = columns.as_ptr();
        let v = values.as_ptr();
        // SAFETY: `local_rows + 1` ascending starts, as many columns below the global size and
        // values as the last of them; PETSc copies. Of the two, the one of another type does nothing.
        check(unsafe { ffi::MatSeqAIJSetPreallocationCSR(matrix.raw, i, j, v) })?;
        // SAFETY: as above.
        check(unsafe { ffi::MatMPIAIJSetPreallocationCSR(matrix.raw, i, j, v) })?;
        matrix.find_owned()?;
        Ok(matrix)
    }

    /// A typed and sized matrix without a pattern.
    fn empty(petsc: &'p Petsc, local_rows: usize, block: usize, pattern: Pattern) -> Result<Self> {
        let global = petsc.total("matrix rows", local_rows)?;
        let alike = petsc.total("block size", block)? == block.saturating_mul(petsc.ranks());
        let whole = match block {
            0 => Err(Error::Unsupported("a block size of 0")),
            _ if !alike => Err(Error::Unsupported("block sizes that differ between ranks")),
            _ => same_length("last block of local rows", local_rows % block, 0),
        };
        petsc.agree(whole)?;
        let mut matrix = Self {
            petsc,
            raw: ptr::null_mut(),
            owned: 0..0,
            global,
            block,
            pattern,
            entries: 0,
        };
        let m = int("matrix rows", local_rows)?;
        let n = int("matrix rows", global)?;
        // SAFETY: PETSc runs; the handle is created before it is used; null handles are destroyable.
        check(unsafe { ffi::MatCreate(petsc.comm(), &mut matrix.raw) })?;
        // SAFETY: the handle is valid.
        check(unsafe { ffi::MatSetSizes(matrix.raw, m, m, n, n) })?;
        // SAFETY: the handle is valid; every rank's rows are whole blocks.
        check(unsafe { ffi::MatSetBlockSize(matrix.raw, int("block size", block)?) })?;
        // SAFETY: the handle is valid; the type's name is NUL-terminated.
        check(unsafe { ffi::MatSetType(matrix.raw, c"aij".as_ptr()) })?;
        Ok(matrix)
    }

    fn find_owned(&mut self) -> Result<()> {
        let mut from = 0;
        let mut to = 0;
        // SAFETY: the matrix is set up; the pointers are valid.
        check(unsafe { ffi::MatGetOwnershipRange(self.raw, &mut from, &mut to) })?;
        self.owned = from.unsigned_abs() as usize..to.unsigned_abs() as usize;
        Ok(())
    }

    /// Replaces all values, in the order in which the pattern was given. Collective.
    pub fn set_values(&mut self, values: &[f64]) -> Result<()> {
        let checked = same_length("values", values.len(), self.entries);
        self.petsc.agree(checked)?;
        match self.pattern {
            // SAFETY: as many values as the pattern has entries on this rank.
            Pattern::Coo => check(unsafe { ffi::MatSetValuesCOO(self.raw, values.as_ptr(), ffi::INSERT_VALUES) }),
            Pattern::Csr if self.petsc.ranks() == 1 => self.set_serial_values(values),
            // SAFETY: a matrix of type mpiaij made from rows that hold as many values.
            Pattern::Csr => check(unsafe { ffi::MatUpdateMPIAIJWithArray(self.raw, values.as_ptr()) }),
        }
    }

    /// MatUpdateMPIAIJWithArray for the type that a single rank has.
    fn set_serial_values(&mut self, values: &[f64]) -> Result<()> {
        let mut array = ptr::null_mut();
        // SAFETY: the matrix is of type seqaij; the array is given back below.
        check(unsafe { ffi::MatSeqAIJGetArrayWrite(self.raw, &mut array) })?;
        if !values.is_empty() {
            // SAFETY: the array holds the entries of the pattern, in its order; no one else uses it.
            unsafe { slice::from_raw_parts_mut(array, values.len()) }.copy_from_slice(values);
        }
        // SAFETY: the array of the call above, once.
        check(unsafe { ffi::MatSeqAIJRestoreArrayWrite(self.raw, &mut array) })?;
        // SAFETY: the matrix is set up; the two calls belong together.
        check(unsafe { ffi::MatAssemblyBegin(self.raw, ffi::MAT_FINAL_ASSEMBLY) })?;
        // SAFETY: as above.
        check(unsafe { ffi::MatAssemblyEnd(self.raw, ffi::MAT_FINAL_ASSEMBLY) })
    }

    /// Declares what the present and all later values have in common. Collective. Not verified.
    pub fn set_symmetry(&mut self, symmetry: Symmetry) -> Result<()> {
        let options: &[_] = match symmetry {
            Symmetry::Symmetric => &[ffi::MAT_SYMMETRIC, ffi::MAT_SYMMETRY_ETERNAL],
            Symmetry::PositiveDefinite => &[ffi::MAT_SPD, ffi::MAT_SPD_ETERNAL, ffi::MAT_SYMMETRY_ETERNAL],
        };
        for &option in options {
            // SAFETY: the matrix is set up.
            check(unsafe { ffi::MatSetOption(self.raw, option, ffi::PetscBool::from(true)) })?;
        }
        Ok(())
    }

    /// Gives multigrid the rigid body modes of the nodes of this rank at `coordinates`, 2 or 3 per
    /// node, as many as the block size: `local_rows` numbers in all. Collective.
    pub fn set_rigid_body_modes(&mut self, coordinates: &[f64]) -> Result<()> {
        if !(2..=3).contains(&self.block) {
            return Err(Error::Unsupported("rigid body modes need blocks of 2 or 3"));
        }
        let mut places = Vector::new(self.petsc, self.local_rows())?;
        self.petsc.agree(places.copy_from(coordinates))?;
        let mut modes = ptr::null_mut();
        // SAFETY: the vector is set up, of whole blocks on every rank.
        check(unsafe { ffi::VecSetBlockSize(places.raw(), int("block size", self.block)?) })?;
        // SAFETY: coordinates in blocks of 2 or 3; the matrix takes a reference of its own.
        check(unsafe { ffi::MatNullSpaceCreateRigidBody(places.raw(), &mut modes) })?;
        // SAFETY: both handles are valid.
        let given = check(unsafe { ffi::MatSetNearNullSpace(self.raw, modes) });
        // SAFETY: made above, not used again.
        check(unsafe { ffi::MatNullSpaceDestroy(&mut modes) }).and(given)
    }

    /// y = A x. Collective.
    pub fn mult(&self, x: &Vector, y: &mut Vector) -> Result<()> {
        self.agree_lengths(&[x, y])?;
        // SAFETY: the matrix is set up; the vectors have its layout and are distinct.
        check(unsafe { ffi::MatMult(self.raw, x.raw(), y.raw()) })
    }

    /// r = b - A x. Collective.
    pub fn residual(&self, b: &Vector, x: &Vector, r: &mut Vector) -> Result<()> {
        self.agree_lengths(&[b, x, r])?;
        // SAFETY: the matrix is set up; the vectors have its layout; `r` is neither `b` nor `x`.
        check(unsafe { ffi::MatResidual(self.raw, b.raw(), x.raw(), r.raw()) })
    }

    fn agree_lengths(&self, vectors: &[&Vector]) -> Result<()> {
        let checked = vectors
            .iter()
            .try_for_each(|v| same_length("vector", v.local_len(), self.local_rows()));
        self.petsc.agree(checked)
    }

    /// Global numbers of the rows that this rank owns.
    pub fn owned_rows(&self) -> Range<usize> {
        self.owned.clone()
    }

    /// Number of rows that this rank owns.
    pub fn local_rows(&self) -> usize {
        self.owned.len()
    }

    /// Number of rows of all ranks.
    pub fn global_rows(&self) -> usize {
        self.global
    }

    /// Number of values that [`Matrix::set_values`] takes on this rank.
    pub fn entries(&self) -> usize {
        self.entries
    }

    /// Unknowns per node.
    pub fn block_size(&self) -> usize {
        self.block
    }

    pub(crate) fn raw(&self) -> ffi::Mat {
        self.raw
    }
}

/// Rows that start at 0, do not overlap, end with the columns, and ascend strictly.
fn check_rows(row_starts: &[usize], columns: &[usize]) -> Result<()> {
    let last = row_starts.len() - 1;
    if row_starts[0] != 0 {
        let why = "it does not start at 0";
        return Err(Error::Pattern { row: 0, why });
    }
    same_length("columns", columns.len(), row_starts[last])?;
    for row in 0..last {
        let why = match columns.get(row_starts[row]..row_starts[row + 1]) {
            None => "its end is not after its start, or beyond the columns",
            Some(row) if !row.is_sorted_by(|a, b| a < b) => "columns must ascend strictly",
            Some(_) => continue,
        };
        return Err(Error::Pattern { row, why });
    }
    Ok(())
}

impl Drop for Matrix<'_> {
    fn drop(&mut self) {
        // SAFETY: PETSc runs (borrowed); the handle is valid or null, and not used again here; a
        // solver that still needs the matrix holds a reference of its own.
        let _ = check(unsafe { ffi::MatDestroy(&mut self.raw) });
    }
}
