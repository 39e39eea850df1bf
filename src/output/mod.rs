//! Results as files: history, arrays, summary and pictures of a run. Nothing here prints.
//!
//! ```text
//! folder               the result folder: one writer at a time, no incomplete file
//! kind                 the command that filled a folder
//! stream               files that grow with a run, with checksums
//! journal              rows with checksums, each on the disk as soon as it is computed
//! history              history.csv, row by row
//! envelope             a history of any length, read back in bounded memory
//! error_band           errors.csv, error bands of the history
//! arrays               fields.npz, streamed through raw files
//! downsampled_history  writes the files that grow with a run, in a thread
//! npz                  reads arrays from such a file and verifies them
//! checkpoint           state from which an interrupted run resumes
//! recorder             the Recorder that combines these files
//! summary              writes and reads summary.json
//! reading              reads a result folder into memory
//! errors               errors for scripts and for readers
//! export               a result in other formats: tables of the fields, surfaces for ParaView
//! fmu                  a case as a model for other programs
//! comparison           the picture of two runs over each other
//! effects              effects.csv, effects.json, effects.svg, table and sentence
//! equilibrium          path.csv, shapes.csv, equilibrium.json, path.svg, table
//! evaluations          journal of the evaluations of a search
//! fit                  fit.json, fit.csv, fit.svg, fitted-case.json, and their text
//! floquet              floquet.csv, floquet.json, floquet.svg; map.csv, map.json, map.svg, and their text
//! optimum              optimum.json, designs.csv, optimum.svg, optimum-case.json, and their text
//! periodic             cycle.json; sweep.csv, sweep.json, sweep.svg, and their text
//! sense                sense.csv, sensors.csv, sense.json, sense.svg, table and sentences
//! study                study.csv, study.json, study.svg, table and sentence
//! sweep                designs.jsonl, sweep.csv, sweep.npz, sweep.json of many designs, and their text
//! uncertainty          uncertainty.json, its text and its table
//! bands                text about figures with their uncertainty bands
//! modes                modes.csv, modes.json, modes.npz, modes.svg, table and sentences
//! report               report.html: a result folder as one page
//! pictures             converts recorded files to the data of each picture
//! plot                 draws pictures: plain data to SVG text
//! quantity_plot        pictures of chosen quantities of any result
//! numbers              formats numbers for readers
//! records              rows as the text of a CSV file
//! columns              rows as a text table for readers
//! accuracy             text about a requested accuracy
//! ```

pub mod accuracy;
pub mod arrays;
pub mod band_structure;
pub mod bands;
pub mod checkpoint;
pub mod columns;
pub mod comparison;
pub mod disk;
pub mod downsampled_history;
pub mod effects;
pub mod envelope;
pub mod equilibrium;
pub mod error_band;
pub mod errors;
pub mod evaluations;
pub mod export;
pub mod fit;
pub mod floquet;
pub mod fmu;
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
pub mod quantity_plot;
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
pub use pictures::Labels;
pub use recorder::{FolderRecorder, Hook};
