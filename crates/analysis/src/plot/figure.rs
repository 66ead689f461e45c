//! Panels side by side over a common legend, drawn into an SVG string.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axis::Axis;
use crate::point::count;

/// Colours of Okabe & Ito without yellow, which is faint on white.
pub(super) const PALETTE: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];
pub(super) const INK: RGBColor = RGBColor(30, 30, 30);
pub(super) const MUTED: RGBColor = RGBColor(120, 120, 120);
const GRID: RGBColor = RGBColor(232, 232, 232);

/// Shape of a data point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
}

pub(super) const MARKERS: [Marker; 5] =
    [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::Cross];

/// How a point is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fill {
    Full,
    Open,
    /// Full, with a ring around it.
    Ringed,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dash {
    Solid,
    Dashed,
}

pub(super) struct Dot {
    pub x: f64,
    pub y: f64,
    /// Half length of the error bar in y.
    pub error: Option<f64>,
}

pub(super) enum Layer {
    Points { color: RGBColor, marker: Marker, fill: Fill, dots: Vec<Dot> },
    Line { color: RGBColor, dash: Dash, points: Vec<(f64, f64)> },
}

/// What stands before the text of a legend entry.
#[derive(Clone, Copy)]
pub(super) enum Sample {
    Point(RGBColor, Marker, Fill),
    Line(RGBColor, Dash),
}

pub(super) struct Panel {
    pub x: Axis,
    pub y: Axis,
    pub layers: Vec<Layer>,
}

pub(super) struct Figure {
    pub title: String,
    pub panels: Vec<Panel>,
    /// Rows of the legend.
    pub legend: Vec<Vec<(Sample, String)>>,
}

const WIDTH: u32 = 800;
const PLOT_HEIGHT: i32 = 400;
const TOP: i32 = 44;
const LEFT: i32 = 78;
const RIGHT: i32 = 18;
const BOTTOM: i32 = 58;
const ROW: i32 = 22;

type Root<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

const INFALLIBLE: &str = "drawing into a string cannot fail";

impl Figure {
    pub fn svg(&self) -> String {
        let rows: Vec<Vec<&(Sample, String)>> = self.legend.iter().flat_map(|row| wrap(row)).collect();
        #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "a few legend rows")]
        let height = TOP + PLOT_HEIGHT + BOTTOM + ROW * rows.len() as i32 + 10;
        let mut text = String::new();
        {
            #[expect(clippy::cast_sign_loss, reason = "heights are positive")]
            let root = SVGBackend::with_string(&mut text, (WIDTH, height as u32)).into_drawing_area();
            self.draw(&root, &rows);
            root.present().expect(INFALLIBLE);
        }
        text
    }

    fn draw(&self, root: &Root<'_>, rows: &[Vec<&(Sample, String)>]) {
        root.fill(&WHITE).expect(INFALLIBLE);
        write(root, &self.title, (WIDTH as i32 / 2, 20), 17, INK, (HPos::Center, VPos::Center));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_possible_wrap,
            reason = "one to three panels"
        )]
        let panels = self.panels.len().max(1) as i32;
        let width = (WIDTH as i32 - RIGHT) / panels;
        for (i, panel) in (0..panels).zip(&self.panels) {
            let frame = Frame {
                left: i * width + LEFT,
                right: (i + 1) * width - if panels > 1 { 6 } else { 0 },
                top: TOP,
                bottom: TOP + PLOT_HEIGHT,
            };
            panel.draw(root, &frame);
        }
        for (i, row) in (0..).zip(rows) {
            legend_row(root, row, TOP + PLOT_HEIGHT + BOTTOM + ROW * i + ROW / 2);
        }
    }
}

struct Frame {
    left: i32,
    right: i32,
    top: i32,
    bottom: i32,
}

impl Frame {
    #[expect(clippy::cast_possible_truncation, reason = "pixels")]
    fn x(&self, share: f64) -> i32 {
        self.left + (share * f64::from(self.right - self.left)).round() as i32
    }
    #[expect(clippy::cast_possible_truncation, reason = "pixels")]
    fn y(&self, share: f64) -> i32 {
        self.bottom - (share * f64::from(self.bottom - self.top)).round() as i32
    }
}

fn write(root: &Root<'_>, text: &str, at: (i32, i32), size: i32, color: RGBColor, anchor: (HPos, VPos)) {
    let style = ("sans-serif", size).into_font().color(&color).pos(Pos::new(anchor.0, anchor.1));
    root.draw(&Text::new(text.to_owned(), at, style)).expect(INFALLIBLE);
}

