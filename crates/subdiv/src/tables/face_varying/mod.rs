//! Face-varying channels as the GPU reads them: values that need no further refinement, beside the patches and the
//! irregular faces.
//!
//! Channels do not animate, so all is done here, once and in f64: control values of every patch with the reflected rows
//! already made, and exact limit values at the corners and edge middles of irregular faces.

mod evaluate;
mod tree;

use std::collections::HashMap;

use crate::face_varying::{Channel, ChannelLevel};
use crate::limit::LimitTable;
use crate::patch::CORNERS;
use crate::refine::{Refinement, child_half_edge};
use crate::tables::limits::{LimitPoints, children};
use crate::tables::{MeshRanges, Tables};
use crate::topology::NONE;

pub use evaluate::FaceVaryingEvaluator;
pub use tree::TexTree;

/// The 16 control values of a patch, row by row (v), u running fastest, as its control points: indices into
/// [`FaceVaryingTable::values`]. Reflected rows are stored like all others, so no mask is needed, and the patch is
/// evaluated by the plain B-spline basis, or by the crease basis where `PatchInfo::crease` says that the patch has one.
///
/// All are [`NONE`] in merged tables, for a patch of a mesh that has no such channel.
pub type FaceVaryingPatch = [u32; 16];

/// One channel of a mesh, or of several as one ([`Tables::merge`]).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceVaryingTable {
    /// The channel's name.
    pub name: String,
    /// The channel is bilinear in every face (`FaceVaryingInterpolation::All`). Then the places 5, 6, 10 and 9 of a patch
    /// are the values at its corners (0,0), (1,0), (1,1) and (0,1), and those around them extrapolate: the spline is the
    /// bilinear function.
    pub is_linear: bool,
    /// Limit values first, then control values of patches. Equal ones of different vertices or levels stand apart.
    pub values: Vec<[f32; 2]>,
    /// For each of the limit values, which are the first of `values`: its limits under the two tangent masks of the
    /// position's limit row at the same corner ([`Tables::limits`], weights 1 and 2). With the position's tangents at that
    /// corner they give the channel's derivatives in space. 0 where the channel has rules of its own, at the ends of seams
    /// and along them, and in bilinear channels.
    pub tangents: Vec<[[f32; 2]; 2]>,
    /// Parallel to [`Tables::patches`].
    pub patches: Vec<FaceVaryingPatch>,
    /// Parallel to [`Tables::irregular`]: the limit values at corners 0 to 3 and in the middles of edges 0 to 3, as the
    /// face itself has them on its side of a seam. [`NONE`] where `limits` and `midpoints` of the face have none.
    pub faces: Vec<[u32; 8]>,
    /// Parallel to [`Tables::filling`]: the limit values at (0,0), (1,0), (1,1), (0,1).
    pub filling: Vec<[u32; 4]>,
}

/// The tables of a refinement's channels, for its other tables.
pub(super) fn tables(tables: &Tables, refinement: &Refinement) -> Vec<FaceVaryingTable> {
    let channels = refinement.face_varying.iter();
    channels.map(|channel| TableBuilder::new(tables, refinement, channel).table()).collect()
}

/// Numbers a channel's values as they are asked for.
struct TableBuilder<'a> {
    tables: &'a Tables,
    refinement: &'a Refinement,
    channel: &'a Channel,
    limits: Vec<[f64; 2]>,
    tangents: Vec<[[f64; 2]; 2]>,
    /// The limit value for each limit point and value there.
    limit_of: HashMap<(u32, u32), u32>,
    controls: Vec<[f64; 2]>,
    /// The control value for each level and value.
    control_of: HashMap<(u32, u32), u32>,
    /// The control value that is twice one less another.
    reflection_of: HashMap<(u32, u32), u32>,
}

impl<'a> TableBuilder<'a> {
    fn new(tables: &'a Tables, refinement: &'a Refinement, channel: &'a Channel) -> Self {
        Self {
            tables,
            refinement,
            channel,
            limits: Vec::new(),
            tangents: Vec::new(),
            limit_of: HashMap::new(),
            controls: Vec::new(),
            control_of: HashMap::new(),
            reflection_of: HashMap::new(),
        }
    }

