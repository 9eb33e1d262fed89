//! What the host needs to know of a SPIR-V module: memory layouts, push constants, bindings, work-group size.
//!
//! Structs are found from the roots that the host writes: push constants, blocks with a binding, and whatever a
//! physical (`buffer_reference`) pointer points to. Reading stops at the first function; all of this stands before it.

use std::collections::{BTreeMap, HashMap};
use std::fmt;

use super::spirv::{self, Instruction, SpirvError, built_in, decoration, dim, execution_mode, op, storage_class};

/// Nesting of types beyond which a module is taken for malformed (a type that contains itself).
const MAX_TYPE_DEPTH: u32 = 32;
/// What the constant of `local_size_x_id` is called, without the axis.
const LOCAL_SIZE: &str = "LOCAL_SIZE_";

/// A type of a member, with its layout in memory. Sizes and strides in bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Type {
    Int {
        signed: bool,
        bits: u32,
    },
    Float {
        bits: u32,
    },
    Vector {
        element: Box<Type>,
        count: u32,
    },
    Matrix {
        bits: u32,
        columns: u32,
        rows: u32,
        stride: u32,
        row_major: bool,
    },
    Array {
        element: Box<Type>,
        count: u32,
        stride: u32,
    },
    RuntimeArray {
        element: Box<Type>,
        stride: u32,
    },
    /// By name; its layout is in [`Reflection::structs`].
    Struct(String),
    /// A `buffer_reference`: 8 bytes, the name of the struct it points to.
    Pointer(String),
}

impl fmt::Display for Type {
    /// Writes the type as GLSL does.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Type::Int { signed: true, bits: 32 } => write!(f, "int"),
            Type::Int { signed: false, bits: 32 } => write!(f, "uint"),
            Type::Int { signed, bits } => write!(f, "{}int{bits}_t", if *signed { "" } else { "u" }),
            Type::Float { bits: 32 } => write!(f, "float"),
            Type::Float { bits: 64 } => write!(f, "double"),
            Type::Float { bits } => write!(f, "float{bits}_t"),
            Type::Vector { element, count } => {
                let prefix = match **element {
                    Type::Int { signed: true, bits: 32 } => "i".into(),
                    Type::Int { signed: false, bits: 32 } => "u".into(),
                    Type::Int { signed: true, bits } => format!("i{bits}"),
                    Type::Int { signed: false, bits } => format!("u{bits}"),
                    Type::Float { bits: 16 } => "f16".into(),
                    Type::Float { bits: 64 } => "d".into(),
                    _ => String::new(),
                };
                write!(f, "{prefix}vec{count}")
            }
            Type::Matrix { bits, columns, rows, .. } => {
                write!(f, "{}mat{columns}x{rows}", if *bits == 64 { "d" } else { "" })
            }
            Type::Array { element, count, .. } => write!(f, "{element}[{count}]"),
            Type::RuntimeArray { element, .. } => write!(f, "{element}[]"),
            Type::Struct(name) | Type::Pointer(name) => write!(f, "{name}"),
        }
    }
}

/// A member of a struct; `offset` in bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    pub name: String,
    pub offset: u32,
    pub ty: Type,
}

/// The members of a struct in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    pub members: Vec<Member>,
}

/// Descriptor types; named after the variants of the crate's own `BindingKind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    UniformBuffer,
    StorageBuffer,
    Sampler,
    SampledImage,
    CombinedImageSampler,
    StorageImage,
    UniformTexelBuffer,
    StorageTexelBuffer,
    InputAttachment,
    AccelerationStructure,
}

/// A resource with a descriptor; `count` is 0 for an array without a size.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    pub set: u32,
    pub binding: u32,
    pub name: String,
    pub kind: BindingKind,
    pub count: u32,
}

/// A specialisation constant; `default` holds the 32 bits of its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SpecConstant {
    pub name: String,
    pub default: u32,
}

