//! Accessors to numbers (glTF 2.0, section 3.6.2), sparse ones and those of small integers too; every range is checked
//! before it is read.
use ::gltf::json::accessor::{Accessor, ComponentType, Type, sparse::Sparse};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, accessor, buffer};

use super::data::Data;
use super::fault::{Fault, at};

/// The elements of an accessor, one after another without gaps.
struct Packed {
    component: ComponentType,
    is_normalized: bool,
    bytes: Vec<u8>,
}

impl Data<'_> {
    /// How many elements an accessor has; not yet whether they are there.
    pub fn count(&self, index: Index<Accessor>, place: &str) -> Result<usize, Fault> {
        let accessor = at(&self.root.accessors, index.value(), "accessors", || place.to_owned())?;
        usize::try_from(accessor.count.0).map_err(|_| Fault::new(place, "too many elements", "fewer"))
    }

    /// Elements of N finite numbers; integers are converted, and normalized where the accessor says so.
    pub fn floats<const N: usize>(&self, index: Index<Accessor>, place: &str) -> Result<Vec<[f32; N]>, Fault> {
        let packed = self.packed(index, N, place)?;
        let size = packed.component.size();
        let mut values = Vec::with_capacity(packed.bytes.len() / (N * size));
        for (element, bytes) in packed.bytes.chunks_exact(N * size).enumerate() {
            let mut value = [0.0; N];
            for (value, bytes) in value.iter_mut().zip(bytes.chunks_exact(size)) {
                *value = float(bytes, packed.component, packed.is_normalized);
                if !value.is_finite() {
                    let place = format!("accessors[{}]: element {element}", index.value());
                    return Err(Fault::new(place, value.to_string(), "a finite number"));
                }
            }
            values.push(value);
        }
        Ok(values)
    }

    /// Elements of N integers without a sign.
    pub fn integers<const N: usize>(&self, index: Index<Accessor>, place: &str) -> Result<Vec<[u32; N]>, Fault> {
        let packed = self.packed(index, N, place)?;
        if packed.is_normalized
            || !matches!(packed.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32)
        {
            let found =
                format!("{}components {:?}", if packed.is_normalized { "normalized " } else { "" }, packed.component);
            return Err(Fault::new(format!("accessors[{}]", index.value()), found, "integers without a sign"));
        }
        let size = packed.component.size();
        let element = |bytes: &[u8]| {
            let mut value = [0; N];
            for (value, bytes) in value.iter_mut().zip(bytes.chunks_exact(size)) {
                *value = unsigned(bytes);
            }
            value
        };
        Ok(packed.bytes.chunks_exact(N * size).map(element).collect())
    }

    /// The bytes of all elements, which must be of `width` components.
    fn packed(&self, index: Index<Accessor>, width: usize, place: &str) -> Result<Packed, Fault> {
        let accessor = at(&self.root.accessors, index.value(), "accessors", || place.to_owned())?;
        let place = format!("accessors[{}]", index.value());
        let (Checked::Valid(component), Checked::Valid(dimensions)) = (accessor.component_type, accessor.type_) else {
            return Err(Fault::new(place, "an unknown type or componentType", "one of glTF 2.0"));
        };
        if component_count(dimensions) != width {
            return Err(Fault::new(place, format!("{dimensions:?}"), format!("elements of {width} components")));
        }
        let component = component.0;
        let element_size = width * component.size();
        let byte_count = accessor.count.0.checked_mul(element_size as u64);
        let byte_count =
            byte_count.ok_or_else(|| Fault::new(&place, format!("{} elements", accessor.count.0), "fewer"))?;
        // What is made of them is at most four times as large, and lives beside them for a while.
        self.spend(byte_count.saturating_mul(5), &place)?;
        let mut bytes = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default().0;
                self.gather(view, offset, accessor.count.0, element_size, &place)?
            }
            None => vec![0; byte_count as usize],
        };
        if let Some(sparse) = &accessor.sparse {
            self.substitute(sparse, &mut bytes, element_size, &place)?;
        }
        Ok(Packed { component, is_normalized: accessor.normalized, bytes })
    }

    /// Copies elements from a view, where they may have gaps between them.
    fn gather(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        count: u64,
        size: usize,
        place: &str,
    ) -> Result<Vec<u8>, Fault> {
        let (bytes, stride) = self.view(view, place)?;
        let stride = stride.unwrap_or(size);
        if stride < size {
            return Err(Fault::new(place, format!("a stride of {stride} bytes"), format!("{size} or more")));
        }
        if count == 0 {
            return Ok(Vec::new());
        }
        let end =
            (count - 1).checked_mul(stride as u64).and_then(|last| last.checked_add(offset)?.checked_add(size as u64));
        let range = end.and_then(|end| Some(usize::try_from(offset).ok()?..usize::try_from(end).ok()?));
        let range = range.and_then(|range| bytes.get(range)).ok_or_else(|| {
            let found = format!("{count} elements of {size} bytes, {stride} apart, from byte {offset}");
            Fault::new(place, found, format!("no more than the {} bytes of bufferViews[{}]", bytes.len(), view.value()))
        })?;
        if stride == size {
            return Ok(range.to_vec());
        }
        Ok(range.chunks(stride).flat_map(|element| &element[..size]).copied().collect())
    }

    /// Replaces the elements that a sparse accessor says.
    fn substitute(&self, sparse: &Sparse, bytes: &mut [u8], size: usize, place: &str) -> Result<(), Fault> {
        let place = format!("{place}.sparse");
        let Checked::Valid(accessor::IndexComponentType(component)) = sparse.indices.component_type else {
            return Err(Fault::new(place, "an unknown componentType", "integers without a sign"));
        };
        let count = sparse.count.0;
        let total = bytes.len() / size;
        if count > total as u64 {
            return Err(Fault::new(place, format!("{count} elements"), format!("at most the {total} of the accessor")));
        }
        let indices =
            self.gather(sparse.indices.buffer_view, sparse.indices.byte_offset.0, count, component.size(), &place)?;
        let values = self.gather(sparse.values.buffer_view, sparse.values.byte_offset.0, count, size, &place)?;
        let mut next = 0;
        for (index, value) in indices.chunks_exact(component.size()).zip(values.chunks_exact(size)) {
            let index = unsigned(index) as usize;
            if index < next || index >= total {
                return Err(Fault::new(place, format!("index {index}"), format!("indices that ascend, below {total}")));
            }
            bytes[index * size..][..size].copy_from_slice(value);
            next = index + 1;
        }
        Ok(())
    }
}

