//! What can be wrong with a cage.

use thiserror::Error;

/// Why a cage cannot be refined. One line each; vertices and faces are counted from 0.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// The mesh has no face.
    #[error("the mesh has no faces")]
    Empty,
    /// The sizes of the faces do not add up to the list of face vertices.
    #[error("the faces' sizes add up to {expected} vertices, but {found} are listed")]
    FaceList {
        /// Sum of the sizes.
        expected: u64,
        /// Entries found.
        found: u64,
    },
    /// A face has fewer than three sides or far too many.
    #[error("face {face} (from 0) has {sides} sides; expected 3 to {max}", max = crate::mesh::MAX_FACE_SIDES)]
    FaceSides {
        /// The face.
        face: u32,
        /// Its number of sides.
        sides: u32,
    },
    /// An index points past the end of what it names.
    #[error("{what} {index} (from 0) is out of range: there are {count}")]
    OutOfRange {
        /// What the index names.
        what: &'static str,
        /// The index.
        index: u32,
        /// How many there are.
        count: u32,
    },
    /// A face names a vertex twice.
    #[error("face {face} names vertex {vertex} twice (both from 0)")]
    RepeatedVertex {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
    /// A face that a scheme does not know.
    #[error("face {face} (from 0) has {sides} sides: scheme {scheme} expects {accepted}")]
    SchemeFace {
        /// The scheme.
        scheme: &'static str,
        /// The face.
        face: u32,
        /// Its number of sides.
        sides: u32,
        /// What the scheme takes.
        accepted: &'static str,
    },
    /// A cage without an inside and an outside everywhere, for the method `table`.
    #[error(
        "vertex {vertex} (from 0) is not manifold: method table expects edges of one or two faces and one fan a vertex"
    )]
    NonManifoldTable {
        /// The vertex.
        vertex: u32,
    },
    /// Hierarchical edits of a mesh that is evaluated by table.
    #[error("tables are over the cage itself: expected no hierarchical edits")]
    EditedTable,
    /// Hierarchical edits of a mesh that is drawn as Gregory patches.
    #[error("Gregory patches are those of the cage's own levels: expected no hierarchical edits")]
    EditedGregory,
    /// A cage that a scheme for closed meshes of quads has no patches for.
    #[error(
        "face {face} (from 0) {found}: method {method} expects quads alone, and smooth ones at vertices of other than four faces"
    )]
    RivalCage {
        /// The scheme.
        method: &'static str,
        /// The face.
        face: u32,
        /// What is wrong with it.
        found: String,
    },
    /// A hierarchical edit's path is too short to name anything.
    #[error("edit {edit} (from 0) has a path of fewer than two entries")]
    EditPath {
        /// The edit.
        edit: u32,
    },
    /// A hierarchical edit's value is no usable number.
    #[error("edit {edit} (from 0) has a value that is not finite, or beyond {max:e} with those before it", max = crate::mesh::MAX_COORDINATE)]
    EditValue {
        /// The edit.
        edit: u32,
    },
    /// A position is NaN, infinite, or so far away that sums of it leave the range of floats.
    #[error("vertex {vertex} (from 0) has a coordinate that is not finite, or beyond {max:e}", max = crate::mesh::MAX_COORDINATE)]
    NotFinite {
        /// The vertex.
        vertex: u32,
    },
    /// There are densities, but not one a vertex.
    #[error("{found} densities are given for {expected} vertices; expected one a vertex, or none")]
    DensityCount {
        /// Number of vertices.
        expected: u64,
        /// Densities found.
        found: u64,
    },
    /// A density is NaN, infinite or below zero.
    #[error("the density of vertex {vertex} (from 0) is not finite, or below zero")]
    Density {
        /// The vertex.
        vertex: u32,
    },
    /// There are colours, but not one a vertex.
    #[error("{found} colours are given for {expected} vertices; expected one a vertex, or none")]
    ColorCount {
        /// Number of vertices.
        expected: u64,
        /// Colours found.
        found: u64,
    },
    /// A colour is NaN, infinite, or so large that sums of it leave the range of floats.
    #[error("vertex {vertex} (from 0) has a colour that is not finite, or beyond {max:e}", max = crate::mesh::MAX_COORDINATE)]
    Color {
        /// The vertex.
        vertex: u32,
    },
    /// A face-varying channel has an index out of range, or a value that is no usable number.
    #[error("face-varying channel {channel} (from 0): {fault}")]
    FaceVarying {
        /// The channel.
        channel: u32,
        /// What is wrong with it.
        fault: String,
    },
    /// The tables would need indices of more than 32 bits.
    #[error("level {level} would have {count} elements; at most 2^31 can be indexed")]
    TooLarge {
        /// The level.
        level: u32,
        /// How many elements it would have.
        count: u64,
    },
    /// More levels were asked for than the tables can number.
    #[error("max level {asked} is out of range: expected 0 to {max}")]
    MaxLevel {
        /// Level asked for.
        asked: u32,
        /// Largest level.
        max: u32,
    },
}
