//! The power fails: what a disk holds at an instant, of a file system in a file that is copied while it is in use.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use crate::program::{LONG, run_long, same, start, stderr, wait};

/// Readings of a disk until two agree.
const READINGS: u32 = 100;

/// An ext4 file system in a file, in use until dropped.
struct Disk {
    image: PathBuf,
    place: PathBuf,
}

fn quietly(command: &str, arguments: &[&Path]) -> bool {
    let mut words = command.split(' ');
    let program = words.next().unwrap_or_default();
    let status = Command::new(program)
        .args(words)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    status.is_ok_and(|status| status.success())
}

impl Disk {
    /// Takes a file system into use; `None` where that is not permitted.
    fn mount(image: &Path) -> Option<Self> {
        let place = image.with_extension("mounted");
        fs::create_dir_all(&place).ok()?;
        quietly("mount -o loop", &[image, &place]).then(|| Self {
            image: image.to_path_buf(),
            place,
        })
    }

    fn new(image: &Path) -> Option<Self> {
        let file = fs::File::create(image).ok()?;
        file.set_len(64 << 20).ok()?;
        quietly("mkfs.ext4 -q", &[image]).then_some(())?;
        Self::mount(image)
    }

    /// The disk as it would be found if the power failed now: one instant of it, which two readings in a row agree on. A copy of blocks
    /// from before a write and from after it is no state that a disk is ever in.
    fn copy(&self, name: &str) -> Option<Self> {
        let copy = self.image.with_file_name(name);
        let mut found = fs::read(&self.image).ok()?;
        for _ in 0..READINGS {
            let again = fs::read(&self.image).ok()?;
            if again == found {
                fs::write(&copy, found).ok()?;
                return Self::mount(&copy);
            }
            found = again;
        }
        panic!("the disk never rests");
    }
}

/// Sends a signal to a program; one that has ended meanwhile takes none.
fn signal(child: &Child, which: &str) {
    let pid = child.id().to_string();
    quietly("kill", &[Path::new(which), Path::new(&pid)]);
}

impl Drop for Disk {
    fn drop(&mut self) {
        quietly("umount", &[&self.place]);
    }
}

/// A run that said "finished" is whole; one that was under way goes on from its checkpoint to the same end.
#[test]
fn what_was_told_survives_a_power_cut() {
    let folder = tempfile::tempdir().expect("a place");
    let whole = folder.path().join("whole");
    assert!(run_long(&whole, &[]).status.success());
    let Some(disk) = Disk::new(&folder.path().join("disk.img")) else {
        println!("skipped: no file system can be mounted here");
        return;
    };
    for trial in 0..3 {
        let name = format!("ended-{trial}");
        let ended = disk.place.join(&name);
        assert!(run_long(&ended, &[]).status.success());
        let found = disk.copy(&format!("{name}.img")).expect("a copy");
        same(&whole, &found.place.join(&name)).expect("all of it");
        fs::remove_dir_all(&ended).expect("room for the next");
    }
    for trial in 0..3 {
        let name = format!("under-way-{trial}");
        let out = disk.place.join(&name);
        let mut child = start(&out, &LONG);
        wait(&mut child, || out.join("checkpoint-before.json").exists());
        // it writes no more while the disk is read; what the kernel has of it may still be on its way
        signal(&child, "-STOP");
        let found = disk.copy(&format!("{name}.img")).expect("a copy");
        signal(&child, "-CONT");
        child.wait().expect("it ends");
        let found = found.place.join(&name);
        let again = run_long(&found, &["--resume"]);
        assert!(again.status.success(), "{}", stderr(&again));
        same(&whole, &found).expect("the same end");
        fs::remove_dir_all(&out).expect("room for the next");
    }
}