    fn table(mut self) -> FaceVaryingTable {
        let mut faces = Vec::with_capacity(self.tables.irregular.len());
        let mut patches = Vec::with_capacity(self.tables.patches.len());
        let first_points: Vec<u32> = self.tables.levels.iter().map(|level| level.points.start).collect();
        let mut no_rows = LimitTable::default();
        let places = LimitPoints::new(self.refinement, &first_points, &mut no_rows);
        if !self.refinement.options.uniform {
            for k in 0..=self.refinement.last_level {
                self.add_patches(k, &mut patches);
                self.add_faces(k, &places, &mut faces);
            }
        }
        let filling = self.filling(&places);
        let first_control = self.limits.len() as u32;
        patches.iter_mut().flatten().for_each(|value| *value += first_control);
        let is_linear = self.channel.levels[0].is_linear;
        let rounded = |value: [f64; 2]| value.map(|c| c as f32);
        FaceVaryingTable {
            name: self.channel.name.clone(),
            is_linear,
            values: self.limits.into_iter().chain(self.controls).map(rounded).collect(),
            tangents: self.tangents.into_iter().map(|tangents| tangents.map(rounded)).collect(),
            patches,
            faces,
            filling,
        }
    }

    fn level(&self, k: u32) -> &'a ChannelLevel {
        &self.channel.levels[k as usize]
    }

    /// Adds the control values of a level's patches, in the order of the patches.
    fn add_patches(&mut self, k: u32, patches: &mut Vec<FaceVaryingPatch>) {
        let level = &self.refinement.levels[k as usize];
        let is_irregular = self.refinement.flags(k, &self.refinement.irregular_faces[k as usize]);
        for face in (0..level.drawn_count).filter(|&face| level.is_drawn(face) && !is_irregular[face as usize]) {
            let (corners, boundary) = self.level(k).control_corners(level, face);
            let mut patch = corners.map(|corner| self.control(k, corner));
            self.reflect(&mut patch, boundary);
            patches.push(patch);
        }
    }

    fn control(&mut self, k: u32, corner: u32) -> u32 {
        let value = self.level(k).corners[corner as usize];
        let of = self.level(k).values[value as usize];
        let controls = &mut self.controls;
        *self.control_of.entry((k, value)).or_insert_with(|| {
            controls.push(of);
            controls.len() as u32 - 1
        })
    }

    /// Makes the outer rows across the boundary edges of a mask: columns first, then whole rows, as [`crate::patch::reflect`].
    fn reflect(&mut self, patch: &mut FaceVaryingPatch, boundary: u8) {
        /// For each edge the step from a row to the one further in, and the first outer place.
        const EDGES: [(u8, usize, isize, usize); 4] = [(8, 0, 1, 4), (2, 3, -1, 4), (1, 0, 4, 1), (4, 12, -4, 1)];
        for (edge, first, inward, along) in EDGES {
            if boundary & edge == 0 {
                continue;
            }
            for i in 0..4 {
                let outer = first + i * along;
                let [near, far] = [1, 2].map(|steps| patch[outer.wrapping_add_signed(steps * inward)]);
                patch[outer] = self.reflection(near, far);
            }
        }
    }

    fn reflection(&mut self, near: u32, far: u32) -> u32 {
        let controls = &mut self.controls;
        *self.reflection_of.entry((near, far)).or_insert_with(|| {
            let [near, far] = [near, far].map(|value| controls[value as usize]);
            controls.push([0, 1].map(|c| 2.0 * near[c] - far[c]));
            controls.len() as u32 - 1
        })
    }

    /// Adds the limit values of a level's irregular faces, in the order of [`Tables::irregular`].
    fn add_faces(&mut self, k: u32, places: &LimitPoints, faces: &mut Vec<[u32; 8]>) {
        let level = &self.refinement.levels[k as usize];
        let split = self.refinement.splits.get(k as usize);
        let children = split.map_or_else(Vec::new, |split| children(level.origins.len(), &split.child_corners));
        for &face in &self.refinement.irregular_faces[k as usize] {
            let half_edges = level.half_edges(face);
            if level.sides(face) != 4 {
                faces.extend(half_edges.map(|_| [NONE; 8]));
                continue;
            }
            let entry = self.tables.irregular[faces.len()];
            let mut values = [NONE; 8];
            for (i, corner) in half_edges.enumerate() {
                if entry.limits[i] != NONE {
                    values[i] = self.limit(entry.limits[i], places.place(k, corner));
                }
                if entry.midpoints[i] != NONE {
                    let middle = child_half_edge(children[corner as usize], level, corner, 1);
                    values[4 + i] = self.limit(entry.midpoints[i], places.place(k + 1, middle));
                }
            }
            faces.push(values);
        }
    }

    /// The limit value at a corner of a level, whose limit point is given.
    fn limit(&mut self, limit_point: u32, (k, corner): (u32, u32)) -> u32 {
        let (of_level, level) = (self.level(k), &self.refinement.levels[k as usize]);
        let (limits, tangents) = (&mut self.limits, &mut self.tangents);
        *self.limit_of.entry((limit_point, of_level.corners[corner as usize])).or_insert_with(|| {
            let limit = of_level.limit(level, corner);
            limits.push(limit.value);
            tangents.push(limit.tangents);
            limits.len() as u32 - 1
        })
    }

    fn filling(&mut self, places: &LimitPoints) -> Vec<[u32; 4]> {
        let last = self.refinement.last_level;
        let level = &self.refinement.levels[last as usize];
        let faces =
            if self.tables.filling.is_empty() { &[] } else { &self.refinement.irregular_faces[last as usize][..] };
        let quads = faces.iter().zip(&self.tables.filling);
        quads
            .map(|(&face, quad)| {
                let first = level.half_edges(face).start;
                [0, 1, 2, 3].map(|i| self.limit(quad.corners[i as usize], places.place(last, first + i)))
            })
            .collect()
    }
}

