//! The record, the series and the final packing.

mod tables;

use record::{NotFinite, Outcome, Row, TableError};
use scene::spheres::{Approach, ReducedSpheres};

use super::memory::{Memory, Phase};
use super::start;
use crate::SimError;
use crate::dem::{Dynamics, View};
use crate::equilibrium::estimate;
use crate::equilibrium::evidence::{Evidence, evidence, judge};
use crate::equilibrium::sample::walls_of;
use crate::observables::coordination::{Coordination, coordination};
use crate::observables::forces::{self, Exponent};
use crate::observables::{blocks, void_ratio};

/// Everything about the run as it stands.
///
/// # Errors
/// [`SimError::Internal`] when an observable is not finite.
pub(super) fn outcome(
    scene: &ReducedSpheres,
    key: &str,
    dynamics: &dyn Dynamics,
    memory: &Memory,
) -> Result<Outcome, SimError> {
    let view = dynamics.view();
    let counted = coordination(&view);
    let mut record = Row::new();
    let not_finite = |error: NotFinite| SimError::Internal(format!("an observable: {error}"));
    scene_columns(&mut record, scene, key).map_err(not_finite)?;
    state_columns(&mut record, scene, &view, &counted, memory).map_err(not_finite)?;
    force_columns(&mut record, scene, &view).map_err(not_finite)?;
    evidence_columns(&mut record, scene, memory).map_err(not_finite)?;
    run_columns(&mut record, scene, dynamics, memory).map_err(not_finite)?;
    let table = |error: TableError| SimError::Internal(format!("a table: {error}"));
    Ok(Outcome {
        record,
        states: Vec::new(),
        series: tables::series(&memory.samples).map_err(table)?,
        packing: tables::packing(scene, &view, &counted).map_err(table)?,
    })
}

/// The groups that were run.
fn scene_columns(record: &mut Row, scene: &ReducedSpheres, key: &str) -> Result<(), NotFinite> {
    record
        .put("model", "cohesive_spheres")
        .put("scene_key", key)
        .put("physics_version", i64::from(scene::Model::CohesiveSpheres.physics_version()))
        .put("n", whole(scene.n))
        .put("seed", whole(scene.seed));
    record
        .number("p_over_sigma_e", scene.pressure)?
        .number("sigma_c_over_sigma_e", scene.adhesion)?
        .number("eta", scene.adhesion / scene.pressure)?
        .number("eta_star", scene.adhesion / scene.pressure.sqrt())?
        .number("wall_mass", scene.wall_mass)?
        .number("agitation_speed", scene.agitation_speed)?;
    Ok(())
}

/// Density and contacts, with their standard errors.
fn state_columns(
    record: &mut Row,
    scene: &ReducedSpheres,
    view: &View,
    counted: &Coordination,
    memory: &Memory,
) -> Result<(), NotFinite> {
    let walls = walls_of(view);
    let e = void_ratio::void_ratio(&walls, view.positions.len());
    let phi = 1.0 / (1.0 + e);
    let scatter = estimate::e_scatter(scene);
    let drift =
        evidence(&memory.samples, start::driven(scene)).e_drift.unwrap_or(0.0) * estimate::DRIFT_TO_REST;
    let e_se = (scatter * scatter + drift * drift).sqrt();
    record
        .number("e", e)?
        .number("e_se", e_se)?
        .number("e_se_scatter", scatter)?
        .number("e_se_drift", drift)?
        .number("phi", phi)?
        .number("phi_se", e_se * phi * phi)?
        .number("z", counted.z)?
        .number("z_plus", counted.z_plus)?
        .number("z_minus", counted.z_minus)?
        .number("z_wall", counted.z_wall)?
        .number("z_backbone", counted.z_backbone)?
        .number("rattler_share", counted.rattler_share)?
        .put("contacts", whole(view.contacts.len() as u64))
        .put("wall_contacts", whole(view.wall_contacts.len() as u64))
        .put("two_contact_particles", whole(counted.with_two));
    if let Some(e_core) = void_ratio::core(&view.positions, &walls) {
        record.number("e_core", e_core)?;
    }
    contact_errors(record, view, counted, &walls)
}

