//! The constitutive law at a point: all branches, objectivity, exact tangent.

use sim_core::mpm::constitutive::{Hardening, Increment, Kinematics, Material, advance, increment};
use sim_core::mpm::plane::{Mat2, Stress};
use sim_core::mpm::real::{Dual, Real};

use super::reference::{material, printed, rows};

#[derive(Clone, Copy)]
struct Point {
    stress: Stress,
    plastic: f64,
}

const VIRGIN: Point = Point { stress: Stress::ZERO, plastic: 0.0 };

impl Point {
    fn strained(self, material: &Material, xx: f64, yy: f64, xy: f64) -> Self {
        self.moved(material, &Increment { xx, yy, xy, cos: 1.0, sin: 0.0 })
    }

    fn moved(self, material: &Material, step: &Increment) -> Self {
        let update = advance(material, self.stress, self.plastic, step);
        let next = Self { stress: update.stress, plastic: self.plastic + update.plastic };
        if let (Some(Hardening { yield_stress, modulus }), true) = (material.plasticity, update.plastic > 0.0)
        {
            let residual = next.stress.von_mises() - yield_stress - modulus * next.plastic;
            assert!(residual.abs() < 1e-12 * yield_stress, "yield residual {residual}");
        }
        next
    }
}

fn check(case: &str, quantity: &str, tolerance: impl Fn(f64) -> f64, value: impl Fn(&Material, f64) -> f64) {
    for row in rows(case, quantity) {
        let found = value(&material(&row.hardening), row.x);
        let error = (found - row.y).abs();
        assert!(
            error <= tolerance(row.y),
            "{case} {quantity}, H = {}, x = {}: {found}, reference {}",
            row.hardening,
            row.x,
            row.y
        );
    }
}

#[test]
fn uniaxial_strain_is_exact() {
    let at = |m: &Material, x: f64| (0..20).fold(VIRGIN, |p, _| p.strained(m, 0.0, -x / 20.0, 0.0));
    check("mp_uniaxial_strain", "minus_sigma_yy_MPa", printed, |m, x| -at(m, x).stress.yy);
    check("mp_uniaxial_strain", "minus_sigma_xx_MPa", printed, |m, x| -at(m, x).stress.xx);
    check("mp_uniaxial_strain", "eps_p_eq", printed, |m, x| at(m, x).plastic);
}

#[test]
fn simple_shear_without_spin_is_exact() {
    let at = |m: &Material, x: f64| (0..20).fold(VIRGIN, |p, _| p.strained(m, 0.0, 0.0, x / 40.0));
    check("mp_simple_shear_norot", "sigma_xy_MPa", printed, |m, x| at(m, x).stress.xy);
    check("mp_simple_shear_norot", "eps_p_eq", printed, |m, x| at(m, x).plastic);
}

#[test]
fn simple_shear_with_the_jaumann_rate() {
    let in_steps_of = |size: f64, m: &Material, x: f64| {
        let steps = (x / size).round() as usize;
        let f = Mat2 { xx: 1.0, xy: x / steps as f64, yx: 0.0, yy: 1.0 };
        let step = increment(f, Kinematics::Jaumann);
        (0..steps).fold(VIRGIN, |p, _| p.moved(m, &step))
    };
    // the return map is first order in the step: 0.1 % of shear per step, 0.1 % of the yield stress
    let at = |m: &Material, x: f64| in_steps_of(1e-3, m, x);
    let first_order = |y: f64| 1e-3 * y.abs().max(0.4);
    check("mp_simple_shear_jaumann", "sigma_xy_MPa", first_order, |m, x| at(m, x).stress.xy);
    check("mp_simple_shear_jaumann", "sigma_xx_MPa", first_order, |m, x| at(m, x).stress.xx);
    check("mp_simple_shear_jaumann", "eps_p_eq", |y| 1e-3 * y.max(0.1), |m, x| at(m, x).plastic);
    let (elastic, gamma) = (material("el"), 1.0_f64);
    // the elastic predictor is second order: 1e-4 already at 1 % per step
    let coarse = in_steps_of(0.01, &elastic, gamma).stress;
    assert!((coarse.xy / elastic.shear() - gamma.sin()).abs() < 1e-4);
    assert!((coarse.xx / elastic.shear() - (1.0 - gamma.cos())).abs() < 1e-4);
}

