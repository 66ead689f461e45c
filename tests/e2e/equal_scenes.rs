//! Equal scenes run once, whichever sweep and units they come from.

use serde_json::json;

use crate::lab::Lab;
use crate::scenes;

#[test]
fn two_sweeps_share_their_common_scenes() {
    let lab = Lab::new();
    let _worker = lab.worker("worker");
    let first = lab.submit(&scenes::quick("first", &[1e4, 1e6]));
    lab.wait_until_done(first);
    let second = lab.submit(&scenes::quick("second", &[1e6, 3e7]));
    assert_eq!(lab.sweep(second).reused, 1);
    lab.wait_until_done(second);
    let (first, second) = (lab.jobs(first), lab.jobs(second));
    assert_eq!(first[1], second[0]);
    assert_ne!(first[0], second[1]);
    assert_eq!(lab.job(first[1]).attempts.len(), 1);
}

#[test]
fn equal_groups_in_other_units_are_the_same_run() {
    let lab = Lab::new();
    let _worker = lab.worker("worker");
    let first = lab.submit(&scenes::quick("soft", &[1e6]));
    lab.wait_until_done(first);
    // every stress ten times as large; the agitation is given relative to a fixed pressure
    let mut stiffer = scenes::quick("stiff", &[1e7]);
    stiffer["base"]["p"] = json!(1e6);
    stiffer["base"]["sigma_e"] = json!(1e10);
    stiffer["base"]["agitation"] = json!(10f64.sqrt());
    let second = lab.submit(&stiffer);
    let view = lab.sweep(second);
    assert_eq!((view.state.name(), view.reused), ("done", 1));
    assert_eq!(lab.jobs(first), lab.jobs(second));
}
