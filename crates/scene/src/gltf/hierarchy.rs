//! The order of nodes: parents before their children, and which of them the scene has.
use ::gltf::json::{Index, Root, scene};

use super::fault::{Fault, at};

/// The nodes of a file in the order of [`crate::Scene::nodes`].
pub struct Hierarchy {
    /// The file's node of every node of the scene: first those that the scene shows, depth first, then the others.
    pub file_nodes: Vec<usize>,
    /// The parent of every node, by its place in `file_nodes`.
    pub parents: Vec<Option<usize>>,
    /// The place in `file_nodes` of every node of the file.
    pub place_of: Vec<usize>,
    /// So many nodes are shown: the first ones.
    pub shown_count: usize,
}

impl Hierarchy {
    /// Orders the nodes of the file. What is shown hangs on the roots of its default scene, else of its first, else on all roots.
    pub fn read(root: &Root) -> Result<Self, Fault> {
        let parents = parents(root)?;
        let scene = match root.scene {
            Some(index) => Some(at(&root.scenes, index.value(), "scenes", || "scene".to_owned())?),
            None => root.scenes.first(),
        };
        let without_parent = || (0..root.nodes.len()).filter(|&node| parents[node].is_none());
        let roots: Vec<usize> = match scene {
            None => without_parent().collect(),
            Some(scene) => scene.nodes.iter().map(Index::value).collect(),
        };
        let place = || "scenes[].nodes".to_owned();
        roots.iter().try_for_each(|&node| at(&root.nodes, node, "nodes", place).map(|_| ()))?;
        if let Some(&node) = roots.iter().find(|&&node| parents[node].is_some()) {
            return Err(Fault::new(place(), format!("node {node}, a child"), "root nodes"));
        }
        let mut order = Self {
            file_nodes: Vec::with_capacity(root.nodes.len()),
            parents: Vec::with_capacity(root.nodes.len()),
            place_of: vec![usize::MAX; root.nodes.len()],
            shown_count: 0,
        };
        roots.iter().for_each(|&node| order.visit(root, node));
        order.shown_count = order.file_nodes.len();
        without_parent().for_each(|node| order.visit(root, node));
        match order.place_of.iter().position(|&place| place == usize::MAX) {
            None => Ok(order),
            Some(node) => Err(Fault::new(format!("nodes[{node}]"), "a node that is its own ancestor", "a tree")),
        }
    }

    /// Appends a root and all below it, children in their order.
    fn visit(&mut self, root: &Root, node: usize) {
        let mut ahead = vec![(node, None)];
        while let Some((node, parent)) = ahead.pop() {
            if self.place_of[node] != usize::MAX {
                continue;
            }
            let place = self.file_nodes.len();
            self.place_of[node] = place;
            self.file_nodes.push(node);
            self.parents.push(parent);
            ahead.extend(children(&root.nodes[node]).rev().map(|child| (child, Some(place))));
        }
    }
}

fn children(node: &scene::Node) -> impl DoubleEndedIterator<Item = usize> {
    node.children.iter().flatten().map(Index::value)
}

/// The parent of every node, of which each has one at most.
fn parents(root: &Root) -> Result<Vec<Option<usize>>, Fault> {
    let mut parents: Vec<Option<usize>> = vec![None; root.nodes.len()];
    for (parent, node) in root.nodes.iter().enumerate() {
        let place = || format!("nodes[{parent}].children");
        for child in children(node) {
            at(&root.nodes, child, "nodes", place)?;
            if let Some(other) = parents[child].replace(parent) {
                return Err(Fault::new(
                    place(),
                    format!("node {child}, which node {other} has, too"),
                    "one parent a node",
                ));
            }
        }
    }
    Ok(parents)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(nodes: &str, scene: &str) -> Result<Hierarchy, Fault> {
        let json = format!(r#"{{"asset":{{"version":"2.0"}},"nodes":{nodes}{scene}}}"#);
        Hierarchy::read(&serde_json::from_str(&json).unwrap())
    }

    #[test]
    fn parents_come_first_and_what_is_not_shown_last() {
        let nodes = r#"[{"children":[3,1]},{},{"children":[0]},{"children":[4]},{},{"children":[6]},{}]"#;
        let order = read(nodes, r#","scene":1,"scenes":[{"nodes":[5]},{"nodes":[2]}]"#).unwrap();
        assert_eq!(order.file_nodes, [2, 0, 3, 4, 1, 5, 6]);
        assert_eq!(order.parents, [None, Some(0), Some(1), Some(2), Some(1), None, Some(5)]);
        assert_eq!(order.shown_count, 5);
        assert_eq!(read(nodes, r#","scenes":[{"nodes":[5]}]"#).unwrap().shown_count, 2);
        assert_eq!(read(nodes, "").unwrap().shown_count, 7);
    }

    #[test]
    fn what_is_no_tree_is_refused() {
        let found = |nodes, scene| read(nodes, scene).err().expect("no tree").found;
        assert_eq!(found(r#"[{"children":[1]},{"children":[0]}]"#, ""), "a node that is its own ancestor");
        assert_eq!(found(r#"[{"children":[0]}]"#, ""), "a node that is its own ancestor");
        assert_eq!(found(r#"[{"children":[2]},{"children":[2]},{}]"#, ""), "node 2, which node 0 has, too");
        assert_eq!(found(r#"[{"children":[1,1]},{}]"#, ""), "node 1, which node 0 has, too");
        assert_eq!(found(r#"[{"children":[9]}]"#, ""), "nodes index 9");
        assert_eq!(found(r#"[{"children":[1]},{}]"#, r#","scenes":[{"nodes":[1]}]"#), "node 1, a child");
        assert_eq!(found("[{}]", r#","scene":1,"scenes":[{"nodes":[0]}]"#), "scenes index 1");
    }
}