/// All that [`reflect`] finds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reflection {
    /// Every struct that the host may have to write, by name.
    pub structs: BTreeMap<String, Layout>,
    /// Name of the push-constant block's struct.
    pub push: Option<String>,
    /// Sorted by set and binding.
    pub bindings: Vec<Binding>,
    /// Threads of a work group; defaults where a specialisation constant sets them.
    pub local_size: Option<[u32; 3]>,
    /// By constant id.
    pub spec_constants: BTreeMap<u32, SpecConstant>,
}

/// Reads a SPIR-V module.
pub fn reflect(words: &[u32]) -> Result<Reflection, String> {
    let mut module = Module::default();
    for instruction in spirv::instructions(words).map_err(|error| error.to_string())? {
        let instruction = instruction.map_err(|error| error.to_string())?;
        if instruction.opcode == op::FUNCTION {
            break;
        }
        module.read(instruction).map_err(|error| error.to_string())?;
    }
    module.resolve()
}

/// How a matrix member is stored; decorations of the member, not of the type.
#[derive(Clone, Copy)]
struct MatrixLayout {
    stride: Option<u32>,
    row_major: bool,
}

/// The declarations of a module, as they are read, and what was made of them so far.
#[derive(Default)]
struct Module<'a> {
    definitions: HashMap<u32, Instruction<'a>>,
    names: HashMap<u32, String>,
    member_names: HashMap<(u32, u32), String>,
    decorations: HashMap<(u32, u32), Option<u32>>,
    member_decorations: HashMap<(u32, u32, u32), Option<u32>>,
    physical_pointees: Vec<u32>,
    /// (variable, pointer type, storage class)
    variables: Vec<(u32, u32, u32)>,
    literal_local_size: Option<[u32; 3]>,
    /// Constants that set the local size, instead of the literals.
    local_size_ids: Option<[u32; 3]>,
    workgroup_size_constant: Option<u32>,
    /// Struct types that were met, and whether their layout is complete.
    laid_out: HashMap<u32, bool>,
    out: Reflection,
}

impl<'a> Module<'a> {
    fn read(&mut self, instruction: Instruction<'a>) -> Result<(), SpirvError> {
        let at = |index| instruction.operand(index);
        match instruction.opcode {
            op::NAME => {
                self.names.insert(at(0)?, instruction.string(1)?);
            }
            op::MEMBER_NAME => {
                self.member_names.insert((at(0)?, at(1)?), instruction.string(2)?);
            }
            op::DECORATE => {
                let value = instruction.operands.get(2).copied();
                self.decorations.insert((at(0)?, at(1)?), value);
                if at(1)? == decoration::BUILT_IN && value == Some(built_in::WORKGROUP_SIZE) {
                    self.workgroup_size_constant = Some(at(0)?);
                }
            }
            op::MEMBER_DECORATE => {
                let value = instruction.operands.get(3).copied();
                self.member_decorations.insert((at(0)?, at(1)?, at(2)?), value);
            }
            op::EXECUTION_MODE if at(1)? == execution_mode::LOCAL_SIZE => {
                self.literal_local_size = Some([at(2)?, at(3)?, at(4)?]);
            }
            op::EXECUTION_MODE_ID if at(1)? == execution_mode::LOCAL_SIZE_ID => {
                self.local_size_ids = Some([at(2)?, at(3)?, at(4)?]);
            }
            op::TYPE_BOOL..=op::TYPE_POINTER | op::TYPE_ACCELERATION_STRUCTURE => {
                self.definitions.insert(at(0)?, instruction);
                let pointer = instruction.opcode == op::TYPE_POINTER;
                if pointer && at(1)? == storage_class::PHYSICAL_STORAGE_BUFFER {
                    self.physical_pointees.push(at(2)?);
                }
            }
            op::CONSTANT..=op::CONSTANT_COMPOSITE | op::SPEC_CONSTANT_TRUE..=op::SPEC_CONSTANT_COMPOSITE => {
                self.definitions.insert(at(1)?, instruction);
            }
            op::VARIABLE => self.variables.push((at(1)?, at(0)?, at(2)?)),
            _ => {}
        }
        Ok(())
    }

