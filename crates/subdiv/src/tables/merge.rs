//! Several meshes as one set of tables, so that one dispatch does a level of all of them.
//!
//! Everything is level by level, and within a level mesh by mesh. What names points, limit points, faces, edges or stars
//! is renumbered; Ptex faces and density slots keep their numbers in their own mesh.

use std::ops::Range;

use crate::edits::PointEdit;
use crate::error::Error;
use crate::mesh::MAX_ELEMENTS;
use crate::patch::{FillingQuad, RegularPatch};
use crate::stencil::StencilRow;
use crate::tables::{Border, FaceVaryingTable, IrregularFace, LevelPoints, LimitSeat, PatchSeams, Tables};
use crate::topology::NONE;

/// Where a mesh lies in tables.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MeshRanges {
    /// Its cage points, among all points.
    pub cage_points: Range<u32>,
    /// By level (none at level 0) and dispatch: its stencil rows. Empty where it has no such level or dispatch.
    pub rows: Vec<Vec<Range<u32>>>,
    /// By level, among the patches.
    pub patches: Vec<Range<u32>>,
    /// By level, among the irregular faces. Those of level 0 are where a selection begins.
    pub irregular: Vec<Range<u32>>,
    /// Among [`Tables::ptex_faces`]. The Ptex face of a location is counted within the mesh.
    pub ptex_faces: Range<u32>,
    /// Among the density slots' lists. Slots are counted within the mesh: vertices first, then n-gons.
    pub slots: Range<u32>,
    /// Its split edges.
    pub edges: Range<u32>,
    /// Its stars.
    pub stars: Range<u32>,
    /// Its limit points.
    pub limits: Range<u32>,
    /// Its spokes of Gregory patches.
    pub spokes: Range<u32>,
    /// Among the faces of uniform refinement.
    pub filling: Range<u32>,
    /// By level, among [`Tables::edits`].
    pub edits: Vec<Range<u32>>,
}

impl Tables {
    /// The ranges of the whole, for tables of one mesh.
    pub fn ranges(&self) -> MeshRanges {
        MeshRanges {
            cage_points: 0..self.cage_point_count,
            rows: self.levels.iter().map(|level| level.dispatches.clone()).collect(),
            patches: if self.basis.patches.is_empty() {
                self.patch_ranges.clone()
            } else {
                vec![0..self.basis.patches.len() as u32, 0..0]
            },
            irregular: self.irregular_ranges.clone(),
            ptex_faces: 0..self.ptex_faces.len() as u32,
            slots: 0..self.slots.rings.count(),
            edges: 0..self.edge_count,
            stars: 0..self.stars.count(),
            limits: 0..self.limit_point_count(),
            spokes: 0..self.gregory.spoke_count(),
            filling: 0..self.filling.len() as u32,
            edits: self.levels.iter().map(|level| level.edits.clone()).collect(),
        }
    }

