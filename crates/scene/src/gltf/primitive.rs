//! A primitive as it is read: its vertices, and triangles of them (glTF 2.0, section 3.7.2).
use std::collections::{BTreeMap, BTreeSet};

use ::gltf::json::accessor::Accessor;
use ::gltf::json::mesh::{self, Mode, Semantic};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, accessor};

use super::data::Data;
use super::fault::Fault;

/// The extension that says that triangles in a row of the same first vertex are one polygon.
pub const NGON_ENCODING: &str = "FB_ngon_encoding";

/// Vertices and triangles of a primitive, not yet welded. Lists of vertices are parallel.
#[derive(Debug, Default)]
pub struct Primitive {
    pub positions: Vec<[f32; 3]>,
    /// By set; of those sets that are asked for.
    pub texcoords: BTreeMap<u32, Vec<[f32; 2]>>,
    pub colors: Option<Vec<[f32; 3]>>,
    pub influences: Vec<InfluenceSet>,
    /// Offsets of positions, one list a morph target; an empty one moves nothing.
    pub targets: Vec<Vec<[f32; 3]>>,
    pub triangles: Vec<[u32; 3]>,
    /// Whether the order of triangles says which of them are one polygon.
    pub keeps_ngons: bool,
    pub material: Option<usize>,
    /// The accessors of all that moves the vertices: primitives that share them share vertices.
    pub accessors: Vec<usize>,
}

/// Four joints of every vertex and their weights.
#[derive(Debug)]
pub struct InfluenceSet {
    pub joints: Vec<[u32; 4]>,
    pub weights: Vec<[f32; 4]>,
}

/// Reads a primitive of triangles; none for points and lines. `place` names it.
pub fn read(
    data: &Data,
    primitive: &mesh::Primitive,
    texcoord_sets: &BTreeSet<u32>,
    place: &str,
) -> Result<Option<Primitive>, Fault> {
    let Checked::Valid(mode) = primitive.mode else {
        return Err(Fault::new(format!("{place}.mode"), "an unknown mode", "0 to 6"));
    };
    if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
        return Ok(None);
    }
    let reader = Reader { data, primitive, place };
    let Some(positions) = reader.attribute(&Semantic::Positions) else {
        return Err(Fault::new(place, "no POSITION", "one"));
    };
    let mut read = Primitive {
        positions: data.floats(positions, place)?,
        accessors: vec![positions.value()],
        material: primitive.material.map(|material| material.value()),
        keeps_ngons: mode == Mode::Triangles
            && primitive.extensions.as_ref().is_some_and(|extensions| extensions.others.contains_key(NGON_ENCODING)),
        ..Primitive::default()
    };
    reader.texcoords(texcoord_sets, &mut read)?;
    reader.colors(&mut read)?;
    reader.influences(&mut read)?;
    reader.targets(&mut read)?;
    read.triangles = triangles(&reader.indices(read.positions.len())?, mode, place)?;
    Ok(Some(read))
}

struct Reader<'a> {
    data: &'a Data<'a>,
    primitive: &'a mesh::Primitive,
    place: &'a str,
}

