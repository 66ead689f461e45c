//! Candidate rows from outlines.

use super::{Candidate, Key, Partner, Wall};

/// Outline of a body with its vertex normals and bounding box.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// Marker positions, counter-clockwise.
    pub points: Vec<[f64; 2]>,
    /// Unit outward normals at the markers.
    pub normals: Vec<[f64; 2]>,
    /// Lowest corner of the bounding box.
    pub low: [f64; 2],
    /// Highest corner of the bounding box.
    pub high: [f64; 2],
}

impl Outline {
    /// Recomputes normals and box after `points` has changed.
    pub fn refresh(&mut self) {
        let n = self.points.len();
        self.normals.clear();
        (self.low, self.high) = ([f64::MAX; 2], [f64::MIN; 2]);
        let mut before = segment_normal(self.points[n - 1], self.points[0]);
        for k in 0..n {
            let after = segment_normal(self.points[k], self.points[(k + 1) % n]);
            self.normals.push(unit([before[0] + after[0], before[1] + after[1]]));
            before = after;
            for axis in 0..2 {
                self.low[axis] = self.low[axis].min(self.points[k][axis]);
                self.high[axis] = self.high[axis].max(self.points[k][axis]);
            }
        }
    }

    /// Signed area by the shoelace formula.
    #[must_use]
    pub fn area(&self) -> f64 {
        let n = self.points.len();
        let cross = |k: usize| {
            let (a, b) = (self.points[k], self.points[(k + 1) % n]);
            a[0] * b[1] - a[1] * b[0]
        };
        0.5 * (0..n).map(cross).sum::<f64>()
    }

    /// Whether the bounding boxes are within `range`.
    #[must_use]
    pub fn near(&self, other: &Self, range: f64) -> bool {
        (0..2).all(|axis| {
            self.low[axis] - range <= other.high[axis] && other.low[axis] - range <= self.high[axis]
        })
    }

    /// Whether `x` is within `range` of the bounding box.
    #[must_use]
    pub fn holds(&self, x: [f64; 2], range: f64) -> bool {
        (0..2).all(|axis| self.low[axis] - range <= x[axis] && x[axis] <= self.high[axis] + range)
    }

    /// The nearest point of the outline: segment, place on it, normal there and gap of `x` along that normal.
    #[must_use]
    pub fn nearest(&self, x: [f64; 2]) -> (usize, f64, [f64; 2], f64) {
        let (mut vertex, mut least) = (0, f64::MAX);
        for (k, p) in self.points.iter().enumerate() {
            let d = square_distance(x, *p);
            if d < least {
                (vertex, least) = (k, d);
            }
        }
        self.around(x, vertex)
    }

    /// The vertex nearest to `x`, walking downhill from `vertex`.
    #[must_use]
    pub fn descend(&self, x: [f64; 2], vertex: usize) -> usize {
        let n = self.points.len();
        let distance = |k: usize| square_distance(x, self.points[k]);
        let mut here = (vertex, distance(vertex));
        loop {
            let beside = [(here.0 + 1) % n, (here.0 + n - 1) % n].map(|k| (k, distance(k)));
            let next = if beside[0].1 <= beside[1].1 { beside[0] } else { beside[1] };
            if next.1 >= here.1 {
                return here.0;
            }
            here = next;
        }
    }

    /// As [`Outline::nearest`] on the two segments at a vertex.
    #[must_use]
    pub fn around(&self, x: [f64; 2], vertex: usize) -> (usize, f64, [f64; 2], f64) {
        let n = self.points.len();
        let mut best = (0, 0.0, [0.0; 2], 0.0);
        let mut least = f64::MAX;
        for k in [(vertex + n - 1) % n, vertex] {
            let (a, b) = (self.points[k], self.points[(k + 1) % n]);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let along = ((x[0] - a[0]) * dx + (x[1] - a[1]) * dy) / (dx * dx + dy * dy);
            let s = along.clamp(0.0, 1.0);
            let away = [x[0] - a[0] - s * dx, x[1] - a[1] - s * dy];
            let d = away[0] * away[0] + away[1] * away[1];
            if d < least {
                least = d;
                let (na, nb) = (self.normals[k], self.normals[(k + 1) % n]);
                let normal = unit([na[0] + s * (nb[0] - na[0]), na[1] + s * (nb[1] - na[1])]);
                best = (k, s, normal, away[0] * normal[0] + away[1] * normal[1]);
            }
        }
        best
    }
}

