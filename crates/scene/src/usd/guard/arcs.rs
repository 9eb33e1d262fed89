//! Where prims lead: the arcs of all layers, and in how many places composition looks for what a prim says. References of
//! references multiply, so a few hundred bytes may name more places than there is time for: they are counted before.
use std::collections::HashMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use openusd::ar::{DefaultResolver, ResolvedPath, Resolver as _, is_package_relative_path};
use openusd::sdf::{self, AbstractData, Value};
use openusd::usda;
use openusd::usdc::CrateData;

use super::{crate_file, package};
use crate::gltf::fault::Fault;

/// Places that one prim may be composed of. Composing it takes a time that grows with their square, a second or so at these.
const MAX_PLACES: u64 = 4000;
/// Places that are looked at to count them: those of variants that are not selected are more.
const MAX_VISITS: u64 = 1 << 16;
/// Arcs that may follow each other; the crate itself gives up at 100.
const MAX_CHAIN: usize = 128;

/// What text says where it has arcs or sublayers.
const WORDS: [&str; 5] = ["references", "payload", "inherits", "specializes", "subLayers"];

/// Arcs of all layers that were opened.
#[derive(Default)]
pub struct Arcs {
    /// The first layer.
    root: Option<PathBuf>,
    layers: HashMap<PathBuf, Layer>,
}

#[derive(Default)]
struct Layer {
    sublayers: Vec<Leads>,
    /// The path of the prim that is meant where none is named.
    default: Option<String>,
    /// By the path of their prim, without variants.
    arcs: HashMap<String, Vec<Arc>>,
}

struct Arc {
    leads: Leads,
    /// None: the default prim's.
    path: Option<String>,
    /// The set and the variant that it is in.
    variant: Option<(String, String)>,
    /// Whether it is to a class, which is looked up for each reference that leads here too, in all that those lead to.
    is_class: bool,
}

/// Which layer is meant.
enum Leads {
    /// The root of the layers where it stands.
    Here,
    Layer(PathBuf),
    /// One of a package.
    Package(String),
    /// What an expression says.
    Any,
}

/// Where composition looks: the first of a stack of layers, and a prim.
#[derive(Clone, PartialEq)]
struct Place {
    layer: PathBuf,
    path: String,
}

impl Arcs {
    /// Adds those of a layer that was checked. What is wrong with it is told by who reads it next.
    pub fn add(&mut self, path: &Path, bytes: &[u8]) {
        if package::is_package(bytes) {
            // Its layers are opened next.
            return;
        }
        let layer = if bytes.starts_with(crate_file::MAGIC) {
            CrateData::open(Cursor::new(bytes), false).ok().map(|data| Layer::of(path, &data))
        } else {
            // Parsing takes longer than all else that is checked, and most text has geometry alone.
            let text = std::str::from_utf8(bytes).ok().filter(|text| WORDS.iter().any(|word| text.contains(word)));
            text.and_then(|text| usda::parse(text).ok()).map(|data| Layer::of(path, &data))
        };
        self.root.get_or_insert_with(|| path.to_owned());
        self.layers.insert(path.to_owned(), layer.unwrap_or_default());
    }

    /// Refuses a prim of a stage that is composed of too many places.
    pub fn check(&self, path: &str) -> Result<(), Fault> {
        let Some(layer) = self.root.clone() else { return Ok(()) };
        let mut visits = MAX_VISITS;
        let place = Place { layer, path: path.to_owned() };
        let places = self.count(&place, &mut Vec::new(), 0, &mut visits);
        if places <= MAX_PLACES {
            return Ok(());
        }
        let found = format!("a prim composed of more than {MAX_PLACES} places");
        Err(Fault::new(path, found, "fewer: references of references multiply"))
    }

    /// Places that a place leads to, with itself; stops soon after there are too many. So many of the chain that leads here are
    /// references.
    fn count(&self, place: &Place, chain: &mut Vec<Place>, references: u64, visits: &mut u64) -> u64 {
        *visits = visits.saturating_sub(1);
        if *visits == 0 || chain.len() >= MAX_CHAIN {
            return u64::MAX;
        }
        let mut total: u64 = 1;
        // Of a set one variant is selected: the largest counts.
        let mut variants: HashMap<(&str, &str), HashMap<&str, u64>> = HashMap::new();
        chain.push(place.clone());
        for layer in self.stack(&place.layer) {
            for above in ancestors(&place.path) {
                for arc in layer.arcs.get(above).into_iter().flatten() {
                    let found = self.count_targets(arc, &place.path[above.len()..], chain, references, visits);
                    match &arc.variant {
                        None => total = total.saturating_add(found),
                        Some((set, variant)) => {
                            let sum = variants.entry((above, set)).or_default().entry(variant).or_default();
                            *sum = sum.saturating_add(found);
                        }
                    }
                    if total > MAX_PLACES {
                        chain.pop();
                        return total;
                    }
                }
            }
        }
        chain.pop();
        let largest = variants.values().map(|set| set.values().copied().max().unwrap_or(0));
        largest.fold(total, u64::saturating_add)
    }

    /// Places that an arc of the last of a chain leads to, so much below its target.
    fn count_targets(&self, arc: &Arc, below: &str, chain: &mut Vec<Place>, references: u64, visits: &mut u64) -> u64 {
        let mut total: u64 = 0;
        let references = references + u64::from(!arc.is_class);
        for target in self.targets(&arc.leads, &chain[chain.len() - 1].layer) {
            let default = || self.layers.get(&target).and_then(|layer| layer.default.as_ref());
            let Some(path) = arc.path.as_ref().or_else(default) else {
                // No prim is meant by default, or one of a layer without arcs.
                total = total.saturating_add(1);
                continue;
            };
            let next = Place { layer: target, path: format!("{path}{below}") };
            // Who leads back to itself is told by the crate, and not followed.
            if !chain.iter().any(|place| next.is_around(place)) {
                let lookups = if arc.is_class { references * references / 4 } else { 0 };
                total = total.saturating_add(self.count(&next, chain, references, visits)).saturating_add(lookups);
            }
        }
        total
    }

