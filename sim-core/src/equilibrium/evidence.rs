//! Evidence that a packing stands still, and what a stop rule makes of it.

use scene::spheres::Stop;
use serde::{Deserialize, Serialize};

use super::sample::Sample;

/// Drift is measured while time grows by this factor: what has become of e in the last fifth of the run.
pub(crate) const WINDOW: f64 = 1.25;
/// Unbalanced force on the backbone beyond which nothing counts as settled [1]: what carries no load stands still only
/// because time was short. Settled packings have 0.01 to 0.3, a gas between light walls 0.7 and more (docs/stability.md).
const LOADED: f64 = 0.5;
/// Tolerances that decide the status where the stop rule does not name them.
pub(crate) const DEFAULT_E_DRIFT: f64 = 2.5e-4;
/// See [`DEFAULT_E_DRIFT`].
pub(crate) const DEFAULT_WALL_IMBALANCE: f64 = 0.01;
/// See [`DEFAULT_E_DRIFT`].
pub(crate) const DEFAULT_Z_REST: f64 = 0.05;
/// See [`DEFAULT_E_DRIFT`].
pub(crate) const DEFAULT_KE_CONTACTS: f64 = 2.0e-6;
/// The paper's threshold of KE/E_el.
pub(crate) const DEFAULT_KE: f64 = 2.0e-7;

/// What the samples say about the end of the run. A quantity that is not defined yet (too few samples, nothing
/// touches) is absent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Evidence {
    /// Largest minus smallest e in the window [1].
    pub(crate) e_drift: Option<f64>,
    /// Where Z+ and Z− are heading.
    pub(crate) approach: Option<Approach>,
    /// Larger of |mean of the later half − mean of the earlier half| of the window for Z+ and Z− [1], doubled: the
    /// change over the whole window of a steady drift, with the flicker of contacts near zero force averaged out.
    pub(crate) z_drift: Option<f64>,
    /// Largest |F/(p S) − 1| over the moving walls, F averaged over the window [1]: exactly, from the momentum that a
    /// wall has gained in it. Walls ring for ever at high adhesion, and the mean of ten samples of the force does not
    /// get below 1 % before the ringing does.
    pub(crate) wall_imbalance: Option<f64>,
    /// |F/(p S) − 1| of the last sample alone [1].
    pub(crate) wall_imbalance_now: f64,
    /// KE/E_el [1].
    pub(crate) ke_over_eel: Option<f64>,
    /// The same with particles of fewer than four contacts left out of KE [1].
    pub(crate) ke_held_over_eel: Option<f64>,
    /// Kinetic energy of the motion along the normals between held particles over E_el, mean over the window [1].
    pub(crate) ke_contacts_over_eel: Option<f64>,
    /// Unbalanced force on the backbone [1].
    pub(crate) unbalanced: f64,
}

impl Evidence {
    /// Larger of what Z+ and Z− still have before them, in magnitude [1].
    pub(crate) fn z_rest(&self) -> Option<f64> {
        self.approach.map(|z| z.plus.rest.abs().max(z.minus.rest.abs()))
    }
}

/// Where Z+ and Z− are heading.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Approach {
    /// Of Z+.
    pub(crate) plus: Limit,
    /// Of Z−.
    pub(crate) minus: Limit,
}

/// A quantity that approaches its limit as 1/t.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Limit {
    /// The limit.
    pub(crate) limit: f64,
    /// What it will still gain or lose.
    pub(crate) rest: f64,
}

/// The driven walls.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Driven {
    /// Which of the walls move.
    pub(crate) moving: [bool; 6],
    /// Mass of a wall [m].
    pub(crate) mass: f64,
}

/// Reads the evidence off a series. The series must not be empty.
pub(crate) fn evidence(samples: &[Sample], walls: Driven) -> Evidence {
    let last = samples.last().expect("the initial state is sampled");
    let ratio = |kinetic: f64| (last.elastic > 0.0).then(|| kinetic / last.elastic);
    let mut found = Evidence {
        wall_imbalance_now: imbalance_now(last, walls),
        ke_over_eel: ratio(last.kinetic),
        ke_held_over_eel: ratio(last.kinetic_held),
        unbalanced: last.unbalanced,
        ..Evidence::default()
    };
    let Some(window) = window(samples) else { return found };
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for sample in window {
        low = low.min(sample.e);
        high = high.max(sample.e);
    }
    found.e_drift = Some(high - low);
    found.wall_imbalance = imbalance(window, walls);
    let (earlier, later) = window.split_at(window.len() / 2);
    let change = |of: fn(&Sample) -> f64| 2.0 * (mean(later, of) - mean(earlier, of)).abs();
    found.approach = approach(samples, window);
    let kinetic =
        mean(window, |sample| if sample.elastic > 0.0 { sample.deforming / sample.elastic } else { 1.0 });
    found.ke_contacts_over_eel = ratio(0.0).map(|_| kinetic);
    found.z_drift = Some(change(|sample| sample.z_plus).max(change(|sample| sample.z_minus)));
    found
}

