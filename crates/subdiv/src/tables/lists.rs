//! Many short lists of indices in one array.

/// Lists of indices, one after another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IndexLists {
    /// List i is `indices[first[i]..first[i + 1]]`.
    pub first: Vec<u32>,
    /// The entries of all lists.
    pub indices: Vec<u32>,
}

impl Default for IndexLists {
    fn default() -> Self {
        Self { first: vec![0], indices: Vec::new() }
    }
}

impl IndexLists {
    /// Number of lists.
    pub fn count(&self) -> u32 {
        self.first.len() as u32 - 1
    }

    /// One list.
    pub fn of(&self, list: u32) -> &[u32] {
        &self.indices[self.first[list as usize] as usize..self.first[list as usize + 1] as usize]
    }

    /// Appends a list and returns its number.
    pub(crate) fn push(&mut self, list: impl IntoIterator<Item = u32>) -> u32 {
        self.indices.extend(list);
        self.first.push(self.indices.len() as u32);
        self.count() - 1
    }

    /// Appends the lists of another, their entries mapped.
    pub(crate) fn append(&mut self, other: &Self, map: impl Fn(u32) -> u32) {
        let end = self.indices.len() as u32;
        self.first.extend(other.first[1..].iter().map(|first| first + end));
        self.indices.extend(other.indices.iter().map(|&index| map(index)));
    }
}
