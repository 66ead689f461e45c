"""Constants of the packings from the tables beside this file: `python3 constants.py`, nothing but Python needed."""

import csv
import math
import os

HERE = os.path.dirname(os.path.abspath(__file__))
YOUNG = 10.0  # MPa


def load(name):
    with open(os.path.join(HERE, f"assembly-{name}.csv")) as file:
        return [{k.split("[")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def both_walls(states, phi):
    for a, b in zip(states, states[1:]):
        if a["phi"] <= phi <= b["phi"]:
            share = (phi - a["phi"]) / (b["phi"] - a["phi"])
            return sum(0.5 * (a[c] + share * (b[c] - a[c])) for c in ("sigma", "sigma_top"))
    return None


def exponent(states, phi_c):
    """Z = z_c + psi (phi - phi_c)^gamma up to 0.95: least squares over a grid of gamma."""
    data = [(s["phi"] - phi_c, s["z"]) for s in states if phi_c <= s["phi"] <= 0.95]
    best = None
    for step in range(20, 200):
        gamma = step / 100
        x = [d**gamma if d > 0 else 0.0 for d, _ in data]
        n, sx, sy = len(x), sum(x), sum(z for _, z in data)
        sxx, sxy = sum(v * v for v in x), sum(v * z for v, (_, z) in zip(x, data))
        psi = (n * sxy - sx * sy) / (n * sxx - sx * sx)
        z_c = (sy - psi * sx) / n
        rest = sum((z_c + psi * v - z) ** 2 for v, (_, z) in zip(x, data))
        if best is None or rest < best[0]:
            best = (rest, gamma, z_c, psi, (rest / n) ** 0.5)
    return best[1:]


elastic = load("elastic")
for name in ("elastic", "h3", "h1", "h0"):
    states = load(name)
    onset = max(i for i, s in enumerate(states) if s["sigma"] <= 1e-4) + 1
    jammed = max(i for i, s in enumerate(states) if s["z"] < 4 or s["sigma"] <= 1e-4) + 1
    gamma, z_c, psi, scatter = exponent(states, states[jammed]["phi"])
    print(f"{name}: stress on the bottom wall from phi = {states[onset]['phi']:.3f} (z = {states[onset]['z']:.2f}),")
    print(f"  z >= 4 from phi_c = {states[jammed]['phi']:.3f}; gamma = {gamma:.2f}, z_c = {z_c:.2f}, psi = {psi:.1f}, scatter {scatter:.2f}")
    if name != "elastic":
        pairs = [(s["phi"], both_walls(elastic, s["phi"]), 0.5 * (s["sigma"] + s["sigma_top"])) for s in states]
        pairs = [p for p in pairs if p[1]]
        for part in (0.1, 0.2, 0.3):
            last = max(i for i, (_, e, x) in enumerate(pairs) if 1 - x / e <= part)
            phi, e, x = pairs[last + 1]
            print(f"  {part:.0%} below elastic for good from phi = {phi:.3f}: {YOUNG * e:.3f} MPa elastic, {YOUNG * x:.3f} MPa plastic")
        for phi_c in (0.8, states[jammed]["phi"]):
            data = [(math.log(s["phi"] / phi_c), s["f_p"]) for s in states if phi_c < s["phi"] <= 0.95]
            alpha = sum(a * b for a, b in data) / sum(a * a for a, _ in data)
            print(f"  alpha of (11) with phi_c = {phi_c:.3f}: {alpha:.1f}")
