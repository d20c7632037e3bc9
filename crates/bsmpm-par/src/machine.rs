//! Processor time, memory and libraries of this process (Linux only).

use std::collections::BTreeMap;
use std::fs;

/// Clock ticks a second in /proc, fixed on Linux.
const TICKS: f64 = 100.0;

/// Processor seconds of this process so far, 0 if unknown.
pub fn cpu_seconds() -> f64 {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let fields: Vec<&str> = after_name.split_whitespace().collect();
    let [user, system] = [11, 12].map(|field| fields.get(field).and_then(|text| text.parse::<f64>().ok()));
    (user.unwrap_or(0.0) + system.unwrap_or(0.0)) / TICKS
}

/// Largest resident memory of this process so far, bytes; 0 if unknown.
pub fn peak_memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM:"));
    line.and_then(|line| line.split_whitespace().nth(1)?.parse::<u64>().ok())
        .unwrap_or(0)
        * 1024
}

/// Processors of this host that its system counts, whoever may use them; `None` if unknown.
pub fn processors() -> Option<u64> {
    let listed = fs::read_to_string("/proc/cpuinfo").ok()?;
    Some(listed.lines().filter(|line| line.starts_with("processor")).count() as u64).filter(|&count| count > 0)
}

/// File name of the BLAS that is loaded, if it can be determined.
pub fn blas() -> Option<String> {
    let maps = fs::read_to_string("/proc/self/maps").unwrap_or_default();
    let files = maps.lines().filter_map(|line| line.split('/').next_back());
    let known = ["openblas", "mkl", "blis", "libblas"];
    let mut found: Vec<&str> = files
        .filter(|name| known.iter().any(|part| name.contains(part)))
        .collect();
    found.sort_unstable();
    found.dedup();
    // Debian calls an optimised BLAS libblas.so too; the package's own library is loaded then as well.
    found
        .iter()
        .find(|name| !name.starts_with("libblas"))
        .or(found.first())
        .map(|name| (*name).to_owned())
}

/// Whether the BLAS is a slow reference one: factorisations then take several times as long.
pub fn has_reference_blas() -> bool {
    let maps = fs::read_to_string("/proc/self/maps").unwrap_or_default();
    maps.contains("/blas/libblas.so")
}

/// Versions of the libraries in use, by name.
pub(crate) fn library_versions() -> BTreeMap<String, String> {
    let (major, minor, subminor) = petsc_rs::version();
    let mpi = mpi::environment::library_version().unwrap_or_default();
    let hdf5 = hdf5_collective::version();
    [
        (
            "petsc",
            format!("{major}.{minor}.{subminor}, {}-bit indices", petsc_rs::petsc_int_bits()),
        ),
        ("mpi", mpi.split(',').next().unwrap_or_default().trim().to_owned()),
        ("hdf5", format!("{}.{}.{}", hdf5.0, hdf5.1, hdf5.2)),
        ("blas", blas().unwrap_or_else(|| "unknown".into())),
    ]
    .map(|(name, version)| (name.to_owned(), version))
    .into()
}
