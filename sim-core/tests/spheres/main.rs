//! Whole runs of cohesive spheres.

mod bits;
mod corners;
mod sanity;
mod support;
