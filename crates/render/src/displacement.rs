//! Displacement maps on the GPU: `glsl/shared/displacement.glsl` filters them, after `planish_scene::displacement`.

use planish_gpu::{Buffer, Device};
use planish_shaders as shaders;
use planish_shaders::{DisplacementMap, MapLevel, MapTile};
use planish_subdiv::ControlMesh;
use planish_subdiv::tables::{DensitySlots, LimitSeat, MeshRanges, Tables, TexTree};
use planish_subdiv::topology::NONE;

use crate::error::Error;
use crate::upload::{address, table};

/// How the texels of a map lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MapLayout {
    /// One tile over texture coordinates, that repeats.
    #[default]
    Repeat,
    /// A tile for each unit square of texture coordinates.
    Udim,
    /// A tile for each Ptex face, whose border texels lie on its edges.
    Faces,
}

/// A displacement map. All texels are displacements in the mesh's own units.
#[derive(Clone, Copy, Debug, Default)]
pub struct DisplacementDesc<'a> {
    /// Numbers in a texel: 1, along the normal, or 3, a vector in the mesh's own space.
    pub channels: u32,
    /// How tiles lie.
    pub layout: MapLayout,
    /// Interleaved channels.
    pub texels: &'a [f32],
    /// First texel, width and height of the levels of all tiles, or of all faces at once.
    pub levels: &'a [[u32; 3]],
    /// First level and number of levels of each tile; none for faces.
    pub tiles: &'a [[u32; 2]],
    /// Tile of each unit square of texture coordinates, row by row; `u32::MAX` for none.
    pub tile_of: &'a [u32],
    /// Unit squares in a row.
    pub tile_columns: u32,
    /// For faces: a bit each, set for parts of a face of other than four sides.
    pub parts: &'a [u32],
    /// No displacement is longer.
    pub bound: f32,
}

impl DisplacementDesc<'_> {
    /// Texels along u and v of the finest level of the first tile.
    fn size(&self) -> [f32; 2] {
        let [_, width, height] = self.levels.first().copied().unwrap_or([0, 1, 1]);
        match self.layout {
            // Border texels lie on both edges.
            MapLayout::Faces => [width, height].map(|count| (count.max(2) - 1) as f32),
            _ => [width, height].map(|count| count as f32),
        }
    }

    /// For each density slot of a mesh, vertices and n-gons, how many texels lie along an edge there: the mean of the edges of the faces
    /// around a vertex, and of the corners of an n-gon.
    fn texel_counts(&self, mesh: &ControlMesh, slots: &DensitySlots, ranges: &MeshRanges) -> Vec<f32> {
        let [width, height] = self.size();
        let slot_count = ranges.slots.len();
        let Some(channel) = mesh.face_varying.first().filter(|_| self.layout != MapLayout::Faces) else {
            return vec![width; slot_count];
        };
        let vertex_count = mesh.positions.len();
        let mut sums = vec![(0.0_f32, 0.0_f32); vertex_count];
        let mut first = 0;
        for &sides in &mesh.face_sizes {
            let corners = first..first + sides as usize;
            for corner in corners.clone() {
                let next = if corner + 1 == corners.end { corners.start } else { corner + 1 };
                let [a, b] = [corner, next].map(|corner| channel.values[channel.indices[corner] as usize]);
                let length = ((b[0] - a[0]) * width).hypot((b[1] - a[1]) * height);
                for end in [corner, next] {
                    let sum = &mut sums[mesh.face_vertices[end] as usize];
                    *sum = (sum.0 + length, sum.1 + 1.0);
                }
            }
            first = corners.end;
        }
        let mut counts: Vec<f32> = sums.iter().map(|&(sum, count)| sum / count.max(1.0)).collect();
        for slot in vertex_count..slot_count {
            let corners = slots.rings.of(ranges.slots.start + slot as u32);
            let sum: f32 = corners.iter().map(|&corner| counts[corner as usize]).sum();
            counts.push(sum / corners.len().max(1) as f32);
        }
        counts
    }
}

/// The maps of a surface's meshes.
#[derive(Default)]
pub(crate) struct Maps {
    buffers: Vec<Buffer>,
    entries: Vec<DisplacementMap>,
    /// The table of maps, and texel counts of the slots of all meshes.
    pub tables: Option<[Buffer; 2]>,
    texel_counts: Vec<f32>,
}