    fn resolve(mut self) -> Result<Reflection, String> {
        self.resolve_local_size()?;
        self.resolve_spec_constants()?;
        for pointee in std::mem::take(&mut self.physical_pointees) {
            if self.definition(pointee)?.opcode == op::TYPE_STRUCT {
                self.lay_out(pointee, 0)?;
            }
        }
        for (variable, pointer, class) in std::mem::take(&mut self.variables) {
            match class {
                storage_class::PUSH_CONSTANT => {
                    let pointee = self.operand(pointer, 2)?;
                    self.out.push = Some(self.lay_out(pointee, 0)?);
                }
                storage_class::STORAGE_BUFFER | storage_class::UNIFORM | storage_class::UNIFORM_CONSTANT => {
                    self.resolve_binding(variable, pointer, class)?;
                }
                _ => {}
            }
        }
        self.out.bindings.sort_by_key(|binding| (binding.set, binding.binding));
        Ok(self.out)
    }

    /// The size is given by literals, or by a constant decorated as the built-in, or by ids; the last of these counts.
    fn resolve_local_size(&mut self) -> Result<(), String> {
        self.out.local_size = self.literal_local_size;
        let constant = self.workgroup_size_constant;
        let built_in =
            constant.map(|id| Ok::<_, String>([self.operand(id, 2)?, self.operand(id, 3)?, self.operand(id, 4)?]));
        for ids in [built_in.transpose()?, self.local_size_ids].into_iter().flatten() {
            let mut size = [0; 3];
            for ((id, axis), length) in ids.into_iter().zip(["X", "Y", "Z"]).zip(&mut size) {
                *length = self.operand(id, 2)?;
                // `local_size_x_id` makes constants without a name, one for each of the two ways.
                let name = self.names.entry(id).or_default();
                if name.is_empty() {
                    *name = format!("{LOCAL_SIZE}{axis}");
                }
            }
            self.out.local_size = Some(size);
        }
        Ok(())
    }

    fn resolve_spec_constants(&mut self) -> Result<(), String> {
        let is_id = |&(&(_, kind), _): &(&(u32, u32), &Option<u32>)| kind == decoration::SPEC_ID;
        let mut constants: Vec<(u32, Option<u32>)> =
            self.decorations.iter().filter(is_id).map(|(&(constant, _), &id)| (constant, id)).collect();
        // Several constants may share an id, where one sets the local size: the name that says most comes last and stays.
        let rank = |constant| match self.name(constant) {
            name if name.is_empty() => 0,
            name if name.starts_with(LOCAL_SIZE) => 1,
            _ => 2,
        };
        constants.sort_unstable_by_key(|&(constant, _)| (rank(constant), constant));
        for (constant, id) in constants {
            let name = self.name(constant);
            let id = id.ok_or_else(|| format!("specialisation constant `{name}` has no id"))?;
            let definition = self.definition(constant)?;
            let default = match definition.opcode {
                op::SPEC_CONSTANT_TRUE => 1,
                op::SPEC_CONSTANT_FALSE => 0,
                op::SPEC_CONSTANT if definition.operands.len() == 3 => self.operand(constant, 2)?,
                _ => return Err(format!("specialisation constant `{name}` is not a scalar of 32 bits")),
            };
            self.out.spec_constants.insert(id, SpecConstant { name, default });
        }
        match self.out.spec_constants.iter().find(|(_, constant)| constant.name.is_empty()) {
            Some((id, _)) => Err(format!("specialisation constant {id} has no name")),
            None => Ok(()),
        }
    }

