//! The row of a finished run: scene in SI units, reduced scene, derived quantities, facts of the execution, record.

use record::{Cell, Row};
use serde_json::Value;

use crate::error::{AppError, AppResult};
use crate::store::RunRow;

/// The flat row of a run. Columns of the scene have the names of its keys (nested ones dotted, `stop.rule`); those of
/// the reduced scene begin with `reduced.`; derived quantities and the record follow under their own names.
pub(super) fn flat(run: &RunRow) -> AppResult<Row> {
    let parse = |text: &str, what: &str| {
        serde_json::from_str::<Value>(text).map_err(|error| AppError::Bug(format!("{what}: {error}")))
    };
    let scene = parse(&run.scene, "stored scene")?;
    let mut row = Row::new();
    flatten(&mut row, "reduced", &parse(&run.reduced, "stored reduced scene")?);
    flatten(&mut row, "", &scene);
    // A scene of an older version may not validate any more; its record still counts.
    if let Ok(scene) = scene::Scene::from_json(&scene) {
        for (name, value) in scene.derived() {
            if let Ok(cell) = Cell::try_from(value) {
                row.put(name, cell);
            }
        }
        row.put("out_of_model", scene.out_of_model().is_some());
    }
    row.extend(run.execution.clone());
    row.extend(run.record.clone());
    row.put("point", i64::try_from(run.point).unwrap_or(i64::MAX));
    row.put("job", run.job.to_string());
    row.put("scene_key", run.scene_key.as_str());
    row.put("physics_version", i64::from(run.physics_version));
    row.put("attempt", i64::from(run.attempt));
    row.put("worker_host", run.host.as_str());
    row.put("determinism_alarm", run.alarm);
    Ok(row)
}

fn flatten(row: &mut Row, prefix: &str, value: &Value) {
    if let Value::Object(members) = value {
        for (name, member) in members {
            let path = if prefix.is_empty() { name.clone() } else { format!("{prefix}.{name}") };
            flatten(row, &path, member);
        }
    } else if let Some(cell) = Cell::from_json(value) {
        row.put(prefix, cell);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nested_keys_are_dotted_and_absent_ones_left_out() {
        let mut row = Row::new();
        let scene = serde_json::json!({ "p": 1e5, "stop": { "rule": "steps" }, "dt": null, "list": [1] });
        flatten(&mut row, "", &scene);
        assert_eq!(row.real("p"), Some(1e5));
        assert_eq!(row.text("stop.rule"), Some("steps"));
        assert_eq!(row.iter().count(), 2);
    }
}
