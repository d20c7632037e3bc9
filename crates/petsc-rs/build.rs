//! Finds PETSc (pkg-config name `PETSc`) and generates bindings of the functions that the crate uses.

use std::{env, path::PathBuf, process::exit};

/// Included before bindgen sees a line: a PETSc of another scalar type stops the build here.
const HEADER: &str = r#"
#include <petscksp.h>
#if defined(PETSC_USE_COMPLEX)
#error "petsc-rs needs a PETSc built with real scalars; this one has complex scalars"
#endif
#if !defined(PETSC_USE_REAL_DOUBLE)
#error "petsc-rs needs a PETSc built with double precision"
#endif
"#;

/// Regular expressions of every function called; what they need of types comes along.
const FUNCTIONS: &[&str] = &[
    "Petsc(Initialize|Initialized|Finalize|GetVersionNumber|PushErrorHandler)",
    "PetscOptions(SetValue|LeftGet|LeftRestore)",
    "Vec(Create|SetSizes|SetType|SetBlockSize|SetValues|AssemblyBegin|AssemblyEnd)",
    "Vec(GetArray|GetArrayRead|RestoreArray|RestoreArrayRead|GetOwnershipRange)",
    "Vec(Set|Norm|Dot|AXPY|Destroy)",
    "Mat(Create|SetSizes|SetType|SetBlockSize|SetOption|AssemblyBegin|AssemblyEnd)",
    "Mat(SetPreallocationCOO|SetValuesCOO|GetOwnershipRange|Mult|Residual|Destroy)",
    "Mat(Seq|MPI)AIJSetPreallocationCSR",
    "Mat(UpdateMPIAIJWithArray|SeqAIJGetArrayWrite|SeqAIJRestoreArrayWrite)",
    "Mat(NullSpaceCreateRigidBody|NullSpaceDestroy|SetNearNullSpace)",
    "Mat(CreateShell|ShellGetContext|ShellSetOperation)",
    "KSP(Create|SetOperators|SetType|GetPC|SetOptionsPrefix|SetFromOptions|SetUp|Solve)",
    "KSP(GetTolerances|SetTolerances|SetNormType|SetInitialGuessNonzero)",
    "KSP(SetReusePreconditioner|GetConvergedReason|GetConvergedReasonString)",
    "KSP(GetIterationNumber|GetOperators|GetType|SetUpOnBlocks|Reset|Destroy)",
    "PC(SetType|FactorSetMatSolverType|FactorGetMatSolverType|GetFailedReason)",
    "PC(GetType|SetUp|SetFailedReason|Reset)",
    "PCShell(SetContext|GetContext|SetSetUp|SetApply|SetName)",
    "PetscObjectReference",
];

const VARIABLES: &[&str] = &[
    "PETSC_COMM_WORLD",
    "PETSC_ERROR_INITIAL",
    "PETSC_ERR_USER",
    "(INSERT|ADD)_VALUES",
    "NORM_(2|INFINITY)",
    "MAT_(SYMMETRIC|SYMMETRY_ETERNAL|SPD|SPD_ETERNAL)",
    "MAT_FINAL_ASSEMBLY",
    "KSP_NORM_.*",
    "KSP_DIVERGED_(PC_FAILED|ITS)",
    "MATOP_MULT",
    "PC_(NOERROR|FACTOR_.*)",
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=MPICC");
    let petsc = pkg_config::Config::new()
        .atleast_version("3.18")
        .probe("PETSc")
        .unwrap_or_else(|error| {
            stop(&format!(
                "PETSc >= 3.18 was not found by pkg-config under the name `PETSc`.\n\
                 Debian, Ubuntu: apt install libpetsc-real-dev; a PETSc of your own: put its\n\
                 lib/pkgconfig directory into PKG_CONFIG_PATH.\n\n{error}"
            ))
        });
    let mpi = build_probe_mpi::probe()
        .unwrap_or_else(|errors| stop(&format!("MPI was not found (mpicc on the PATH, or MPICC): {errors:?}")));

    let includes = petsc.include_paths.iter().chain(&mpi.include_paths);
    let mut builder = bindgen::builder()
        .header_contents("petsc-rs.h", HEADER)
        .clang_args(includes.map(|dir| format!("-I{}", dir.display())))
        .blocklist_type("MPI_Comm|ompi_communicator_t")
        .raw_line("use mpi::ffi::MPI_Comm;")
        .default_enum_style(bindgen::EnumVariation::Consts)
        .prepend_enum_name(false)
        .generate_comments(false)
        .layout_tests(false);
    for name in FUNCTIONS {
        builder = builder.allowlist_function(name);
    }
    for name in VARIABLES {
        builder = builder.allowlist_var(name);
    }
    let bindings = builder
        .generate()
        .unwrap_or_else(|error| stop(&format!("PETSc's headers were refused: {error}")));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    bindings
        .write_to_file(out.join("bindings.rs"))
        .unwrap_or_else(|error| stop(&format!("the bindings cannot be written: {error}")));
}

/// Ends the build with a message that Cargo shows as it is.
fn stop(message: &str) -> ! {
    println!("cargo::error={}", message.replace('\n', "\ncargo::error="));
    exit(1);
}