impl FaceVaryingTable {
    /// The values at the four corners of a patch of a bilinear channel: at (0,0), (1,0), (1,1), (0,1).
    pub fn corner_values(&self, patch: u32) -> [u32; 4] {
        CORNERS.map(|place| self.patches[patch as usize][place])
    }

    /// The tables of several meshes' channels of one number as one: level by level, and within a
    /// level mesh by mesh. A mesh without the channel gets [`NONE`].
    pub(super) fn merged(parts: &[Tables], channel: usize, places: &[MeshRanges]) -> Self {
        let of = |part: &'_ Tables| part.face_varying.get(channel).cloned();
        let tables: Vec<Option<Self>> = parts.iter().map(of).collect();
        let present = || tables.iter().flatten();
        let mut merged = Self {
            name: present().next().map_or_else(String::new, |table| table.name.clone()),
            is_linear: present().all(|table| table.is_linear),
            tangents: present().flat_map(|table| table.tangents.iter().copied()).collect(),
            values: present().flat_map(|table| table.values[..table.tangents.len()].iter().copied()).collect(),
            ..Self::default()
        };
        let (mut first_limit, mut first_control) = (0, merged.values.len() as u32);
        merged.values.extend(present().flat_map(|table| table.values[table.tangents.len()..].iter().copied()));
        let renumbered: Vec<Option<Self>> = tables
            .iter()
            .map(|table| {
                let table = table.as_ref()?;
                let limit_count = table.tangents.len() as u32;
                let place = |value: u32| match value {
                    NONE => NONE,
                    value if value < limit_count => first_limit + value,
                    value => first_control + value - limit_count,
                };
                let moved = Self {
                    patches: table.patches.iter().map(|patch| patch.map(place)).collect(),
                    faces: table.faces.iter().map(|face| face.map(place)).collect(),
                    filling: table.filling.iter().map(|quad| quad.map(place)).collect(),
                    ..Self::default()
                };
                first_limit += limit_count;
                first_control += table.values.len() as u32 - limit_count;
                Some(moved)
            })
            .collect();
        let levels = places.iter().map(|mesh| mesh.patches.len()).max().unwrap_or(0);
        for k in 0..levels {
            for (part, table) in parts.iter().zip(&renumbered) {
                append(&mut merged.patches, &part.patch_ranges, k, table.as_ref().map(|table| &table.patches[..]));
                append(&mut merged.faces, &part.irregular_ranges, k, table.as_ref().map(|table| &table.faces[..]));
            }
        }
        for (part, table) in parts.iter().zip(&renumbered) {
            match table {
                Some(table) => merged.filling.extend(&table.filling),
                None => merged.filling.extend(part.filling.iter().map(|_| [NONE; 4])),
            }
        }
        merged
    }
}

/// Appends a level's part of some entries, or as many that name nothing.
fn append<const N: usize>(
    merged: &mut Vec<[u32; N]>,
    ranges: &[std::ops::Range<u32>],
    k: usize,
    entries: Option<&[[u32; N]]>,
) {
    let range = ranges.get(k).cloned().unwrap_or_default();
    match entries {
        Some(entries) => merged.extend(&entries[range.start as usize..range.end as usize]),
        None => merged.extend(range.map(|_| [NONE; N])),
    }
}
