//! Record, states, series and packing of a run.

use record::{Outcome, Packing, Row, Table};

use super::PlasticDiscs;
use crate::mpm::contact::Partner;
use crate::mpm::observe::curvature;
use crate::mpm::observe::state::State;

/// Bottom-wall stress, in E, above which an assembly counts as jammed.
const JAMMED_STRESS: f64 = 1e-4;

pub(super) fn outcome(run: &PlasticDiscs) -> Result<Outcome, Box<dyn std::error::Error>> {
    let states = run.log.states.iter().map(State::row).collect::<Result<Vec<_>, _>>()?;
    Ok(Outcome {
        record: record(run)?,
        states,
        series: series(&run.log.states)?,
        packing: Packing(
            [
                ("particles".to_owned(), particles(run)?),
                ("points".to_owned(), points(run)?),
                ("outlines".to_owned(), outlines(run)?),
                ("contacts".to_owned(), contacts(run)?),
            ]
            .into(),
        ),
    })
}

/// The last state, the jamming point and the effort.
fn record(run: &PlasticDiscs) -> Result<Row, Box<dyn std::error::Error>> {
    let mut row = run.log.states.last().map(State::row).transpose()?.unwrap_or_default();
    let status = if run.log.finished { run.log.status.as_str() } else { "running" };
    row.put("status", status).put("steps", i64::try_from(run.log.steps)?);
    row.number("dt", if run.world.last_dt > 0.0 { run.world.last_dt } else { run.log.dt })?;
    row.number("sim_time", run.world.time)?;
    let isostatic = if run.scene.mu > 0.0 { 3.0 } else { 4.0 };
    if let Some(state) = jamming_point(&run.log.states, isostatic) {
        row.number("phi_c", state.phi)?.number("strain_c", state.strain)?.number("sigma_c", state.sigma)?;
        row.number("z_c", state.z)?;
    }
    if let Some(last) = run.log.states.last().filter(|last| last.work > 0.0) {
        row.number("energy_gap", run.world.energy_gap() / last.work)?;
    }
    let effort = run.world.effort;
    let substeps = effort.substeps.max(1) as f64;
    row.number("newton_per_step", effort.newton as f64 / substeps)?;
    row.number("sweeps_per_step", effort.sweeps as f64 / substeps)?;
    row.put("halved_steps", i64::try_from(effort.halved)?);
    Ok(row)
}

/// First state from which on the backbone is isostatic (Z ≥ 4 without friction, 3 with it) and the bottom wall bears
/// more than 10⁻⁴ E until the end.
fn jamming_point(states: &[State], isostatic: f64) -> Option<&State> {
    let jammed = |state: &State| state.z >= isostatic && state.sigma > JAMMED_STRESS;
    let onset = states.iter().rposition(|state| !jammed(state)).map_or(0, |last| last + 1);
    states.get(onset)
}

fn series(states: &[State]) -> Result<Table, Box<dyn std::error::Error>> {
    let mut table = Table::new();
    let columns: Vec<_> = states.iter().map(State::columns).collect();
    let Some(first) = columns.first() else { return Ok(table) };
    for (index, (name, unit, _)) in first.iter().enumerate() {
        let values: Vec<f64> = columns.iter().map(|row| row[index].2).collect();
        table.push(name, unit, &values)?;
    }
    Ok(table)
}

fn particles(run: &PlasticDiscs) -> Result<Table, Box<dyn std::error::Error>> {
    let outlines = run.view().outlines();
    let count = run.world.bodies.len();
    let mut columns: [Vec<f64>; 7] = std::array::from_fn(|_| Vec::with_capacity(count));
    for (body, outline) in run.world.bodies.iter().zip(&outlines) {
        let mass: f64 = body.mass.iter().sum();
        let mut centre = [0.0; 2];
        for (node, m) in body.mass.iter().enumerate() {
            let at = body.reference(node);
            for axis in 0..2 {
                centre[axis] += m * (at[axis] + body.displacement[2 * node + axis]) / mass;
            }
        }
        let area: f64 = body.volumes().sum();
        let flowed = body.volumes().zip(&body.points.plastic).filter(|(_, plastic)| **plastic > 1e-6);
        let window = f64::max(1.5 * body.template.cell * body.size, 0.1 * body.size);
        let values = [
            centre[0],
            centre[1],
            body.size,
            area,
            outline.area(),
            curvature::largest(&outline.points, window),
            flowed.map(|(volume, _)| volume).sum::<f64>() / area,
        ];
        columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
    }
    let names = [
        ("x", "d"),
        ("y", "d"),
        ("radius", "d"),
        ("area", "d^2"),
        ("area_outline", "d^2"),
        ("kappa_max", "1/d"),
        ("f_p", "1"),
    ];
    table(&names, &columns)
}

