//! The tree of paths of a binary layer.
//!
//! An entry names its place among the paths, its token, and where its sibling is: 0: it has a sibling, which is the next entry,
//! and no child; above 0: it has a child, the next entry, and a sibling that many entries on; -1: a child and no sibling;
//! else: neither.
use super::blocks;
use super::budget::Budget;
use super::cursor::Cursor;
use super::text::MAX_NESTING;
use crate::gltf::fault::Fault;

/// What a path takes in memory beside its text.
const PATH_BYTES: u64 = 48;

/// The entries of the tree, as they are stored.
struct Entries {
    paths: Vec<u32>,
    tokens: Vec<u32>,
    jumps: Vec<i32>,
}

/// The lengths of all paths; refuses entries that are no tree, or one too deep.
pub fn check(mut cursor: Cursor, tokens: &[Box<[u8]>], budget: &mut Budget) -> Result<Vec<u64>, Fault> {
    let path_count = cursor.u64()?;
    budget.charge(cursor.place(), path_count.saturating_mul(PATH_BYTES))?;
    let mut lengths = vec![0; path_count as usize];
    let count = cursor.u64()?;
    let entries = Entries {
        paths: blocks::integers(&mut cursor, count, budget)?,
        tokens: blocks::integers(&mut cursor, count, budget)?,
        jumps: blocks::integers(&mut cursor, count, budget)?.into_iter().map(u32::cast_signed).collect(),
    };
    if count > 0 {
        walk(&cursor, &entries, tokens, &mut lengths, budget)?;
    }
    Ok(lengths)
}

/// Where a path ends: bytes, and names in it.
#[derive(Clone, Copy, Default)]
struct End {
    length: u64,
    depth: usize,
}

fn walk(
    cursor: &Cursor,
    entries: &Entries,
    tokens: &[Box<[u8]>],
    lengths: &mut [u64],
    budget: &mut Budget,
) -> Result<(), Fault> {
    let count = entries.jumps.len();
    let mut is_seen = vec![false; count];
    let mut ahead = vec![(0, End::default())];
    while let Some((mut entry, mut parent)) = ahead.pop() {
        loop {
            match is_seen.get_mut(entry) {
                Some(is_seen) if !*is_seen => *is_seen = true,
                Some(_) => return Err(cursor.fault(format!("entry {entry} in the tree twice"), "every entry once")),
                None => return Err(cursor.fault(format!("a jump to entry {entry}"), format!("one of {count} entries"))),
            }
            let end = if entry == 0 {
                End { length: 1, depth: 0 }
            } else {
                end(cursor, entries.tokens[entry], tokens, parent)?
            };
            budget.charge(cursor.place(), end.length)?;
            let path = entries.paths[entry] as usize;
            let Some(length) = lengths.get_mut(path) else {
                return Err(
                    cursor.fault(format!("entry {entry} of path {path}"), format!("one of {} paths", lengths.len()))
                );
            };
            *length = end.length;
            match entries.jumps[entry] {
                0 => {}
                jump @ 1.. => {
                    ahead.push((entry.saturating_add(jump as usize), parent));
                    parent = end;
                }
                -1 => parent = end,
                _ => break,
            }
            entry += 1;
        }
    }
    Ok(())
}

/// The end of a path one token longer than its parent. Negative tokens are of properties.
fn end(cursor: &Cursor, token: u32, tokens: &[Box<[u8]>], parent: End) -> Result<End, Fault> {
    let index = token.cast_signed().unsigned_abs();
    let Some(token) = tokens.get(index as usize) else {
        return Err(cursor.fault(format!("token {index}"), format!("one of {} tokens", tokens.len())));
    };
    let inner = token.iter().filter(|byte| matches!(byte, b'/' | b'{' | b'[')).count();
    let end = End { length: parent.length + 1 + token.len() as u64, depth: parent.depth + 1 + inner };
    if end.depth > MAX_NESTING {
        return Err(cursor.fault(format!("a path of {} names", end.depth), format!("at most {MAX_NESTING}")));
    }
    Ok(end)
}