/// Standard errors of contact averages, from the octants of the sample.
fn contact_errors(
    record: &mut Row,
    view: &View,
    counted: &Coordination,
    walls: &[f64; 6],
) -> Result<(), NotFinite> {
    let octants = blocks::octants(&view.positions, walls);
    let mut all = vec![0.0; view.positions.len()];
    let mut tensile = all.clone();
    for contact in &view.contacts {
        for particle in [contact.i, contact.j] {
            all[particle] += 1.0;
            tensile[particle] += f64::from(u8::from(contact.normal_force < 0.0));
        }
    }
    let compressive: Vec<f64> = all.iter().zip(&tensile).map(|(total, part)| total - part).collect();
    let with_walls: Vec<f64> = counted.contacts.iter().map(|&count| f64::from(count)).collect();
    let loose: Vec<f64> = counted.backbone.iter().map(|&kept| f64::from(u8::from(!kept))).collect();
    for (name, values) in [
        ("z_se", &all),
        ("z_plus_se", &compressive),
        ("z_minus_se", &tensile),
        ("z_wall_se", &with_walls),
        ("rattler_share_se", &loose),
    ] {
        if let Some(error) = blocks::standard_error(values, &octants) {
            record.number(name, error)?;
        }
    }
    Ok(())
}

/// Statistics of the normal forces of pairs.
fn force_columns(record: &mut Row, scene: &ReducedSpheres, view: &View) -> Result<(), NotFinite> {
    let normal: Vec<f64> = view.contacts.iter().map(|contact| contact.normal_force).collect();
    let mut exponent = |name: &str, fit: Option<Exponent>| -> Result<(), NotFinite> {
        if let Some(fit) = fit {
            record
                .number(&format!("beta_{name}"), fit.beta)?
                .number(&format!("beta_{name}_se"), fit.standard_error)?
                .put(&format!("beta_{name}_contacts"), whole(fit.count as u64));
        }
        Ok(())
    };
    if let Some(found) = forces::statistics(&normal, scene.adhesion) {
        exponent("plus", found.plus)?;
        exponent("minus", found.minus)?;
        record.number("zero_force_share", found.peak_share)?;
    }
    if !normal.is_empty() {
        #[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
        record.number("fn_mean", normal.iter().sum::<f64>() / normal.len() as f64)?;
        record
            .number("overlap_max", view.contacts.iter().map(|contact| contact.overlap).fold(0.0, f64::max))?;
    }
    Ok(())
}

/// The status and the numbers that justify it.
fn evidence_columns(record: &mut Row, scene: &ReducedSpheres, memory: &Memory) -> Result<(), NotFinite> {
    let found: Evidence = evidence(&memory.samples, start::driven(scene));
    let (_, fired) = judge(&scene.stop, &found);
    let status = match memory.phase {
        Phase::Finished(status) => status.name(),
        _ => "running",
    };
    record.put("status", status).put("criteria", fired.names());
    let numbers = [
        ("e_drift", found.e_drift),
        ("z_drift", found.z_drift),
        ("wall_imbalance", found.wall_imbalance),
        ("wall_imbalance_now", Some(found.wall_imbalance_now)),
        ("ke_over_eel", found.ke_over_eel),
        ("ke_held_over_eel", found.ke_held_over_eel),
        ("ke_contacts_over_eel", found.ke_contacts_over_eel),
        ("z_rest", found.z_rest()),
        ("z_limit", found.approach.map(|z| z.plus.limit + z.minus.limit)),
        ("z_plus_limit", found.approach.map(|z| z.plus.limit)),
        ("z_minus_limit", found.approach.map(|z| z.minus.limit)),
        ("unbalanced_force", Some(found.unbalanced)),
    ];
    for (name, value) in numbers {
        if let Some(value) = value {
            record.number(name, value)?;
        }
    }
    Ok(())
}

/// How it was run: steps, time step, interventions.
fn run_columns(
    record: &mut Row,
    scene: &ReducedSpheres,
    dynamics: &dyn Dynamics,
    memory: &Memory,
) -> Result<(), NotFinite> {
    record
        .put("steps", whole(dynamics.steps()))
        .put("step_limit", whole(memory.step_limit))
        .put("kernel", dynamics.kernel())
        .put("dt_reason", memory.dt_reason.as_str())
        .put("retries", i64::from(memory.retries))
        .number("dt", dynamics.dt())?
        .number("sim_time", dynamics.time())?;
    if let Some(fault) = &memory.fault {
        record.put("retried_after", fault.as_str());
    }
    record.put(
        "approach",
        match scene.approach {
            Approach::Natural => "natural",
            Approach::RollingKicks => "rolling_kicks",
        },
    );
    if scene.approach == Approach::RollingKicks {
        record.put("kicks", whole(memory.kicks)).number("kick_energy", memory.kick_energy)?;
        for (name, mark) in [("began", memory.kicks_began), ("ended", memory.kicks_ended)] {
            if let Some(mark) = mark {
                record
                    .put(&format!("kicks_{name}_step"), whole(mark.step))
                    .put(&format!("kicks_{name}_two_contact_particles"), whole(mark.with_two))
                    .number(&format!("kicks_{name}_e"), mark.e)?
                    .number(&format!("kicks_{name}_z"), mark.z)?;
            }
        }
    }
    Ok(())
}

/// A count for the record.
fn whole(count: u64) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}
