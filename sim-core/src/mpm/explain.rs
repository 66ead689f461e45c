//! What a scene of plastic discs would run.

use scene::plastic::{Method, ReducedPlastic};

use crate::{Explanation, Skip};

/// Kernel, step and cost of a scene, without building it.
#[must_use]
pub fn explain(scene: &ReducedPlastic) -> Explanation {
    let absent = |condition: bool, absent: &str, skipped: &str| {
        condition.then(|| Skip { absent: absent.to_owned(), skipped: skipped.to_owned(), saves: None })
    };
    let dt_reason = if scene.method == Method::Explicit {
        "the stable step of the explicit method, estimated before the mesh is there; it shrinks as cells are squeezed; \
         recorded states fall on whole steps"
    } else if scene.dt.is_some() {
        "asked for, cut so that recorded states fall on whole steps"
    } else {
        "the wall moves by at most a quarter of the smallest cell and a thousandth of the height; recorded states fall \
         on whole steps"
    };
    let points = scene.points();
    let reduced = scene::Reduced::PlasticDiscs(scene.clone());
    let cost = scene::cost(&reduced);
    Explanation {
        kernel: super::simulation::kernel(scene),
        skips: [
            absent(scene.mu == 0.0, "friction", "tangential impulses and responses"),
            absent(scene.sigma_y.is_none(), "yield", "return map and plastic strain"),
            absent(!scene.f_bar, "f_bar", "mean volume change of the cells"),
        ]
        .into_iter()
        .flatten()
        .collect(),
        dt: scene.time_step(),
        dt_reason: dt_reason.to_owned(),
        // state and trial of a point, its share of nodes, factor and compliance
        memory_bytes: points * if scene.method == Method::Explicit { 120 } else { 600 },
        expected_steps: cost.steps,
        expected_seconds: cost.seconds,
    }
}
