//! Subdivision schemes.

/// A stationary subdivision scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scheme {
    /// Catmull and Clark 1978: faces of any number of sides.
    #[default]
    CatmullClark,
    /// Loop 1987: triangles.
    Loop,
    /// Stam and Loop 2003: triangles and quads.
    LoopStam,
    /// Zorin, Schroeder and Sweldens 1996, Modified Butterfly: triangles, interpolated.
    Butterfly,
}

impl Scheme {
    /// Its name as it is written on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::CatmullClark => "catmull-clark",
            Self::Loop => "loop",
            Self::LoopStam => "loop-stam",
            Self::Butterfly => "butterfly",
        }
    }
}
