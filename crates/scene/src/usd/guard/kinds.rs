//! Types of values in a binary layer, and what each of them is stored as.

/// How arrays of a type may be packed.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Packing {
    None,
    Integers,
    Floats,
}

/// What lists consist of.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Item {
    Token,
    String,
    Path,
    Reference,
    Payload,
    /// Numbers of so many bytes.
    Number(u64),
    /// Two strings.
    Selection,
    /// Two paths.
    Relocation,
}

/// What a type is stored as.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Kind {
    /// So many bytes.
    Fixed(u64, Packing),
    Token,
    String,
    /// A string where it is stored apart, a token where it is inlined.
    Asset,
    Dictionary,
    TimeSamples,
    Doubles,
    Payload,
    List(Item),
    ListOp(Item),
    /// Nothing, or nothing that is read.
    Nothing,
}

/// What the type of a code is stored as (`CrateDataTypes` of OpenUSD).
pub fn kind(code: u8) -> Kind {
    use Packing::{Floats, Integers, None};
    match code {
        1 | 2 => Kind::Fixed(1, None),
        3 | 4 => Kind::Fixed(4, Integers),
        5 | 6 => Kind::Fixed(8, Integers),
        7 => Kind::Fixed(2, Floats),
        8 => Kind::Fixed(4, Floats),
        9 | 56 => Kind::Fixed(8, Floats),
        10 => Kind::String,
        11 | 53 => Kind::Token,
        12 | 57 => Kind::Asset,
        13 => Kind::Fixed(32, None),
        14 => Kind::Fixed(72, None),
        15 => Kind::Fixed(128, None),
        // Quaternions: double, float, half.
        16 => Kind::Fixed(32, None),
        17 => Kind::Fixed(16, None),
        18 => Kind::Fixed(8, None),
        // Vectors of 2, 3 and 4: double, float, half, int.
        19..=30 => {
            let count = u64::from(code - 19) / 4 + 2;
            Kind::Fixed(count * [8, 4, 2, 4][usize::from(code - 19) % 4], None)
        }
        31 => Kind::Dictionary,
        32 => Kind::ListOp(Item::Token),
        33 | 54 => Kind::ListOp(Item::String),
        34 => Kind::ListOp(Item::Path),
        35 => Kind::ListOp(Item::Reference),
        36 | 38 => Kind::ListOp(Item::Number(4)),
        37 | 39 => Kind::ListOp(Item::Number(8)),
        40 => Kind::List(Item::Path),
        41 => Kind::List(Item::Token),
        // Specifier, permission, variability.
        42..=44 => Kind::Fixed(4, None),
        45 => Kind::List(Item::Selection),
        46 => Kind::TimeSamples,
        47 => Kind::Payload,
        48 => Kind::Doubles,
        // Offset and scale.
        49 => Kind::List(Item::Number(16)),
        50 => Kind::List(Item::String),
        55 => Kind::ListOp(Item::Payload),
        58 => Kind::List(Item::Relocation),
        _ => Kind::Nothing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_have_the_size_of_their_numbers() {
        let sizes: Vec<Kind> = (19..31).map(kind).collect();
        let expected = [16, 8, 4, 8, 24, 12, 6, 12, 32, 16, 8, 16].map(|size| Kind::Fixed(size, Packing::None));
        assert_eq!(sizes, expected);
    }
}
