//! trial
use super::scenes::{law, level, upright};
use sim_core::mpm::body::Body;
use sim_core::mpm::implicit::Implicit;
use sim_core::mpm::packing::{diameters, pack};
use sim_core::mpm::template::disc;
use sim_core::mpm::world::World;
use std::sync::Arc;

#[test]
#[ignore]
fn trial() {
    let get = |k: &str, d: f64| std::env::var(k).map_or(d, |v| v.parse::<f64>().unwrap());
    let n = get("N", 300.0) as usize;
    let (c, dt, phi0) = (get("ACROSS", 12.0) as usize, get("DT", 0.02), get("PHI", 0.75));
    let law = law(&std::env::var("H").unwrap_or("1".into()));
    let t0 = std::time::Instant::now();
    let p = pack(diameters(n, 2.0, 4.0).iter().map(|d| d / 2.0).collect(), phi0, 1).unwrap();
    println!("packed {:.2}s side {}", t0.elapsed().as_secs_f64(), p.width);
    let t = Arc::new(disc(c));
    let bodies =
        p.radii.iter().zip(&p.centres).map(|(&r, &x)| Body::new(t.clone(), r, x, &law.material)).collect();
    let walls =
        vec![level(0.0, 1.0, 0.0), level(p.height, -1.0, -2.0), upright(0.0, 1.0), upright(p.width, -1.0)];
    let mut world = World::new(bodies, walls, law);
    let mut solver = Implicit::new(&world);
    let t0 = std::time::Instant::now();
    let limit = get("LIMIT", 60.0);
    let mut last = world.effort;
    let mut step = 0;
    loop {
        step += 1;
        if let Err(e) = solver.step(&mut world, dt) {
            println!("step {step}: {e}");
            break;
        }
        let area: f64 = world.bodies.iter().map(|b| b.volumes().sum::<f64>()).sum();
        let phi = area / (world.walls[1].point[1] * p.width);
        if step % 10 == 0 {
            let e = world.effort;
            println!(
                "{step} t {:.2} phi {phi:.4} bottom {:.4} top {:.4} rows {} newton/step {:.1} sweeps/newton {:.0} halved {} ke {:.2e} el {:.2e} pl {:.2e} w {:.2e} {:.1}s",
                world.time,
                world.wall_force(0) / p.width,
                world.wall_force(1) / p.width,
                world.impulses.len(),
                (e.newton - last.newton) as f64 / 10.0,
                (e.sweeps - last.sweeps) as f64 / (e.newton - last.newton).max(1) as f64,
                e.halved,
                world.kinetic_energy(),
                world.elastic_energy(),
                world.energies.plastic,
                world.energies.work,
                t0.elapsed().as_secs_f64()
            );
            last = e;
        }
        if phi > 0.97 || t0.elapsed().as_secs_f64() > limit {
            break;
        }
    }
}