    fn resolve_binding(&mut self, variable: u32, pointer: u32, class: u32) -> Result<(), String> {
        let (mut ty, mut count) = (self.operand(pointer, 2)?, 1_u32);
        let mut depth = 0;
        let kind = loop {
            let definition = self.definition(ty)?;
            match definition.opcode {
                op::TYPE_ARRAY => count = count.saturating_mul(self.length(self.operand(ty, 2)?)?),
                op::TYPE_RUNTIME_ARRAY => count = 0,
                _ => break self.kind(ty, class)?,
            }
            ty = self.operand(ty, 1)?;
            depth += 1;
            if depth > MAX_TYPE_DEPTH {
                return Err("an array type contains itself".into());
            }
        };
        let mut name = self.name(variable);
        if self.definition(ty)?.opcode == op::TYPE_STRUCT {
            let block = self.lay_out(ty, 0)?;
            if name.is_empty() {
                name = block;
            }
        }
        let decoration = |kind| self.decorations.get(&(variable, kind)).copied().flatten();
        let set = decoration(decoration::DESCRIPTOR_SET).ok_or_else(|| format!("`{name}` has no set"))?;
        let binding = decoration(decoration::BINDING).ok_or_else(|| format!("`{name}` has no binding"))?;
        self.out.bindings.push(Binding { set, binding, name, kind, count });
        Ok(())
    }

    fn kind(&self, ty: u32, class: u32) -> Result<BindingKind, String> {
        /// Operand `Sampled` of an image that is read through a sampler; the other value, 2, means storage.
        const SAMPLED: u32 = 1;
        Ok(match self.definition(ty)?.opcode {
            op::TYPE_IMAGE => match (self.operand(ty, 2)?, self.operand(ty, 6)?) {
                (dim::BUFFER, SAMPLED) => BindingKind::UniformTexelBuffer,
                (dim::BUFFER, _) => BindingKind::StorageTexelBuffer,
                (dim::SUBPASS_DATA, _) => BindingKind::InputAttachment,
                (_, SAMPLED) => BindingKind::SampledImage,
                _ => BindingKind::StorageImage,
            },
            op::TYPE_SAMPLER => BindingKind::Sampler,
            op::TYPE_SAMPLED_IMAGE => match self.operand(self.operand(ty, 1)?, 2)? {
                dim::BUFFER => BindingKind::UniformTexelBuffer,
                _ => BindingKind::CombinedImageSampler,
            },
            op::TYPE_ACCELERATION_STRUCTURE => BindingKind::AccelerationStructure,
            op::TYPE_STRUCT if class == storage_class::STORAGE_BUFFER => BindingKind::StorageBuffer,
            op::TYPE_STRUCT if class == storage_class::UNIFORM => BindingKind::UniformBuffer,
            opcode => return Err(format!("a resource of a type with opcode {opcode} is not supported")),
        })
    }

    /// Adds the layout of the struct type `id` to the result and returns the struct's name.
    fn lay_out(&mut self, id: u32, depth: u32) -> Result<String, String> {
        let definition = self.definition(id)?;
        let name = self.name(id);
        if definition.opcode != op::TYPE_STRUCT || name.is_empty() {
            return Err(format!("type {id} is not a struct with a name"));
        }
        match self.laid_out.insert(id, false) {
            Some(true) => {
                self.laid_out.insert(id, true);
                return Ok(name);
            }
            Some(false) => return Err(format!("struct `{name}` contains itself")),
            None => {}
        }
        let mut layout = Layout::default();
        for (index, &ty) in (0..).zip(definition.rest(1).map_err(|error| error.to_string())?) {
            let decoration = |kind| self.member_decorations.get(&(id, index, kind)).copied();
            let member = self.member_names.get(&(id, index)).cloned();
            let member = member.ok_or_else(|| format!("member {index} of `{name}` has no name"))?;
            let offset = decoration(decoration::OFFSET).flatten();
            let offset = offset.ok_or_else(|| format!("`{name}.{member}` has no offset"))?;
            let matrix = MatrixLayout {
                stride: decoration(decoration::MATRIX_STRIDE).flatten(),
                row_major: decoration(decoration::ROW_MAJOR).is_some(),
            };
            let ty = self.ty(ty, matrix, depth + 1).map_err(|error| format!("`{name}.{member}`: {error}"))?;
            layout.members.push(Member { name: member, offset, ty });
        }
        match self.out.structs.get(&name) {
            Some(other) if *other != layout => Err(format!("struct `{name}` has two layouts in this module")),
            _ => {
                self.out.structs.insert(name.clone(), layout);
                self.laid_out.insert(id, true);
                Ok(name)
            }
        }
    }

