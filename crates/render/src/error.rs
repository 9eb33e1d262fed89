//! What can go wrong between a cage and a recorded frame.

use thiserror::Error;

/// Why a surface cannot be uploaded or drawn. One line each.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The cage cannot be refined.
    #[error(transparent)]
    Subdivision(#[from] planish_subdiv::Error),
    /// The device failed.
    #[error(transparent)]
    Gpu(#[from] planish_gpu::Error),
    /// Colours that follow from points of several levels.
    #[error(
        "tables and substitutes have no colours that are subdivided as positions are: expected `t colorinterpolation`, bilinear ones, or none"
    )]
    SubdividedColors,
    /// A face that a substitute of subdivision surfaces has no patch for.
    #[error("face {face} (from 0) has {sides} sides: method {method} expects {accepted}")]
    SubstituteFace {
        /// The substitute.
        method: &'static str,
        /// The face.
        face: u32,
        /// Its number of sides.
        sides: u32,
        /// What it takes.
        accepted: &'static str,
    },
    /// A scheme that is there to compare with has no part in this.
    #[error("method {method} is there to compare with: expected no {what}")]
    Rival {
        /// The scheme.
        method: &'static str,
        /// What it has not.
        what: &'static str,
    },
    /// A tess factor that is no number of segments.
    #[error("tess factor {factor} is out of range: expected a number from 1 to 16000")]
    TessFactor {
        /// The factor.
        factor: f32,
    },
    /// A density that is no length.
    #[error("edge length of {pixels} pixels is out of range: expected a number above 0")]
    EdgePixels {
        /// The length.
        pixels: f32,
    },
    /// The device cannot capture what the tessellation stages produce.
    #[error("device {device} has no VK_EXT_transform_feedback, which dump needs")]
    NoTransformFeedback {
        /// Its name.
        device: String,
    },
    /// The device cannot draw lines.
    #[error("device {device} has no fillModeNonSolid, which the wire view needs")]
    NoLines {
        /// Its name.
        device: String,
    },
    /// The device cannot draw colours of vertices beside the other layers.
    #[error("device {device} draws into {found} colour targets at once, colours of vertices need {expected}")]
    TooFewTargets {
        /// Its name.
        device: String,
        /// Targets that it has.
        found: u32,
        /// Targets that are needed.
        expected: u32,
    },
    /// The tessellator made another number of triangles than its specification says.
    #[error("the device tessellated {found} triangles where {expected} were expected")]
    TriangleCount {
        /// What the factors ask for.
        expected: u64,
        /// What was captured.
        found: u64,
    },
}