/// Every material point: place, von Mises stress, plastic strain, mean stress.
fn points(run: &PlasticDiscs) -> Result<Table, Box<dyn std::error::Error>> {
    let mut columns: [Vec<f64>; 6] = std::array::from_fn(|_| Vec::new());
    for (number, body) in run.world.bodies.iter().enumerate() {
        let template = &body.template;
        let n = template.nodes_per_cell;
        for (cell, nodes) in template.cells.chunks_exact(n).enumerate() {
            for p in template.first_point[cell] as usize..template.first_point[cell + 1] as usize {
                let mut x = [0.0; 2];
                for (a, &node) in nodes.iter().enumerate() {
                    let at = body.reference(node as usize);
                    for axis in 0..2 {
                        x[axis] += template.values[n * p + a]
                            * (at[axis] + body.displacement[2 * node as usize + axis]);
                    }
                }
                let stress = body.points.stress[p];
                let values =
                    [number as f64, x[0], x[1], stress.von_mises(), body.points.plastic[p], stress.mean()];
                columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
            }
        }
    }
    let names = [
        ("disc", "1"),
        ("x", "d"),
        ("y", "d"),
        ("von_mises", "E"),
        ("plastic_strain", "1"),
        ("mean_stress", "E"),
    ];
    table(&names, &columns)
}

fn outlines(run: &PlasticDiscs) -> Result<Table, Box<dyn std::error::Error>> {
    let mut columns: [Vec<f64>; 3] = std::array::from_fn(|_| Vec::new());
    for (number, outline) in run.view().outlines().iter().enumerate() {
        for x in &outline.points {
            columns
                .iter_mut()
                .zip([number as f64, x[0], x[1]])
                .for_each(|(column, value)| column.push(value));
        }
    }
    table(&[("disc", "1"), ("x", "d"), ("y", "d")], &columns)
}

/// Force-bearing contacts over the last interval; a wall is partner −1 − its number (bottom, top, left, right).
fn contacts(run: &PlasticDiscs) -> Result<Table, Box<dyn std::error::Error>> {
    let mut columns: [Vec<f64>; 3] = std::array::from_fn(|_| Vec::new());
    for contact in run.view().contacts() {
        let partner = match contact.partner {
            Partner::Body(other) => f64::from(other),
            Partner::Wall(wall) => -1.0 - f64::from(wall),
        };
        let values = [f64::from(contact.disc), partner, contact.force];
        columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
    }
    table(&[("disc", "1"), ("partner", "1"), ("force", "E d")], &columns)
}

fn table(names: &[(&str, &str)], columns: &[Vec<f64>]) -> Result<Table, Box<dyn std::error::Error>> {
    let mut table = Table::new();
    for ((name, unit), values) in names.iter().zip(columns) {
        table.push(name, unit, values)?;
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jamming_is_isostatic_and_lasts() {
        let state = |z: f64, sigma: f64| State { z, sigma, ..State::default() };
        let states = [
            state(4.5, 1e-3),
            state(3.5, 1e-3),
            state(3.6, 1e-3),
            state(4.1, 0.0),
            state(4.2, 1e-3),
            state(5.0, 0.1),
        ];
        assert_eq!(jamming_point(&states, 4.0).map(|state| state.z), Some(4.2));
        // with friction three contacts suffice, but the bottom wall has to bear something
        assert_eq!(jamming_point(&states[..3], 3.0).map(|state| state.z), Some(4.5));
        assert_eq!(jamming_point(&states, 3.0).map(|state| state.z), Some(4.2));
        assert_eq!(jamming_point(&states, 6.0), None);
    }
}
