//! Creases along rows of quads: what a heavily creased model has.
use std::collections::{HashMap, HashSet};

use crate::cage::Cage;
use crate::random::Random;

/// Sharpness of the creases: semi-sharp, whole and fractional, and infinite.
const SHARPNESS: [&str; 6] = ["1.5", "2", "2.3", "4", "10", "10"];
/// Edges of the longest crease.
const LONGEST: usize = 60;

/// Creases a share of a closed mesh's edges: lines that go straight on through vertices of valence 4 until they meet
/// another vertex or another crease.
pub fn add_creases(cage: &mut Cage, share: f64) {
    let mut random = Random::new(11);
    let mut next = HashMap::new();
    let mut valences = vec![0; cage.positions.len()];
    for face in &cage.faces {
        for i in 0..face.len() {
            let (a, b, c) = (face[i], face[(i + 1) % face.len()], face[(i + 2) % face.len()]);
            next.insert((a, b), c);
            valences[a as usize] += 1;
        }
    }
    let straight = |a: u32, b: u32| {
        let c = (valences[b as usize] == 4).then(|| next.get(&(a, b))).flatten()?;
        next.get(&(*c, b)).copied()
    };
    let mut starts: Vec<(u32, u32)> = next.keys().copied().collect();
    starts.sort_unstable();
    let wanted = (share * starts.len() as f64 / 2.0) as usize;
    let edge = |a: u32, b: u32| (a.min(b), a.max(b));
    let mut creased = HashSet::new();
    while creased.len() < wanted {
        let (a, b) = random.pick(&starts);
        if !creased.insert(edge(a, b)) {
            continue;
        }
        let mut line = vec![a, b];
        while let Some(c) = straight(line[line.len() - 2], line[line.len() - 1]) {
            if line.len() > LONGEST || !creased.insert(edge(line[line.len() - 1], c)) {
                break;
            }
            line.push(c);
        }
        let vertices: Vec<String> = line.iter().map(u32::to_string).collect();
        let sharpness = random.pick(&SHARPNESS);
        cage.tags.push(format!("t crease {}/1/0 {} {sharpness}", line.len(), vertices.join(" ")));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::large::blob;

    #[test]
    fn the_share_of_edges_is_creased_along_edges_that_are_there() {
        let mut cage = blob(600, 0.1);
        let edges: HashSet<(u32, u32)> =
            cage.faces.iter().flat_map(|f| (0..4).map(|i| (f[i], f[(i + 1) % 4]))).collect();
        add_creases(&mut cage, 0.2);
        let mut count = 0;
        for tag in &cage.tags {
            let words: Vec<&str> = tag.split(' ').collect();
            let line: Vec<u32> = words[3..words.len() - 1].iter().map(|word| word.parse().unwrap()).collect();
            assert!(line.windows(2).all(|pair| edges.contains(&(pair[0], pair[1]))), "{tag}");
            count += line.len() - 1;
        }
        let wanted = edges.len() / 10;
        assert!((wanted..wanted + LONGEST).contains(&count), "{count} creased, {wanted} wanted");
    }
}