/// The samples of the last fifth of the time, one before them included; nothing while there are fewer than four.
fn window(samples: &[Sample]) -> Option<&[Sample]> {
    const FEWEST: usize = 4;
    let from = samples.last()?.time / WINDOW;
    let first = samples.partition_point(|sample| sample.time < from);
    let window = &samples[first.saturating_sub(1)..];
    (first > 0 && window.len() >= FEWEST).then_some(window)
}

/// Z+ and Z− extrapolated in 1/t, as they go on rising long after e has settled (docs/accuracy.md): through their means
/// over the last fifth of the time and over the last fifth of its first half.
fn approach(samples: &[Sample], late: &[Sample]) -> Option<Approach> {
    const FEWEST: usize = 2;
    let now = samples.last()?.time;
    let half = 0.5 * now;
    let early = &samples[samples.partition_point(|sample| sample.time < half / WINDOW)
        ..samples.partition_point(|sample| sample.time <= half)];
    if early.len() < FEWEST || early[0].time <= 0.0 {
        return None;
    }
    let inverse = |samples: &[Sample]| mean(samples, |sample| 1.0 / sample.time);
    let (then, lately) = (inverse(early), inverse(late));
    let limit = |of: fn(&Sample) -> f64| {
        let value = mean(late, of);
        let slope = (value - mean(early, of)) / (then - lately);
        Limit { limit: value + slope * lately, rest: slope / now }
    };
    Some(Approach { plus: limit(|sample| sample.z_plus), minus: limit(|sample| sample.z_minus) })
}

#[expect(clippy::cast_precision_loss, reason = "a window is a few samples")]
fn mean(samples: &[Sample], of: impl Fn(&Sample) -> f64) -> f64 {
    samples.iter().map(of).sum::<f64>() / samples.len() as f64
}

/// Largest of what `of` says about the driven walls.
fn largest(walls: Driven, of: impl Fn(usize) -> f64) -> f64 {
    (0..6).filter(|&wall| walls.moving[wall]).map(of).fold(0.0, f64::max)
}

/// |F̄/L̄ − 1| with F̄ − L̄ = m_w Δv/Δt, the mean over the time between the first and the last sample.
fn imbalance(window: &[Sample], walls: Driven) -> Option<f64> {
    let [first, .., last] = window else { return None };
    let momentum =
        |wall: usize| walls.mass * (last.wall_velocities[wall] - first.wall_velocities[wall]).abs();
    let load = |wall: usize| mean(window, |sample| sample.wall_loads[wall]);
    Some(largest(walls, |wall| momentum(wall) / ((last.time - first.time) * load(wall))))
}

fn imbalance_now(sample: &Sample, walls: Driven) -> f64 {
    largest(walls, |wall| (sample.wall_forces[wall] / sample.wall_loads[wall] - 1.0).abs())
}

/// What a stop rule makes of the evidence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Verdict {
    /// e stands still, the walls balance their load, and the particles carry it.
    pub(crate) settled: bool,
    /// Settled, hardly any motion deforms the network any more, and Z± are near their limits.
    pub(crate) equilibrium: bool,
    /// The rule of the scene says that the run may end.
    pub(crate) stop: bool,
}

/// Which criteria hold, each by its own tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Fired {
    /// Drift of e.
    pub(crate) e_drift: bool,
    /// Balance of the walls.
    pub(crate) wall_imbalance: bool,
    /// The backbone carries its load.
    pub(crate) loaded: bool,
    /// KE/E_el of all particles.
    pub(crate) ke: bool,
    /// The same of the motion that deforms the network.
    pub(crate) ke_contacts: bool,
    /// What Z± have before them.
    pub(crate) z_rest: bool,
}

impl Fired {
    /// Names of the criteria that hold, joined by `+`; `none` when there are none.
    pub(crate) fn names(self) -> String {
        let all = [
            (self.e_drift, "e_drift"),
            (self.wall_imbalance, "wall_imbalance"),
            (self.loaded, "loaded"),
            (self.ke, "ke"),
            (self.ke_contacts, "ke_contacts"),
            (self.z_rest, "z_rest"),
        ];
        let names: Vec<&str> = all.into_iter().filter_map(|(fired, name)| fired.then_some(name)).collect();
        if names.is_empty() { "none".to_owned() } else { names.join("+") }
    }
}

