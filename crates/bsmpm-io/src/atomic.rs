//! Replaces a file such that readers always find either the old or the new file.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use crate::Error;

/// End of a temporary name, which begins with a dot.
const TEMPORARY: &str = ".tmp";

/// Writes a file by `fill` under a temporary name in the same directory, then renames it to `path`. The bytes are on
/// the disk before the rename, so a power failure leaves no empty file under the final name.
///
/// # Errors
/// [`Error::File`] with the system's error; the temporary file is removed and an older `path` is unchanged.
pub fn replace(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<(), Error> {
    FilledFile::new(path, fill)?.give_name()?;
    sync_folder(path).map_err(Error::file("write", path))
}

/// Complete file under a temporary name. It is removed unless it gets its final name.
#[derive(Debug)]
pub(crate) struct FilledFile {
    file: File,
    temporary: PathBuf,
    path: PathBuf,
}

impl FilledFile {
    /// Writes the file.
    pub fn new(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> Result<Self, Error> {
        let temporary = temporary(path);
        let written = write(&temporary, fill).map(|file| Self {
            file,
            temporary: temporary.clone(),
            path: path.into(),
        });
        written.map_err(|source| {
            let _ = fs::remove_file(&temporary);
            Error::File {
                action: "write",
                path: path.to_owned(),
                source,
            }
        })
    }

    /// Writes the bytes to the disk, then renames the file. The caller must sync the folder.
    pub fn give_name(self) -> Result<(), Error> {
        let named = self
            .file
            .sync_all()
            .and_then(|()| fs::rename(&self.temporary, &self.path));
        named.map_err(Error::file("write", &self.path))
    }
}

impl Drop for FilledFile {
    fn drop(&mut self) {
        // A renamed file no longer has this name.
        let _ = fs::remove_file(&self.temporary);
    }
}

/// Writes the entry of a file in its folder to the disk.
pub(crate) fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    File::open(folder)?.sync_all()
}

fn write(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<File> {
    // All attempts use one name: the file of a killed program is removed here, and a link with that name is not
    // followed.
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let mut writer = BufWriter::with_capacity(1 << 16, File::create_new(path)?);
    fill(&mut writer)?;
    writer.into_inner().map_err(io::IntoInnerError::into_error)
}

/// Removes temporary files of a killed program from a folder that no other program writes to.
pub(crate) fn remove_temporaries(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        if name.as_encoded_bytes().starts_with(b".") && name.as_encoded_bytes().ends_with(TEMPORARY.as_bytes()) {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

fn temporary(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(TEMPORARY);
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_no_other() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("run.json");
        replace(&path, |file| file.write_all(b"old")).unwrap();
        let failed = replace(&path, |file| {
            file.write_all(b"half of the n")?;
            Err(io::Error::other("disk full"))
        });
        assert!(matches!(failed, Err(Error::File { action: "write", .. })));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
        replace(&path, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }
}