    fn targets(&self, leads: &Leads, here: &Path) -> Vec<PathBuf> {
        let all = self.layers.keys();
        match leads {
            Leads::Here => vec![here.to_owned()],
            Leads::Layer(path) => vec![path.clone()],
            Leads::Package(start) => all.filter(|path| path.to_string_lossy().starts_with(start)).cloned().collect(),
            Leads::Any => all.cloned().collect(),
        }
    }

    /// A layer and its sublayers.
    fn stack(&self, root: &Path) -> Vec<&Layer> {
        let mut paths = vec![root.to_owned()];
        let mut next = 0;
        while let Some(layer) = paths.get(next).map(|path| self.layers.get(path)) {
            for leads in layer.iter().flat_map(|layer| &layer.sublayers) {
                for target in self.targets(leads, root) {
                    if !paths.contains(&target) {
                        paths.push(target);
                    }
                }
            }
            next += 1;
        }
        paths.iter().filter_map(|path| self.layers.get(path)).collect()
    }
}

impl Layer {
    fn of(path: &Path, data: &dyn AbstractData) -> Self {
        let mut layer = Self::default();
        let root = sdf::Path::abs_root();
        if let Some(Value::StringVec(assets)) = field(data, &root, "subLayers") {
            layer.sublayers = assets.iter().map(|asset| leads(asset, path)).collect();
        }
        if let Some(Value::Token(name)) = field(data, &root, "defaultPrim") {
            layer.default = Some(format!("/{}", name.as_str().trim_start_matches('/')));
        }
        for site in data.spec_paths() {
            if matches!(data.spec_type(&site), Some(sdf::SpecType::Prim | sdf::SpecType::Variant)) {
                layer.add(path, data, &site);
            }
        }
        layer
    }

    /// Adds the arcs of a prim, or of one of its variants.
    fn add(&mut self, layer: &Path, data: &dyn AbstractData, site: &sdf::Path) {
        let mut arcs: Vec<(Leads, sdf::Path, bool)> = Vec::new();
        if let Some(Value::ReferenceListOp(list)) = field(data, site, "references") {
            arcs.extend(list.iter().map(|to| (leads(&to.asset_path, layer), to.prim_path.clone(), false)));
        }
        match field(data, site, "payload") {
            Some(Value::PayloadListOp(list)) => {
                arcs.extend(list.iter().map(|to| (leads(&to.asset_path, layer), to.prim_path.clone(), false)));
            }
            Some(Value::Payload(to)) => arcs.push((leads(&to.asset_path, layer), to.prim_path, false)),
            _ => {}
        }
        for class in ["inheritPaths", "specializes"] {
            if let Some(Value::PathListOp(list)) = field(data, site, class) {
                arcs.extend(list.iter().map(|to| (Leads::Here, to.clone(), true)));
            }
        }
        if arcs.is_empty() {
            return;
        }
        let bare = site.strip_all_variant_selections();
        let variant = site.as_str().split_once('{').and_then(|(_, rest)| rest.split_once('}'));
        let variant = variant.and_then(|(selection, _)| selection.split_once('='));
        let variant = variant.map(|(set, variant)| (set.to_owned(), variant.to_owned()));
        let list = self.arcs.entry(bare.as_str().to_owned()).or_default();
        list.extend(arcs.into_iter().map(|(leads, to, is_class)| {
            let to = to.strip_all_variant_selections();
            let path = (!to.is_empty()).then(|| to.as_str().to_owned());
            Arc { leads, path, variant: variant.clone(), is_class }
        }));
    }
}

fn field(data: &dyn AbstractData, path: &sdf::Path, name: &str) -> Option<Value> {
    Some(data.try_field(path, name).ok()??.into_owned())
}

/// Which layer an asset is, named in a layer.
fn leads(asset: &str, layer: &Path) -> Leads {
    if asset.is_empty() {
        return Leads::Here;
    }
    if asset.starts_with('`') {
        return Leads::Any;
    }
    let resolver = DefaultResolver::new();
    let identifier = resolver.create_identifier(asset, Some(&ResolvedPath::new(layer.to_owned())));
    let path = resolver.resolve(&identifier).map_or_else(|| PathBuf::from(&identifier), |path| path.to_path_buf());
    let name = path.to_string_lossy();
    if name.to_ascii_lowercase().ends_with(".usdz") && !is_package_relative_path(&name) {
        return Leads::Package(format!("{name}["));
    }
    Leads::Layer(path)
}

/// A path and those above it, but for the root.
fn ancestors(path: &str) -> impl Iterator<Item = &str> {
    let parent = |path: &&str| path.rfind('/').filter(|&end| end > 0).map(|end| path[..end].len());
    std::iter::successors(Some(path), move |path| parent(path).map(|end| &path[..end]))
}

/// Whether a path is that of another, or above it.
fn is_above(above: &str, path: &str) -> bool {
    path.strip_prefix(above).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

impl Place {
    /// Whether a place is this one, or one is in the other.
    fn is_around(&self, other: &Self) -> bool {
        self.layer == other.layer && (is_above(&self.path, &other.path) || is_above(&other.path, &self.path))
    }
}
