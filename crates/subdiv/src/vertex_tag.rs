//! What decides the rules at a vertex, in two bytes.

/// What decides the rules at a vertex.
///
/// | bit | meaning |
/// |---|---|
/// | 0 | boundary: the faces form one fan between two boundary edges |
/// | 1 | corner: infinitely sharp, interpolated |
/// | 2 | not a regular arrangement of faces |
/// | 3 | touches a face that is no quad (level 0 only) |
/// | 4 | semi-sharp itself, or an end of a semi-sharp edge: its rule still changes from level to level |
/// | 5 | an end of an infinitely sharp edge between two faces |
/// | 6 | not manifold: more than one fan of faces, or an edge of more than two faces |
/// | 7 | infinitely sharp edges do not cut the faces as a regular boundary or corner has them |
/// | 8 | seams of a face-varying channel do not either |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VertexTag(u16);

impl VertexTag {
    const BOUNDARY: u16 = 1;
    const CORNER: u16 = 2;
    const EXTRAORDINARY: u16 = 4;
    const BESIDE_NON_QUAD: u16 = 8;
    const SEMI_SHARP: u16 = 16;
    const INFINITE_CREASE: u16 = 32;
    const NON_MANIFOLD: u16 = 64;
    const IRREGULAR_SECTORS: u16 = 128;
    const IRREGULAR_VALUES: u16 = 256;

    /// The tag of a manifold vertex with this many faces.
    pub fn new(face_count: u32, boundary: bool, corner: bool, beside_non_quad: bool) -> Self {
        let regular = match (boundary, corner) {
            (false, false) => face_count == 4,
            (false, true) => false,
            (true, false) => face_count == 2,
            (true, true) => face_count == 1,
        };
        Self(
            (u16::from(boundary) * Self::BOUNDARY)
                | (u16::from(corner) * Self::CORNER)
                | (u16::from(!regular) * Self::EXTRAORDINARY)
                | (u16::from(beside_non_quad) * Self::BESIDE_NON_QUAD),
        )
    }

    /// The tag of a vertex that is not manifold.
    pub(crate) fn non_manifold(corner: bool, beside_non_quad: bool) -> Self {
        let plain = Self::new(0, false, corner, beside_non_quad);
        Self(plain.0 | Self::NON_MANIFOLD)
    }

    /// The tag of the middle of an edge that is not manifold: a crease with two faces on every side of it.
    pub(crate) fn middle_of_non_manifold() -> Self {
        Self::non_manifold(false, false)
    }

    /// The tag with what its edges' and its own sharpness adds.
    pub(crate) fn with_sharpness(self, semi_sharp: bool, infinite_crease: bool) -> Self {
        let kept = self.0 & !(Self::SEMI_SHARP | Self::INFINITE_CREASE);
        Self(kept | (u16::from(semi_sharp) * Self::SEMI_SHARP) | (u16::from(infinite_crease) * Self::INFINITE_CREASE))
    }

    pub(crate) fn with_irregular_sectors(self) -> Self {
        Self(self.0 | Self::IRREGULAR_SECTORS)
    }

    pub(crate) fn with_irregular_values(self) -> Self {
        Self(self.0 | Self::IRREGULAR_VALUES)
    }

    /// The tag with what an older one of the same vertex says of face-varying channels.
    pub(crate) fn with_values_of(self, older: Self) -> Self {
        Self(self.0 | older.0 & Self::IRREGULAR_VALUES)
    }

    /// On the boundary of a manifold part: the crease rule, unless it is a corner.
    pub fn is_boundary(self) -> bool {
        self.0 & Self::BOUNDARY != 0
    }

    /// Interpolated at every level.
    pub fn is_corner(self) -> bool {
        self.0 & Self::CORNER != 0
    }

    /// Other than four faces inside, two on the boundary, one at a corner.
    pub fn is_extraordinary(self) -> bool {
        self.0 & Self::EXTRAORDINARY != 0
    }

    /// Semi-sharp, or an end of a semi-sharp edge.
    pub fn is_semi_sharp(self) -> bool {
        self.0 & Self::SEMI_SHARP != 0
    }

    /// An end of an infinitely sharp edge between two faces.
    pub fn has_infinite_crease(self) -> bool {
        self.0 & Self::INFINITE_CREASE != 0
    }

    /// More than one fan of faces, or an edge of more than two faces.
    pub fn is_non_manifold(self) -> bool {
        self.0 & Self::NON_MANIFOLD != 0
    }

    /// Smooth, a boundary without creases, or a sharpened boundary vertex: the rule follows from the tag alone.
    pub fn is_plain(self) -> bool {
        self.0 & (Self::SEMI_SHARP | Self::INFINITE_CREASE | Self::NON_MANIFOLD) == 0
    }

    /// Quads all of whose vertices are so have a bicubic limit patch, and so do their face-varying values.
    pub fn is_regular(self) -> bool {
        let is_cut = self.0 & (Self::INFINITE_CREASE | Self::NON_MANIFOLD) != 0;
        let irregular = if is_cut { Self::IRREGULAR_SECTORS } else { Self::EXTRAORDINARY };
        self.0 & (irregular | Self::IRREGULAR_VALUES | Self::BESIDE_NON_QUAD | Self::SEMI_SHARP) == 0
    }

    /// All faces at the vertex are quads.
    pub fn touches_only_quads(self) -> bool {
        self.0 & Self::BESIDE_NON_QUAD == 0
    }

    /// The tag of the vertex that it becomes one level down, where all faces are quads; sharpness apart.
    pub(crate) fn child(self) -> Self {
        Self(self.0 & !Self::BESIDE_NON_QUAD)
    }
}
