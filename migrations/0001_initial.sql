-- Sweeps, points, jobs, attempts, results, events. Times are milliseconds since the Unix epoch by the
-- coordinator's clock. Ids that leave the service are UUIDs as text; inside, rows refer to each other by integers.

-- One row per submitted sweep. The counts are kept by increments (trigger jobs_state_counts), so that the status of
-- a sweep costs the same at ten points and at a million.
create table sweeps (
    seq integer primary key autoincrement,   -- order of submission; cursor of the list
    id text not null unique,
    name text not null,
    model text not null,
    definition text not null,                -- as submitted
    priority integer not null,
    state text not null check (state in ('expanding', 'running', 'paused', 'done', 'failed', 'cancelled')),
    points integer not null,                 -- after `where`
    expanded integer not null default 0,     -- points turned into jobs
    candidates integer not null,             -- places in the sweep's order, those left out included
    scanned integer not null default 0,      -- of these, looked at: where expansion goes on after a restart
    left_out text not null,                  -- JSON: what `where` left out
    reused integer not null default 0,       -- points whose result was there already
    queued integer not null default 0,
    leased integer not null default 0,
    done integer not null default 0,
    failed integer not null default 0,
    cancelled integer not null default 0,
    cost real not null default 0,            -- estimated core-seconds of the expanded points
    cost_done real not null default 0,       -- the same of those that are done
    cost_given_up real not null default 0,   -- the same of those set aside or cancelled
    timed_cost real not null default 0,      -- estimated core-seconds of the runs made for it …
    timed_wall real not null default 0,      -- … and the wall seconds they took: the speed behind the ETA
    submitted_at integer not null,
    finished_at integer
) strict;

-- The reconcilers look only for sweeps that are not over.
create index sweeps_open on sweeps (state) where state in ('expanding', 'running', 'paused');

-- One row per run. Two points with the same scene key share the row.
create table jobs (
    seq integer primary key autoincrement,
    id text not null unique,
    scene_key text not null unique,
    model text not null,
    physics_version integer not null,
    reduced text not null,                   -- JSON, what the worker runs
    scene text not null,                     -- JSON, SI units of the first point that wanted it
    state text not null default 'queued' check (state in ('queued', 'leased', 'done', 'failed', 'cancelled')),
    priority integer not null default 0,     -- largest of the sweeps that want it
    cost real not null,                      -- estimated core-seconds
    wanted integer not null default 0,       -- sweeps that want it and are not cancelled
    runnable integer not null default 0,     -- of these, sweeps that are not paused
    not_before integer not null default 0,   -- back-off after a failure
    attempt integer not null default 0,      -- fencing number, grows with every claim
    failures integer not null default 0,     -- the program's fault
    losses integer not null default 0,       -- expired leases
    losses_in_a_row integer not null default 0, -- expired leases since the last new checkpoint
    worker integer references workers (seq),
    lease_until integer,
    checkpoint_hash text,
    checkpoint_steps integer,
    checkpoint_bytes integer,
    result integer references results (seq), -- the accepted one
    check ((state = 'leased') = (lease_until is not null))
) strict;

-- The claim: best job of a model and physics version. Long runs first among equals, so that the last one to finish
-- does not start last.
create index jobs_claimable on jobs (model, physics_version, priority desc, cost desc, seq)
    where state = 'queued' and runnable > 0;
-- The reaper and a worker that asks again; as small as the number of slots.
create index jobs_leased on jobs (worker) where state = 'leased';
-- Whether a checkpoint file is still in use.
create index jobs_checkpoint on jobs (checkpoint_hash) where checkpoint_hash is not null;

-- Every point of a sweep in its documented order.
create table points (
    sweep integer not null references sweeps (seq),
    point integer not null,                  -- place in the sweep, from 0
    job integer not null references jobs (seq),
    scene text not null,                     -- JSON in SI units, as this sweep wrote it
    primary key (sweep, point)
) strict, without rowid;

-- Which sweep wants which job, and with how many points: what a change of a job's state means for a sweep's counts.
create table wants (
    job integer not null references jobs (seq),
    sweep integer not null references sweeps (seq),
    points integer not null,
    primary key (job, sweep)
) strict, without rowid;
-- Pause, resume, cancel and retry walk the jobs of one sweep.
create index wants_of_sweep on wants (sweep, job);

