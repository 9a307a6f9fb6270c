//! Parts of a mesh that hang together.

/// Which of some parts belong to the largest piece, given the parts beside each. Other pieces would fall, or hang by a vertex.
pub fn largest_piece(count: usize, beside: impl Fn(usize) -> Vec<usize>) -> Vec<bool> {
    let mut piece_of = vec![usize::MAX; count];
    let mut sizes = Vec::new();
    for first in 0..count {
        let (mut next, mut size) = (vec![first], 0);
        while let Some(part) = next.pop() {
            if piece_of[part] == usize::MAX {
                piece_of[part] = sizes.len();
                size += 1;
                next.extend(beside(part));
            }
        }
        sizes.push(size);
    }
    let largest = (0..count).max_by_key(|piece| sizes[*piece]);
    piece_of.into_iter().map(|piece| Some(piece) == largest).collect()
}
