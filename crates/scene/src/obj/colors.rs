//! Colours of vertices: the three numbers that may follow a position.
use planish_subdiv::mesh::VertexColors;

use super::finite;
use super::lines::Tokens;
use super::warnings::Warnings;
use crate::error::Fault;

/// What a vertex without a colour has where others have one.
const WHITE: [f32; 3] = [1.0; 3];

/// The colours of a file's vertices so far.
#[derive(Default)]
pub struct Colors {
    /// Of the vertices up to the last one that has a colour.
    values: Vec<[f32; 3]>,
    /// How many vertices have one.
    count: usize,
}

impl Colors {
    /// Reads what follows the position of the vertex that is the last of so many. Exactly three values are a colour; any
    /// other number of them (one is a weight) is ignored.
    pub fn read(&mut self, line: u32, mut tokens: Tokens, vertex_count: usize) -> Result<(), Fault> {
        let rest: [Option<&[u8]>; 4] = std::array::from_fn(|_| tokens.next());
        let [Some(red), Some(green), Some(blue), None] = rest else { return Ok(()) };
        self.values.resize(vertex_count - 1, WHITE);
        let channel = |token| finite(line, token, "colour");
        self.values.push([channel(red)?, channel(green)?, channel(blue)?]);
        self.count += 1;
        Ok(())
    }

    /// The colours of all vertices, if any has one; warns of those that have none.
    pub fn finish(mut self, vertex_count: usize, warnings: &mut Warnings) -> Option<VertexColors> {
        if self.count == 0 {
            return None;
        }
        if self.count < vertex_count {
            let without = vertex_count - self.count;
            warnings.push(None, format!("{without} of {vertex_count} vertices have no colour: white"));
        }
        self.values.resize(vertex_count, WHITE);
        Some(VertexColors { values: self.values, ..VertexColors::default() })
    }
}
