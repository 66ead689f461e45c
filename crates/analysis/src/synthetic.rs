//! Synthetic studies with known parameters for the tests.

use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64;

use crate::master::MasterCurve;
use crate::{Run, plateau};

pub(crate) const E_MIN: f64 = 0.76;

pub(crate) struct Study {
    pub curve: MasterCurve,
    pub noise: f64,
    pub seed: u64,
    pub replicates: u64,
    /// Exponent b of the scaling variable (σc/p)(p/σe)^b.
    pub b: f64,
    /// Exponent q of α_n.
    pub q: f64,
    pub sigma_c: Vec<f64>,
    pub p: Vec<f64>,
    pub sigma_e: Vec<f64>,
    pub alpha_n: Vec<f64>,
}

pub(crate) fn log_range(low: f64, high: f64, n: u32) -> Vec<f64> {
    (0..n).map(|i| low * (high / low).powf(f64::from(i) / f64::from(n - 1))).collect()
}

impl Study {
    /// The paper's 220 points.
    pub fn paper(seed: u64) -> Self {
        Self {
            curve: MasterCurve::PAPER,
            noise: 0.008,
            seed,
            replicates: 1,
            b: 0.5,
            q: 0.0,
            sigma_c: log_range(2e3, 4e8, 11),
            p: vec![1e4, 5e4, 1e5, 1e6],
            sigma_e: log_range(5e8, 2e11, 5),
            alpha_n: vec![0.25],
        }
    }

    /// Runs with e = e_min + e_r (e_max − e_min) + noise; the bonds follow η alone.
    pub fn runs(&self) -> Vec<Run> {
        let mut rng = Pcg64::seed_from_u64(self.seed);
        let normal = Normal::new(0.0, 1.0).unwrap();
        let mut runs = Vec::new();
        for &p in &self.p {
            let e_max = plateau::e_max(p, E_MIN, 1.0, 0.24, 1e4).unwrap();
            for &sigma_e in &self.sigma_e {
                for &sigma_c in &self.sigma_c {
                    for &alpha_n in &self.alpha_n {
                        let scaling =
                            sigma_c / p * (p / sigma_e).powf(self.b) * (alpha_n / 0.25).powf(self.q);
                        let e_r = self.curve.e_r(scaling);
                        for seed in 1..=self.replicates {
                            let eta = sigma_c / p;
                            let tensile = 2.0 * eta / (1.0 + eta) + 0.02 * normal.sample(&mut rng);
                            runs.push(Run {
                                id: format!("{p:e}/{sigma_c:e}/{sigma_e:e}/{alpha_n}/{seed}"),
                                p,
                                sigma_c,
                                sigma_e,
                                alpha_n,
                                mw: 96.0,
                                ei: 1.704,
                                seed,
                                e: E_MIN + e_r * (e_max - E_MIN) + self.noise * normal.sample(&mut rng),
                                z: Some(4.05),
                                z_minus: Some(tensile),
                                z_plus: Some(4.05 - tensile),
                                beta_plus: Some(0.9 * eta / (0.2 + eta) + 0.03 / (0.02 + eta)),
                                beta_plus_se: Some(0.02),
                                beta_minus: Some(0.9 + 0.1 / (0.1 + eta)),
                                beta_minus_se: Some(0.02),
                                status: "equilibrium".to_owned(),
                                out_of_model: sigma_c / sigma_e > 0.05,
                                ..Run::default()
                            });
                        }
                    }
                }
            }
        }
        runs
    }
}
