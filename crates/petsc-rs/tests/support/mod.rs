//! Prepares the process of the test program: environment variables, working directory and captured output.

pub mod classes;
pub mod shell;

use std::ffi::{c_int, c_void};
use std::fs::{self, File};
use std::os::fd::AsRawFd;
use std::path::PathBuf;
use std::{env, process};

unsafe extern "C" {
    fn dup(fd: c_int) -> c_int;
    fn dup2(from: c_int, to: c_int) -> c_int;
    fn close(fd: c_int) -> c_int;
    fn fflush(stream: *mut c_void) -> c_int;
}

/// Lets MPI start without a launcher, and sets the variable that PETSc must not obey.
pub fn prepare_environment() {
    let mut variables = vec![("PETSC_OPTIONS", "-from_environment")];
    if env::var_os("OMPI_COMM_WORLD_SIZE").is_none() {
        variables.extend([
            ("OMPI_MCA_ess_singleton_isolated", "1"),
            ("OMPI_MCA_pml", "ob1"),
            ("OMPI_MCA_btl", "self"),
        ]);
    }
    for (name, value) in variables {
        // SAFETY: the first act of the program, which has one thread.
        unsafe { env::set_var(name, value) };
    }
}

fn scratch() -> PathBuf {
    env::temp_dir().join(format!("petsc-rs-{}", process::id()))
}

/// Makes a directory of this process the working directory, with a `.petscrc` in it.
pub fn enter_directory_with_petscrc() {
    fs::create_dir_all(scratch()).expect("a directory for the test");
    env::set_current_dir(scratch()).expect("the directory exists");
    fs::write(".petscrc", "-from_petscrc 1\n-ksp_type gmres\n").expect("a file for the test");
}

/// Standard output and error of this process, written to a file until `end`.
pub struct Captured {
    saved: [c_int; 2],
    path: PathBuf,
}

impl Captured {
    pub fn begin() -> Self {
        let path = scratch().join("printed");
        let file = File::create(&path).expect("a file for the test");
        // SAFETY: descriptors 1 and 2 are open; null flushes every C stream.
        let saved = unsafe {
            fflush(std::ptr::null_mut());
            let saved = [dup(1), dup(2)];
            dup2(file.as_raw_fd(), 1);
            dup2(file.as_raw_fd(), 2);
            saved
        };
        Self { saved, path }
    }

    /// What was printed; removes the scratch directory.
    pub fn end(self) -> String {
        // SAFETY: as in `begin`; the saved descriptors are closed once.
        unsafe {
            fflush(std::ptr::null_mut());
            for (saved, fd) in self.saved.into_iter().zip([1, 2]) {
                dup2(saved, fd);
                close(saved);
            }
        }
        let printed = fs::read_to_string(&self.path).unwrap_or_else(|e| e.to_string());
        let _ = fs::remove_dir_all(scratch());
        printed
    }
}
