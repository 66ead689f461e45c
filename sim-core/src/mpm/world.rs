//! Bodies, walls and what happens between them.

use super::body::Body;
use super::contact::{ContactKind, Key, Wall};
use super::element::Law;
use super::explicit::{DAMPING, Memory};
use super::observe::network::Impulses;

/// Numerical choices of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numerics {
    /// Time integration parameter θ of the implicit step, ½ … 1; 1 is backward Euler.
    pub theta: f64,
    /// Relative force residual at which Newton's iteration stops.
    pub residual: f64,
    /// Overlap or gap under load that is accepted, in cells.
    pub gap: f64,
    /// Most Newton iterations before the step is halved.
    pub iterations: usize,
    /// Most halvings of a step.
    pub halvings: u32,
    /// Relative change of impulses at which a contact sweep stops.
    pub impulse: f64,
    /// Most contact sweeps per Newton iteration.
    pub sweeps: usize,
    /// Relative change of impulses at which the contact sweeps of an explicit step stop.
    pub explicit_impulse: f64,
    /// Most contact sweeps of an explicit step.
    pub explicit_sweeps: usize,
}

impl Default for Numerics {
    fn default() -> Self {
        Self {
            theta: 1.0,
            residual: 1e-4,
            gap: 1e-3,
            iterations: 20,
            halvings: 8,
            impulse: 1e-5,
            sweeps: 500,
            explicit_impulse: 1e-3,
            explicit_sweeps: 20,
        }
    }
}

/// Energies per unit thickness, accumulated from the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Energies {
    /// Work of walls and body forces.
    pub work: f64,
    /// Plastic dissipation Σ V q Δε_p.
    pub plastic: f64,
    /// Work done against friction.
    pub friction: f64,
    /// Kinetic energy taken by the damping of the explicit step.
    pub damping: f64,
    /// Work of the stresses, Σ ½ (fⁿ + fⁿ⁺¹)·Δu: elastic energy and plastic dissipation, and what a hypoelastic law
    /// does not give back.
    pub internal: f64,
    /// What the implicit step takes for θ > ½: (θ − ½)(Δv·M Δv + Δf·Δu), and what is lost between two grids of an
    /// updated Lagrangian body.
    pub numerical: f64,
    /// What is lost as contacts close: they do not bounce.
    pub contact: f64,
}

/// Effort since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Effort {
    /// Steps taken, halved ones counted as they are.
    pub substeps: u64,
    /// Newton iterations.
    pub newton: u64,
    /// Contact sweeps.
    pub sweeps: u64,
    /// Steps that had to be halved.
    pub halved: u64,
}

/// Everything that moves.
#[derive(Clone, Debug)]
pub struct World {
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The walls.
    pub walls: Vec<Wall>,
    /// What the material points obey.
    pub law: Law,
    /// Between what contact acts.
    pub contact: ContactKind,
    /// Coulomb coefficient μ of every contact.
    pub friction: f64,
    /// Acceleration of every body [length/time²].
    pub acceleration: [f64; 2],
    /// Decay rate of the motion that is not rigid in the explicit step [c_S/size].
    pub damping: f64,
    /// Numerical choices.
    pub numerics: Numerics,
    /// Contacts of the explicit step.
    pub memory: Memory,
    /// Normal impulses between bodies and with walls since they were last taken out.
    pub network: Impulses,
    /// Impulses of the last step (normal, tangential), sorted by key, and the step they belong to.
    pub impulses: Vec<(Key, [f64; 2])>,
    /// Normals of the same contacts.
    pub normals: Vec<[f64; 2]>,
    /// Length of the last step.
    pub last_dt: f64,
    /// Impulse received by each wall since the start, along its normal (pushing on it is positive).
    pub wall_impulse: Vec<f64>,
    /// Energies.
    pub energies: Energies,
    /// Effort.
    pub effort: Effort,
    /// Time since the start.
    pub time: f64,
}

impl World {
    /// A world at rest.
    #[must_use]
    pub fn new(bodies: Vec<Body>, walls: Vec<Wall>, law: Law) -> Self {
        let wall_impulse = vec![0.0; walls.len()];
        Self {
            bodies,
            walls,
            law,
            contact: ContactKind::default(),
            friction: 0.0,
            acceleration: [0.0; 2],
            damping: DAMPING,
            numerics: Numerics::default(),
            memory: Memory::default(),
            network: Impulses::new(),
            impulses: Vec::new(),
            normals: Vec::new(),
            last_dt: 0.0,
            wall_impulse,
            energies: Energies::default(),
            effort: Effort::default(),
            time: 0.0,
        }
    }

    /// Elastic energy Σ V σ:C⁻¹:σ/2.
    #[must_use]
    pub fn elastic_energy(&self) -> f64 {
        let m = &self.law.material;
        let of = |body: &Body| -> f64 {
            let density = body.points.stress.iter().map(|s| {
                let trace = s.xx + s.yy + s.zz;
                let square = s.xx * s.xx + s.yy * s.yy + s.zz * s.zz + 2.0 * s.xy * s.xy;
                ((1.0 + m.poisson) * square - m.poisson * trace * trace) / (2.0 * m.young)
            });
            density.zip(body.volumes()).map(|(density, volume)| density * volume).sum()
        };
        self.bodies.iter().map(of).sum()
    }

    /// Kinetic energy.
    #[must_use]
    pub fn kinetic_energy(&self) -> f64 {
        self.bodies.iter().map(Body::kinetic_energy).sum()
    }

    /// Work that is found nowhere: what went in, less what is kept and what was dissipated by the law, friction,
    /// contacts and the integrator. A hypoelastic law loses or gains a little (1 % in a disc compressed by 17 %); the
    /// rest is the tolerance of the solver.
    #[must_use]
    pub fn energy_gap(&self) -> f64 {
        let Energies { work, plastic, friction, damping, numerical, contact, internal: _ } = self.energies;
        work - self.elastic_energy()
            - self.kinetic_energy()
            - plastic
            - friction
            - damping
            - numerical
            - contact
    }

    /// Linear momentum.
    #[must_use]
    pub fn momentum(&self) -> [f64; 2] {
        self.bodies.iter().map(Body::momentum).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
    }

    /// Force on a wall along its normal in the last step.
    #[must_use]
    pub fn wall_force(&self, wall: usize) -> f64 {
        let on = super::contact::Partner::Wall(wall as u32);
        let sum: f64 =
            self.impulses.iter().filter(|(key, _)| key.partner == on).map(|(_, impulse)| impulse[0]).sum();
        if self.last_dt > 0.0 { sum / self.last_dt } else { 0.0 }
    }
}
