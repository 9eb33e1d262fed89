//! Counts the float arithmetic of a module that a driver may not fuse, and that which it may.
//!
//! Two patches that share an edge stay watertight only if both compute its points with the same roundings. A driver may
//! contract `a * b + c` to one fused operation in one of them and not in the other, unless the operations are
//! decorated `NoContraction` (`precise` in GLSL, which does not reach into called functions).

use std::collections::{HashMap, HashSet};

use crate::spirv::{self, Instruction, SpirvError, op};

const OP_EXT_INST_IMPORT: u32 = 11;
const OP_EXT_INST: u32 = 12;
const OP_FUNCTION_END: u32 = 56;
const DECORATION_NO_CONTRACTION: u32 = 42;

/// Opcodes of float arithmetic that may be fused: `OpFAdd`, `OpFSub`, `OpFMul`, `OpFDiv`, `OpFRem`, `OpFMod`,
/// `OpVectorTimesScalar`, `OpMatrixTimesScalar`, `OpVectorTimesMatrix`, `OpMatrixTimesVector`,
/// `OpMatrixTimesMatrix`, `OpOuterProduct`, `OpDot`. Negation rounds nothing and is left out.
const FLOAT_ARITHMETIC: [u32; 13] = [129, 131, 133, 136, 140, 141, 142, 143, 144, 145, 146, 147, 148];

/// `Fma` of GLSL.std.450: one rounding, always; it needs no decoration.
const GLSL_FMA: u32 = 50;
/// Instructions of GLSL.std.450 that are sums of products inside and cannot be decorated: `Determinant`,
/// `MatrixInverse`, `FMix`, `SmoothStep`, `Length`, `Distance`, `Cross`, `Normalize`, `FaceForward`, `Reflect`,
/// `Refract`.
const GLSL_SUMS_OF_PRODUCTS: [u32; 11] = [33, 34, 46, 49, 66, 67, 68, 69, 70, 71, 72];

/// The float arithmetic of one function of a module.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FunctionReport {
    /// Name as in the module: `main`, or with glslang's parameter list: `limit_point(vf3;f1;`.
    pub name: String,
    /// Operations decorated `NoContraction`.
    pub no_contraction: u32,
    /// Operations that a driver may fuse.
    pub contractible: u32,
    /// Calls of `fma`.
    pub fma: u32,
    /// Calls of built-in functions whose inner arithmetic no decoration reaches (`mix`, `cross`, `normalize`, ..).
    pub undecorable: u32,
}

impl FunctionReport {
    /// The function's name as written in GLSL, without the parameter list: `limit_point`.
    pub fn base_name(&self) -> &str {
        self.name.split('(').next().unwrap_or_default()
    }
}

/// Counts the float arithmetic of every function with a body in `spirv`, in the module's order.
///
/// # Errors
/// When `spirv` is no well-formed stream of SPIR-V instructions.
pub fn no_contraction_report(spirv: &[u32]) -> Result<Vec<FunctionReport>, SpirvError> {
    let mut names = HashMap::new();
    let mut precise = HashSet::new();
    let mut glsl_sets = HashSet::new();
    let mut reports = Vec::new();
    let mut current: Option<FunctionReport> = None;
    for instruction in spirv::instructions(spirv)? {
        let instruction = instruction?;
        match instruction.opcode {
            op::NAME => {
                names.insert(instruction.operand(0)?, instruction.string(1)?);
            }
            op::DECORATE if instruction.operand(1)? == DECORATION_NO_CONTRACTION => {
                precise.insert(instruction.operand(0)?);
            }
            OP_EXT_INST_IMPORT if instruction.string(1)? == "GLSL.std.450" => {
                glsl_sets.insert(instruction.operand(0)?);
            }
            op::FUNCTION => {
                let id = instruction.operand(1)?;
                let name = names.get(&id).cloned().unwrap_or_else(|| format!("%{id}"));
                current = Some(FunctionReport { name, ..FunctionReport::default() });
            }
            OP_FUNCTION_END => reports.extend(current.take()),
            _ => {
                if let Some(report) = &mut current {
                    count(report, &instruction, &precise, &glsl_sets)?;
                }
            }
        }
    }
    Ok(reports)
}

/// Adds one instruction of a function's body to its report.
fn count(
    report: &mut FunctionReport,
    instruction: &Instruction<'_>,
    precise: &HashSet<u32>,
    glsl_sets: &HashSet<u32>,
) -> Result<(), SpirvError> {
    if FLOAT_ARITHMETIC.contains(&instruction.opcode) {
        if precise.contains(&instruction.operand(1)?) {
            report.no_contraction += 1;
        } else {
            report.contractible += 1;
        }
    } else if instruction.opcode == OP_EXT_INST && glsl_sets.contains(&instruction.operand(2)?) {
        match instruction.operand(3)? {
            GLSL_FMA => report.fma += 1,
            built_in if GLSL_SUMS_OF_PRODUCTS.contains(&built_in) => report.undecorable += 1,
            _ => {}
        }
    }
    Ok(())
}
