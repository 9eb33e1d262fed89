//! A scene of several meshes: turned, scaled unevenly, mirrored, and in a row.
use glam::DVec3;

use crate::scene_text::{Array, Instance, Rotation, SceneText};

pub fn scene() -> SceneText {
    let mut text = SceneText {
        comment: "Several meshes: turned, scaled unevenly, mirrored, and in a row.".to_owned(),
        ..SceneText::default()
    };
    for name in ["crease_2_3", "mixed_triangles_quads", "ngon_5", "open_cylinder"] {
        text.mesh(name, &format!("{name}.obj"));
    }
    let instance = |mesh: &str, name: &str, translate: [f64; 3], turn: Option<([f64; 3], f64)>| Instance {
        mesh: mesh.to_owned(),
        name: Some(name.to_owned()),
        translate: Some(translate),
        rotate: turn.map(|(axis, degrees)| Rotation { axis, degrees }),
        ..Instance::default()
    };
    text.instances = vec![
        Instance {
            scale: Some([1.2, 0.6, 1.0]),
            ..instance("ngon_5", "flower", [-6.0, 0.5, 3.0], Some(([1.0, 0.0, 0.2], 40.0)))
        },
        instance("crease_2_3", "block", [0.0, 0.5, 0.0], Some(([0.0, 1.0, 0.0], 25.0))),
        Instance {
            scale: Some([-1.0, 1.0, 1.0]),
            ..instance("crease_2_3", "mirrored block", [5.0, 0.5, 0.0], Some(([0.0, 1.0, 0.0], -25.0)))
        },
        Instance {
            scale: Some([1.0, 0.6, 1.4]),
            ..instance("open_cylinder", "pipe", [1.5, 0.3, 4.5], Some(([0.0, 0.3, 1.0], 80.0)))
        },
        Instance {
            scale: Some([0.5; 3]),
            array: Some(Array { count: [5, 1, 2], step: [2.5, 0.0, -2.0] }),
            ..instance("mixed_triangles_quads", "rocket", [-5.0, 1.0, -4.0], None)
        },
    ];
    text.camera("front", DVec3::new(3.0, 7.0, 17.0), DVec3::new(-0.5, 0.3, 0.0), 45.0);
    text
}
