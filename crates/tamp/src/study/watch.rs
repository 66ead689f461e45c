//! Follows a sweep to its end.

use std::time::Duration;

use protocol::SweepId;
use protocol::api::SweepView;
use tokio_util::sync::CancellationToken;

use super::stack::Stack;
use crate::failure::Failure;
use crate::progress::{Progress, span};

/// Time between two looks.
const BETWEEN: Duration = Duration::from_millis(250);

/// Shows progress until the sweep is over; `None` when told to stop before.
pub async fn until_over(
    stack: &Stack,
    sweep: SweepId,
    stop: &CancellationToken,
) -> Result<Option<SweepView>, Failure> {
    let mut progress = Progress::new("study", false);
    let mut ticks = tokio::time::interval(BETWEEN);
    loop {
        tokio::select! {
            () = stop.cancelled() => {
                progress.end("saving and stopping");
                return Ok(None);
            }
            () = stack.broken() => {
                progress.end("stopped");
                return Err(Failure::Work("coordinator or worker ended unexpectedly (set TAMP_LOG=info to see why)".to_owned()));
            }
            _ = ticks.tick() => {}
        }
        let view: SweepView = stack.client.get(&format!("/v1/sweeps/{sweep}")).await?;
        progress.show(view.progress, &words(&view));
        if view.state.is_terminal() {
            progress.end(&words(&view));
            return Ok(Some(view));
        }
    }
}

fn words(view: &SweepView) -> String {
    let counts = view.counts;
    let mut words = format!("{} of {} done, {} running", counts.done, view.points, counts.leased);
    if counts.failed > 0 {
        words = format!("{words}, {} failed", counts.failed);
    }
    match view.eta_seconds {
        Some(eta) if !view.state.is_terminal() => format!("{words}, {} left", span(eta)),
        _ => words,
    }
}
