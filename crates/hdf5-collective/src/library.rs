//! Initialisation of HDF5, and agreement of errors between ranks.

use std::marker::PhantomData;

use mpi::collective::{CommunicatorCollectives, SystemOperation};
use mpi::environment::Universe;
use mpi::topology::{Communicator, SimpleCommunicator};

use crate::error::{Error, Result};
use crate::handle;

/// The running HDF5 on all ranks of the universe: borrows MPI, so that files are closed before it ends.
pub struct Hdf5<'u> {
    universe: &'u Universe,
    _one_thread: PhantomData<*mut ()>,
}

impl<'u> Hdf5<'u> {
    /// Starts HDF5, which from then on prints nothing by itself and loads no plugin: `HDF5_PLUGIN_PATH` and
    /// `HDF5_PLUGIN_PRELOAD` are removed from the environment. To be called while no other thread reads that.
    /// Collective.
    ///
    /// # Errors
    /// [`Error::Library`] if it does not start.
    pub fn initialize(universe: &'u Universe) -> Result<Self> {
        let hdf5 = Self {
            universe,
            _one_thread: PhantomData,
        };
        hdf5.agree(handle::start())?;
        Ok(hdf5)
    }

    pub(crate) fn world(&self) -> SimpleCommunicator {
        self.universe.world()
    }

    /// The outcome of this rank, or `OtherRank` where only others failed. Collective.
    pub(crate) fn agree<T>(&self, mine: Result<T>) -> Result<T> {
        let own = u8::from(mine.is_err());
        let mut most = 0_u8;
        self.world().all_reduce_into(&own, &mut most, SystemOperation::max());
        if most > 0 {
            mine.and(Err(Error::OtherRank))
        } else {
            mine
        }
    }

    /// Where a rank's rows begin, and the rows of all. Collective.
    pub(crate) fn place(&self, own: u64) -> (u64, u64) {
        let world = self.world();
        let mut counts = vec![0_u64; world.size().unsigned_abs() as usize];
        world.all_gather_into(&own, &mut counts[..]);
        let before = counts.iter().take(world.rank().unsigned_abs() as usize).sum();
        (before, counts.iter().sum())
    }
}

/// Version of the HDF5 linked at run time: major, minor, release.
pub fn version() -> (u32, u32, u32) {
    handle::version()
}
