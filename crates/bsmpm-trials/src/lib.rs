#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Packages whose programs and examples are tried.
const PACKAGES: [&str; 4] = ["bsmpm-par", "bsmpm-tools", "bsmpm-ranks", "hdf5-collective"];

/// An executable of the workspace, by the name of its target: a program (`bsmpm-par`, `bsmpm`) or an example.
///
/// # Panics
/// If cargo cannot build it, or if there is none of that name.
pub fn executable(name: &str) -> &'static Path {
    static BUILT: OnceLock<HashMap<String, PathBuf>> = OnceLock::new();
    let built = BUILT.get_or_init(build);
    built
        .get(name)
        .unwrap_or_else(|| panic!("{PACKAGES:?} have no executable {name}"))
}

/// Builds all of them, optimised as users run them whatever this test program is, and into its target directory. Once a
/// process; test programs side by side wait for each other, as cargo locks the directory. Only cargo knows whether a
/// file that is there already is that of the sources: times of files tell nothing of features, profiles and switched
/// branches.
fn build() -> HashMap<String, PathBuf> {
    let own = std::env::current_exe().expect("the path of this program");
    let target = own.ancestors().nth(3).expect("target/PROFILE/deps/PROGRAM");
    // Without `cargo test`, as scripts/extremes does it, there is only the one of PATH.
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["build", "--bins", "--examples", "--release"]);
    cargo
        .args(["--message-format", "json-render-diagnostics", "--target-dir"])
        .arg(target);
    cargo.args(PACKAGES.iter().flat_map(|package| ["--package", package]));
    // What it compiles, and why it fails, is seen at once: this may take minutes.
    let cargo = cargo.stdin(Stdio::null()).stderr(Stdio::inherit());
    let output = cargo.output().unwrap_or_else(|error| panic!("{cargo:?}: {error}"));
    assert!(
        output.status.success(),
        "the programs under test cannot be built: {cargo:?}"
    );
    let messages = String::from_utf8(output.stdout).expect("cargo's messages");
    messages.lines().filter_map(executable_of).collect()
}

/// Name and path of the executable that a message of cargo names.
fn executable_of(message: &str) -> Option<(String, PathBuf)> {
    let message: serde_json::Value = serde_json::from_str(message).ok()?;
    Some((
        message["target"]["name"].as_str()?.to_owned(),
        message["executable"].as_str()?.into(),
    ))
}
