//! What a scene holds besides its meshes.

use planish_scene::{LightKind, Mesh, Scene};
use serde::Serialize;

/// Counts of a scene.
#[derive(Debug, Default, PartialEq, Serialize)]
pub struct SceneInfo {
    pub meshes: usize,
    pub instances: usize,
    pub nodes: usize,
    pub cameras: Vec<String>,
    pub camera_paths: Vec<String>,
    pub distant_lights: usize,
    pub point_lights: usize,
    pub spot_lights: usize,
    pub has_environment: bool,
    pub materials: Vec<String>,
    pub textures: usize,
    pub images: Vec<String>,
    pub morph_targets: usize,
    pub joints: usize,
    /// Meshes whose points are given over time.
    pub point_caches: usize,
    pub animations: Vec<String>,
    /// First and last moment of what moves, in seconds.
    pub time_range: Option<[f64; 2]>,
    pub frames_per_second: Option<f64>,
    pub is_animated: bool,
    pub warnings: usize,
}

impl SceneInfo {
    /// Of a scene.
    pub fn new(scene: &Scene) -> Self {
        let lights = |is: fn(&LightKind) -> bool| scene.lights.iter().filter(|light| is(&light.kind)).count();
        let deformations = || scene.meshes.iter().filter_map(|mesh: &Mesh| mesh.deformation.as_ref());
        Self {
            meshes: scene.meshes.len(),
            instances: scene.instances.len(),
            nodes: scene.nodes.len(),
            cameras: scene.cameras.iter().map(|camera| camera.name.clone()).collect(),
            camera_paths: scene.paths.iter().map(|path| path.name().to_owned()).collect(),
            distant_lights: lights(|kind| matches!(kind, LightKind::Distant { .. })),
            point_lights: lights(|kind| matches!(kind, LightKind::Point { .. })),
            spot_lights: lights(|kind| matches!(kind, LightKind::Spot { .. })),
            has_environment: scene.environment.is_some(),
            materials: scene.materials.iter().map(|material| material.name.clone()).collect(),
            textures: scene.textures.len(),
            images: scene.images.iter().map(|image| image.name.clone()).collect(),
            morph_targets: deformations().map(|deformation| deformation.morphs.len()).sum(),
            joints: deformations()
                .filter_map(|deformation| deformation.skin.as_ref())
                .map(|skin| skin.joints.len())
                .sum(),
            point_caches: deformations().filter(|deformation| deformation.points.is_some()).count(),
            animations: scene.clips.clone(),
            time_range: scene.time_range,
            frames_per_second: scene.frames_per_second,
            is_animated: scene.is_animated(),
            warnings: scene.warnings.len(),
        }
    }

    /// Tells it, a line a subject; nothing of subjects that there are none of.
    pub fn describe(&self, line: &mut impl FnMut(&str, String)) {
        if self.meshes != 1 || self.instances != 1 || self.nodes > 0 {
            line("scene graph", format!("{} meshes, {} instances, {} nodes", self.meshes, self.instances, self.nodes));
        }
        let mut names = |what: &str, names: &[String]| {
            if !names.is_empty() {
                line(what, format!("{} ({})", names.len(), names.join(", ")));
            }
        };
        names("cameras", &self.cameras);
        names("camera paths", &self.camera_paths);
        names("materials", &self.materials);
        names("images", &self.images);
        names("animations", &self.animations);
        let lights = [
            (self.distant_lights, "distant"),
            (self.point_lights, "point"),
            (self.spot_lights, "spot"),
            (usize::from(self.has_environment), "environment"),
        ];
        counted("lights", &lights, line);
        let deformed =
            [(self.morph_targets, "morph targets"), (self.joints, "joints"), (self.point_caches, "point caches")];
        counted("deformation", &deformed, line);
        if let Some([first, last]) = self.time_range {
            let rate = self.frames_per_second.map_or_else(String::new, |rate| format!(" at {rate} frames a second"));
            line("time", format!("{first} to {last} s{rate}"));
        }
    }
}

fn counted(what: &str, counts: &[(usize, &str)], line: &mut impl FnMut(&str, String)) {
    let told: Vec<String> =
        counts.iter().filter(|(count, _)| *count > 0).map(|(count, kind)| format!("{count} {kind}")).collect();
    if !told.is_empty() {
        line(what, told.join(", "));
    }
}

#[cfg(test)]
mod tests {
    use planish_scene::{Camera, Curve, Instance, Light, Node};

    use super::*;

    fn told(scene: &Scene) -> Vec<String> {
        let mut lines = Vec::new();
        SceneInfo::new(scene).describe(&mut |name: &str, text: String| lines.push(format!("{name}: {text}")));
        lines
    }

    #[test]
    fn a_mesh_alone_has_nothing_to_tell() {
        let instance = Instance::placed("a", 0, glam::Affine3A::IDENTITY);
        let scene = Scene { meshes: vec![Mesh::default()], instances: vec![instance], ..Scene::default() };
        assert_eq!(told(&scene), [""; 0]);
    }

    #[test]
    fn subjects_are_told_with_names_and_counts() {
        let camera = Camera::upright("front", glam::Vec3::Z, glam::Vec3::ZERO, 45.0, 1.0).unwrap();
        let light = Light {
            name: "sun".to_owned(),
            node: 0,
            kind: LightKind::Distant { angle: 0.5 },
            color: [1.0; 3],
            intensity: Curve::constant(3.0),
            casts_shadows: true,
        };
        let scene = Scene {
            cameras: vec![camera],
            lights: vec![light],
            nodes: vec![Node::still("root", None)],
            time_range: Some([0.0, 1.5]),
            frames_per_second: Some(24.0),
            ..Scene::default()
        };
        let expected = [
            "scene graph: 0 meshes, 0 instances, 1 nodes",
            "cameras: 1 (front)",
            "lights: 1 distant",
            "time: 0 to 1.5 s at 24 frames a second",
        ];
        assert_eq!(told(&scene), expected);
    }
}
