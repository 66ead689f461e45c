//! A deformable body: its discretisation, nodal motion and material state.

use std::sync::Arc;

use super::constitutive::Material;
use super::plane::{Mat2, Stress};
use super::template::Template;
use super::updated::Cloud;

/// State of the material points.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// Deformation gradient F.
    pub gradient: Vec<Mat2>,
    /// Cauchy stress.
    pub stress: Vec<Stress>,
    /// Equivalent plastic strain ε_p.
    pub plastic: Vec<f64>,
}

impl Points {
    /// Undeformed, unstressed.
    #[must_use]
    pub fn virgin(count: usize) -> Self {
        Self {
            gradient: vec![Mat2::identity(); count],
            stress: vec![Stress::ZERO; count],
            plastic: vec![0.0; count],
        }
    }
}

/// One body. Unknown 2a + i is component i of node a.
#[derive(Clone, Debug)]
pub struct Body {
    /// Discretisation at unit size.
    pub template: Arc<Template>,
    /// Size of the body: its radius for a disc.
    pub size: f64,
    /// Reference position of the template's origin.
    pub origin: [f64; 2],
    /// Nodal displacement from the reference.
    pub displacement: Vec<f64>,
    /// Nodal velocity.
    pub velocity: Vec<f64>,
    /// Material state.
    pub points: Points,
    /// Lumped mass of each node.
    pub mass: Vec<f64>,
    /// Unknowns held at rest (planes of symmetry, clamped ends).
    pub fixed: Vec<u32>,
    /// Undeformed area.
    pub area: f64,
    /// What the points of an updated Lagrangian body carry from grid to grid; its template and nodal values last for one
    /// step. `None`: total Lagrangian.
    pub cloud: Option<Box<Cloud>>,
}

impl Body {
    /// A body at rest.
    #[must_use]
    pub fn new(template: Arc<Template>, size: f64, origin: [f64; 2], material: &Material) -> Self {
        let mass = template.lumped.iter().map(|lumped| lumped * size * size * material.density).collect();
        let unknowns = 2 * template.nodes.len();
        let points = Points::virgin(template.point_count());
        Self {
            area: template.volumes.iter().sum::<f64>() * size * size,
            cloud: None,
            size,
            origin,
            displacement: vec![0.0; unknowns],
            velocity: vec![0.0; unknowns],
            points,
            mass,
            fixed: Vec::new(),
            template,
        }
    }

    /// Holds the body symmetric about the axes through its origin: nodes on an axis do not leave it.
    pub fn hold_symmetric(&mut self) {
        for (node, at) in self.template.nodes.iter().enumerate() {
            for (axis, across) in at.iter().enumerate() {
                if across.abs() < 1e-9 {
                    self.fixed.push((2 * node + axis) as u32);
                }
            }
        }
    }

    /// Reference position of a node.
    #[must_use]
    pub fn reference(&self, node: usize) -> [f64; 2] {
        let at = self.template.nodes[node];
        [self.origin[0] + self.size * at[0], self.origin[1] + self.size * at[1]]
    }

    /// Positions of the outline markers for given nodal displacements.
    pub fn outline_at(&self, displacement: &[f64], out: &mut Vec<[f64; 2]>) {
        out.clear();
        for marker in &self.template.markers {
            let mut at = [0.0; 2];
            for &(place, weight) in &marker.weights {
                let node = self.template.contact_nodes[place as usize] as usize;
                let reference = self.reference(node);
                at[0] += weight * (reference[0] + displacement[2 * node]);
                at[1] += weight * (reference[1] + displacement[2 * node + 1]);
            }
            out.push(at);
        }
    }

    /// Present volume of each point, V_p = J V_p0.
    pub fn volumes(&self) -> impl Iterator<Item = f64> + '_ {
        let scale = self.size * self.size;
        self.points.gradient.iter().zip(&self.template.volumes).map(move |(f, v)| f.det() * v * scale)
    }

    /// Linear momentum.
    #[must_use]
    pub fn momentum(&self) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (mass, v) in self.mass.iter().zip(self.velocity.as_chunks::<2>().0) {
            sum[0] += mass * v[0];
            sum[1] += mass * v[1];
        }
        sum
    }

    /// Kinetic energy.
    #[must_use]
    pub fn kinetic_energy(&self) -> f64 {
        let nodes = self.mass.iter().zip(self.velocity.as_chunks::<2>().0);
        nodes.map(|(mass, v)| 0.5 * mass * (v[0] * v[0] + v[1] * v[1])).sum()
    }
}
