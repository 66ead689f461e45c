//! What is read off a world: solid fraction, coordination, curvature, plastic share.

pub mod curvature;
pub mod network;
pub mod state;