    /// The tables of several meshes as one, and where each mesh lies in them. A level has as many dispatches as the mesh
    /// with the most; a mesh with fewer is in the last ones. One part stays as it is.
    ///
    /// Face-varying channels are merged by their number: channel i of all meshes becomes channel i, under the first mesh'
    /// name of it. What a mesh without it has instead are indices of [`NONE`].
    ///
    /// Fails where indices would not fit.
    ///
    /// # Panics
    /// If there is no part, or if the parts' `max_level` differ.
    pub fn merge(mut parts: Vec<Self>) -> Result<(Self, Vec<MeshRanges>), Error> {
        assert!(!parts.is_empty(), "tables of one mesh at least");
        assert!(parts.iter().all(|part| part.max_level == parts[0].max_level), "one max_level for all meshes");
        if parts.len() == 1 {
            let ranges = vec![parts[0].ranges()];
            return Ok((parts.remove(0), ranges));
        }
        let last_level = parts.iter().map(|part| part.last_level).max().unwrap_or(0);
        let count = parts.iter().map(Self::largest_index).sum::<u64>();
        if count >= u64::from(MAX_ELEMENTS) {
            return Err(Error::TooLarge { level: last_level, count });
        }
        let patches = parts.iter().map(|part| part.patches.len() as u64).sum::<u64>();
        if patches >= Border::MAX_PATCHES {
            return Err(Error::TooLarge { level: last_level, count: patches });
        }
        let mut merged = Self { max_level: parts[0].max_level, last_level, ..Self::default() };
        let mut meshes = vec![MeshRanges::default(); parts.len()];
        merged.place_points(&parts, &mut meshes);
        merged.place_faces(&parts, &mut meshes);
        let places = parts.iter().zip(&meshes);
        let points: Vec<Vec<u32>> = places.map(|(part, mesh)| part.new_points(mesh, merged.cage_point_count)).collect();
        for ((part, mesh), points) in parts.iter().zip(&mut meshes).zip(&points) {
            merged.append_slots(part, mesh);
            merged.append_rows(part, points);
            merged.append_limits(part, mesh, points);
            let patches = merged.basis.append(&part.basis, points, mesh.limits.start);
            if !patches.is_empty() {
                mesh.patches[0] = patches;
            }
        }
        let stencils: Vec<(u32, Vec<u32>)> = parts
            .iter()
            .zip(&points)
            .map(|(part, points)| merged.gregory.stencils.append_tables(&part.gregory.stencils, points))
            .collect();
        for k in 0..=last_level as usize {
            for ((part, points), (first, tables)) in parts.iter().zip(&points).zip(&stencils) {
                let range = part.irregular_ranges.get(k).cloned().unwrap_or_default();
                let own = part.gregory.stencils.faces.get(to_usize(range)).unwrap_or_default();
                merged.gregory.stencils.append_faces(own, *first, tables, points);
            }
            let first_edit = merged.edits.len() as u32;
            merged.hierarchical_edit_count = 0;
            for ((part, mesh), points) in parts.iter().zip(&mut meshes).zip(&points) {
                merged.append_faces(part, mesh, points, k);
                merged.append_edits(part, mesh, points, k);
            }
            merged.levels[k].edits = first_edit..merged.edits.len() as u32;
        }
        let channel_count = parts.iter().map(|part| part.face_varying.len()).max().unwrap_or(0);
        let channels = (0..channel_count).map(|channel| FaceVaryingTable::merged(&parts, channel, &meshes));
        merged.face_varying = channels.collect();
        Ok((merged, meshes))
    }

    /// A bound on all numbers in the tables.
    fn largest_index(&self) -> u64 {
        let counts = [
            self.point_count() as usize,
            self.stencils.indices.len(),
            self.stencils.weights.len(),
            self.limits.indices.len(),
            self.limits.weights.len(),
            self.gregory.indices.len(),
            self.gregory.stencils.rings.len(),
            self.gregory.stencils.weights.len(),
            self.stars.indices.len(),
            self.patches.len(),
            self.basis.patches.len(),
            self.basis.controls.len(),
            self.basis.weights.len(),
            2 * self.basis.edges.len(),
            self.irregular.len(),
            self.slots.rings.indices.len(),
            self.slots.neighbours.indices.len(),
        ];
        let values = self.face_varying.iter().map(|table| table.values.len());
        counts.into_iter().chain(values).max().unwrap_or(0) as u64
    }

    /// Gives every level of points its place. The rows of a level's last dispatch come first, as in one mesh.
    fn place_points(&mut self, parts: &[Self], meshes: &mut [MeshRanges]) {
        for (part, mesh) in parts.iter().zip(meshes.iter_mut()) {
            mesh.cage_points = following(self.cage_point_count, part.cage_point_count);
            self.cage_point_count = mesh.cage_points.end;
            mesh.rows.push(Vec::new());
        }
        self.levels.push(LevelPoints { points: 0..self.cage_point_count, ..LevelPoints::default() });
        let mut row = 0;
        for k in 1..=self.last_level as usize {
            let dispatches_of = |part: &Self| part.levels.get(k).map_or(0, |level| level.dispatches.len());
            let count = parts.iter().map(dispatches_of).max().unwrap_or(0);
            meshes.iter_mut().for_each(|mesh| mesh.rows.push(vec![0..0; count]));
            let first = row;
            let mut dispatches = vec![0..0; count];
            for phase in (0..count).rev() {
                dispatches[phase].start = row;
                for (part, mesh) in parts.iter().zip(meshes.iter_mut()) {
                    let own = (phase + dispatches_of(part)).checked_sub(count);
                    let own_count = own.map_or(0, |own| part.levels[k].dispatches[own].len() as u32);
                    mesh.rows[k][phase] = row..row + own_count;
                    row += own_count;
                }
                dispatches[phase].end = row;
            }
            let points = first + self.cage_point_count..row + self.cage_point_count;
            self.levels.push(LevelPoints { points, dispatches, edits: 0..0 });
        }
    }