fn square_distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1])
}

fn segment_normal(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    unit([b[1] - a[1], a[0] - b[0]])
}

fn unit(v: [f64; 2]) -> [f64; 2] {
    let length = (v[0] * v[0] + v[1] * v[1]).sqrt();
    if length > 0.0 { [v[0] / length, v[1] / length] } else { [1.0, 0.0] }
}

/// Candidates of the markers of one body within `range`, in the order of their keys. Markers of both bodies of a pair
/// are tested against the other's outline (two passes), so that neither can cut a corner of the other.
pub fn candidates(body: usize, outlines: &[Outline], walls: &[Wall], range: f64, out: &mut Vec<Candidate>) {
    out.clear();
    let own = &outlines[body];
    for (number, wall) in walls.iter().enumerate() {
        for (marker, x) in own.points.iter().enumerate() {
            let gap = (x[0] - wall.point[0]) * wall.normal[0] + (x[1] - wall.point[1]) * wall.normal[1];
            if gap < range {
                let key =
                    Key { body: body as u32, partner: Partner::Wall(number as u32), marker: marker as u32 };
                out.push(Candidate { key, gap, normal: wall.normal, segment: 0, share: 0.0 });
            }
        }
    }
    for (number, other) in outlines.iter().enumerate() {
        if number == body || !own.near(other, range) {
            continue;
        }
        for (marker, &x) in own.points.iter().enumerate() {
            if !other.holds(x, range) {
                continue;
            }
            let (segment, share, normal, gap) = other.nearest(x);
            // surfaces that meet look at each other; a marker near the far side of a thin neck does not
            let facing = own.normals[marker][0] * normal[0] + own.normals[marker][1] * normal[1] < 0.0;
            if gap < range && facing {
                let key =
                    Key { body: body as u32, partner: Partner::Body(number as u32), marker: marker as u32 };
                out.push(Candidate { key, gap, normal, segment: segment as u32, share });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(x: f64, y: f64, n: usize) -> Outline {
        let mut out = Outline::default();
        for k in 0..n {
            let a = std::f64::consts::TAU * k as f64 / n as f64;
            out.points.push([x + libm::cos(a), y + libm::sin(a)]);
        }
        out.refresh();
        out
    }

    #[test]
    fn normals_point_from_the_partner_to_the_marker() {
        let outlines = [circle(0.0, 0.0, 64), circle(2.01, 0.0, 64)];
        let wall = Wall { point: [0.0, -1.005], normal: [0.0, 1.0], velocity: [0.0; 2] };
        let mut found = Vec::new();
        candidates(0, &outlines, &[wall], 0.05, &mut found);
        assert!(found.is_sorted_by_key(|one| one.key));
        let closest = |partner| {
            let of = found.iter().filter(move |one| one.key.partner == partner);
            of.min_by(|a, b| a.gap.total_cmp(&b.gap)).copied().unwrap()
        };
        let disc = closest(Partner::Body(1));
        assert!((disc.gap - 0.01).abs() < 1e-9 && disc.normal[0] < -0.999, "{disc:?}");
        let ground = closest(Partner::Wall(0));
        assert!((ground.gap - 0.005).abs() < 1e-12 && ground.normal[1] > 0.999);
        assert!((outlines[0].area() - 32.0 * libm::sin(std::f64::consts::TAU / 64.0)).abs() < 1e-12);
    }

    #[test]
    fn the_gap_is_continuous_round_a_corner() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].to_vec();
        let mut outline = Outline { points: square, ..Outline::default() };
        outline.refresh();
        let mut last = None;
        for k in 0..2000 {
            let a = std::f64::consts::TAU * k as f64 / 2000.0;
            let (.., gap) = outline.nearest([0.5 + 0.8 * libm::cos(a), 0.5 + 0.8 * libm::sin(a)]);
            if let Some(before) = last {
                assert!(f64::abs(gap - before) < 0.01, "{k}: {before} {gap}");
            }
            last = Some(gap);
        }
    }
}
