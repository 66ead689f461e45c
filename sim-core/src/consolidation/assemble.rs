//! Where a run starts.

use rand_pcg::Pcg64;
use scene::discs::{Assembly, ReducedDiscs};

use super::scales::Scales;
use crate::SimError;
use crate::boundary::CellControl;
use crate::dem::{DiscParameters, InitialDiscs};
use crate::packing::hard_discs::{FluidRecipe, hard_disc_fluid, maxwell_velocities};

/// Streams of random numbers.
const POSITIONS: u128 = 1;
const VELOCITIES: u128 = 2;

/// Laws of a scene.
#[must_use]
pub fn parameters(scene: &ReducedDiscs) -> DiscParameters {
    DiscParameters {
        f0: scene.f0,
        d0: scene.d0,
        restitution: scene.en,
        kt: scene.kt,
        mu: scene.mu,
        kr: scene.kr,
        mu_r: scene.mu_r,
        mixed: scene.precision == scene::Precision::Mixed,
    }
}

/// The hard-disc fluid of a scene; discs of type 1 are at rest.
///
/// # Errors
/// [`SimError::Scene`] when the fluid cannot be made or is too small for its cell.
pub fn initial_state(scene: &ReducedDiscs) -> Result<InitialDiscs, SimError> {
    let refuse = |field: &str, problem: String, remedy: &str| SimError::Scene {
        field: field.to_owned(),
        problem,
        remedy: remedy.to_owned(),
    };
    let discs = usize::try_from(scene.n)
        .map_err(|_| refuse("n", format!("{} discs do not fit into memory", scene.n), "lower n"))?;
    let recipe = FluidRecipe {
        discs,
        solid_fraction: scene.phi_i,
        size_ratio: scene.size_ratio,
        clearance: 1.01 * scene.d0,
        sweeps: usize::try_from(scene.fluid_sweeps).unwrap_or(usize::MAX),
    };
    let mut random = Pcg64::new(u128::from(scene.seed), POSITIONS);
    let fluid = hard_disc_fluid(&recipe, &mut random)
        .map_err(|error| refuse("phi_i", error.to_string(), "lower phi_i"))?;
    let speed = match scene.assembly {
        Assembly::Type1 => 0.0,
        // V* = √(F0 D0/m).
        Assembly::Type2 => scene.v0 * libm::sqrt(scene.f0 * scene.d0),
        Assembly::Cohesionless => scene.v0 * libm::sqrt(Scales::of(scene, scene.p0).pressure),
    };
    let velocities =
        maxwell_velocities(&fluid.radii, speed, &mut Pcg64::new(u128::from(scene.seed), VELOCITIES));
    let control = match scene.assembly {
        Assembly::Type2 => CellControl::Fixed,
        Assembly::Type1 | Assembly::Cohesionless => {
            pressure_control(scene, scene.p0, assembly_mass(scene, &fluid.radii))
        }
    };
    Ok(InitialDiscs {
        positions: fluid.positions,
        radii: fluid.radii,
        velocities,
        spins: vec![0.0; discs],
        edges: [fluid.edge; 2],
        control,
    })
}

/// Mass of the cell coordinate at the first pressure [m].
#[must_use]
pub fn assembly_mass(scene: &ReducedDiscs, radii: &[f64]) -> f64 {
    scene.assembly_cell_mass.unwrap_or_else(|| radii.iter().map(|r| 4.0 * r * r).sum())
}

/// Stress control at a pressure P* (P/K_N without cohesion).
#[must_use]
pub fn pressure_control(scene: &ReducedDiscs, reduced_pressure: f64, mass: f64) -> CellControl {
    // At P = 0 without cohesion there is no time scale; it does not occur.
    let scales = Scales::of(scene, reduced_pressure);
    CellControl::Pressure { pressure: scales.pressure, mass, cap: scene.ia / scales.time }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn start(text: &str) -> (ReducedDiscs, InitialDiscs) {
        let scene::Reduced::CohesiveDiscs(scene) = scene::Scene::from_text(text).unwrap().reduce() else {
            panic!("discs");
        };
        let initial = initial_state(&scene).unwrap();
        (scene, initial)
    }

    #[test]
    fn the_cohesionless_gas_has_the_first_pressure() {
        let (_, gas) = start(r#"{"model": "cohesive_discs", "assembly": "cohesionless", "n": 2000}"#);
        let energy: f64 = gas
            .radii
            .iter()
            .zip(&gas.velocities)
            .map(|(r, [u, v])| 0.5 * 4.0 * r * r * (u * u + v * v))
            .sum();
        let [mean, square] =
            [1, 2].map(|power| gas.radii.iter().map(|r| (2.0 * r).powi(power)).sum::<f64>() / 2000.0);
        let compressibility = 1.0 / 0.64 + 0.36 * mean * mean / (square * 0.64 * 0.64);
        let pressure = energy / (gas.edges[0] * gas.edges[1]) * compressibility;
        // 1e-5 up to the sample's moments of the diameter and its mean energy, 2 standard errors of 2 to 3 %.
        assert!((pressure / 1e-5 - 1.0).abs() < 0.06, "{pressure:e}");
    }

    #[test]
    fn type_1_is_at_rest_and_both_pull_a_cell_as_heavy_as_the_discs() {
        for assembly in ["type1", "cohesionless"] {
            let (scene, initial) =
                start(&format!(r#"{{"model": "cohesive_discs", "assembly": "{assembly}", "n": 50}}"#));
            let still = initial.velocities.iter().flatten().all(|&v| v == 0.0);
            assert_eq!(still, assembly == "type1");
            let discs: f64 = initial.radii.iter().map(|r| 4.0 * r * r).sum();
            assert_eq!(assembly_mass(&scene, &initial.radii), discs);
        }
    }
}