/// Lateral strain that keeps σ_xx = 0, by the secant method on the update itself.
fn free_sided(m: &Material, p: Point, yy: f64) -> (Point, f64) {
    let (mut a, mut b) = (0.0, -yy);
    let mut fa = p.strained(m, a, yy, 0.0).stress.xx;
    for _ in 0..60 {
        let next = p.strained(m, b, yy, 0.0);
        let fb = next.stress.xx;
        if fb.abs() < 1e-14 || fb == fa {
            break;
        }
        (a, b, fa) = (b, b - fb * (b - a) / (fb - fa), fb);
    }
    (p.strained(m, b, yy, 0.0), b)
}

#[test]
fn plane_strain_with_free_sides() {
    let at = |m: &Material, x: f64| {
        (0..200).fold((VIRGIN, 0.0), |(p, xx), _| {
            let (next, lateral) = free_sided(m, p, -x / 200.0);
            (next, xx + lateral)
        })
    };
    let within = |y: f64| 1e-3 * y.abs() + 1e-9;
    let case = "mp_plane_strain_free";
    check(case, "minus_sigma_yy_MPa", within, |m, x| -at(m, x).0.stress.yy);
    check(case, "minus_sigma_zz_MPa", within, |m, x| -at(m, x).0.stress.zz);
    check(case, "eps_p_eq", within, |m, x| at(m, x).0.plastic);
    check(case, "eps_xx", within, |m, x| at(m, x).1);
}

#[test]
fn a_corner_in_the_strain_path() {
    let at = |m: &Material, substeps: u32, time: f64| {
        let share = 1.0 / f64::from(substeps);
        let first = f64::from(substeps) * time.min(1.0);
        let second = f64::from(substeps) * (time - 1.0).max(0.0);
        let after = (0..first.round() as u32).fold(VIRGIN, |p, _| p.strained(m, 0.0, 0.0, 0.06 * share));
        (0..second.round() as u32).fold(after, |p, _| p.strained(m, 0.08 * share, -0.1 * share, 0.0))
    };
    let case = "mp_nonproportional";
    // the return map is first order past the corner: 1 % of the yield stress with 100 substeps, 0.05 % with 2000
    for (substeps, bound) in [(100, 1e-2), (2000, 5e-4)] {
        let within = |y: f64| bound * y.abs().max(0.4);
        check(case, "sigma_xx_MPa", within, |m, x| at(m, substeps, x).stress.xx);
        check(case, "sigma_yy_MPa", within, |m, x| at(m, substeps, x).stress.yy);
        check(case, "sigma_zz_MPa", within, |m, x| at(m, substeps, x).stress.zz);
        check(case, "sigma_xy_MPa", within, |m, x| at(m, substeps, x).stress.xy);
        check(case, "eps_p_eq", |y| bound * y, |m, x| at(m, substeps, x).plastic);
    }
}

#[test]
fn a_quarter_turn_leaves_the_stress_invariants_alone() {
    let m = material("1");
    let stressed = VIRGIN.strained(&m, 0.03, -0.05, 0.02);
    let (sin, cos) = (std::f64::consts::FRAC_PI_2 / 100.0).sin_cos();
    let f = Mat2 { xx: cos, xy: sin, yx: -sin, yy: cos };
    let turned = (0..100).fold(stressed, |p, _| p.moved(&m, &increment(f, Kinematics::Jaumann)));
    assert!((turned.stress.von_mises() / stressed.stress.von_mises() - 1.0).abs() < 1e-12);
    assert!((turned.stress.xx - stressed.stress.yy).abs() < 1e-12);
    assert!((turned.stress.xy + stressed.stress.xy).abs() < 1e-12);
    // taken literally, "infinitesimal strain" invents dθ²/2 of strain per step and does not turn the stress
    let literal = increment(f, Kinematics::Infinitesimal);
    assert!((literal.xx + (std::f64::consts::FRAC_PI_2 / 100.0).powi(2) / 2.0).abs() < 1e-8);
}

fn dual(f: Mat2) -> Mat2<Dual> {
    Mat2 {
        xx: Dual::variable(f.xx, 0),
        xy: Dual::variable(f.xy, 1),
        yx: Dual::variable(f.yx, 2),
        yy: Dual::variable(f.yy, 3),
    }
}

