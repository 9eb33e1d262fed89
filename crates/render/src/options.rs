//! What a frame is asked to be.

/// Largest tess factor that a patch can have: the tessellator's own bound, by the specification.
pub const MAX_TESS_FACTOR: f32 = 64.0;
/// The same for fractional-odd spacing.
pub const MAX_ODD_TESS_FACTOR: f32 = 63.0;

/// How the irregular parts of a surface are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceMethod {
    /// Static feature-adaptive subdivision (FAS).
    #[default]
    Fas,
    /// Global table-driven refinement drawn as triangles: the baseline of FAS section 8.1.
    Uniform,
}

/// Where tessellated points lie between whole factors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// Factors are rounded up to whole numbers.
    Equal,
    /// The next odd number of segments, two of them shorter.
    #[default]
    FractionalOdd,
    /// The next even number of segments, two of them shorter; never fewer than two.
    FractionalEven,
}

impl Spacing {
    /// Value of the shaders' specialization constant `SPACING`.
    pub fn constant(self) -> u32 {
        match self {
            Self::Equal => 0,
            Self::FractionalOdd => 1,
            Self::FractionalEven => 2,
        }
    }

    /// Largest factor that a patch can be tessellated with.
    pub fn max_factor(self) -> f32 {
        match self {
            Self::FractionalOdd => MAX_ODD_TESS_FACTOR,
            Self::Equal | Self::FractionalEven => MAX_TESS_FACTOR,
        }
    }
}

/// How finely the surface is tessellated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    /// The same tess factor, at least 1, on every base edge.
    Tess(f32),
    /// Triangle edges of about this many pixels.
    EdgePixels(f32),
}

impl Default for Density {
    fn default() -> Self {
        Self::EdgePixels(4.0)
    }
}

/// What the beauty image shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// Lit by a key, a fill, a rim and a small sky.
    #[default]
    Shaded,
    /// Normals as colours.
    Normal,
    /// Kind of patch by hue, the patch by brightness.
    Patch,
    /// Level of subdivision.
    Level,
    /// Tess factor.
    Tess,
    /// Parameters of the Ptex face.
    Uv,
    /// Shaded, with the edges of all triangles.
    Wire,
}

impl View {
    /// Value of the fragment shader's specialization constant `VIEW`.
    pub fn constant(self) -> u32 {
        match self {
            Self::Shaded | Self::Wire => 0,
            Self::Normal => 1,
            Self::Patch => 2,
            Self::Level => 3,
            Self::Tess => 4,
            Self::Uv => 5,
        }
    }

    /// Whether the view needs more than the normal.
    pub fn needs_layers(self) -> bool {
        !matches!(self, Self::Shaded | Self::Wire)
    }
}
