//! Elimination order: inner nodes from the far inside outwards, the contact nodes last, so that the last block of the
//! factor is the Schur complement on the contact nodes.

/// Nodes in the order of their elimination.
pub(super) fn interior_first(
    nodes: &[[f64; 2]],
    cells: &[u32],
    nodes_per_cell: usize,
    contact_nodes: &[u32],
) -> Vec<u32> {
    let mut level = vec![u32::MAX; nodes.len()];
    contact_nodes.iter().for_each(|&node| level[node as usize] = 0);
    for depth in 1.. {
        let mut reached = Vec::new();
        for corners in cells.chunks_exact(nodes_per_cell) {
            if corners.iter().any(|&node| level[node as usize] == depth - 1) {
                reached.extend(corners.iter().copied().filter(|&node| level[node as usize] == u32::MAX));
            }
        }
        if reached.is_empty() {
            break;
        }
        reached.into_iter().for_each(|node| level[node as usize] = depth);
    }
    let angle = |node: u32| {
        let [x, y] = nodes[node as usize];
        libm::atan2(y, x)
    };
    let mut order: Vec<u32> = (0..nodes.len() as u32).collect();
    order.sort_by(|&a, &b| {
        let by_level = level[b as usize].cmp(&level[a as usize]);
        by_level.then(angle(a).total_cmp(&angle(b))).then(a.cmp(&b))
    });
    order
}

/// Nodes by number, those that contact acts on last, and how many these are.
pub(super) fn as_numbered(touched: &[bool]) -> (Vec<u32>, usize) {
    let nodes = |last: bool| (0..touched.len() as u32).filter(move |&node| touched[node as usize] == last);
    let order: Vec<u32> = nodes(false).chain(nodes(true)).collect();
    (order, touched.iter().filter(|last| **last).count())
}
