//! `/v1/events`: server-sent events.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::time::Duration;

use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::IntoResponse;
use axum::response::sse::{Event as SseEvent, KeepAlive, Sse};
use futures_util::stream;
use protocol::SweepId;
use protocol::api::Event;
use serde::Deserialize;
use tokio::sync::{broadcast, watch};
use utoipa::IntoParams;

use super::extract::Params;
use super::problem::Answer;
use crate::app::App;
use crate::error::AppError;
use crate::store::StoredEvent;

#[derive(Deserialize, IntoParams)]
#[serde(deny_unknown_fields)]
pub(super) struct EventQuery {
    /// Only events of this sweep.
    sweep: Option<SweepId>,
    /// Begin after this event; the header `Last-Event-ID` goes over it. Absent: begin now.
    after: Option<i64>,
}

/// Follow what happens, as server-sent events
///
/// Events have a growing `id`; a client that comes back with `Last-Event-ID` misses none that is still kept (else it
/// gets an event `reset` first, and reads the state anew). `progress` events have no id and are not kept.
#[utoipa::path(get, path = "/v1/events", tag = "sweeps",
    params(EventQuery, ("Last-Event-ID" = Option<i64>, Header, description = "the last event seen")),
    responses((status = 200, body = Event, content_type = "text/event-stream")))]
pub(super) async fn events(
    State(app): State<App>,
    Params(query): Params<EventQuery>,
    headers: HeaderMap,
) -> Answer<impl IntoResponse> {
    let header = headers.get("last-event-id").map(|value| {
        value.to_str().ok().and_then(|text| text.trim().parse::<i64>().ok()).ok_or_else(|| {
            let remedy = "give the `id` of the last event seen";
            AppError::field("query", "Last-Event-ID", format!("{value:?}"), "is no event id", remedy)
        })
    });
    let (oldest, newest) = app.store().event_range().await?;
    let after = header.transpose()?.or(query.after);
    let mut ready = VecDeque::new();
    if after.is_some_and(|after| after + 1 < oldest) {
        let data = format!("{{\"oldest\":{oldest}}}");
        ready.push_back(SseEvent::default().event("reset").data(data));
    }
    let follower = Follower {
        happened: app.happened(),
        progress: app.progress().subscribe(),
        last: after.unwrap_or(newest),
        sweep: query.sweep,
        ready,
        app,
    };
    let events = stream::unfold(follower, |mut follower| async move {
        let event = follower.next().await?;
        Some((Ok::<_, Infallible>(event), follower))
    });
    Ok(Sse::new(events).keep_alive(KeepAlive::new().interval(Duration::from_secs(15))))
}

struct Follower {
    app: App,
    happened: watch::Receiver<u64>,
    progress: broadcast::Receiver<Event>,
    last: i64,
    sweep: Option<SweepId>,
    ready: VecDeque<SseEvent>,
}

impl Follower {
    async fn next(&mut self) -> Option<SseEvent> {
        loop {
            if let Some(event) = self.ready.pop_front() {
                return Some(event);
            }
            self.happened.mark_unchanged();
            match self.app.store().events(self.last, self.sweep, 500).await {
                Ok(stored) if !stored.is_empty() => {
                    self.last = stored.last().map_or(self.last, |event| event.seq);
                    self.ready.extend(stored.into_iter().map(written));
                    continue;
                }
                Ok(_) => {}
                Err(error) => {
                    tracing::error!(%error, "an event stream ends: the log does not read");
                    return None;
                }
            }
            tokio::select! {
                changed = self.happened.changed() => changed.ok()?,
                progress = self.progress.recv() => {
                    if let Ok(event) = progress
                        && self.sweep.is_none_or(|sweep| event.sweep == Some(sweep))
                    {
                        return Some(sse(&event));
                    }
                }
                () = self.app.stopping().cancelled() => return None,
            }
        }
    }
}

fn written(stored: StoredEvent) -> SseEvent {
    let seq = stored.seq;
    let event = Event {
        id: Some(seq),
        at: stored.at.rfc3339(),
        kind: stored.kind,
        sweep: stored.sweep,
        job: stored.job,
        data: stored.data,
    };
    sse(&event).id(seq.to_string())
}

fn sse(event: &Event) -> SseEvent {
    let data = serde_json::to_string(event).unwrap_or_default();
    SseEvent::default().event(&event.kind).data(data)
}
