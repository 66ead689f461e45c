//! A consistent picture of the state at one instant, free of the memory layout.

/// The state at time t_n, particles in their original numbering. Velocities are those at t_n itself (not at the
/// half step), forces those at the positions and velocities of t_n.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    /// Steps done, n.
    pub step: u64,
    /// Time [τ].
    pub time: f64,
    /// Radius of each particle [d].
    pub radii: Vec<f64>,
    /// Centres [d].
    pub positions: Vec<[f64; 3]>,
    /// Velocities [d/τ].
    pub velocities: Vec<[f64; 3]>,
    /// Angular velocities [1/τ].
    pub spins: Vec<[f64; 3]>,
    /// Total contact force on each particle, viscous part included [k_n d].
    pub forces: Vec<[f64; 3]>,
    /// Total contact torque on each particle [k_n d²].
    pub torques: Vec<[f64; 3]>,
    /// Interacting pairs (overlap > 0, or within the range of the attraction), sorted by (i, j), i < j.
    pub contacts: Vec<PairContact>,
    /// Particles in contact with walls, sorted by (particle, wall).
    pub wall_contacts: Vec<WallContact>,
    /// The walls: x low, x high, y low, y high, z low, z high; empty without walls.
    pub walls: Vec<WallView>,
    /// Energies of this instant.
    pub energies: Energies,
}

/// One interacting pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairContact {
    /// First particle.
    pub i: usize,
    /// Second particle, i < j.
    pub j: usize,
    /// Unit vector from i to j.
    pub normal: [f64; 3],
    /// ov = −δ_n [d]; negative for a distant attraction.
    pub overlap: f64,
    /// k_n ov, the elastic repulsion, ≥ 0 [k_n d].
    pub elastic: f64,
    /// k_n ov − f_c, elastic part and attraction, positive in compression [k_n d].
    pub normal_force: f64,
    /// The viscous part of the normal force, positive when it pushes apart [k_n d].
    pub viscous: f64,
    /// Tangential force on i [k_n d].
    pub tangential: [f64; 3],
    /// Whether the tangential force is at its Coulomb bound.
    pub sliding: bool,
}

/// One particle touching one wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallContact {
    /// Particle.
    pub particle: usize,
    /// Wall: 2·axis for the low wall, 2·axis + 1 for the high one.
    pub wall: usize,
    /// ov = −δ_n [d].
    pub overlap: f64,
    /// k_n ov [k_n d].
    pub elastic: f64,
    /// k_n ov − f_c,wall, positive in compression [k_n d].
    pub normal_force: f64,
    /// The viscous part of the normal force [k_n d].
    pub viscous: f64,
    /// Tangential force on the particle [k_n d].
    pub tangential: [f64; 3],
    /// Whether the tangential force is at its Coulomb bound.
    pub sliding: bool,
}

/// One wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallView {
    /// Axis of its normal: 0, 1, 2.
    pub axis: usize,
    /// Position of its inner face along the axis [d].
    pub position: f64,
    /// Velocity along the axis at t_n [d/τ].
    pub velocity: f64,
    /// Total normal contact force of the particles on the wall, positive when they push it outwards [k_n d].
    pub force: f64,
    /// p S, the load that pushes it inwards [k_n d].
    pub load: f64,
    /// Whether it moves.
    pub moving: bool,
}

/// Energies at one instant [k_n d²].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Σ m v²/2 over particles.
    pub translation: f64,
    /// Σ I ω²/2 over particles.
    pub rotation: f64,
    /// Σ k_n ov²/2, walls included.
    pub elastic_normal: f64,
    /// Σ f_t²/2k_t, walls included.
    pub elastic_tangential: f64,
    /// Σ −f_c ov, walls included: the potential of the constant adhesion (zero when the contact opens).
    pub adhesion: f64,
    /// Σ m_w v_w²/2 over walls.
    pub walls: f64,
    /// p V, the potential of the load.
    pub load: f64,
}

impl Energies {
    /// KE of the stop criterion: particles, translation and spin, walls left out.
    #[must_use]
    pub fn kinetic(&self) -> f64 {
        self.translation + self.rotation
    }

    /// E_el of the stop criterion: Σ k_n ov²/2 + f_t²/2k_t, walls included.
    #[must_use]
    pub fn elastic(&self) -> f64 {
        self.elastic_normal + self.elastic_tangential
    }

    /// Everything that a frictionless, undamped run conserves. With all six walls moving p V is the potential of
    /// the load up to the coupling of the wall motions: force p S on each wall is exactly −∂(p V)/∂position.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic() + self.elastic() + self.adhesion + self.walls + self.load
    }
}
