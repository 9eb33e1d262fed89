//! Makes the files of `scenes/`, larger meshes of any size, and scenes of them. The same arguments give the same bytes.
//!
//! | module | idea |
//! |---|---|
//! | `cage` | a mesh under construction, and its OBJ text |
//! | `tags` | creases, sharp vertices, holes and options |
//! | `seams` | texture coordinates with seams |
//! | `edits` | hierarchical edits |
//! | `random` | a small random number generator and smooth noise |
//! | `sheets` | grids, strips and other open sheets |
//! | `sectors` | discs and fans around one vertex, rings around one n-gon |
//! | `solids` | closed meshes: cube, torus, cube sphere and others |
//! | `lattice` | the surface of a set of cells of a bent lattice |
//! | `rotate` | edge rotations, which make extraordinary vertices, and relaxation |
//! | `random_cage` | cages that a seed makes, for tests |
//! | `large` | meshes of any number of faces |
//! | `scenes` | what stands in `scenes/` |
//! | `terrain` | hills of any number of faces |
//! | `flight` | a camera's way through their valleys |
//! | `crowd` | one mesh in many places |
//! | `distances` | a camera's way from a model |
//! | `framing` | from how far a camera sees things |
//! | `scene_text` | a scene file under construction, and its JSON text |
//! | `gltf_text` | a glTF file under construction, as JSON and as GLB |
//! | `sprout` | the glTF scene that shows it all |
//! | `hero` | the scene that shows it all |
pub mod cage;
pub mod creased;
pub mod crowd;
pub mod distances;
pub mod edits;
pub mod flight;
pub mod framing;
pub mod gltf_text;
pub mod hero;
pub mod large;
pub mod lattice;
pub mod random;
pub mod random_cage;
pub mod rotate;
pub mod scene_text;
pub mod scenes;
pub mod seams;
pub mod sectors;
pub mod sheets;
pub mod solids;
pub mod sprout;
pub mod tags;
pub mod terrain;
