//! Threads that do one step after another together: who does which chunk, who has done what, and a barrier for
//! meetings that happen several thousand times a second.

use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

/// Rounds of busy waiting before the processor is offered to others.
const SPINS: u32 = 2000;

/// The threads of one system. Nothing here decides about results: chunks are the unit of work and of sums, whoever
/// does them.
pub(super) struct Crew {
    threads: usize,
    arrived: AtomicUsize,
    round: AtomicUsize,
    poisoned: AtomicBool,
    stopped: AtomicBool,
    /// Round of work in which a chunk was last done.
    done: Vec<AtomicU64>,
}

/// Poisons the crew when its thread unwinds, so that the others do not wait for ever.
pub(super) struct PoisonOnPanic<'a>(&'a Crew);

impl Drop for PoisonOnPanic<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.poisoned.store(true, Ordering::Release);
        }
    }
}

impl Crew {
    /// A crew for a system of `chunks`.
    pub(super) fn new(threads: usize, chunks: usize) -> Self {
        Self {
            threads,
            arrived: AtomicUsize::new(0),
            round: AtomicUsize::new(0),
            poisoned: AtomicBool::new(false),
            stopped: AtomicBool::new(false),
            done: (0..chunks).map(|_| AtomicU64::new(0)).collect(),
        }
    }

    /// A crew of one, which never waits.
    pub(super) fn alone() -> Self {
        Self::new(1, 0)
    }

    /// Whether there is one thread only.
    pub(super) fn is_alone(&self) -> bool {
        self.threads == 1
    }

    pub(super) fn poison_on_panic(&self) -> PoisonOnPanic<'_> {
        PoisonOnPanic(self)
    }

    /// Tells all threads to leave after this meeting.
    pub(super) fn stop(&self) {
        self.stopped.store(true, Ordering::Release);
    }

    pub(super) fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Acquire)
    }

    /// The chunks of a thread: always the same ones, so that they stay in the cache of its core; dealt out to and fro, so that
    /// all threads advance through the system together and a chunk seldom waits for those before it. Two threads then have
    /// the two halves of a box whose eight chunks are octants along a Hilbert curve, and few contacts between them.
    pub(super) fn share(&self, thread: usize, chunks: usize) -> impl Iterator<Item = usize> + Clone + use<> {
        let threads = self.threads;
        (0..chunks.div_ceil(threads))
            .map(move |round| round * threads + if round % 2 == 0 { thread } else { threads - 1 - thread })
            .filter(move |&chunk| chunk < chunks)
    }

    /// Says that a chunk is done in this round of work (rounds ascend).
    pub(super) fn report(&self, chunk: usize, round: u64) {
        self.done[chunk].store(round, Ordering::Release);
    }

    /// Waits until `chunks` have been reported in this round.
    pub(super) fn await_chunks(&self, chunks: std::ops::Range<usize>, round: u64) {
        for chunk in chunks {
            self.spin_while(|| self.done[chunk].load(Ordering::Acquire) != round);
        }
    }

    /// All threads wait until the last one has come; that one does `alone` before anybody goes on.
    pub(super) fn meet(&self, alone: impl FnOnce()) {
        let round = self.round.load(Ordering::Acquire);
        if self.arrived.fetch_add(1, Ordering::AcqRel) + 1 == self.threads {
            alone();
            self.arrived.store(0, Ordering::Relaxed);
            self.round.store(round.wrapping_add(1), Ordering::Release);
            return;
        }
        self.spin_while(|| self.round.load(Ordering::Acquire) == round);
    }

    fn spin_while(&self, unready: impl Fn() -> bool) {
        let mut spins = 0;
        while unready() {
            assert!(!self.poisoned.load(Ordering::Acquire), "another thread of this simulation panicked");
            if spins < SPINS {
                spins += 1;
                std::hint::spin_loop();
            } else {
                std::thread::yield_now();
            }
        }
    }
}

/// A pointer that several threads work through, each on its own part.
pub(super) struct Shared<T>(*mut T);

// SAFETY: whoever dereferences it vouches for disjoint parts; the pointee outlives the scope of the threads.
unsafe impl<T> Sync for Shared<T> {}

impl<T> Shared<T> {
    pub(super) fn new(pointer: *mut T) -> Self {
        Self(pointer)
    }

    pub(super) fn get(&self) -> *mut T {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nobody_passes_before_the_last_one_has_come_and_done_its_work() {
        let crew = Crew::new(3, 0);
        let (count, meetings) = (AtomicUsize::new(0), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| {
                    for round in 1..=200 {
                        count.fetch_add(1, Ordering::AcqRel);
                        crew.meet(|| {
                            meetings.fetch_add(1, Ordering::AcqRel);
                        });
                        assert_eq!(count.load(Ordering::Acquire), 3 * round);
                        assert_eq!(meetings.load(Ordering::Acquire), round);
                        crew.meet(|| {});
                    }
                });
            }
        });
    }

    #[test]
    fn two_threads_have_the_halves_of_eight_octants() {
        let crew = Crew::new(2, 8);
        assert_eq!(crew.share(0, 8).collect::<Vec<_>>(), [0, 3, 4, 7]);
        assert_eq!(crew.share(1, 8).collect::<Vec<_>>(), [1, 2, 5, 6]);
        assert_eq!(Crew::new(3, 8).share(2, 8).collect::<Vec<_>>(), [2, 3]);
    }

    #[test]
    fn every_chunk_has_one_thread_and_is_awaited_until_reported() {
        let chunks = 5;
        let crew = Crew::new(2, chunks);
        let work: Vec<AtomicUsize> = (0..chunks).map(|_| AtomicUsize::new(0)).collect();
        std::thread::scope(|scope| {
            for thread in 0..2 {
                let (crew, work) = (&crew, &work);
                scope.spawn(move || {
                    let mine = crew.share(thread, chunks);
                    for round in 1..=200_u64 {
                        for chunk in mine.clone() {
                            work[chunk].fetch_add(1, Ordering::Relaxed);
                            crew.report(chunk, round);
                        }
                        crew.await_chunks(0..chunks, round);
                        for work in work {
                            assert_eq!(work.load(Ordering::Relaxed) as u64, round);
                        }
                        crew.meet(|| {});
                    }
                });
            }
        });
    }
}
