//! What limit points give to ACC and Pm-patches around them. Shader: `glsl/rival_spokes.comp`.

use planish_shaders::rival_spokes_comp::Push;
use planish_shaders::{LimitPoint, SpokePoint};
use planish_subdiv::stencil::StencilRow;
use planish_subdiv::tables::Tables;

use crate::limit::LimitsInUse;
use crate::surface::Surface;
use crate::upload::address;

/// What the stage reads and makes.
pub(crate) fn push(surface: &Surface, limits: &LimitsInUse) -> Push {
    let (tables, frame) = (&surface.buffers, &surface.frame);
    Push {
        points: address(&frame.points),
        limits: address(&frame.limits),
        ranges: address(&tables.spoke_ranges),
        spokes: address(&tables.rival_spokes),
        indices: address(&tables.spoke_indices),
        weights: address(&tables.spoke_weights),
        made: address(&frame.spoke_points),
        made_middles: address(&frame.spoke_middles),
        in_use: limits.in_use,
        head: limits.head,
    }
}

/// CPU twin: the spokes' points and the middles from points and limit points, bit for bit as the shader makes them.
pub fn rival_spokes(tables: &Tables, points: &[[f32; 3]], limits: &[LimitPoint]) -> Vec<(SpokePoint, [f32; 3])> {
    let table = &tables.gregory;
    let origin = |row: &StencilRow| points[table.indices[row.first_index as usize] as usize];
    let weighed = |row: &StencilRow| {
        let indices = &table.indices[row.first_index as usize..][..row.count as usize];
        let weights = &table.weights[row.first_weight as usize..][..row.count as usize];
        let mut sum = [0.0_f32; 3];
        for (&index, weight) in indices.iter().zip(weights).skip(1) {
            (0..3).for_each(|c| sum[c] += weight * (points[index as usize][c] - origin(row)[c]));
        }
        sum
    };
    let plus = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|c| a[c] + b[c]);
    let mut made = vec![(SpokePoint::default(), [0.0; 3]); table.rival_spokes.len()];
    for (limit, &[first, count]) in limits.iter().zip(&table.of_limit) {
        let own = first as usize..(first + count) as usize;
        for (rows, made) in table.rival_spokes[own.clone()].iter().zip(&mut made[own]) {
            let spoke = SpokePoint {
                edge: plus(limit.position, weighed(&rows.edge)),
                across: weighed(&rows.across),
                beside: weighed(&rows.beside),
            };
            *made = (spoke, plus(origin(&rows.middle), weighed(&rows.middle)));
        }
    }
    made
}
