//! The displacement maps of a scene's meshes.

use std::path::Path;

use anyhow::{Context, Result};
use planish_gpu::Device;
use planish_render::{DisplacementDesc, MapLayout, Surface};
use planish_scene::Scene;
use planish_scene::displacement::{DisplacementMap, DisplacementRequest, TileLayout, load_displacement};
use planish_subdiv::ControlMesh;

use crate::args::DisplacementArguments;
use crate::console::{Console, WrongUsage};

impl DisplacementArguments {
    /// Replaces the maps that the meshes of the scene at `path` ask for, or what is different with them.
    ///
    /// # Errors
    /// [`WrongUsage`] if there is no map for what is given.
    pub fn apply(&self, path: &Path, scene: &mut Scene) -> Result<()> {
        if let Some(file) = &self.file {
            scene.meshes.iter_mut().for_each(|mesh| mesh.displacement = Some(DisplacementRequest::new(file)));
        }
        let has_map = scene.meshes.iter().any(|mesh| mesh.displacement.is_some());
        if let Some(flag) = self.first_detail().filter(|_| !has_map) {
            let path = path.display();
            return Err(WrongUsage(format!("{flag} needs --displacement: {path} has no displacement map")).into());
        }
        for request in scene.meshes.iter_mut().filter_map(|mesh| mesh.displacement.as_mut()) {
            request.scale = self.scale.unwrap_or(request.scale);
            request.midpoint = self.midpoint.unwrap_or(request.midpoint);
            request.kind = self.kind.map_or(request.kind, Into::into);
            request.layout = self.layout.map_or(request.layout, Into::into);
        }
        Ok(())
    }

    /// The first flag that says something of a map.
    fn first_detail(&self) -> Option<&'static str> {
        let given = [
            (self.scale.is_some(), "--displacement-scale"),
            (self.midpoint.is_some(), "--displacement-midpoint"),
            (self.kind.is_some(), "--displacement-kind"),
            (self.layout.is_some(), "--displacement-layout"),
        ];
        given.into_iter().find(|(is_given, _)| *is_given).map(|(_, flag)| flag)
    }
}

/// Gives a map to a mesh of a surface.
pub fn upload_map(
    device: &Device,
    surface: &mut Surface,
    mesh: usize,
    control_mesh: &ControlMesh,
    map: &DisplacementMap,
) -> Result<()> {
    let levels: Vec<[u32; 3]> = map.levels.iter().map(|level| [level.first_texel, level.width, level.height]).collect();
    let tiles: Vec<[u32; 2]> = map.tiles.iter().map(|tile| [tile.first_level, tile.level_count]).collect();
    let desc = DisplacementDesc {
        channels: map.channels,
        layout: match map.layout {
            TileLayout::Repeat => MapLayout::Repeat,
            TileLayout::Udim => MapLayout::Udim,
            TileLayout::Faces => MapLayout::Faces,
        },
        texels: &map.texels,
        levels: &levels,
        tiles: &tiles,
        tile_of: &map.tile_of,
        tile_columns: map.tile_columns,
        parts: &map.parts,
        bound: map.bound,
    };
    Ok(surface.displace(device, mesh, control_mesh, &desc)?)
}

/// Reads the maps of the meshes of the scene at `path`, one a mesh that has one; tells what is odd in them.
pub fn load_maps(path: &Path, scene: &Scene, console: &Console) -> Result<Vec<Option<DisplacementMap>>> {
    let load = |mesh: &planish_scene::Mesh| {
        let Some(request) = &mesh.displacement else { return Ok(None) };
        let (map, warning) = load_displacement(request, mesh).with_context(|| path.display().to_string())?;
        if let Some(warning) = warning {
            console.warn(warning);
        }
        console.explain(format_args!(
            "{}: {} texels in {} levels, displaces by {} at most",
            request.path.display(),
            map.texel_count(),
            map.level_count(),
            map.bound,
        ));
        Ok(Some(map))
    };
    scene.meshes.iter().map(load).collect()
}

#[cfg(test)]
mod tests {
    use planish_scene::Mesh;
    use planish_scene::displacement::{DisplacementKind, DisplacementLayout};

    use super::*;
    use crate::names::{DisplacementKindName, DisplacementLayoutName};

    fn scene(displacement: Option<DisplacementRequest>) -> Scene {
        Scene { meshes: vec![Mesh { displacement, ..Mesh::default() }, Mesh::default()], ..Scene::default() }
    }

    #[test]
    fn a_file_replaces_all_maps_of_the_scene_with_all_that_is_said_of_them() {
        let asked = DisplacementRequest { scale: 3.0, midpoint: 0.5, ..DisplacementRequest::new("scene.exr") };
        let mut scene = scene(Some(asked));
        let arguments = DisplacementArguments {
            file: Some("mine.png".into()),
            midpoint: Some(0.25),
            kind: Some(DisplacementKindName::Vector),
            ..DisplacementArguments::default()
        };
        arguments.apply(Path::new("s.json"), &mut scene).unwrap();
        let expected = DisplacementRequest {
            kind: DisplacementKind::Vector,
            midpoint: 0.25,
            ..DisplacementRequest::new("mine.png")
        };
        assert!(scene.meshes.iter().all(|mesh| mesh.displacement.as_ref() == Some(&expected)));
    }

    #[test]
    fn without_a_file_the_scenes_maps_keep_what_is_not_given() {
        let asked = DisplacementRequest { scale: 3.0, midpoint: 0.5, ..DisplacementRequest::new("scene.exr") };
        let mut scene = scene(Some(asked.clone()));
        let layout = Some(DisplacementLayoutName::Faces);
        let arguments = DisplacementArguments { scale: Some(-2.0), layout, ..DisplacementArguments::default() };
        arguments.apply(Path::new("s.json"), &mut scene).unwrap();
        let expected = DisplacementRequest { scale: -2.0, layout: DisplacementLayout::Faces, ..asked };
        assert_eq!((scene.meshes[0].displacement.as_ref(), &scene.meshes[1].displacement), (Some(&expected), &None));
    }

    #[test]
    fn details_of_no_map_are_wrong_usage() {
        let arguments = DisplacementArguments { midpoint: Some(0.5), ..DisplacementArguments::default() };
        let error = arguments.apply(Path::new("a.obj"), &mut scene(None)).unwrap_err();
        assert!(error.is::<WrongUsage>());
        assert!(error.to_string().starts_with("--displacement-midpoint needs --displacement: a.obj has no"), "{error}");
        DisplacementArguments::default().apply(Path::new("a.obj"), &mut scene(None)).unwrap();
    }
}
