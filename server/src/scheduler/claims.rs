//! Claims that arrive together are served together: whoever gets the turn serves everybody who waits, in one
//! transaction with one fsync. Alone, a claim waits for nobody.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::oneshot;

use crate::clock::Clock;
use crate::store::{Claim, Granted, Store};

/// Most claims served in one transaction.
const BATCH: usize = 128;

type Answer = Option<Vec<Granted>>;

/// The queue of claims.
pub struct ClaimQueue {
    store: Store,
    clock: Arc<dyn Clock>,
    lease: Duration,
    waiting: Mutex<Vec<(Claim, oneshot::Sender<Answer>)>>,
    turn: tokio::sync::Mutex<()>,
}

/// The claim was not served; nothing is leased. Ask again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the claim was not served; ask again")]
pub struct NotServed;

impl ClaimQueue {
    /// An empty queue.
    #[must_use]
    pub fn new(store: Store, clock: Arc<dyn Clock>, lease: Duration) -> Arc<Self> {
        Arc::new(Self { store, clock, lease, waiting: Mutex::default(), turn: tokio::sync::Mutex::default() })
    }

    /// Serves one claim. `Ok(None)`: the worker is not registered.
    ///
    /// # Errors
    /// [`NotServed`] when the database refused; the cause is logged.
    pub async fn claim(self: &Arc<Self>, claim: Claim) -> Result<Answer, NotServed> {
        let (sender, answer) = oneshot::channel();
        self.waiting.lock().expect("no holder of this lock panics").push((claim, sender));
        // In a task of its own: a client that goes away does not take the others' claims with it.
        let queue = Arc::clone(self);
        tokio::spawn(async move { queue.serve().await });
        answer.await.map_err(|_| NotServed)
    }

    async fn serve(&self) {
        let _turn = self.turn.lock().await;
        let batch: Vec<_> = {
            let mut waiting = self.waiting.lock().expect("no holder of this lock panics");
            let size = waiting.len().min(BATCH);
            waiting.drain(..size).collect()
        };
        // Somebody before us served ours.
        if batch.is_empty() {
            return;
        }
        let (claims, senders): (Vec<Claim>, Vec<_>) = batch.into_iter().unzip();
        let now = self.clock.now();
        match self.store.claim(&claims, now, now.plus(self.lease)).await {
            Ok(answers) => {
                for (sender, answer) in senders.into_iter().zip(answers) {
                    // A receiver that went away asks again and gets the same jobs.
                    let _ = sender.send(answer);
                }
            }
            Err(error) => tracing::error!(%error, claims = claims.len(), "claims were not served"),
        }
    }
}
