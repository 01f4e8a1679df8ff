//! Map files larger than memory: mapped, not read. The one place of this crate with `unsafe`.

#![allow(unsafe_code, reason = "a mapped file, the one address in this crate where unsafe may live")]

use memmap2::{Mmap, MmapMut};
use std::fs::{File, OpenOptions};
use std::io;
use std::ops::{Deref, DerefMut};
use std::path::Path;

/// The bytes of a map file, brought in as they are read.
#[derive(Debug)]
pub struct MapFile {
    bytes: Mmap,
}

impl MapFile {
    /// Maps a file.
    ///
    /// # Errors
    /// When it is not a file, or the system refuses.
    pub fn open(path: &Path) -> io::Result<Self> {
        // Asked before opening: a pipe would wait for a writer, a device never end.
        if !std::fs::metadata(path)?.is_file() {
            return Err(io::Error::other("it is not a file"));
        }
        let file = File::open(path)?;
        // SAFETY: the map is only read, and our own programs replace map files whole, never change them in place. Whoever
        // else truncates one while it is in use ends this process by a signal; there is no way to forbid that.
        let bytes = unsafe { Mmap::map(&file)? };
        Ok(Self { bytes })
    }
}

impl Deref for MapFile {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.bytes
    }
}

/// A map file in the making, under a name that nobody else uses yet.
#[derive(Debug)]
pub struct NewMapFile {
    bytes: MmapMut,
}

impl NewMapFile {
    /// Makes the file at `path` `length` bytes long, kept as far as it was there, and maps it to be written.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn open(path: &Path, length: u64) -> io::Result<Self> {
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        file.set_len(length)?;
        // SAFETY: the file has a name of this process alone until it is finished, so nobody else writes or truncates it.
        let bytes = unsafe { MmapMut::map_mut(&file)? };
        Ok(Self { bytes })
    }

    /// Brings what was written to the disk.
    ///
    /// # Errors
    /// When the system refuses.
    pub fn finish(self) -> io::Result<()> {
        self.bytes.flush()
    }
}

impl Deref for NewMapFile {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.bytes
    }
}

impl DerefMut for NewMapFile {
    fn deref_mut(&mut self) -> &mut [u8] {
        &mut self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_into_a_mapped_file_is_read_from_it() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.edgemap");
        let mut new = NewMapFile::open(&path, 5).expect("a new file");
        new.copy_from_slice(b"bytes");
        new.finish().expect("written");
        assert_eq!(&*MapFile::open(&path).expect("a file"), b"bytes");
        let longer = NewMapFile::open(&path, 7).expect("the same file");
        assert_eq!(&*longer, b"bytes\0\0");
    }

    #[test]
    fn a_folder_and_a_missing_file_are_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        MapFile::open(folder.path()).expect_err("a folder");
        MapFile::open(&folder.path().join("none")).expect_err("no such file");
    }
}
