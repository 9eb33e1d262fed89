//! Cages through refinement, tables and selection, against the theory and the f64 evaluator.

mod basis;
mod cages;
mod edits;
mod face_varying;
mod gregory;
mod merge;
mod rivals;
mod selection;
mod surface;
mod tables;