#[test]
fn the_tangent_is_the_derivative_on_every_branch() {
    let base = VIRGIN.strained(&material("1"), 0.03, -0.05, 0.02);
    let gradients = [
        Mat2 { xx: 1.0005, xy: 0.0002, yx: -0.0001, yy: 0.9996 },
        Mat2 { xx: 1.03, xy: 0.02, yx: -0.05, yy: 0.96 },
        Mat2 { xx: 0.98, xy: 0.1, yx: 0.02, yy: 1.05 },
    ];
    let (mut elastic, mut plastic) = (0, 0);
    for hardening in ["el", "0", "1", "3"] {
        let m = material(hardening);
        for (f, p) in gradients.iter().flat_map(|&f| [(f, VIRGIN), (f, base)]) {
            for kinematics in [Kinematics::Jaumann, Kinematics::Infinitesimal] {
                let plastic_strain = Dual::constant(p.plastic);
                let step = increment(dual(f), kinematics);
                let exact = advance(&m, p.stress.lift(), plastic_strain, &step);
                if exact.plastic.re > 0.0 {
                    plastic += 1
                } else {
                    elastic += 1
                }
                let eps = 1e-6;
                for k in 0..4 {
                    let shifted = |sign: f64| {
                        let mut g = f;
                        *[&mut g.xx, &mut g.xy, &mut g.yx, &mut g.yy][k] += sign * eps;
                        advance(&m, p.stress, p.plastic, &increment(g, kinematics)).stress
                    };
                    let (up, down) = (shifted(1.0), shifted(-1.0));
                    let pairs = [
                        (exact.stress.xx, up.xx - down.xx),
                        (exact.stress.yy, up.yy - down.yy),
                        (exact.stress.zz, up.zz - down.zz),
                        (exact.stress.xy, up.xy - down.xy),
                    ];
                    for (value, difference) in pairs {
                        let error = (value.d[k] - difference / (2.0 * eps)).abs();
                        assert!(error < 1e-6 * m.young, "H = {hardening}, {f:?}, d/df{k}: {error}");
                    }
                }
            }
        }
    }
    assert!(elastic > 10 && plastic > 10, "both branches are visited: {elastic}, {plastic}");
}

/// C = K 1⊗1 + 2G β I_dev − 2G γ n⊗n with β = 1 − 3GΔγ/q, γ = 1/(1 + H/3G) − (1 − β) (Simo & Hughes).
#[test]
fn the_tangent_is_that_of_simo_and_hughes() {
    let m = material("3");
    let strain = [0.03, -0.05, 0.02];
    let variable = |k: usize| Dual::variable(strain[k], k);
    let step = Increment {
        xx: variable(0),
        yy: variable(1),
        xy: variable(2),
        cos: Dual::constant(1.0),
        sin: Dual::constant(0.0),
    };
    let update = advance(&m, Stress::ZERO.lift(), Dual::constant(0.0), &step);
    let elastic = Material { plasticity: None, ..m };
    let trial = VIRGIN.strained(&elastic, strain[0], strain[1], strain[2]).stress;
    let (mean, q) = (trial.mean(), trial.von_mises());
    let norm = q * (2.0_f64 / 3.0).sqrt();
    let n = [(trial.xx - mean) / norm, (trial.yy - mean) / norm, trial.xy / norm];
    let g = m.shear();
    let bulk = m.lame() + 2.0 * g / 3.0;
    let beta = 1.0 - 3.0 * g * update.plastic.re / q;
    let gamma = 1.0 / (1.0 + 3.0 / (3.0 * g)) - (1.0 - beta);
    for (i, sigma) in [update.stress.xx, update.stress.yy, update.stress.xy].iter().enumerate() {
        for j in 0..3 {
            let both_normal = if i < 2 && j < 2 { 1.0 } else { 0.0 };
            let unit = if i == j { 1.0 } else { 0.0 };
            let twice = if j == 2 { 2.0 } else { 1.0 };
            let deviatoric = if i == 2 || j == 2 { unit } else { unit - both_normal / 3.0 };
            let expected =
                bulk * both_normal + 2.0 * g * beta * deviatoric - 2.0 * g * gamma * n[i] * n[j] * twice;
            assert!((sigma.d[j] - expected).abs() < 1e-10, "{i}{j}: {} {expected}", sigma.d[j]);
        }
    }
}

#[test]
fn the_tangent_modulus_reading_gives_a_slope_of_h() {
    let hardening = Hardening::from_tangent(0.4, 10.0, 1.0);
    assert!((10.0 * hardening.modulus / (10.0 + hardening.modulus) - 1.0).abs() < 1e-14);
}