fn stroke(root: &Root<'_>, points: Vec<(i32, i32)>, style: ShapeStyle) {
    root.draw(&PathElement::new(points, style)).expect(INFALLIBLE);
}

impl Panel {
    fn draw(&self, root: &Root<'_>, frame: &Frame) {
        self.grid(root, frame);
        for layer in &self.layers {
            match layer {
                Layer::Line { color, dash, points } => self.line(root, frame, *color, *dash, points),
                Layer::Points { color, marker, fill, dots } => {
                    for dot in dots {
                        self.dot(root, frame, dot, *color, *marker, *fill);
                    }
                }
            }
        }
        let corners = vec![
            (frame.left, frame.top),
            (frame.right, frame.top),
            (frame.right, frame.bottom),
            (frame.left, frame.bottom),
            (frame.left, frame.top),
        ];
        stroke(root, corners, INK.stroke_width(1));
        let middle = i32::midpoint(frame.left, frame.right);
        write(root, &self.x.label, (middle, frame.bottom + 42), 15, INK, (HPos::Center, VPos::Center));
        let style = ("sans-serif", 15)
            .into_font()
            .transform(FontTransform::Rotate270)
            .color(&INK)
            .pos(Pos::new(HPos::Center, VPos::Center));
        let at = (frame.left - 58, i32::midpoint(frame.top, frame.bottom));
        root.draw(&Text::new(self.y.label.clone(), at, style)).expect(INFALLIBLE);
    }

    fn grid(&self, root: &Root<'_>, frame: &Frame) {
        for tick in self.x.ticks() {
            let Some(share) = self.x.place(tick.at) else { continue };
            let x = frame.x(share);
            let length = if tick.label.is_some() { 6 } else { 3 };
            if let Some(label) = tick.label {
                stroke(root, vec![(x, frame.top), (x, frame.bottom)], GRID.stroke_width(1));
                write(root, &label, (x, frame.bottom + 16), 13, INK, (HPos::Center, VPos::Center));
            }
            stroke(root, vec![(x, frame.bottom), (x, frame.bottom - length)], INK.stroke_width(1));
        }
        for tick in self.y.ticks() {
            let Some(share) = self.y.place(tick.at) else { continue };
            let y = frame.y(share);
            let length = if tick.label.is_some() { 6 } else { 3 };
            if let Some(label) = tick.label {
                stroke(root, vec![(frame.left, y), (frame.right, y)], GRID.stroke_width(1));
                write(root, &label, (frame.left - 8, y), 13, INK, (HPos::Right, VPos::Center));
            }
            stroke(root, vec![(frame.left, y), (frame.left + length, y)], INK.stroke_width(1));
        }
    }

    fn pixel(&self, frame: &Frame, x: f64, y: f64) -> Option<(i32, i32)> {
        Some((frame.x(self.x.place(x)?), frame.y(self.y.place(y)?)))
    }

    /// Draws the parts of a line that lie inside the frame.
    fn line(&self, root: &Root<'_>, frame: &Frame, color: RGBColor, dash: Dash, points: &[(f64, f64)]) {
        let mut part: Vec<(i32, i32)> = Vec::new();
        for &(x, y) in points {
            match self.pixel(frame, x, y) {
                Some(pixel) => part.push(pixel),
                None => pen(root, std::mem::take(&mut part), color, dash),
            }
        }
        pen(root, part, color, dash);
    }

    fn dot(&self, root: &Root<'_>, frame: &Frame, dot: &Dot, color: RGBColor, marker: Marker, fill: Fill) {
        let Some(at) = self.pixel(frame, dot.x, dot.y) else { return };
        if let Some(error) = dot.error.filter(|error| *error > 0.0) {
            let end = |y: f64, edge: i32| self.pixel(frame, dot.x, y).map_or(edge, |pixel| pixel.1);
            let (low, high) = (end(dot.y - error, frame.bottom), end(dot.y + error, frame.top));
            stroke(root, vec![(at.0, low), (at.0, high)], color.stroke_width(1));
        }
        mark(root, at, color, marker, fill);
    }
}

fn pen(root: &Root<'_>, points: Vec<(i32, i32)>, color: RGBColor, dash: Dash) {
    if points.len() < 2 {
        return;
    }
    match dash {
        Dash::Solid => stroke(root, points, color.stroke_width(2)),
        Dash::Dashed => {
            for part in dashes(&points) {
                stroke(root, part, color.stroke_width(2));
            }
        }
    }
}

