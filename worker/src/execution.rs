//! What belongs to one execution alone, beside the physics' result.

use std::time::Duration;

use record::Row;

/// Version of this code, as results carry it.
pub const CODE_VERSION: &str = env!("CARGO_PKG_VERSION");

/// One execution.
#[derive(Clone, Debug)]
pub struct Execution {
    /// Name of the compiled kernel.
    pub kernel: String,
    /// Version of the physics.
    pub physics_version: u32,
    /// Machine.
    pub host: String,
    /// Hardware class.
    pub hardware: String,
    /// Threads inside the scene.
    pub threads: usize,
    /// Particles.
    pub particles: u64,
    /// Steps done by this attempt.
    pub steps: u64,
    /// Wall time of this attempt spent computing.
    pub wall: Duration,
    /// Wall time of earlier attempts whose state this one went on from [s].
    pub earlier_wall_s: f64,
    /// Steps at which this attempt took over; 0: from the beginning.
    pub resumed_at: u64,
}

impl Execution {
    /// The columns: `wall_s`, `ns_per_particle_step`, `kernel`, `host`, … .
    #[must_use]
    pub fn row(&self) -> Row {
        let mut row = Row::new();
        let wall = self.wall.as_secs_f64();
        #[expect(clippy::cast_precision_loss, reason = "a rate; counts stay far below 2^53")]
        let work = self.steps as f64 * self.particles as f64;
        let count = |value: u64| i64::try_from(value).unwrap_or(i64::MAX);
        row.put("kernel", self.kernel.as_str())
            .put("code_version", CODE_VERSION)
            .put("physics_version", i64::from(self.physics_version))
            .put("host", self.host.as_str())
            .put("hardware", self.hardware.as_str())
            .put("threads", i64::try_from(self.threads).unwrap_or(i64::MAX))
            .put("resumed", self.resumed_at > 0)
            .put("resumed_at_step", count(self.resumed_at));
        // a duration is finite, and so is a quotient with a positive divisor
        let total = row.number("wall_s", self.earlier_wall_s + wall).map(|_| ());
        let rate = if work > 0.0 {
            row.number("ns_per_particle_step", wall * 1e9 / work).map(|_| ())
        } else {
            Ok(())
        };
        debug_assert!(total.is_ok() && rate.is_ok());
        row
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resumed_run_tells_the_whole_wall_time_and_its_own_rate() {
        let row = Execution {
            kernel: "k".to_owned(),
            physics_version: 1,
            host: "h".to_owned(),
            hardware: "x".to_owned(),
            threads: 1,
            particles: 1000,
            steps: 500,
            wall: Duration::from_millis(50),
            earlier_wall_s: 1.0,
            resumed_at: 200,
        }
        .row();
        assert_eq!(row.real("wall_s"), Some(1.05));
        assert!((row.real("ns_per_particle_step").unwrap() - 100.0).abs() < 1e-9);
        assert_eq!(row.get("resumed"), Some(&record::Cell::Flag(true)));
    }
}