impl Maps {
    /// Uploads a mesh's map; returns its place. `slot_count` is that of all meshes.
    pub fn add(
        &mut self,
        device: &Device,
        desc: &DisplacementDesc<'_>,
        mesh: &ControlMesh,
        slots: &DensitySlots,
        ranges: &MeshRanges,
    ) -> Result<u32, Error> {
        let levels = desc.levels.iter().map(|&[first_texel, width, height]| MapLevel { first_texel, width, height });
        let tiles = desc.tiles.iter().map(|&[first_level, level_count]| MapTile { first_level, level_count });
        let buffers = [
            table(device, "map texels", desc.texels)?,
            table(device, "map levels", &levels.collect::<Vec<_>>())?,
            table(device, "map tiles", &tiles.collect::<Vec<_>>())?,
            table(device, "map tile places", desc.tile_of)?,
            table(device, "map parts", desc.parts)?,
        ];
        let [width, height] = desc.size();
        self.entries.push(DisplacementMap {
            texels: address(&buffers[0]),
            levels: address(&buffers[1]),
            tiles: address(&buffers[2]),
            tile_of: address(&buffers[3]),
            parts: address(&buffers[4]),
            channels: desc.channels,
            // LAYOUT_REPEAT, LAYOUT_UDIM and LAYOUT_FACES.
            layout_kind: desc.layout as u32,
            tile_columns: desc.tile_columns,
            tile_rows: desc.tile_of.len() as u32 / desc.tile_columns.max(1),
            level_count: desc.levels.len() as u32,
            texel: [1.0 / width, 1.0 / height],
            ..DisplacementMap::default()
        });
        self.buffers.extend(buffers);
        let slot_count = slots.rings.count() as usize;
        self.texel_counts.resize(slot_count, 0.0);
        let counts = desc.texel_counts(mesh, slots, ranges);
        self.texel_counts[ranges.slots.start as usize..][..counts.len()].copy_from_slice(&counts);
        self.tables = Some([
            table(device, "displacement maps", &self.entries)?,
            table(device, "texel counts", &self.texel_counts)?,
        ]);
        Ok(self.entries.len() as u32 - 1)
    }

    pub fn all(&self) -> impl Iterator<Item = &Buffer> {
        self.buffers.iter().chain(self.tables.iter().flatten())
    }
}

/// Texture coordinates as the shaders read them: of displaced surfaces 16 of each patch and 8 of each irregular face; of others trees
/// with their patches and quads.
pub(crate) struct TexCoordBuffers {
    pub values: Buffer,
    pub patches: Buffer,
    pub faces: Buffer,
    pub nodes: Buffer,
    pub roots: Buffer,
}

impl TexCoordBuffers {
    /// Of displaced surfaces with Gregory patches: those of the bicubic patches, and a tree of all meshes for the others.
    pub fn of_tables_and_tree(device: &Device, tables: &Tables, tree: &TexTree) -> Result<Self, Error> {
        let channel = tables.face_varying.first();
        let mut both = TexTree {
            values: channel.map_or_else(Vec::new, |channel| channel.values.clone()),
            patches: channel.map_or_else(|| vec![[NONE; 16]; tables.patches.len()], |channel| channel.patches.clone()),
            ..TexTree::default()
        };
        both.append(tree);
        Self::of_tree(device, &both)
    }

    pub fn of_tables(device: &Device, tables: &Tables) -> Result<Self, Error> {
        let channel = tables.face_varying.first();
        let values = channel.map_or(&[][..], |channel| &channel.values);
        let patches: Vec<u32> = channel.map_or_else(Vec::new, |channel| channel.patches.concat());
        let faces: Vec<u32> = channel.map_or_else(Vec::new, |channel| channel.faces.concat());
        // A mesh without a channel may be displaced too: the first entries say so.
        let or_none = |entries: Vec<u32>, count: usize| if entries.is_empty() { vec![NONE; count] } else { entries };
        Self::new(
            device,
            values,
            &or_none(patches, 16 * tables.patches.len()),
            &or_none(faces, 8 * tables.irregular.len()),
            &[],
            // Until it is given coordinates a surface has none, whatever its shaders look up.
            &vec![NONE; tables.ptex_faces.len()],
        )
    }

    pub fn of_tree(device: &Device, tree: &TexTree) -> Result<Self, Error> {
        Self::new(device, &tree.values, &tree.patches.concat(), &tree.quads.concat(), &tree.nodes.concat(), &tree.roots)
    }

    fn new(
        device: &Device,
        values: &[[f32; 2]],
        patches: &[u32],
        faces: &[u32],
        nodes: &[u32],
        roots: &[u32],
    ) -> Result<Self, Error> {
        Ok(Self {
            values: table(device, "texture coordinates", values)?,
            patches: table(device, "texture coordinates of patches", patches)?,
            faces: table(device, "texture coordinates of faces", faces)?,
            nodes: table(device, "nodes of texture coordinates", nodes)?,
            roots: table(device, "roots of texture coordinates", roots)?,
        })
    }

    pub fn all(&self) -> [&Buffer; 5] {
        [&self.values, &self.patches, &self.faces, &self.nodes, &self.roots]
    }
}

/// What the displacement at limit points is found by.
pub(crate) fn limit_seats(tables: &Tables) -> Vec<shaders::LimitSeat> {
    let seat = |seat: &LimitSeat| shaders::LimitSeat {
        canonical: seat.canonical,
        uv: seat.uv,
        along_a: seat.tangents[0],
        along_b: seat.tangents[1],
    };
    tables.limit_seats.iter().map(seat).collect()
}