/// Tolerances [1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tolerances {
    e_drift: f64,
    wall_imbalance: f64,
    ke: f64,
    ke_contacts: f64,
    z_rest: f64,
}

/// The tolerances of a stop rule, defaults where it names none.
pub(crate) fn tolerances(stop: &Stop) -> Tolerances {
    let defaults = Tolerances {
        e_drift: DEFAULT_E_DRIFT,
        wall_imbalance: DEFAULT_WALL_IMBALANCE,
        ke: DEFAULT_KE,
        ke_contacts: DEFAULT_KE_CONTACTS,
        z_rest: DEFAULT_Z_REST,
    };
    match *stop {
        Stop::Settled { e_drift, wall_imbalance } => Tolerances { e_drift, wall_imbalance, ..defaults },
        Stop::Evidence { e_drift, wall_imbalance, ke_contacts, z_rest } => {
            Tolerances { e_drift, wall_imbalance, ke_contacts, z_rest, ..defaults }
        }
        Stop::KineticEnergy { ke_over_eel } => Tolerances { ke: ke_over_eel, ..defaults },
        Stop::Steps => defaults,
    }
}

/// Judges the evidence by a stop rule.
pub(crate) fn judge(stop: &Stop, found: &Evidence) -> (Verdict, Fired) {
    let tolerances = tolerances(stop);
    let within = |value: Option<f64>, tolerance: f64| value.is_some_and(|value| value <= tolerance);
    let fired = Fired {
        e_drift: within(found.e_drift, tolerances.e_drift),
        wall_imbalance: within(found.wall_imbalance, tolerances.wall_imbalance),
        loaded: within(Some(found.unbalanced), LOADED),
        ke: within(found.ke_over_eel, tolerances.ke),
        ke_contacts: within(found.ke_contacts_over_eel, tolerances.ke_contacts),
        z_rest: within(found.z_rest(), tolerances.z_rest),
    };
    let settled = fired.e_drift && fired.wall_imbalance && fired.loaded;
    let equilibrium = settled && fired.z_rest && fired.ke_contacts;
    // Taken alone the paper's ratio is met before anything happens when adhesion stores more energy in the first
    // pairs than the agitation holds: the walls must carry at least most of their load.
    let loaded = within(found.wall_imbalance, 0.1);
    let stop = match stop {
        Stop::Settled { .. } => settled,
        Stop::Evidence { .. } => equilibrium,
        Stop::KineticEnergy { .. } => fired.ke && loaded,
        Stop::Steps => false,
    };
    (Verdict { settled, equilibrium, stop }, fired)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: Driven = Driven { moving: [true; 6], mass: 3.0 };
    const RULE: Stop =
        Stop::Evidence { e_drift: 1e-3, wall_imbalance: 0.01, ke_contacts: 2e-6, z_rest: 0.05 };

    /// A series in which walls have a constant net force since the beginning.
    fn series(e: impl Fn(f64) -> f64, force: f64, kinetic: f64) -> Vec<Sample> {
        (0..200_u32)
            .map(|k| {
                let time = f64::from(k);
                Sample {
                    step: u64::from(k) * 10,
                    time,
                    dt: 0.1,
                    e: e(time),
                    z: 4.0,
                    z_plus: 2.5 + 0.01 * f64::from(k % 2),
                    z_minus: 1.5 - 0.01 * f64::from(k % 2),
                    with_two: 10,
                    kinetic,
                    kinetic_held: kinetic * 1e-1,
                    deforming: kinetic * 1e-3,
                    elastic: 1.0,
                    unbalanced: 1e-5,
                    wall_forces: [force; 6],
                    wall_loads: [2.0; 6],
                    wall_velocities: [(force - 2.0) / ALL.mass * time; 6],
                }
            })
            .collect()
    }

    #[test]
    fn drift_is_the_change_over_the_last_fifth() {
        let found = evidence(&series(|t| 2.0 - 1e-4 * t, 2.0, 1.0), ALL);
        // the window starts at or just before 199/1.25 = 159.2
        assert!((found.e_drift.unwrap() - 40.0e-4).abs() < 1e-12);
        assert!(found.z_drift.unwrap() < 3e-3, "flicker averages out");
    }

    #[test]
    fn each_criterion_can_hold_the_run_back() {
        let good = evidence(&series(|_| 1.2, 2.0, 1e-9), ALL);
        assert!(judge(&RULE, &good).0.stop);
        let heading = good.approach.unwrap();
        for bad in [
            Evidence { e_drift: Some(2e-3), ..good },
            Evidence { wall_imbalance: Some(0.02), ..good },
            Evidence { ke_contacts_over_eel: Some(1e-5), ..good },
            Evidence {
                approach: Some(Approach { minus: Limit { limit: 1.6, rest: 0.1 }, ..heading }),
                ..good
            },
            Evidence {
                approach: Some(Approach { plus: Limit { limit: 2.4, rest: -0.1 }, ..heading }),
                ..good
            },
            Evidence { approach: None, ..good },
            Evidence { e_drift: None, ..good },
            Evidence { unbalanced: 0.7, ..good },
        ] {
            assert!(!judge(&RULE, &bad).0.stop, "{bad:?}");
        }
        let flying = Evidence { ke_over_eel: Some(1e-2), ke_held_over_eel: Some(1e-5), ..good };
        let (verdict, fired) = judge(&RULE, &flying);
        assert!(verdict.stop, "motion that deforms nothing does not hold it back");
        assert_eq!(fired.names(), "e_drift+wall_imbalance+loaded+ke_contacts+z_rest");
    }

    #[test]
    fn a_limit_approached_as_one_over_time_is_found_exactly() {
        let mut samples = series(|_| 1.2, 2.0, 1e-9);
        for sample in &mut samples[1..] {
            sample.z_plus = 2.5 - 3.0 / sample.time;
            sample.z_minus = 1.5 + 7.0 / sample.time;
        }
        let found = evidence(&samples, ALL);
        let heading = found.approach.unwrap();
        assert!((heading.plus.limit - 2.5).abs() < 1e-12 && (heading.minus.limit - 1.5).abs() < 1e-12);
        assert!((heading.plus.rest - 3.0 / 199.0).abs() < 1e-12);
        assert!((found.z_rest().unwrap() - 7.0 / 199.0).abs() < 1e-12);
        assert_eq!(evidence(&samples[..5], ALL).approach, None, "one sample in the first half");
    }

    #[test]
    fn what_carries_no_load_is_not_settled() {
        let mut samples = series(|_| 1.7, 2.0, 0.0);
        for sample in &mut samples {
            sample.unbalanced = 0.8;
        }
        let (verdict, fired) =
            judge(&Stop::Settled { e_drift: 1e-3, wall_imbalance: 0.01 }, &evidence(&samples, ALL));
        assert!(!verdict.settled && !verdict.stop, "{}", fired.names());
    }

    #[test]
    fn the_papers_rule_waits_for_loaded_walls() {
        let rule = Stop::KineticEnergy { ke_over_eel: 2e-7 };
        let unloaded = evidence(&series(|_| 1.7, 0.0, 1e-9), ALL);
        assert!(!judge(&rule, &unloaded).0.stop);
        let loaded = evidence(&series(|t| 2.0 - 1e-4 * t, 2.0, 1e-9), ALL);
        let (verdict, _) = judge(&rule, &loaded);
        assert!(verdict.stop && !verdict.settled && !verdict.equilibrium);
    }

    #[test]
    fn ringing_walls_are_in_balance() {
        // once around between two samples, nearly: their forces are all 10 to 15 % too large, the mean force is not
        let mut samples = series(|_| 1.2, 2.0, 1e-9);
        let (amplitude, frequency) = (0.3, 0.9995 * std::f64::consts::TAU);
        for sample in &mut samples {
            sample.wall_forces = [2.0 + amplitude * (frequency * sample.time).cos(); 6];
            let velocity = amplitude / (ALL.mass * frequency) * (frequency * sample.time).sin();
            sample.wall_velocities = [velocity; 6];
        }
        let found = evidence(&samples, ALL);
        assert!(found.wall_imbalance_now > 0.1);
        // at most 2 A/(ω Δt) over the load, Δt = 40
        assert!(found.wall_imbalance.unwrap() < 1.2e-3, "{found:?}");
        assert!(judge(&RULE, &found).0.stop);
    }

    #[test]
    fn fixed_walls_owe_no_balance_and_early_samples_no_verdict() {
        let samples = series(|_| 1.2, 3.0, 0.0);
        assert!((evidence(&samples, ALL).wall_imbalance.unwrap() - 0.5).abs() < 1e-12);
        let fixed = Driven { moving: [false; 6], ..ALL };
        assert_eq!(evidence(&samples, fixed).wall_imbalance, Some(0.0));
        assert_eq!(evidence(&samples[..3], ALL).e_drift, None);
    }
}
