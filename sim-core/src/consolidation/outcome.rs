//! What a run hands over.

use std::collections::BTreeMap;

use record::{Outcome, Packing, Row, Table};

use super::driver::{Consolidation, Phase};
use super::measure::solid_fraction;
use crate::SimError;

impl Consolidation {
    pub(super) fn outcome_now(&self) -> Result<Outcome, SimError> {
        let internal = |what: String| SimError::Internal(what);
        let picture = self.dem.picture();
        let mut record = Row::new();
        let status = match self.course.phase {
            Phase::Done => "equilibrium",
            Phase::NotConverged => "not_converged",
            _ => "running",
        };
        if let Some(last) = self.states.last() {
            record.extend(last.row.clone());
        }
        let whole = |number: u64| i64::try_from(number).unwrap_or(i64::MAX);
        record
            .put("status", status)
            .put("steps", whole(self.dem.steps()))
            .put("states", whole(self.states.len() as u64))
            .put("rescued", self.course.rescued)
            .put("n", whole(self.radii.len() as u64));
        let mut numbers =
            vec![("dt", self.dem.dt()), ("sim_time", self.dem.time()), ("phi", solid_fraction(&picture))];
        let densest = self.states.iter().filter_map(|state| state.row.real("phi")).fold(0.0, f64::max);
        if densest > 0.0 {
            numbers.push(("phi_max", densest));
        }
        for (name, value) in numbers {
            record.number(name, value).map_err(|error| internal(format!("{name}: {error}")))?;
        }
        Ok(Outcome {
            record,
            states: self.states.iter().map(|state| state.row.clone()).collect(),
            series: self.series().map_err(|error| internal(error.to_string()))?,
            packing: self.packing(&picture).map_err(|error| internal(error.to_string()))?,
        })
    }

    fn series(&self) -> Result<Table, record::TableError> {
        let columns = [("time", "T0"), ("p", "1"), ("phi", "1"), ("z", "1"), ("kinetic", "F1 a")];
        let mut table = Table::new();
        for (at, (name, unit)) in columns.into_iter().enumerate() {
            let values: Vec<f64> = self.course.series.iter().map(|point| point[at]).collect();
            table.push(name, unit, &values)?;
        }
        Ok(table)
    }

    fn packing(&self, picture: &crate::dem::CellPicture) -> Result<Packing, record::TableError> {
        let mut tables = BTreeMap::new();
        let mut cell = Table::new();
        cell.push("l1", "a", &picture.edges[..1])?.push("l2", "a", &picture.edges[1..])?;
        tables.insert("cell".to_owned(), cell);

        let mut particles = Table::new();
        let along = |axis: usize| picture.positions.iter().map(|x| x[axis]).collect::<Vec<f64>>();
        let moving = |axis: usize| picture.velocities.iter().map(|v| v[axis]).collect::<Vec<f64>>();
        particles
            .push("x", "a", &along(0))?
            .push("y", "a", &along(1))?
            .push("radius", "a", &picture.radii)?
            .push("vx", "a/tau", &moving(0))?
            .push("vy", "a/tau", &moving(1))?
            .push("spin", "1/tau", &picture.spins)?;
        tables.insert("particles".to_owned(), particles);

        let mut contacts = Table::new();
        let list = &picture.contacts;
        let column = |of: &dyn Fn(usize) -> f64| (0..list.len()).map(of).collect::<Vec<f64>>();
        contacts
            .push("i", "1", &column(&|k| f64::from(list[k].i)))?
            .push("j", "1", &column(&|k| f64::from(list[k].j)))?
            .push("gap", "a", &column(&|k| list[k].gap))?
            .push("branch_x", "a", &column(&|k| list[k].branch[0]))?
            .push("branch_y", "a", &column(&|k| list[k].branch[1]))?
            .push("normal_force", "K_N a", &column(&|k| list[k].normal))?
            .push("tangential_force", "K_N a", &column(&|k| list[k].tangential))?
            .push("rolling_moment", "K_N a2", &column(&|k| list[k].rolling))?;
        tables.insert("contacts".to_owned(), contacts);

        let curves = |of: &dyn Fn(&super::driver::State) -> Vec<[f64; 2]>, names: [(&str, &str); 2]| {
            let mut rows = [Vec::new(), Vec::new(), Vec::new()];
            for (state, recorded) in self.states.iter().enumerate() {
                for point in of(recorded) {
                    rows[0].push(state as f64);
                    rows[1].push(point[0]);
                    rows[2].push(point[1]);
                }
            }
            let mut table = Table::new();
            table.push("state", "1", &rows[0])?;
            table.push(names[0].0, names[0].1, &rows[1])?;
            table.push(names[1].0, names[1].1, &rows[2])?;
            Ok::<Table, record::TableError>(table)
        };
        let scattering = curves(&|state| state.scattering.clone(), [("k", "1/a"), ("intensity", "a2")])?;
        tables.insert("scattering".to_owned(), scattering);
        let forces = curves(&|state| state.histogram.clone(), [("normal_force", "F0"), ("density", "1/F0")])?;
        tables.insert("normal_forces".to_owned(), forces);
        Ok(Packing(tables))
    }
}
