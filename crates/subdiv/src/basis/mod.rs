//! Basis function tables (Hollaender and Boubekeur 2010): the cage is split once, and every point of a grid over each of its faces is a
//! sum of points around that face, by weights that follow from how these hang together.
//!
//! | module | idea |
//! |---|---|
//! | `poly` | half-edges of a mesh or a piece of one, and how it is split |
//! | `step` | one step of a scheme: rows of points |
//! | `walk` | pieces by how they hang together |
//! | `limit` | positions and tangents in the limit |
//! | `grid` | the table of a configuration |
//! | `source` | tables from a cache, else made |
//! | `cache` | what names a table, and its bytes |
//! | `build` | the tables of a cage |
//! | `fixed` | how large the paper's own set is |

mod build;
mod cache;
mod fixed;
mod grid;
mod limit;
pub(crate) mod poly;
mod source;
mod step;
mod walk;

pub use build::{BasisOptions, MAX_TABLE_LEVEL, MAX_TABLE_STEPS};
pub use cache::{BasisCache, BasisCounts, NoCache};
pub use fixed::{FIXED_VALENCES, TableSet, fixed_set};