    fn ty(&mut self, id: u32, matrix: MatrixLayout, depth: u32) -> Result<Type, String> {
        if depth > MAX_TYPE_DEPTH {
            return Err("types nest too deep".into());
        }
        let opcode = self.definition(id)?.opcode;
        let at = |index| self.operand(id, index);
        Ok(match opcode {
            op::TYPE_INT => Type::Int { bits: at(1)?, signed: at(2)? == 1 },
            op::TYPE_FLOAT => Type::Float { bits: at(1)? },
            op::TYPE_VECTOR => {
                let (element, count) = (at(1)?, at(2)?);
                Type::Vector { element: Box::new(self.ty(element, matrix, depth + 1)?), count }
            }
            op::TYPE_MATRIX => {
                let (column, columns) = (at(1)?, at(2)?);
                let (component, rows) = (self.operand(column, 1)?, self.operand(column, 2)?);
                let stride = matrix.stride.ok_or("a matrix without stride")?;
                let bits = self.operand(component, 1)?;
                Type::Matrix { bits, columns, rows, stride, row_major: matrix.row_major }
            }
            op::TYPE_ARRAY => {
                let (element, count) = (at(1)?, self.length(at(2)?)?);
                Type::Array { element: Box::new(self.ty(element, matrix, depth + 1)?), count, stride: self.stride(id)? }
            }
            op::TYPE_RUNTIME_ARRAY => {
                let element = at(1)?;
                Type::RuntimeArray { element: Box::new(self.ty(element, matrix, depth + 1)?), stride: self.stride(id)? }
            }
            op::TYPE_STRUCT => Type::Struct(self.lay_out(id, depth)?),
            // What it points to is laid out by the walk over all pointers: that ends the recursion of linked structs.
            op::TYPE_POINTER if at(1)? == storage_class::PHYSICAL_STORAGE_BUFFER => {
                let name = self.name(at(2)?);
                if name.is_empty() {
                    return Err("a pointer to a type without a name".into());
                }
                Type::Pointer(name)
            }
            opcode => return Err(format!("a type with opcode {opcode} has no layout in memory")),
        })
    }

    fn stride(&self, array: u32) -> Result<u32, String> {
        let stride = self.decorations.get(&(array, decoration::ARRAY_STRIDE)).copied().flatten();
        stride.ok_or_else(|| "an array without stride".into())
    }

    /// The value of an array's length, which must not depend on specialisation: neither would the layout be fixed.
    fn length(&self, constant: u32) -> Result<u32, String> {
        match self.definition(constant)?.opcode {
            op::CONSTANT => self.operand(constant, 2),
            _ => Err("the length of an array is not a plain constant".into()),
        }
    }

    fn definition(&self, id: u32) -> Result<Instruction<'a>, String> {
        self.definitions.get(&id).copied().ok_or_else(|| format!("id {id} is used but not defined"))
    }

    fn operand(&self, id: u32, index: usize) -> Result<u32, String> {
        self.definition(id)?.operand(index).map_err(|error| error.to_string())
    }

    fn name(&self, id: u32) -> String {
        self.names.get(&id).cloned().unwrap_or_default()
    }
}
