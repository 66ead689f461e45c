//! Heartbeats, gathered in memory and written together: one fsync for all that came in a second.

use std::collections::HashMap;
use std::sync::Mutex;

use protocol::WorkerId;

use crate::clock::Moment;
use crate::store::Beat;

/// Signs of life not yet written.
#[derive(Debug, Default)]
pub struct Heartbeats(Mutex<Gathered>);

#[derive(Debug, Default)]
struct Gathered {
    beats: HashMap<(i64, u32), Beat>,
    seen: HashMap<WorkerId, Moment>,
}

impl Heartbeats {
    /// Adds a heartbeat; the newest of a lease counts.
    pub fn beat(&self, worker: WorkerId, beat: Beat) {
        let mut gathered = self.lock();
        gathered.seen.insert(worker, beat.at);
        gathered.beats.insert((beat.seq, beat.attempt), beat);
    }

    /// Notes that a worker was heard.
    pub fn seen(&self, worker: WorkerId, at: Moment) {
        self.lock().seen.insert(worker, at);
    }

    /// Takes everything gathered, in the order of the jobs.
    #[must_use]
    pub fn take(&self) -> (Vec<Beat>, Vec<(WorkerId, Moment)>) {
        let gathered = std::mem::take(&mut *self.lock());
        let mut beats: Vec<Beat> = gathered.beats.into_values().collect();
        beats.sort_by_key(|beat| (beat.seq, beat.attempt));
        let mut seen: Vec<(WorkerId, Moment)> = gathered.seen.into_iter().collect();
        seen.sort();
        (beats, seen)
    }

    /// Puts back what could not be written; newer ones stay.
    pub fn put_back(&self, beats: Vec<Beat>, seen: Vec<(WorkerId, Moment)>) {
        let mut gathered = self.lock();
        for beat in beats {
            gathered.beats.entry((beat.seq, beat.attempt)).or_insert(beat);
        }
        for (worker, at) in seen {
            gathered.seen.entry(worker).or_insert(at);
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Gathered> {
        self.0.lock().expect("no holder of this lock panics")
    }
}