    /// Gives the faces of every level their places.
    fn place_faces(&mut self, parts: &[Self], meshes: &mut [MeshRanges]) {
        let (mut patch, mut irregular) = (0, 0);
        for k in 0..=self.last_level as usize {
            let (first_patch, first_irregular) = (patch, irregular);
            for (part, mesh) in parts.iter().zip(meshes.iter_mut()) {
                let count = |ranges: &[Range<u32>]| ranges.get(k).map_or(0, |range| range.len() as u32);
                mesh.patches.push(patch..patch + count(&part.patch_ranges));
                mesh.irregular.push(irregular..irregular + count(&part.irregular_ranges));
                (patch, irregular) = (mesh.patches[k].end, mesh.irregular[k].end);
            }
            self.patch_ranges.push(first_patch..patch);
            self.irregular_ranges.push(first_irregular..irregular);
        }
    }

    fn append_slots(&mut self, part: &Self, mesh: &mut MeshRanges) {
        mesh.ptex_faces = following(self.ptex_faces.len() as u32, part.ptex_faces.len() as u32);
        self.ptex_faces.extend(&part.ptex_faces);
        mesh.slots = following(self.slots.rings.count(), part.slots.rings.count());
        self.slots.ngon_count += part.slots.ngon_count;
        self.slots.rings.append(&part.slots.rings, |slot| slot);
        self.slots.neighbours.append(&part.slots.neighbours, |slot| slot);
        mesh.edges = following(self.edge_count, part.edge_count);
        self.edge_count = mesh.edges.end;
    }

    /// Appends the weights and indices of a part's stencils, and puts its rows where its points are.
    fn append_rows(&mut self, part: &Self, points: &[u32]) {
        let table = &mut self.stencils;
        let row_count = self.levels.last().map_or(0, |level| level.points.end) - self.cage_point_count;
        table.rows.resize(row_count as usize, StencilRow::default());
        let (first_index, first_weight) = (table.indices.len() as u32, table.weights.len() as u32);
        for (row, &point) in part.stencils.rows.iter().zip(&points[part.cage_point_count as usize..]) {
            table.rows[(point - self.cage_point_count) as usize] = row.moved(first_index, first_weight);
        }
        table.indices.extend(part.stencils.indices.iter().map(|&point| points[point as usize]));
        table.weights.extend(&part.stencils.weights);
    }

    fn append_limits(&mut self, part: &Self, mesh: &mut MeshRanges, points: &[u32]) {
        mesh.limits = following(self.limit_point_count(), part.limit_point_count());
        let table = &mut self.limits;
        let (first_index, first_weight) = (table.indices.len() as u32, table.weights.len() as u32);
        table.rows.extend(part.limits.rows.iter().map(|row| row.moved(first_index, first_weight)));
        table.indices.extend(part.limits.indices.iter().map(|&point| points[point as usize]));
        table.weights.extend(&part.limits.weights);
        let seats = part.limit_seats.iter();
        self.limit_seats.extend(seats.map(|seat| LimitSeat { canonical: seat.canonical + mesh.limits.start, ..*seat }));
        mesh.spokes = following(self.gregory.spoke_count(), part.gregory.spoke_count());
        self.gregory.append_spokes(&part.gregory, points);
        mesh.stars = following(self.stars.count(), part.stars.count());
        self.stars.append(&part.stars, |point| points[point as usize]);
        mesh.filling = following(self.filling.len() as u32, part.filling.len() as u32);
        let corners = |quad: &FillingQuad| quad.corners.map(|limit| limit + mesh.limits.start);
        self.filling.extend(part.filling.iter().map(|quad| FillingQuad { corners: corners(quad), ..*quad }));
    }