-- One row per execution.
create table attempts (
    job integer not null references jobs (seq),
    attempt integer not null,
    worker integer not null references workers (seq),
    started_at integer not null,
    ended_at integer,
    "end" text check ("end" in ('done', 'failed', 'lost', 'released', 'cancelled')),
    class text,
    message text,
    steps integer not null default 0,
    expected_steps integer not null default 0,
    fraction real not null default 0,
    wall_s real not null default 0,
    live text not null default '{}',
    primary key (job, attempt)
) strict, without rowid;

-- Results: one row per different outcome of a job. The accepted one is jobs.result; others are evidence.
create table results (
    seq integer primary key autoincrement,
    job integer not null references jobs (seq),
    digest text not null,                    -- BLAKE3 of the outcome
    attempt integer not null,
    worker integer not null references workers (seq),
    hardware text not null,
    alarm integer not null default 0,        -- differs from another result of the same hardware class
    record text not null,                    -- JSON
    execution text not null,                 -- JSON
    outcome text not null,                   -- blob that holds the whole outcome, compressed
    states text,                             -- blob of the states of a loading path, compressed
    stored_at integer not null,
    unique (job, digest, hardware)
) strict;
-- The alarms, for the metrics.
create index results_alarm on results (alarm) where alarm = 1;
-- Whether an outcome file is still in use.
create index results_outcome on results (outcome);
create index results_states on results (states) where states is not null;

-- Worker processes: host and boot are the identity.
create table workers (
    seq integer primary key autoincrement,
    id text not null unique,
    host text not null,
    boot text not null,
    slots integer not null,
    hardware text not null,
    code_version text not null,
    models text not null,                    -- JSON
    registered_at integer not null,
    seen_at integer not null,
    unique (host, boot)
) strict;

-- What happened, for `GET /v1/events` with Last-Event-ID. The oldest rows are dropped by the reaper.
create table events (
    seq integer primary key autoincrement,
    at integer not null,
    kind text not null,
    sweep text,
    job text,
    data text not null
) strict;

-- Answers to requests with an Idempotency-Key.
create table idempotency (
    key text primary key,
    fingerprint text not null,               -- hash of the request; another request under the same key is refused
    sweep integer not null references sweeps (seq),
    stored_at integer not null
) strict, without rowid;

-- Files that no row needs any more; removed after the transaction that let go of them.
create table dropped_blobs (
    hash text primary key,
    since integer not null
) strict, without rowid;

-- Jobs by state over all sweeps, for the metrics; one row.
create table totals (
    one integer primary key check (one = 1),
    queued integer not null default 0,
    leased integer not null default 0,
    done integer not null default 0,
    failed integer not null default 0,
    cancelled integer not null default 0
) strict;
insert into totals (one) values (1);

create trigger jobs_new_totals after insert on jobs begin
    update totals set
        queued = queued + (new.state = 'queued'),
        done = done + (new.state = 'done');
end;

-- A change of a job's state moves its points from one count to another in every sweep that has it, in the same
-- transaction, whichever statement made the change.
create trigger jobs_state_counts after update of state on jobs when old.state <> new.state begin
    update totals set
        queued = queued + (new.state = 'queued') - (old.state = 'queued'),
        leased = leased + (new.state = 'leased') - (old.state = 'leased'),
        done = done + (new.state = 'done') - (old.state = 'done'),
        failed = failed + (new.state = 'failed') - (old.state = 'failed'),
        cancelled = cancelled + (new.state = 'cancelled') - (old.state = 'cancelled');
    update sweeps set
        queued = queued + ((new.state = 'queued') - (old.state = 'queued')) * wants.points,
        leased = leased + ((new.state = 'leased') - (old.state = 'leased')) * wants.points,
        done = done + ((new.state = 'done') - (old.state = 'done')) * wants.points,
        failed = failed + ((new.state = 'failed') - (old.state = 'failed')) * wants.points,
        cancelled = cancelled + ((new.state = 'cancelled') - (old.state = 'cancelled')) * wants.points,
        cost_done = cost_done + ((new.state = 'done') - (old.state = 'done')) * wants.points * new.cost,
        cost_given_up = cost_given_up
            + ((new.state in ('failed', 'cancelled')) - (old.state in ('failed', 'cancelled')))
            * wants.points * new.cost
    from wants where wants.job = new.seq and wants.sweep = sweeps.seq;
end;
