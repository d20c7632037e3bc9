//! Fuzzes the reader of `run.json`.

use bsmpm_io::manifest::{MANIFEST, Manifest};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

thread_local! {
    static FOLDER: TempDir = TempDir::new().expect("a folder for temporary files");
}

/// The bytes of the file.
pub fn target(data: &[u8]) {
    FOLDER.with(|folder| try_file(folder.path(), data));
}

fn try_file(folder: &Path, data: &[u8]) {
    let file = folder.join(MANIFEST);
    fs::write(&file, data).expect("room for a file");
    match Manifest::read(folder) {
        Ok(manifest) => {
            let text = serde_json::to_vec_pretty(&manifest).expect("a manifest is JSON");
            fs::write(&file, text).expect("room for a file");
            assert_eq!(Manifest::read(folder).expect("what was read once"), manifest);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
