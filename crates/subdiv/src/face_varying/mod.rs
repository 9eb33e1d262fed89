//! Face-varying channels: values at the corners of faces, refined by OpenSubdiv's rules.
//!
//! Two faces that name different values at an end of their common edge make it a *seam*: the channel is cut open there.
//! Where no seam ends at a vertex the channel follows the vertex' own rules, sharpness included. Where one does, the rules
//! are the channel's, and [`FaceVaryingInterpolation`](crate::mesh::FaceVaryingInterpolation) chooses among them
//! (OpenSubdiv's `vtr/fvarLevel`). Channels do not animate, so they are refined once, here and in f64.
//!
//! | module | idea |
//! |---|---|
//! | `level` | one channel on one level: whose value is whose, seams, and the rules at level 0 |
//! | `rule` | the rules of the values at one vertex, and how they change from level to level |
//! | `split` | one channel, one level down |
//! | `limit` | limits at corners, and the control values of regular faces |

mod level;
mod limit;
mod rule;
mod split;

pub(crate) use level::ChannelLevel;

/// One channel on all levels of a refinement.
#[derive(Clone, Debug)]
pub(crate) struct Channel {
    pub name: String,
    pub levels: Vec<ChannelLevel>,
}
