//! Names to meshes. Files are read once however many names they have, unless they are displaced in different ways.
use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::text::MeshText;
use super::{Fault, displacement};
use crate::displacement::DisplacementRequest;
use crate::error::name_list;
use crate::obj::{Warnings, quoted};
use crate::{Bounds, Error, Instance, LoadOptions, Mesh, Warning};

/// The meshes of a scene file and their names.
#[derive(Default)]
pub struct Meshes {
    meshes: Vec<Mesh>,
    bounds: Vec<Bounds>,
    /// Names in file order, for messages.
    names: Vec<String>,
    /// Into `meshes`: two names of one file lead to one mesh.
    index_of: HashMap<String, usize>,
    warnings: Warnings,
}

/// Reads the OBJ files that the scene file at `scene` names.
pub fn read(scene: &Path, texts: &[MeshText], options: &LoadOptions) -> Result<Meshes, Error> {
    let mut meshes = Meshes::default();
    let mut meshes_of_file: HashMap<PathBuf, Vec<usize>> = HashMap::new();
    for (element, text) in texts.iter().enumerate() {
        let misplaced = |fault: Fault| {
            let Fault { place, found, expected } = fault.within("meshes", element);
            Error::Misplaced { path: scene.to_owned(), place, found, expected }
        };
        meshes.check(text).map_err(misplaced)?;
        let displacement = text.displacement.as_ref().map(|text| displacement::request(scene, text)).transpose();
        let displacement = displacement.map_err(misplaced)?;
        let file = scene.with_file_name(&text.file);
        // Two spellings of one file's path are one file.
        let key = std::fs::canonicalize(&file).unwrap_or_else(|_| file.clone());
        let of_file = meshes_of_file.entry(key).or_default();
        let known = of_file.iter().copied().find(|&index| meshes.meshes[index].displacement == displacement);
        let index = match known {
            Some(index) => index,
            None => {
                let added = match of_file.first() {
                    Some(&read) => Ok(meshes.add_again(read, text, displacement)),
                    None => meshes.add(text, &file, displacement, options),
                };
                let index = added.map_err(|source| Error::Mesh {
                    path: scene.to_owned(),
                    place: format!("meshes[{element}].file"),
                    source: Box::new(source),
                })?;
                of_file.push(index);
                index
            }
        };
        meshes.names.push(text.name.clone());
        meshes.index_of.insert(text.name.clone(), index);
    }
    Ok(meshes)
}

impl Meshes {
    /// Index and box of the mesh that has a name.
    pub fn get(&self, name: &str) -> Result<(usize, Bounds), Fault> {
        let unknown = || {
            let expected = name_list(self.names.iter().map(String::as_str), "meshes");
            Fault::new("mesh", quoted(name.as_bytes()), expected)
        };
        let index = *self.index_of.get(name).ok_or_else(unknown)?;
        Ok((index, self.bounds[index]))
    }

    /// Warns of meshes that stand nowhere.
    pub fn warn_of_unused(&mut self, instances: &[Instance]) {
        let mut used = vec![false; self.meshes.len()];
        instances.iter().for_each(|instance| used[instance.mesh] = true);
        for (mesh, _) in self.meshes.iter().zip(used).filter(|&(_, used)| !used) {
            self.warnings.push(None, format!("mesh {} has no instance", quoted(mesh.name.as_bytes())));
        }
    }

    /// The meshes, and what is odd in their files.
    pub fn into_parts(self) -> (Vec<Mesh>, Vec<Warning>) {
        (self.meshes, self.warnings.into_vec())
    }

    fn check(&self, text: &MeshText) -> Result<(), Fault> {
        if self.index_of.contains_key(&text.name) {
            return Err(Fault::new("name", format!("{} again", quoted(text.name.as_bytes())), "different names"));
        }
        // A control character would break the line of a message that names the file.
        if text.file.contains(char::is_control) || !crate::has_extension(Path::new(&text.file), "obj") {
            return Err(Fault::new("file", quoted(text.file.as_bytes()), "the path of an .obj file"));
        }
        Ok(())
    }

    /// Reads an OBJ file and returns its mesh' index.
    fn add(
        &mut self,
        text: &MeshText,
        file: &Path,
        displacement: Option<DisplacementRequest>,
        options: &LoadOptions,
    ) -> Result<usize, Error> {
        let (mut mesh, warnings) = crate::read_mesh(file, &crate::obj_bytes(file)?, options)?;
        for warning in warnings {
            self.warnings.push(None, format!("{}: {warning}", file.display()));
        }
        mesh.name.clone_from(&text.name);
        mesh.displacement = displacement;
        self.bounds.push(mesh.bounds().expect("an OBJ file without vertices is refused"));
        self.meshes.push(mesh);
        Ok(self.meshes.len() - 1)
    }

    /// Adds a mesh that has been read, displaced in another way.
    fn add_again(&mut self, read: usize, text: &MeshText, displacement: Option<DisplacementRequest>) -> usize {
        self.bounds.push(self.bounds[read]);
        self.meshes.push(Mesh { name: text.name.clone(), displacement, ..self.meshes[read].clone() });
        self.meshes.len() - 1
    }
}
