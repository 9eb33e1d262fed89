//! Helpers shared by the end-to-end tests, which run the programs that users run and judge what comes out.
//!
//! | module | idea |
//! |---|---|
//! | `repository` | where scenes, models and programs are |
//! | `program` | running `planish` and judging how it ended |
//! | `parallel` | many independent checks on all cores, all failures told |
//! | `cage` | a mesh file's faces: Ptex numbering, boundary |
//! | `export` | cages to files of other formats |
//! | `ply` | dumps, read and thinned out |
//! | `oracle` | a dump against OpenSubdiv's limit surface |
//! | `judge` | a dump judged as a whole |
//! | `view` | cameras at odd places |
//! | `weld` | a dump as one connected mesh |
//! | `folder` | a folder to write into, which must end as it was meant to |
//! | `layers` | an EXR file's channels |
//! | `stage` | small USD stages |
//! | `golden` | images against committed ones |

pub mod cage;
pub mod export;
pub mod folder;
pub mod golden;
pub mod judge;
pub mod layers;
pub mod oracle;
pub mod parallel;
pub mod ply;
pub mod program;
pub mod repository;
pub mod stage;
pub mod view;
pub mod weld;