impl Reader<'_> {
    fn attribute(&self, semantic: &Semantic) -> Option<Index<Accessor>> {
        self.primitive.attributes.get(&Checked::Valid(semantic.clone())).copied()
    }

    fn named(&self, semantic: &Semantic) -> String {
        format!("{}.attributes.{}", self.place, semantic.to_string())
    }

    /// Refuses a list that is not parallel to the positions.
    fn parallel<T>(&self, values: Vec<T>, read: &Primitive, place: &str) -> Result<Vec<T>, Fault> {
        if values.len() == read.positions.len() {
            return Ok(values);
        }
        Err(Fault::new(place, format!("{} elements", values.len()), format!("{}, as POSITION", read.positions.len())))
    }

    fn texcoords(&self, sets: &BTreeSet<u32>, read: &mut Primitive) -> Result<(), Fault> {
        for &set in sets {
            let semantic = Semantic::TexCoords(set);
            if let Some(accessor) = self.attribute(&semantic) {
                let place = self.named(&semantic);
                let values = self.parallel(self.data.floats(accessor, &place)?, read, &place)?;
                read.texcoords.insert(set, values);
            }
        }
        Ok(())
    }

    fn colors(&self, read: &mut Primitive) -> Result<(), Fault> {
        let semantic = Semantic::Colors(0);
        let Some(accessor) = self.attribute(&semantic) else { return Ok(()) };
        let place = self.named(&semantic);
        let is_rgba = self.data.root.accessors.get(accessor.value()).map(|accessor| accessor.type_)
            == Some(Checked::Valid(accessor::Type::Vec4));
        let values = if is_rgba {
            let rgba = self.data.floats::<4>(accessor, &place)?;
            rgba.into_iter().map(|[red, green, blue, _]| [red, green, blue]).collect()
        } else {
            self.data.floats::<3>(accessor, &place)?
        };
        read.colors = Some(self.parallel(values, read, &place)?);
        Ok(())
    }

    fn influences(&self, read: &mut Primitive) -> Result<(), Fault> {
        for set in 0.. {
            let [joints, weights] = [Semantic::Joints(set), Semantic::Weights(set)];
            let (joint_accessor, weight_accessor) = match (self.attribute(&joints), self.attribute(&weights)) {
                (None, None) => break,
                (Some(joints), Some(weights)) => (joints, weights),
                (None, _) => {
                    return Err(Fault::new(self.place, weights.to_string(), format!("{}, too", joints.to_string())));
                }
                (_, None) => {
                    return Err(Fault::new(self.place, joints.to_string(), format!("{}, too", weights.to_string())));
                }
            };
            let place = self.named(&joints);
            let joints = self.parallel(self.data.integers(joint_accessor, &place)?, read, &place)?;
            let place = self.named(&weights);
            let weights: Vec<[f32; 4]> = self.parallel(self.data.floats(weight_accessor, &place)?, read, &place)?;
            if let Some(vertex) = weights.iter().position(|weights| weights.iter().any(|&weight| weight < 0.0)) {
                return Err(Fault::new(
                    place,
                    format!("weights {:?} of vertex {vertex}", weights[vertex]),
                    "none below 0",
                ));
            }
            read.accessors.extend([joint_accessor.value(), weight_accessor.value()]);
            read.influences.push(InfluenceSet { joints, weights });
        }
        Ok(())
    }

    fn targets(&self, read: &mut Primitive) -> Result<(), Fault> {
        for (index, target) in self.primitive.targets.iter().flatten().enumerate() {
            let offsets = match target.positions {
                None => Vec::new(),
                Some(accessor) => {
                    let place = format!("{}.targets[{index}].POSITION", self.place);
                    let count = self.data.count(accessor, &place)?;
                    if count != read.positions.len() {
                        let expected = format!("{}, as POSITION", read.positions.len());
                        return Err(Fault::new(place, format!("{count} elements"), expected));
                    }
                    self.data.floats(accessor, &place)?
                }
            };
            read.accessors.push(target.positions.map_or(usize::MAX, |accessor| accessor.value()));
            read.targets.push(offsets);
        }
        Ok(())
    }

    /// The vertex of every corner, in range.
    fn indices(&self, vertex_count: usize) -> Result<Vec<u32>, Fault> {
        let Some(accessor) = self.primitive.indices else {
            return Ok((0..vertex_count as u32).collect());
        };
        let place = format!("{}.indices", self.place);
        let indices: Vec<u32> = self.data.integers::<1>(accessor, &place)?.into_iter().map(|[index]| index).collect();
        match indices.iter().position(|&index| index as usize >= vertex_count) {
            None => Ok(indices),
            Some(at) => {
                let found = format!("index {} as element {at}", indices[at]);
                Err(Fault::new(place, found, format!("less than {vertex_count}, the number of vertices")))
            }
        }
    }
}

/// The triangles of a list, strip or fan. Strips are stitched together by triangles that name a vertex twice: those go.
fn triangles(indices: &[u32], mode: Mode, place: &str) -> Result<Vec<[u32; 3]>, Fault> {
    let is_proper = |&[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    Ok(match mode {
        Mode::TriangleStrip => {
            let turned = |(number, corners): (usize, &[u32])| match number % 2 {
                0 => [corners[0], corners[1], corners[2]],
                _ => [corners[0], corners[2], corners[1]],
            };
            indices.windows(3).enumerate().map(turned).filter(is_proper).collect()
        }
        Mode::TriangleFan => match indices.split_first() {
            None => Vec::new(),
            Some((&center, rim)) => rim.windows(2).map(|pair| [pair[0], pair[1], center]).filter(is_proper).collect(),
        },
        _ => {
            let (whole, rest) = indices.as_chunks::<3>();
            if !rest.is_empty() {
                return Err(Fault::new(place, format!("{} indices", indices.len()), "three a triangle"));
            }
            whole.to_vec()
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_side_up() {
        let of = |mode| triangles(&[0, 1, 2, 3, 4], mode, "p").unwrap();
        assert_eq!(of(Mode::TriangleStrip), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(of(Mode::TriangleFan), [[1, 2, 0], [2, 3, 0], [3, 4, 0]]);
        assert!(triangles(&[0, 1, 2, 3], Mode::Triangles, "p").is_err());
        assert_eq!(triangles(&[], Mode::TriangleFan, "p").unwrap(), <[[u32; 3]; 0]>::default());
    }

    #[test]
    fn triangles_that_stitch_strips_together_are_left_out() {
        let strip = triangles(&[0, 1, 2, 3, 3, 5, 5, 6, 7], Mode::TriangleStrip, "p").unwrap();
        assert_eq!(strip, [[0, 1, 2], [1, 3, 2], [5, 6, 7]]);
    }
}
