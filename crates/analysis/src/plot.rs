//! Pictures as SVG text, 800 px wide, on white, in colours that the colour-blind can tell apart (Okabe & Ito).

mod axis;
mod bonds;
mod collapse;
mod discs;
mod exponents;
mod figure;
mod forces;
mod plastic;
mod profile;
mod series;

pub(crate) use axis::plain;
pub use bonds::bonds_svg;
pub use collapse::{collapse_svg, master_svg, plateau_svg, raw_svg};
pub use discs::{consolidation_svg, moduli_svg, structure_svg};
pub use exponents::exponents_svg;
pub use forces::{distribution_svg, forces_svg};
pub use plastic::{compaction_svg, coordination_svg, curvature_svg, stress_strain_svg};
pub use profile::{profile_svg, variation_svg};

#[cfg(test)]
mod tests;
