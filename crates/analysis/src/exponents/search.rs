//! Coordinate search: a scan and a golden section along each active exponent in turn.

#[derive(Clone, Copy)]
pub(super) struct Bounds {
    pub low: f64,
    pub high: f64,
}

const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Minimises `cost` over the active coordinates from `start`. With `local` the first scan stays within ± that.
pub(super) fn minimise(
    cost: &impl Fn([f64; 3]) -> f64,
    start: [f64; 3],
    active: [bool; 3],
    bounds: Bounds,
    local: Option<f64>,
) -> [f64; 3] {
    let mut best = start;
    let coordinates: Vec<usize> = (0..3).filter(|&k| active[k]).collect();
    let rounds = if coordinates.len() > 1 { 4 } else { 1 };
    for round in 0..rounds {
        for &k in &coordinates {
            let reach = match (local, round) {
                (Some(reach), 0) => reach,
                (None, 0) => bounds.high - bounds.low,
                _ => 0.15,
            };
            best[k] = along(cost, best, k, bounds, reach);
        }
    }
    best
}

fn along(cost: &impl Fn([f64; 3]) -> f64, at: [f64; 3], k: usize, bounds: Bounds, reach: f64) -> f64 {
    let value = |x: f64| {
        let mut point = at;
        point[k] = x;
        cost(point)
    };
    let (low, high) = ((at[k] - reach).max(bounds.low), (at[k] + reach).min(bounds.high));
    let step = if reach > 1.0 { 0.05 } else { reach / 6.0 };
    let (mut best, mut best_cost) = (at[k], value(at[k]));
    let mut x = low;
    while x <= high + 1e-12 {
        let found = value(x);
        if found < best_cost {
            (best, best_cost) = (x, found);
        }
        x += step;
    }
    let (mut a, mut b) = ((best - step).max(bounds.low), (best + step).min(bounds.high));
    let (mut c, mut d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
    let (mut at_c, mut at_d) = (value(c), value(d));
    while b - a > 2e-3 {
        if at_c < at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - GOLDEN * (b - a);
            at_c = value(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + GOLDEN * (b - a);
            at_d = value(d);
        }
    }
    let middle = f64::midpoint(a, b);
    if value(middle) <= best_cost { middle } else { best }
}
