//! Makes the meshes of `scenes/` and larger ones of any size. The same arguments give the same bytes.
//!
//! | module | idea |
//! |---|---|
//! | `cage` | a mesh under construction, and its OBJ text |
//! | `random` | a small random number generator and smooth noise |
//! | `sheets` | grids, strips and other open sheets |
//! | `sectors` | discs and fans around one vertex, rings around one n-gon |
//! | `solids` | closed meshes: cube, torus, cube sphere and others |
//! | `lattice` | the surface of a set of cells of a bent lattice |
//! | `rotate` | edge rotations, which make extraordinary vertices, and relaxation |
//! | `large` | meshes of any number of faces |
//! | `scenes` | what stands in `scenes/` |
//! | `hero` | the scene that shows it all |
pub mod cage;
pub mod hero;
pub mod large;
pub mod lattice;
pub mod random;
pub mod rotate;
pub mod scenes;
pub mod sectors;
pub mod sheets;
pub mod solids;
