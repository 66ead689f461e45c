//! The shape of the code: who depends on whom, what belongs where, whether the documents match the tree.

mod architecture;
mod edges;
mod workspace;
