//! The blow-up guard: an energy balance and the geometry, looked at every [`EVERY`] steps.

use serde::{Deserialize, Serialize};

use crate::dem::View;

/// Steps between looks: a fault is caught within twice this number, half of the 1000 that are promised.
pub(crate) const EVERY: u64 = 500;
/// Energy that may be gained, as a share of the energy the run has handled [1]. The scheme's own oscillation about
/// the conserved energy is of order (ω dt)²/24 of the vibration energy, a few 1e-3 at the largest time step used.
const GAIN: f64 = 0.05;

/// What the guard remembers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Guard {
    /// Smallest energy seen (kinetic, elastic, adhesion, walls and p V), less what kicks have put in [k_n d²].
    lowest: Option<f64>,
    /// Largest sum of magnitudes seen: what a relative gain refers to [k_n d²].
    handled: f64,
    /// Energy put in by kicks [k_n d²].
    injected: f64,
}

impl Guard {
    /// Tells the guard of energy put in on purpose [k_n d²].
    pub(crate) fn inject(&mut self, energy: f64) {
        self.injected += energy;
    }

    /// Looks at a state. Contacts only dissipate and p V is the potential of the load, so the total energy may not
    /// grow; no particle may leave the box or pass through another.
    ///
    /// # Errors
    /// What was found.
    pub(crate) fn look(&mut self, view: &View, adhesion: f64, wall_adhesion: f64) -> Result<(), String> {
        let energies = view.energies;
        let total = energies.total();
        if !total.is_finite() {
            return Err("the energy is not finite".to_owned());
        }
        // an overlap of half a diameter beyond the one at rest under adhesion is no soft contact any more
        if let Some(worst) = view.contacts.iter().find(|contact| contact.overlap > 0.5 + adhesion) {
            return Err(format!("particles {} and {} overlap by {:.3} d", worst.i, worst.j, worst.overlap));
        }
        if let Some(worst) = view.wall_contacts.iter().find(|contact| contact.overlap > 1.0 + wall_adhesion) {
            return Err(format!(
                "particle {} overlaps wall {} by {:.3} d",
                worst.particle, worst.wall, worst.overlap
            ));
        }
        for (particle, x) in view.positions.iter().enumerate() {
            let outside = view.walls.chunks_exact(2).enumerate().any(|(axis, pair)| {
                let slack = 0.5 + wall_adhesion;
                !(x[axis] >= pair[0].position - slack && x[axis] <= pair[1].position + slack)
            });
            if outside {
                return Err(format!("particle {particle} left the box"));
            }
        }
        let magnitude = energies.kinetic()
            + energies.elastic()
            + energies.adhesion.abs()
            + energies.walls
            + energies.load.abs();
        let balance = total - self.injected;
        // The reference for a gain is what was handled before this look, so that a blow-up does not raise its own bar;
        // only the adhesion that first contacts have set free since then counts, which is at most f_c each.
        let handled = self.handled.max(energies.adhesion.abs());
        if let Some(lowest) = self.lowest
            && balance - lowest > GAIN * handled
        {
            return Err(format!(
                "the energy grew by {:.3e} k_n d², {:.0} % of all that was handled",
                balance - lowest,
                100.0 * (balance - lowest) / handled
            ));
        }
        self.lowest = Some(self.lowest.map_or(balance, |lowest| lowest.min(balance)));
        self.handled = self.handled.max(magnitude);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dem::{Energies, WallView};

    fn state(energies: Energies, x: f64) -> View {
        let wall =
            |axis, position| WallView { axis, position, velocity: 0.0, force: 0.0, load: 1.0, moving: true };
        View {
            positions: vec![[x, 5.0, 5.0]],
            walls: (0..3).flat_map(|axis| [wall(axis, 0.0), wall(axis, 10.0)]).collect(),
            energies,
            ..View::default()
        }
    }

    #[test]
    fn falling_energy_passes_and_growing_energy_does_not() {
        let mut guard = Guard::default();
        let with =
            |kinetic: f64| state(Energies { translation: kinetic, load: 10.0, ..Energies::default() }, 5.0);
        for kinetic in [1.0, 0.9, 0.5, 0.5, 0.6] {
            guard.look(&with(kinetic), 0.0, 0.0).unwrap();
        }
        assert!(guard.clone().look(&with(1.2), 0.0, 0.0).unwrap_err().contains("grew"));
        guard.inject(1.0);
        guard.look(&with(1.2), 0.0, 0.0).unwrap();
    }

    #[test]
    fn nan_and_escape_are_seen() {
        let mut guard = Guard::default();
        let nan = Energies { rotation: f64::NAN, ..Energies::default() };
        assert!(guard.look(&state(nan, 5.0), 0.0, 0.0).is_err());
        assert!(guard.look(&state(Energies::default(), 10.6), 0.0, 0.0).unwrap_err().contains("left"));
        assert!(guard.look(&state(Energies::default(), f64::NAN), 0.0, 0.0).is_err());
        guard.look(&state(Energies::default(), 10.4), 0.0, 0.0).unwrap();
    }
}
