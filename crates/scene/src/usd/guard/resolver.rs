//! Every layer that a stage opens is read once, and checked before the crate sees it.
use std::cell::RefCell;
use std::collections::HashSet;
use std::io::{self, Cursor};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use openusd::ar::{
    Asset, DefaultResolver, ResolvedPath, Resolver, is_package_relative_path, split_package_relative_path_outer,
};

use super::arcs::Arcs;
use super::budget::Budget;
use super::{check, package};
use crate::Error;
use crate::gltf::fault::Fault;
use crate::usd::misplaced;

/// Largest layer, bytes.
const MAX_LAYER: u64 = 2 << 30;

/// Finds files as the crate's own resolver does.
pub struct Checked {
    files: DefaultResolver,
    findings: Findings,
}

/// What has been found in layers; the resolver that the stage owns shares it with us.
#[derive(Clone)]
pub struct Findings(Rc<RefCell<State>>);

struct State {
    /// The first layer as it was asked for, and as the resolver calls it.
    root: (PathBuf, PathBuf),
    budget: Budget,
    /// Of all layers that were read.
    bytes: u64,
    checked: HashSet<PathBuf>,
    arcs: Arcs,
    /// The prim that is composed, if one is.
    prim: Option<String>,
    /// A layer is opened to see what it is, and then to be read.
    last: Option<(PathBuf, Arc<[u8]>)>,
    /// The first.
    error: Option<Error>,
}

impl Findings {
    /// Of the layers of a file.
    pub fn of(path: &Path) -> Self {
        let root = (path.to_owned(), path.canonicalize().unwrap_or_else(|_| path.to_owned()));
        let state = State {
            root,
            budget: Budget::new(),
            bytes: 0,
            checked: HashSet::new(),
            arcs: Arcs::default(),
            prim: None,
            last: None,
            error: None,
        };
        Self(Rc::new(RefCell::new(state)))
    }

    /// How many bytes all layers have so far.
    pub fn bytes(&self) -> u64 {
        self.0.borrow().bytes
    }

    /// Refuses a prim that is composed of too many places. It is what is composed from now on.
    pub fn check_places(&self, path: &str) -> Result<(), Fault> {
        let mut state = self.0.borrow_mut();
        state.prim = Some(path.to_owned());
        state.arcs.check(path)
    }

    /// What is wrong with a layer, if anything is.
    pub fn take_error(&self) -> Option<Error> {
        self.0.borrow_mut().error.take()
    }
}

impl Checked {
    pub fn new(findings: &Findings) -> Self {
        Self { files: DefaultResolver::new(), findings: findings.clone() }
    }
}

impl State {
    fn open(&mut self, resolved: &Path) -> Result<Arc<[u8]>, Error> {
        let path = if resolved == self.root.1 { &self.root.0.clone() } else { resolved };
        if let Some((_, bytes)) = self.last.as_ref().filter(|(last, _)| last == path) {
            return Ok(bytes.clone());
        }
        self.last = None;
        let bytes = read(path)?;
        if !self.checked.contains(path) {
            check(&bytes, &mut self.budget).map_err(|fault| misplaced(path, fault))?;
            self.bytes += bytes.len() as u64;
            self.checked.insert(path.to_owned());
            self.arcs.add(resolved, &bytes);
            if let Some(prim) = &self.prim {
                self.arcs.check(prim).map_err(|fault| misplaced(&self.root.0, fault))?;
            }
        }
        let bytes: Arc<[u8]> = bytes.into();
        self.last = Some((path.to_owned(), bytes.clone()));
        Ok(bytes)
    }
}

/// The bytes of a layer: a file, or an entry of a package.
fn read(path: &Path) -> Result<Vec<u8>, Error> {
    let name = path.to_str().filter(|name| is_package_relative_path(name));
    let Some((package, entry)) = name.and_then(split_package_relative_path_outer) else {
        check_size(path)?;
        return crate::file_bytes(path);
    };
    let package = Path::new(&package);
    let size = check_size(package)?;
    let file = std::fs::File::open(package);
    let file = file.map_err(|source| Error::Unreadable { path: package.to_owned(), source })?;
    package::entry(io::BufReader::new(file), size, &entry, MAX_LAYER).map_err(|fault| misplaced(package, fault))
}

/// The size of a file; refuses what is no file, and layers that are too large.
fn check_size(path: &Path) -> Result<u64, Error> {
    crate::refuse_directory(path)?;
    let metadata = std::fs::metadata(path);
    let metadata = metadata.map_err(|source| Error::Unreadable { path: path.to_owned(), source })?;
    if !metadata.is_file() {
        return Err(misplaced(path, Fault::new("", "a device or a pipe", "a file")));
    }
    if metadata.len() > MAX_LAYER {
        let found = format!("{} bytes", metadata.len());
        return Err(misplaced(path, Fault::new("", found, format!("a layer of at most {MAX_LAYER}"))));
    }
    Ok(metadata.len())
}

/// Bytes of a layer, which others may read too.
struct Bytes(Cursor<Arc<[u8]>>);

impl io::Read for Bytes {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.0.read(into)
    }
}

impl io::Seek for Bytes {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

impl Asset for Bytes {
    fn size(&self) -> io::Result<u64> {
        Ok(self.0.get_ref().len() as u64)
    }
}

impl Resolver for Checked {
    fn create_identifier(&self, asset_path: &str, anchor: Option<&ResolvedPath>) -> String {
        self.files.create_identifier(asset_path, anchor)
    }

    fn resolve(&self, asset_path: &str) -> Option<ResolvedPath> {
        self.files.resolve(asset_path)
    }

    fn resolve_for_new_asset(&self, asset_path: &str) -> Option<ResolvedPath> {
        self.files.resolve_for_new_asset(asset_path)
    }

    fn open_asset(&self, resolved_path: &ResolvedPath) -> io::Result<Box<dyn Asset>> {
        let mut state = self.findings.0.borrow_mut();
        match state.open(resolved_path) {
            Ok(bytes) => Ok(Box::new(Bytes(Cursor::new(bytes)))),
            Err(error) => {
                let message = error.to_string();
                state.error.get_or_insert(error);
                Err(io::Error::other(message))
            }
        }
    }
}