    /// Appends a level's patches and irregular faces.
    fn append_faces(&mut self, part: &Self, mesh: &MeshRanges, points: &[u32], k: usize) {
        let moved = |entry: u32, first: u32| if entry == NONE { NONE } else { entry + first };
        let edges = |edges: [u32; 4]| edges.map(|edge| moved(edge, mesh.edges.start));
        let limits = |limits: [u32; 4]| limits.map(|limit| moved(limit, mesh.limits.start));
        let range = |ranges: &[Range<u32>], k: usize| ranges.get(k).cloned().unwrap_or_default();
        let patch_shift = |k: usize| range(&mesh.patches, k).start.wrapping_sub(range(&part.patch_ranges, k).start);
        let own = &part.patches[to_usize(range(&part.patch_ranges, k))];
        let seams = own.iter().filter(|patch| patch.seams != NONE).map(|patch| part.seams[patch.seams as usize]);
        // The patches of a level name their seams in order.
        let mut next_seams = self.seams.len() as u32;
        // Those that decide are of this level, or of the one before.
        let coarse_shift = k.checked_sub(1).map_or(0, patch_shift);
        let shift = |border: &Border| if border.part == Border::WHOLE { patch_shift(k) } else { coarse_shift };
        self.seams.extend(seams.map(|seams| PatchSeams {
            limits: limits(seams.limits),
            borders: seams.borders.map(|border| {
                border.map(|border| Border { patch: border.patch.wrapping_add(shift(&border)), ..border })
            }),
        }));
        self.patches.extend(own.iter().map(|patch| RegularPatch {
            seams: if patch.seams == NONE {
                NONE
            } else {
                next_seams += 1;
                next_seams - 1
            },
            points: patch.points.map(|point| points[point as usize]),
            edges: edges(patch.edges),
            ..*patch
        }));
        let next = |ranges: &[Range<u32>]| range(ranges, k + 1).start;
        let child = |child: u32| match child {
            NONE => NONE,
            _ if child & IrregularFace::IRREGULAR != 0 => child - next(&part.irregular_ranges) + next(&mesh.irregular),
            _ => child - next(&part.patch_ranges) + next(&mesh.patches),
        };
        if !part.gregory.faces.is_empty() {
            let own = &part.gregory.faces[to_usize(range(&part.irregular_ranges, k))];
            let border = |border: Border| Border { patch: border.patch.wrapping_add(patch_shift(k)), ..border };
            self.gregory.append_faces(own, mesh.spokes.start, mesh.limits.start, border);
        }
        let faces = &part.irregular[to_usize(range(&part.irregular_ranges, k))];
        self.irregular.extend(faces.iter().map(|face| IrregularFace {
            children: face.children.map(child),
            edges: edges(face.edges),
            stars: face.stars.map(|star| moved(star, mesh.stars.start)),
            limits: limits(face.limits),
            midpoints: limits(face.midpoints),
            ..*face
        }));
    }

    /// Appends a level's edits; `hierarchical_edit_count` is that of the parts before.
    fn append_edits(&mut self, part: &Self, mesh: &mut MeshRanges, points: &[u32], k: usize) {
        let own = to_usize(part.levels.get(k).map_or(0..0, |level| level.edits.clone()));
        let first = self.edits.len() as u32;
        for (edit, sources) in part.edits[own.clone()].iter().zip(&part.edit_sources[own]) {
            self.edits.push(PointEdit { point: points[edit.point as usize], ..*edit });
            self.edit_sources.push(sources.iter().map(|source| source + self.hierarchical_edit_count).collect());
        }
        mesh.edits.push(first..self.edits.len() as u32);
        self.hierarchical_edit_count += part.hierarchical_edit_count;
    }

    /// Where each point of a part lies among the merged tables' points.
    fn new_points(&self, mesh: &MeshRanges, merged_cage_point_count: u32) -> Vec<u32> {
        let mut points: Vec<u32> = mesh.cage_points.clone().collect();
        points.resize(self.point_count() as usize, NONE);
        for (level, rows) in self.levels.iter().zip(&mesh.rows) {
            let own = rows.len() - level.dispatches.len();
            for (from, to) in level.dispatches.iter().zip(&rows[own..]) {
                for (from, to) in from.clone().zip(to.clone()) {
                    points[(self.cage_point_count + from) as usize] = merged_cage_point_count + to;
                }
            }
        }
        points
    }
}

impl StencilRow {
    pub(super) fn moved(self, first_index: u32, first_weight: u32) -> Self {
        Self {
            first_index: self.first_index + first_index,
            first_weight: self.first_weight + first_weight,
            count: self.count,
        }
    }
}

pub(super) fn following(first: u32, count: u32) -> Range<u32> {
    first..first + count
}

fn to_usize(range: Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}
