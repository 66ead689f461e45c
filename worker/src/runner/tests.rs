use std::sync::atomic::Ordering;

use protocol::FailureKind;
use scene::spheres::{Approach, DampingMass, ReducedSpheres, Stop};

use super::*;
use crate::fake::{Counting, Trap};

fn scene() -> Reduced {
    Reduced::CohesiveSpheres(ReducedSpheres {
        n: 10,
        seed: 3,
        pressure: 1e-5,
        adhesion: 1e-3,
        alpha_n: 0.25,
        mu: 0.4,
        kt_over_kn: 2.0 / 7.0,
        wall_mass: 96.0,
        ei: 1.7,
        mu_wall: 0.0,
        wall_adhesion: 0.0,
        moving_walls: 6,
        agitation_speed: 1e-4,
        damping_mass: DampingMass::Effective,
        clamp_viscous: false,
        dt: None,
        max_steps: None,
        stop: Stop::Steps,
        approach: Approach::Natural,
        precision: scene::Precision::Double,
    })
}

fn task(starts: Vec<Bytes>) -> Task {
    let scene = scene();
    let key = scene.key();
    Task { scene, key, options: Options::default(), starts, checkpoint_every: None }
}

fn run_through(engine: &Counting, task: &Task) -> (End, Vec<Sealed>) {
    let mut made = Vec::new();
    let end = run(engine, task, &Control::new(), &mut |sealed| made.push(sealed));
    (end, made)
}

fn record_of(end: End) -> Row {
    match end {
        End::Finished { outcome, .. } => outcome.record,
        other => panic!("not finished: {other:?}"),
    }
}

fn sealed_at(engine: &Counting, task: &Task, steps: u64) -> Sealed {
    let mut simulation = engine.compile(&task.scene, &task.options).unwrap();
    let progress = simulation.advance(steps).unwrap();
    let run = Run { simulation, progress, wall: Duration::ZERO, earlier_wall_s: 0.25, resumed_at: 0 };
    run.save(task).unwrap()
}

#[test]
fn a_resumed_run_ends_like_one_that_was_never_stopped() {
    let engine = Counting::to(1000);
    let whole = record_of(run_through(&engine, &task(Vec::new())).0);
    let middle = sealed_at(&engine, &task(Vec::new()), 421).bytes;
    let compiled = engine.compiled.load(Ordering::SeqCst);
    let (end, _) = run_through(&engine, &task(vec![middle]));
    let End::Finished { outcome, execution } = end else { panic!("{end:?}") };
    assert_eq!(outcome.record, whole);
    assert_eq!(execution.real("resumed_at_step"), Some(421.0));
    assert!(execution.real("wall_s").unwrap() >= 0.25, "earlier attempts count");
    assert_eq!(engine.compiled.load(Ordering::SeqCst), compiled, "went on from the checkpoint");
}

#[test]
fn damaged_checkpoints_are_skipped_down_to_the_beginning() {
    let engine = Counting::to(1000);
    let whole = record_of(run_through(&engine, &task(Vec::new())).0);
    let good = sealed_at(&engine, &task(Vec::new()), 10).bytes;
    let mut torn = good.to_vec();
    torn.pop();
    let label = Label { scene_key: scene().key(), steps: 9, wall_s: 0.0 };
    let nonsense = Sealed::new(label.clone(), b"too short").unwrap().bytes;
    let panics = Sealed::new(label, &[0xff; 16]).unwrap().bytes;

    let (end, _) = run_through(&engine, &task(vec![torn.clone().into(), nonsense.clone(), panics, good]));
    let End::Finished { outcome, execution } = end else { panic!("{end:?}") };
    assert_eq!(outcome.record, whole);
    assert_eq!(execution.real("resumed_at_step"), Some(10.0));

    let (end, _) = run_through(&engine, &task(vec![torn.into(), nonsense]));
    let End::Finished { outcome, execution } = end else { panic!("{end:?}") };
    assert_eq!(outcome.record, whole);
    assert_eq!(execution.real("resumed_at_step"), Some(0.0));
}

#[test]
fn checkpoints_come_on_time_and_can_be_used() {
    let engine = Counting { per_step: Duration::from_micros(200), ..Counting::to(2000) };
    let mut often = task(Vec::new());
    often.checkpoint_every = Some(Duration::from_millis(50));
    let (end, made) = run_through(&engine, &often);
    let whole = record_of(end);
    assert!(!made.is_empty());
    assert!(made.windows(2).all(|pair| pair[0].label.steps < pair[1].label.steps));
    let last = made.last().unwrap().bytes.clone();
    assert_eq!(record_of(run_through(&Counting::to(2000), &task(vec![last])).0), whole);
}

#[test]
fn a_job_yields_with_its_state_and_is_dropped_without() {
    let engine = Counting { per_step: Duration::from_micros(100), ..Counting::to(1_000_000) };
    let told = |command| {
        let control = Control::new();
        let task = task(Vec::new());
        std::thread::scope(|scope| {
            let running = scope.spawn(|| run(&engine, &task, &control, &mut |_| {}));
            while control.latest().progress.is_none_or(|progress| progress.steps == 0) {
                std::thread::yield_now();
            }
            control.command(command);
            running.join().unwrap()
        })
    };
    let End::Yielded(Some(sealed)) = told(Command::Yield) else { panic!("did not yield") };
    assert!(sealed.label.steps > 0);
    assert!(matches!(told(Command::Drop), End::Dropped));
}

#[test]
fn what_is_told_before_the_start_starts_nothing() {
    let engine = Counting::to(10);
    let control = Control::new();
    control.command(Command::Yield);
    let end = run(&engine, &task(Vec::new()), &control, &mut |_| {});
    assert!(matches!(end, End::Yielded(None)));
    assert_eq!(engine.compiled.load(Ordering::SeqCst), 0);
}

#[test]
fn failures_are_classified() {
    for (trap, kind, class) in [
        (Trap::Panic(50), FailureKind::Retryable, "panic"),
        (Trap::Unstable(50), FailureKind::Permanent, "unstable"),
        (Trap::Stuck(50), FailureKind::Retryable, "internal"),
    ] {
        let engine = Counting { trap, ..Counting::to(100) };
        let (end, _) = run_through(&engine, &task(Vec::new()));
        let End::Failed(failed) = end else { panic!("{trap:?}: {end:?}") };
        assert_eq!((failed.kind, failed.class), (kind, class));
    }
}
