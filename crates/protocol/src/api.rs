//! Request and response bodies of the public API, one file per resource. The lease messages are in `lease`.

mod event;
mod job;
mod page;
mod point;
mod sweep;
mod worker;

pub use event::Event;
pub use job::{AttemptEnd, AttemptView, JobView, ResultView};
pub use page::{Page, PageQuery, ResultPage};
pub use point::{Explanation, PointView, Verdict};
pub use sweep::{ControlReply, Counts, DryRun, Estimate, LeftOut, SweepState, SweepView};
pub use worker::WorkerView;
