//! The glTF reader, on files that the tests make.
mod cages;
mod common;
mod deformations;
mod errors;
mod looks;
mod ngons;
mod robust;
mod scenes;