fn component_count(dimensions: Type) -> usize {
    match dimensions {
        Type::Scalar => 1,
        Type::Vec2 => 2,
        Type::Vec3 => 3,
        Type::Vec4 | Type::Mat2 => 4,
        Type::Mat3 => 9,
        Type::Mat4 => 16,
    }
}

/// A little-endian integer of one, two or four bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte))
}

/// A component as a number (glTF 2.0, section 3.6.2.2: normalized integers).
fn float(bytes: &[u8], component: ComponentType, is_normalized: bool) -> f32 {
    let bits = unsigned(bytes);
    let (value, greatest) = match component {
        ComponentType::F32 => return f32::from_bits(bits),
        ComponentType::I8 => (f32::from(bits as u8 as i8), f32::from(i8::MAX)),
        ComponentType::U8 => (f32::from(bits as u8), f32::from(u8::MAX)),
        ComponentType::I16 => (f32::from(bits as u16 as i16), f32::from(i16::MAX)),
        ComponentType::U16 => (f32::from(bits as u16), f32::from(u16::MAX)),
        ComponentType::U32 => (bits as f32, u32::MAX as f32),
    };
    if is_normalized { (value / greatest).max(-1.0) } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_integers_become_numbers() {
        assert_eq!(float(&[0x81], ComponentType::I8, true), -1.0);
        assert_eq!(float(&[0x80], ComponentType::I8, true), -1.0);
        assert_eq!(float(&[0x80], ComponentType::I8, false), -128.0);
        assert_eq!(float(&[255], ComponentType::U8, true), 1.0);
        assert_eq!(float(&[0xff, 0x7f], ComponentType::I16, true), 1.0);
        assert_eq!(float(&[0x34, 0x12], ComponentType::U16, false), 4660.0);
        assert_eq!(float(&1.5f32.to_le_bytes(), ComponentType::F32, false), 1.5);
    }
}
