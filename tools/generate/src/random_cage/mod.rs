//! Random cages: a base shape, random operations on its faces, random positions and random tags.
//!
//! A cage follows from its [`Recipe`]. Every operation and every kind of tag draws from a generator of its own, so that
//! a feature that is switched off, or fewer operations, leave all the rest as it was.
//!
//! | module | idea |
//! |---|---|
//! | `bases` | what it starts from |
//! | `operations` | what happens to the faces |
//! | `manifold` | which faces form a manifold |
//! | `tags` | creases, sharp vertices, holes and options |
mod bases;
pub mod manifold;
mod operations;
mod tags;

use glam::DVec3;

use crate::cage::Cage;
use crate::random::Random;

/// No more faces, however many operations there are.
pub const MAX_FACES: usize = 60;

/// How far vertices are moved at most, along each axis; edges are about 1 long.
const JITTER: f64 = 0.12;

/// What a random cage may have: a bit each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Features(pub u32);

impl Features {
    /// Nothing but quads, closed or open, manifold and consistently oriented.
    pub const PLAIN: Self = Self(0);
    /// Faces that are no quads.
    pub const N_GONS: Self = Self(1);
    /// Infinite sharpness, where there are creases or corners.
    pub const INFINITE: Self = Self(1 << 1);
    /// Whole sharpness, where there are creases or corners.
    pub const SEMI_SHARP: Self = Self(1 << 2);
    /// Fractional sharpness, where there are creases or corners.
    pub const FRACTIONAL: Self = Self(1 << 3);
    /// Sharp edges.
    pub const CREASES: Self = Self(1 << 4);
    /// Sharp vertices.
    pub const CORNERS: Self = Self(1 << 5);
    /// Faces that are not drawn.
    pub const HOLES: Self = Self(1 << 6);
    /// Boundary rules other than edge and corner.
    pub const BOUNDARY_RULES: Self = Self(1 << 7);
    /// Chaikin's rule.
    pub const CHAIKIN: Self = Self(1 << 8);
    /// The rule for smooth triangles.
    pub const SMOOTH_TRIANGLES: Self = Self(1 << 9);
    /// Edges of more than two faces or of opposite orientation, vertices with several fans.
    pub const NONMANIFOLD: Self = Self(1 << 10);
    /// Inside vertices with two faces.
    pub const VALENCE_2: Self = Self(1 << 11);
    /// Fans that begin and end at one edge of many faces, see [`manifold::has_slit_fan`].
    pub const SLIT_FANS: Self = Self(1 << 12);
    /// All of them.
    pub const ALL: Self = Self((1 << 13) - 1);

    /// Each with its name.
    pub const NAMES: [(&str, Self); 13] = [
        ("n-gons", Self::N_GONS),
        ("infinite", Self::INFINITE),
        ("semi-sharp", Self::SEMI_SHARP),
        ("fractional", Self::FRACTIONAL),
        ("creases", Self::CREASES),
        ("corners", Self::CORNERS),
        ("holes", Self::HOLES),
        ("boundary-rules", Self::BOUNDARY_RULES),
        ("chaikin", Self::CHAIKIN),
        ("smooth-triangles", Self::SMOOTH_TRIANGLES),
        ("non-manifold", Self::NONMANIFOLD),
        ("valence-2", Self::VALENCE_2),
        ("slit-fans", Self::SLIT_FANS),
    ];

    /// These and others.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// These but for others.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Those that are also among others.
    #[must_use]
    pub const fn only(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Whether all of some features are among these.
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
}

/// What a random cage follows from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// Where the random numbers begin.
    pub seed: u64,
    /// What the cage may have; whether it has it is up to the seed.
    pub features: Features,
    /// How many operations are tried on the base shape.
    pub operation_count: u32,
}

/// What draws random numbers of its own.
#[derive(Clone, Copy)]
enum Purpose {
    Base,
    Positions,
    Creases,
    Corners,
    Holes,
    Options,
    /// The operation of that number.
    Operation(u32),
}

impl Recipe {
    /// The cage.
    pub fn cage(&self) -> Cage {
        let mut cage = bases::base(&mut self.random(Purpose::Base), self.features);
        for operation in 0..self.operation_count {
            operations::operate(&mut cage, &mut self.random(Purpose::Operation(operation)), self.features);
        }
        jitter(&mut cage, &mut self.random(Purpose::Positions));
        tags::tag(cage, self)
    }

    fn random(&self, purpose: Purpose) -> Random {
        let number = match purpose {
            Purpose::Base => 0,
            Purpose::Positions => 1,
            Purpose::Creases => 2,
            Purpose::Corners => 3,
            Purpose::Holes => 4,
            Purpose::Options => 5,
            Purpose::Operation(operation) => 6 + u64::from(operation),
        };
        Random::new(Random::new(self.seed).bits() ^ Random::new(number).bits())
    }
}

fn jitter(cage: &mut Cage, random: &mut Random) {
    for position in &mut cage.positions {
        *position += JITTER * (2.0 * DVec3::new(random.unit(), random.unit(), random.unit()) - 1.0);
    }
}
