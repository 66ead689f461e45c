//! Paths of the code that must not change a bit, and the oracle.

use sim_core::dem::{CellControl, CellDynamics, CellPicture, DiscParameters, discs, restore_discs};
use sim_core::{KernelChoice, Options};

use crate::support::{FAST, TABLE_1, gas, large_gas};

const FREE: CellControl = CellControl::Pressure { pressure: 1e-5, mass: 10.0, cap: 5e-4 };

/// Long enough for several sorts of the particles (8192 steps).
const STEPS: u64 = 20_000;

fn after(dem: &mut dyn CellDynamics, steps: u64) -> (CellPicture, [f64; 2]) {
    dem.run(steps).unwrap();
    (dem.picture(), dem.cell().rate)
}

#[test]
fn scalar_and_vector_paths_give_the_same_bits() {
    for mixed in [false, true] {
        for control in [CellControl::Fixed, FREE] {
            let run = |kernel| {
                let options = Options { threads: 1, kernel };
                let parameters = DiscParameters { mixed, ..TABLE_1 };
                after(discs(&parameters, &gas(control), 0.1, &options).as_mut(), STEPS)
            };
            let plain = run(KernelChoice::Scalar);
            assert_eq!(run(KernelChoice::Auto), plain);
            assert_eq!(run(KernelChoice::Avx2), plain);
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    // Four chunks, with pairs across their borders and across those of the cell.
    for mixed in [false, true] {
        let parameters = DiscParameters { mixed, ..TABLE_1 };
        let initial = large_gas(FREE);
        let run = |threads| {
            let options = Options { threads, kernel: KernelChoice::Auto };
            let mut dem = discs(&parameters, &initial, 0.1, &options);
            let (picture, rate) = after(dem.as_mut(), 900);
            (dem.counters().threads, picture, rate)
        };
        let one = run(1);
        assert!(one.1.contacts.len() > 1000, "{}", one.1.contacts.len());
        for threads in [2, 3] {
            let several = run(threads);
            assert_eq!(several.0, threads as u64);
            assert_eq!((several.1, several.2), (one.1.clone(), one.2));
        }
    }
}

#[test]
fn mixed_precision_starts_as_double_does() {
    // Velocities are rounded in each of 300 steps, at worst all one way: half of 300 times what rounding the first ones does
    // to the same run in double precision.
    let places = |mixed, rounded| {
        let parameters = DiscParameters { mixed, ..TABLE_1 };
        let mut initial = gas(FREE);
        if rounded {
            let single = |x: f64| f64::from(x as f32);
            initial.velocities.iter_mut().flatten().for_each(|v| *v = single(*v));
            initial.spins.iter_mut().for_each(|spin| *spin = single(*spin));
        }
        after(discs(&parameters, &initial, 0.1, &FAST).as_mut(), 300).0.positions
    };
    let double = places(false, false);
    let farthest = |others: Vec<[f64; 2]>| {
        let apart = |(one, other): (&[f64; 2], &[f64; 2])| (one[0] - other[0]).hypot(one[1] - other[1]);
        double.iter().zip(&others).map(apart).fold(0.0, f64::max)
    };
    let (mixed, rounded) = (farthest(places(true, false)), farthest(places(false, true)));
    assert!(mixed > 0.0 && mixed < 150.0 * rounded, "{mixed:e} {rounded:e}");
}

#[test]
fn null_laws_equal_full_laws_without_strength() {
    // Rolling: a stiffness too small to matter. Attraction: a force far below round-off.
    let none = DiscParameters { kr: 0.0, mu_r: 0.0, ..TABLE_1 };
    let weak = DiscParameters { kr: 1e-300, mu_r: 1.0, ..TABLE_1 };
    let run =
        |parameters: &DiscParameters| after(discs(parameters, &gas(FREE), 0.1, &FAST).as_mut(), STEPS).0;
    let (one, other) = (run(&none), run(&weak));
    assert_eq!(one.positions, other.positions);
    assert_eq!(one.spins, other.spins);
    let none = DiscParameters { f0: 0.0, d0: 0.0, ..TABLE_1 };
    let weak = DiscParameters { f0: 1e-300, d0: 1e-3, ..TABLE_1 };
    assert_eq!(run(&none).positions, run(&weak).positions);
}

#[test]
fn a_resumed_system_continues_to_the_same_bits() {
    let mut whole = discs(&TABLE_1, &gas(FREE), 0.1, &FAST);
    whole.set_local_damping(0.3);
    for (stop, mixed) in [(777, false), (9000, true), (16_384, false)] {
        let parameters = DiscParameters { mixed, ..TABLE_1 };
        let mut first = discs(&parameters, &gas(FREE), 0.1, &FAST);
        first.set_local_damping(0.3);
        first.run(stop).unwrap();
        let mut second = restore_discs(&parameters, &gas(FREE).radii, &first.save(), &FAST).unwrap();
        assert_eq!(second.save(), first.save());
        first.run(STEPS - stop).unwrap();
        second.run(STEPS - stop).unwrap();
        assert_eq!(second.save(), first.save(), "stopped at {stop}");
    }
    whole.run(STEPS).unwrap();
    let damaged = &whole.save()[..100];
    assert!(restore_discs(&TABLE_1, &gas(FREE).radii, damaged, &FAST).is_err());
}

#[test]
fn forces_equal_those_of_the_oracle() {
    // Static normal forces of all pairs of nearest images, by the formulas of Table I.
    let mut dem = discs(&TABLE_1, &gas(FREE), 0.1, &FAST);
    for _ in 0..20 {
        dem.run(500).unwrap();
        let picture = dem.picture();
        let mut expected = Vec::new();
        for i in 0..picture.radii.len() {
            for j in i + 1..picture.radii.len() {
                let along = |axis: usize| {
                    let difference = picture.positions[j][axis] - picture.positions[i][axis];
                    difference - picture.edges[axis] * (difference / picture.edges[axis]).round()
                };
                let gap = along(0).hypot(along(1)) - picture.radii[i] - picture.radii[j];
                if gap < 1e-3 {
                    let force = if gap < 0.0 { -gap - 1e-5 } else { -1e-5 * (1.0 - gap / 1e-3) };
                    expected.push((i as u32, j as u32, force));
                }
            }
        }
        let found: Vec<_> = picture.contacts.iter().map(|c| (c.i, c.j, c.normal)).collect();
        assert_eq!(found.len(), expected.len());
        for (one, other) in found.iter().zip(&expected) {
            assert_eq!((one.0, one.1), (other.0, other.1));
            assert!((one.2 - other.2).abs() < 1e-14);
        }
    }
    assert!(dem.picture().contacts.len() > 60);
}

#[test]
fn a_shifted_origin_changes_round_off_only() {
    let run = |shift: [f64; 2]| {
        let mut initial = gas(FREE);
        for position in &mut initial.positions {
            for axis in 0..2 {
                position[axis] = (position[axis] + shift[axis]) % initial.edges[axis];
            }
        }
        after(discs(&TABLE_1, &initial, 0.1, &FAST).as_mut(), 300).0
    };
    let (here, there) = (run([0.0; 2]), run([5.3, 1.9]));
    assert!((here.edges[0] - there.edges[0]).abs() < 1e-12);
    for (one, other) in here.velocities.iter().zip(&there.velocities) {
        assert!((one[0] - other[0]).abs() < 1e-12 && (one[1] - other[1]).abs() < 1e-12);
    }
}
