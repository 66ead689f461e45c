"""Figures 1, 3, 4 and 5 of the study as SVG from the tables beside this file: `python3 figures.py`, nothing but Python."""

import csv
import os

HERE = os.path.dirname(os.path.abspath(__file__))
COLORS = {"elastic": "#0072b2", "h0": "#d55e00", "h1": "#009e73", "h3": "#cc79a7"}
NAMES = {"elastic": "elastic", "h0": "H = 0", "h1": "H = 1 MPa", "h3": "H = 3 MPa"}
W, H, LEFT, TOP, BOTTOM = 380, 300, 62, 34, 50


def load(setup):
    found = {}
    for name in COLORS:
        path = os.path.join(HERE, f"{setup}-{name}.csv")
        if os.path.exists(path):
            with open(path) as file:
                found[name] = [{k.split("[")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    return found


def ticks(low, high):
    step = 10 ** len(str(int(high - low))) if high - low >= 1 else 1.0
    while (high - low) / step < 4:
        step /= 2 if str(step)[-1] != "5" else 2.5
    first = int(low / step) * step
    values = [first + k * step for k in range(20)]
    return [v for v in values if low - 1e-9 <= v <= high + 1e-9]


def panel(at, x_label, y_label, curves):
    """curves: name -> list of (x, y)."""
    points = [p for curve in curves.values() for p in curve]
    x0, x1 = min(p[0] for p in points), max(p[0] for p in points)
    y0, y1 = min(0.0, min(p[1] for p in points)), max(p[1] for p in points)
    if y1 < 1.05 and min(p[1] for p in points) > 0.5:
        y0 = min(p[1] for p in points)
    px = lambda x: at[0] + LEFT + (x - x0) / (x1 - x0) * (W - LEFT - 14)
    py = lambda y: at[1] + TOP + (y1 - y) / (y1 - y0) * (H - TOP - BOTTOM)
    out = [f'<rect x="{px(x0):.1f}" y="{py(y1):.1f}" width="{px(x1) - px(x0):.1f}" height="{py(y0) - py(y1):.1f}" fill="none" stroke="#1e1e1e"/>']
    for v in ticks(x0, x1):
        out.append(f'<line x1="{px(v):.1f}" x2="{px(v):.1f}" y1="{py(y0):.1f}" y2="{py(y0) + 4:.1f}" stroke="#1e1e1e"/>')
        out.append(f'<text x="{px(v):.1f}" y="{py(y0) + 17:.1f}" text-anchor="middle">{v:.4g}</text>')
    for v in ticks(y0, y1):
        out.append(f'<line x1="{px(x0) - 4:.1f}" x2="{px(x0):.1f}" y1="{py(v):.1f}" y2="{py(v):.1f}" stroke="#1e1e1e"/>')
        out.append(f'<text x="{px(x0) - 7:.1f}" y="{py(v) + 4:.1f}" text-anchor="end">{v:.4g}</text>')
    for name, curve in curves.items():
        path = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y in curve)
        out.append(f'<polyline points="{path}" fill="none" stroke="{COLORS[name]}" stroke-width="1.6"/>')
    out.append(f'<text x="{(px(x0) + px(x1)) / 2:.1f}" y="{py(y0) + 36:.1f}" text-anchor="middle">{x_label}</text>')
    x, y = at[0] + 14, (py(y0) + py(y1)) / 2
    out.append(f'<text x="{x}" y="{y:.1f}" text-anchor="middle" transform="rotate(-90 {x} {y:.1f})">{y_label}</text>')
    return out


def figure(name, panels, names):
    columns = min(2, len(panels))
    rows = (len(panels) + columns - 1) // columns
    rows_of_names = (len(names) + 2 * columns - 1) // (2 * columns)
    width, height = columns * W + 10, rows * H + 22 + 18 * rows_of_names
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="12">', f'<rect width="{width}" height="{height}" fill="white"/>']
    for k, one in enumerate(panels):
        out += panel((k % columns * W, k // columns * H), *one)
    for k, key in enumerate(names):
        x, y = 70 + 150 * (k % (2 * columns)), height - 20 - 18 * (rows_of_names - 1 - k // (2 * columns))
        out.append(f'<line x1="{x}" x2="{x + 24}" y1="{y}" y2="{y}" stroke="{COLORS[key]}" stroke-width="2"/>')
        out.append(f'<text x="{x + 30}" y="{y + 4}">{NAMES[key]}</text>')
    with open(os.path.join(HERE, f"{name}.svg"), "w") as file:
        file.write("\n".join(out + ["</svg>", ""]))


discs = load("diametrical")
stress = lambda column: {n: [(s["strain"], 10 * s[column]) for s in states] for n, states in discs.items()}
figure("figure-1", [
    ("strain 1 − h/D", "F/D [MPa]", stress("sigma")),
    ("strain 1 − h/D", "F/contact width [MPa]", stress("sigma_contact")),
    ("strain 1 − h/D", "volume mean of −σyy [MPa]", stress("sigma_volume")),
    ("strain 1 − h/D", "−σyy at the centre [MPa]", stress("sigma_centre")),
], discs)

packings = load("assembly")
# mean of bottom and top wall: less of the inertia of the box
sigma = lambda s: 5 * (s["sigma"] + s["sigma_top"])
begin = {n: max(i for i, s in enumerate(p) if s["z"] < 4 or s["sigma"] <= 1e-4) + 1 for n, p in packings.items()}
of = lambda x, y: {n: [(x(s), y(s)) for s in p] for n, p in packings.items()}
figure("figure-3", [
    ("σ [MPa], mean of bottom and top", "mean largest curvature κ⟨d⟩", of(sigma, lambda s: s["kappa_d"])),
    ("σ [MPa], mean of bottom and top", "solid fraction Φ", of(sigma, lambda s: s["phi"])),
], packings)
excess = {n: [(-s["strain_log"] + p[begin[n]]["strain_log"], sigma(s) - sigma(p[begin[n]])) for s in p[begin[n]:]] for n, p in packings.items()}
figure("figure-4", [
    ("solid fraction Φ", "σ − σc [MPa]", {n: [(s["phi"], sigma(s) - sigma(p[begin[n]])) for s in p[begin[n]:]] for n, p in packings.items()}),
    ("excess strain ε − εc", "σ − σc [MPa]", excess),
], packings)
figure("figure-5", [
    ("Φ − Φc", "Z − Zc", {n: [(s["phi"] - p[begin[n]]["phi"], s["z"] - p[begin[n]]["z"]) for s in p[begin[n]:]] for n, p in packings.items()}),
], packings)
