//! Results as files: history, arrays, summary and pictures of a run. Nothing here prints.
//!
//! ```text
//! folder    which folder, one writer at a time, and how files get into it without ever being half written
//! kind      which command filled a folder
//! stream    files that grow with a run, with checksums
//! journal   rows with checksums, each on the disk as soon as it is computed
//! history   history.csv, row by row
//! envelope  a history of any length, read back in bounded memory
//! arrays    fields.npz, streamed through raw files
//! behind    the files that grow with a run, written by a thread of their own
//! npz       arrays back from such a file, checked against it
//! checkpoint  where an interrupted run goes on
//! recorder  the Recorder that ties them together
//! summary   summary.json, there and back
//! reading   a result folder back into memory
//! errors    what went wrong, for scripts and for people
//! export    a result in other formats: tables of the fields, surfaces for ParaView
//! comparison  the picture of two runs over each other
//! effects   effects.csv, effects.json, effects.svg, table and sentence
//! equilibrium  path.csv, shapes.csv, equilibrium.json, path.svg, table
//! evaluations  evaluations of an interrupted search
//! fit       fit.json, fit.csv, fit.svg, fitted-case.json, and their words
//! floquet   floquet.csv, floquet.json, floquet.svg; map.csv, map.json, map.svg, and their words
//! optimum   optimum.json, designs.csv, optimum.svg, optimum-case.json, and their words
//! periodic  cycle.json; sweep.csv, sweep.json, sweep.svg, and their words
//! sense     sense.csv, sensors.csv, sense.json, sense.svg, table and sentences
//! study     study.csv, study.json, study.svg, table and sentence
//! sweep     designs.jsonl, sweep.csv, sweep.npz, sweep.json of many designs, and their words
//! uncertainty  uncertainty.json, its words and its table
//! bands     figures beside what uncertain numbers leave open of them, in words
//! modes     modes.csv, modes.json, modes.npz, modes.svg, table and sentences
//! report    report.html: a result folder as one page
//! pictures  from recorded files to the data of each picture
//! plot      one picture a file, from plain data to SVG text
//! numbers   numbers as people read them
//! records   rows as the text of a CSV file
//! columns   rows as a table for people
//! accuracy  an accuracy that was asked for, in words
//! ```

pub mod accuracy;
pub mod arrays;
pub mod bands;
pub mod behind;
pub mod checkpoint;
pub mod columns;
pub mod comparison;
pub mod disk;
pub mod effects;
pub mod envelope;
pub mod equilibrium;
pub mod errors;
pub mod evaluations;
pub mod export;
pub mod fit;
pub mod floquet;
pub mod folder;
pub mod history;
pub mod journal;
pub mod kind;
pub mod machine;
pub mod modes;
pub mod npz;
pub use crate::error::numbers;
pub mod optimum;
pub mod periodic;
pub mod pictures;
pub mod plot;
pub mod reading;
pub mod recorder;
pub mod records;
pub mod report;
pub mod response;
pub mod sense;
pub mod state_space;
pub mod stream;
pub mod study;
pub mod summary;
pub mod sweep;
pub mod uncertainty;

pub use folder::ResultFolder;
pub use recorder::{FolderRecorder, Hook, Labels};