/// Cuts a polyline into dashes of 8 px with gaps of 5 px along its length.
fn dashes(points: &[(i32, i32)]) -> Vec<Vec<(i32, i32)>> {
    let mut parts = vec![vec![points[0]]];
    let (mut on, mut left) = (true, 8.0);
    for pair in points.windows(2) {
        let (mut from, to) = ((f64::from(pair[0].0), f64::from(pair[0].1)), pair[1]);
        let to = (f64::from(to.0), f64::from(to.1));
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length <= left {
                left -= length;
                if on {
                    parts.last_mut().expect("starts with one").push(pair[1]);
                }
                break;
            }
            let share = left / length;
            from = (from.0 + share * (to.0 - from.0), from.1 + share * (to.1 - from.1));
            #[expect(clippy::cast_possible_truncation, reason = "pixels")]
            let pixel = (from.0.round() as i32, from.1.round() as i32);
            if on {
                parts.last_mut().expect("starts with one").push(pixel);
            } else {
                parts.push(vec![pixel]);
            }
            on = !on;
            left = if on { 8.0 } else { 5.0 };
        }
    }
    parts.retain(|part| part.len() > 1);
    parts
}

fn mark(root: &Root<'_>, (x, y): (i32, i32), color: RGBColor, marker: Marker, fill: Fill) {
    let polygon = |corners: Vec<(i32, i32)>| {
        if fill == Fill::Open {
            let mut closed = corners.clone();
            closed.push(corners[0]);
            stroke(root, closed, color.stroke_width(1));
        } else {
            root.draw(&Polygon::new(corners, color.mix(0.85).filled())).expect(INFALLIBLE);
        }
    };
    match marker {
        Marker::Circle if fill == Fill::Open => {
            root.draw(&Circle::new((x, y), 4, color.stroke_width(1))).expect(INFALLIBLE);
        }
        Marker::Circle => root.draw(&Circle::new((x, y), 4, color.mix(0.85).filled())).expect(INFALLIBLE),
        Marker::Square => polygon(vec![(x - 4, y - 4), (x + 4, y - 4), (x + 4, y + 4), (x - 4, y + 4)]),
        Marker::Triangle => polygon(vec![(x, y - 5), (x + 5, y + 4), (x - 5, y + 4)]),
        Marker::Diamond => polygon(vec![(x, y - 5), (x + 5, y), (x, y + 5), (x - 5, y)]),
        Marker::Cross => {
            let width = if fill == Fill::Open { 1 } else { 2 };
            stroke(root, vec![(x - 4, y - 4), (x + 4, y + 4)], color.stroke_width(width));
            stroke(root, vec![(x - 4, y + 4), (x + 4, y - 4)], color.stroke_width(width));
        }
    }
    if fill == Fill::Ringed {
        root.draw(&Circle::new((x, y), 8, INK.stroke_width(1))).expect(INFALLIBLE);
    }
}

/// Width of a legend entry; text is measured at 7.2 px a letter.
#[expect(clippy::cast_possible_truncation, reason = "pixels")]
fn entry_width(text: &str) -> i32 {
    44 + (7.2 * count(text.chars().count())) as i32
}

/// Breaks a legend row that does not fit into the width.
fn wrap(row: &[(Sample, String)]) -> Vec<Vec<&(Sample, String)>> {
    let mut rows: Vec<Vec<&(Sample, String)>> = Vec::new();
    let mut used = i32::MAX;
    for entry in row {
        let width = entry_width(&entry.1);
        if used == i32::MAX || used + width > WIDTH as i32 - 40 {
            rows.push(Vec::new());
            used = 0;
        }
        rows.last_mut().expect("pushed above").push(entry);
        used += width;
    }
    rows
}

fn legend_row(root: &Root<'_>, row: &[&(Sample, String)], y: i32) {
    let total: i32 = row.iter().map(|entry| entry_width(&entry.1)).sum();
    let mut x = (WIDTH as i32 - total) / 2;
    for (sample, text) in row {
        match *sample {
            Sample::Point(color, marker, fill) => mark(root, (x + 14, y), color, marker, fill),
            Sample::Line(color, dash) => pen(root, vec![(x, y), (x + 27, y)], color, dash),
        }
        write(root, text, (x + 33, y), 13, INK, (HPos::Left, VPos::Center));
        x += entry_width(text);
    }
}
