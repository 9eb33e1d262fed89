//! The prims that are read, and the nodes that they stand on: every prim that can have a transform is one.
use std::collections::HashMap;

use openusd::usd;

use super::attributes::Attributes;
use super::guard::Stage;
use super::{convert, xform};
use crate::curve::{Curve, Interpolation};
use crate::gltf::fault::Fault;
use crate::node::{Node, TransformStep};

/// Prims that a stage may have: references multiply, and no honest scene of ours comes near.
const MAX_PRIMS: usize = 1 << 20;
/// What composing all prims may cost, at half a KiB each: the floor, and one more for so many bytes of layers.
const MIN_COST: u64 = 1 << 19;
const BYTES_A_COST: u64 = 4;
/// How deep prims may stand in each other.
const MAX_DEPTH: usize = 256;
/// Prims without a place, and what is below them: they are read where something names them.
const PLACELESS: [&str; 6] = ["Material", "Shader", "NodeGraph", "SkelAnimation", "BlendShape", "GeomSubset"];

/// A prim on its node.
pub struct Item {
    pub prim: usd::Prim,
    /// Its type's name; empty without one.
    pub kind: String,
    /// Into [`Tree::nodes`].
    pub node: usize,
    /// The item of its parent.
    pub parent: Option<usize>,
    /// The prim that it shares all it has with: in the prototype of an instance, else itself.
    pub source: String,
    /// Whether renders show it.
    pub is_rendered: bool,
    /// Whether it is below a point instancer, which says where it stands.
    pub is_prototype: bool,
}

/// Nodes, and the prims that stand on them.
pub struct Tree {
    pub nodes: Vec<Node>,
    /// Depth first.
    pub items: Vec<Item>,
    /// The item of a prim's path.
    pub item_of: HashMap<String, usize>,
}

struct Ahead {
    prim: usd::Prim,
    parent: Option<usize>,
    depth: usize,
}

impl Tree {
    /// Walks through a stage. `rate`: time codes a second.
    pub fn read(stage: &Stage, rate: f64, is_z_up: bool) -> Result<Self, Fault> {
        let mut tree = Self { nodes: Vec::new(), items: Vec::new(), item_of: HashMap::new() };
        if is_z_up {
            let turn = TransformStep::Matrix(Curve::constant(xform::z_up()));
            tree.nodes.push(Node { steps: vec![turn], ..Node::still("/", None) });
        }
        let mut ahead: Vec<Ahead> = Vec::new();
        let roots = stage.root_prims().map_err(|error| failed("/", &error))?;
        for name in roots {
            ahead.push(Ahead { prim: stage.prim(format!("/{name}").as_str())?, parent: None, depth: 0 });
        }
        ahead.reverse();
        let mut cost = 0;
        while let Some(Ahead { prim, parent, depth }) = ahead.pop() {
            let path = prim.path().as_str().to_owned();
            if depth > MAX_DEPTH || tree.items.len() >= MAX_PRIMS {
                let found = format!("{} prims, {depth} deep", tree.items.len());
                return Err(Fault::new(path, found, format!("at most {MAX_PRIMS}, {MAX_DEPTH} deep")));
            }
            let index = prim.prim_index().graph().map_err(|error| failed(&path, &error))?;
            let places = index.all_nodes().count() as u64;
            // Below references in references, every place is composed once for every pair of levels above.
            let levels = places.min(depth as u64);
            cost += places * (1 + places / 32 + levels * levels / 8);
            let most = MIN_COST + stage.bytes() / BYTES_A_COST;
            if cost > most {
                let found = format!("composition that costs {cost} so far");
                let expected = format!("at most {most} in layers of this size: instanceable prims share theirs");
                return Err(Fault::new(path, found, expected));
            }
            let status = stage.prim_status(prim.path().clone()).map_err(|error| failed(&path, &error))?;
            if !usd::PrimPredicate::DEFAULT.matches(status) {
                continue;
            }
            let kind = prim.type_name().map_err(|error| failed(&path, &error))?;
            let kind = kind.map(|kind| kind.as_str().to_owned()).unwrap_or_default();
            if PLACELESS.contains(&kind.as_str()) {
                continue;
            }
            let children = stage.children(&prim)?;
            let item = tree.item(prim, kind, parent, rate)?;
            let children = children.into_iter().map(|prim| Ahead { prim, parent: Some(item), depth: depth + 1 });
            let first = ahead.len();
            ahead.extend(children);
            ahead[first..].reverse();
        }
        Ok(tree)
    }

    /// Adds a prim and its node; returns the item's place.
    fn item(&mut self, prim: usd::Prim, kind: String, parent: Option<usize>, rate: f64) -> Result<usize, Fault> {
        let attributes = Attributes::new(&prim, rate);
        let path = attributes.path();
        let transform = xform::read(&attributes)?;
        let own_visible = visible(&attributes)?;
        let root = (self.nodes.first().is_some_and(|node| node.name == "/")).then_some(0);
        let above = parent.map(|parent| &self.items[parent]);
        let mut node = Node {
            steps: transform.steps,
            visible: own_visible,
            ..Node::still(&path, above.map(|above| above.node).or(root))
        };
        if transform.is_reset {
            node.visible = self.visible_below(node.parent, &node.visible);
            node.parent = root;
        }
        let purpose = attributes.get("purpose", "a token", convert::token)?;
        let is_rendered = match purpose.as_deref() {
            None => above.is_none_or(|above| above.is_rendered),
            Some(purpose) => ["default", "render"].contains(&purpose),
        };
        let is_prototype = above.is_some_and(|above| above.is_prototype || above.kind == "PointInstancer");
        let source = prim.prim_in_prototype().map_err(|error| failed(&path, &error))?;
        let source = source.map_or_else(|| path.clone(), |source| source.path().as_str().to_owned());
        let item = Item { prim, kind, node: self.nodes.len(), parent, source, is_rendered, is_prototype };
        self.nodes.push(node);
        self.item_of.insert(path, self.items.len());
        self.items.push(item);
        Ok(self.items.len() - 1)
    }

    /// The meshes at and below a path that renders show.
    pub fn meshes_below(&self, path: &str) -> Vec<usize> {
        let is_below = |item: &Item| {
            let rest = item.prim.path().as_str().strip_prefix(path);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        let is_shown = |item: &Item| item.kind == "Mesh" && item.is_rendered && is_below(item);
        (0..self.items.len()).filter(|&item| is_shown(&self.items[item])).collect()
    }

    /// When something is seen that says so itself, and hangs on a node for its visibility alone.
    pub fn visible_below(&self, node: Option<usize>, own: &Curve<bool>) -> Curve<bool> {
        let chain =
            || std::iter::successors(node, |&node| self.nodes[node].parent).map(|node| &self.nodes[node].visible);
        let mut times: Vec<f64> = chain().chain([own]).flat_map(|curve| curve.times().iter().copied()).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let at = |time: f64| chain().chain([own]).all(|curve| curve.at(time));
        let values = times.iter().map(|&time| at(time)).collect();
        Curve::keyed(times, values, Interpolation::Step).unwrap_or_else(|_| Curve::constant(at(0.0)))
    }
}

fn visible(attributes: &Attributes) -> Result<Curve<bool>, Fault> {
    let is_visible = |value| convert::token(value).map(|token| token != "invisible");
    let curve = attributes.curve("visibility", ("a token", Interpolation::Step), is_visible)?;
    Ok(curve.unwrap_or_else(|| Curve::constant(true)))
}

fn failed(path: &str, error: &dyn std::fmt::Display) -> Fault {
    Fault::new(path, error.to_string(), "a prim that can be read")
}
