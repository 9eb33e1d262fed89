//! CPU twin of the emit stage's part for Gregory patches, `glsl/shared/emit_gregory.glsl`.

use planish_subdiv::tables::{GregoryFace, GregoryKind};

use crate::emit::{EmitInput, Emitted};
use crate::factors::{PatchFactors, triangle_count};
use crate::gregory_points::Seats;
use crate::gregory_visibility::is_gregory_unseen;
use crate::lists::PatchKind;
use crate::objects::to_world;

impl EmitInput<'_> {
    /// An irregular face that is drawn as a Gregory patch.
    pub(crate) fn gregory_leaf(&self, place: u32, face: &GregoryFace, split_edges: u32, emitted: &mut Emitted) {
        let factors = self.factors(&self.tables.irregular[place as usize].info, split_edges);
        let pieces = factors.cut_count();
        if self.is_culled() && self.is_gregory_left_out(face, &factors) {
            return;
        }
        let is_triangle = matches!(face.kind, GregoryKind::PartOfTriangle(_));
        if pieces == 1 {
            let kind = if is_triangle { PatchKind::Triangle } else { PatchKind::Gregory };
            return emitted[kind as usize].push(self.entry(place, split_edges, factors.triangle_count(), &factors));
        }
        let kind = if is_triangle { PatchKind::TriangleCut } else { PatchKind::GregoryCut };
        for i in 0..pieces * pieces {
            let piece = [i % pieces, i / pieces];
            let own = factors.piece(pieces, piece);
            let flags = split_edges | piece[0] << 4 | piece[1] << 12 | pieces << 20;
            let triangles = triangle_count(own.counts, own.inner);
            emitted[kind as usize].push(self.entry(place, flags, triangles, &factors));
        }
    }

    fn is_gregory_left_out(&self, face: &GregoryFace, factors: &PatchFactors) -> bool {
        let seats = Seats { limits: self.limits, spokes: self.spokes };
        let points = seats.control_points(face).into_iter().map(|point| to_world(self.object.0, point));
        // A bicubic patch with a semi-sharp crease that decides along an edge has another curve there.
        let is_creased = |place: u32| self.tables.patches[place as usize].sharpness != 0.0;
        let has_creased_border = face.borders.iter().flatten().any(|border| is_creased(border.patch));
        let cull_back = self.culls_back() && factors.cut_count() == 1 && !has_creased_border;
        let points: Vec<_> = points.collect();
        is_gregory_unseen(&points, self.view, &factors.grain(), cull_back, self.object.0.displacement)
    }
}
