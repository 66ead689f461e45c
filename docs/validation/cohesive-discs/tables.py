"""Prints the tables of README.md from states.csv and draws phi.svg, coordination.svg, elastic.svg and forces.svg.

Standard library only."""
import csv
import json
import math
import pathlib
import statistics

HERE = pathlib.Path(__file__).parent
with open(HERE / "states.csv") as file:
    ROWS = [{k: (float(v) if k not in TEXT else v) for k, v in row.items() if v != ""}
            for TEXT in [{"assembly", "branch", "converged", "scene_key", "kernel", "physics_version", "code_version"}]
            for row in csv.DictReader(file)]
PAPER = {  # Table II: phi at the lowest pressure, and its scatter
    ("cohesionless", 0.0): (0.811, 0.001), ("type1", 0.0): (0.723, 0.001), ("type2", 0.0): (0.472, 0.008),
    ("cohesionless", 0.005): (0.805, 0.002), ("type1", 0.005): (0.688, 0.001), ("type2", 0.005): (0.524, 0.008),
}
ORDER = [(a, m) for a in ("cohesionless", "type1", "type2") for m in (0.0, 0.005, 0.5)]


# Table III of the paper: P*0, phi_0, lambda, alpha, P*1 of eq. (9).
TABLE_3 = {0.0: (0.0237, 0.469, 0.349, 0.91, 0.271), 0.005: (0.0316, 0.515, 0.194, 1.08, 0.9),
           0.5: (0.0178, 0.382, 0.25, 0.86, 2.6)}


def consolidation(p, p0, phi_0, slope, alpha, p1):
    """Eq. (9) of the paper."""
    inside = p / p0 * (-math.expm1(-(p1 / p) ** alpha)) ** (1 / alpha)
    return 1 / (1 / phi_0 - slope * math.log(inside))


def trusted(row):
    """Physics version 1 has moduli spoilt by round-off where a network has mechanisms (without rolling resistance)."""
    return bool(row.get("bulk")) and (row["mu_r"] > 0 or int(row["physics_version"]) > 1)


def series(assembly, mu_r, n=1400):
    return [r for r in ROWS if r["assembly"] == assembly and r["mu_r"] == mu_r and r["n"] == n]


def mean(values):
    values = list(values)
    if not values:
        return "-"
    if len(values) == 1:
        return f"{values[0]:.4g}"
    return f"{statistics.fmean(values):.4f} ± {statistics.stdev(values) / math.sqrt(len(values)):.4f}"


def at(rows, p, branches=("assembly", "compression")):
    return [r for r in rows if abs(r["p"] / p - 1) < 1e-3 and r["branch"] in branches] if p else []


print("## Φ at the lowest pressure (Table II): mean ± standard error\n")
print("| assembling, μ_R/a | samples | Φ | paper | distance / standard error | z | z+ | z− | x0 | z* |")
print("|---|---|---|---|---|---|---|---|---|---|")
for key in ORDER:
    rows = [r for r in series(*key) if r["branch"] == "assembly"]
    if not rows:
        continue
    phi = [r["phi"] for r in rows]
    paper = PAPER.get(key)
    away = ""
    if paper and len(phi) > 1:
        # The paper's ± is the scatter of its samples (4 or 5): its mean has half of it as standard error.
        error = math.hypot(statistics.stdev(phi) / math.sqrt(len(phi)), paper[1] / 2)
        away = f"{(statistics.fmean(phi) - paper[0]) / error:+.1f}"
    told = f"{paper[0]} ± {paper[1]}" if paper else ""
    print(f"| {key[0]}, {key[1]:g} | {len(phi)} | {mean(phi)} | {told} | {away} | "
          + " | ".join(mean(r[c] for r in rows) for c in ("z", "z_plus", "z_minus", "rattler_share", "z_star")) + " |")

print("\n## The curve of type 2: mean ± standard error over samples\n")
for mu_r in (0.0, 0.005, 0.5):
    rows = series("type2", mu_r)
    pressures = sorted({round(r["p"], 8) for r in rows if r["branch"] in ("assembly", "compression")})
    if not pressures:
        continue
    print(f"### μ_R/a = {mu_r:g}\n")
    print("| P* | samples | Φ | z | z+ | z− | B [K_N] | G [K_N] | B_V/B | B/B_R | ξ' [a] |")
    print("|---|---|---|---|---|---|---|---|---|---|---|")
    for p in pressures:
        here = at(rows, p)
        ok = [r for r in here if trusted(r)]
        print(f"| {p:.4g} | {len(here)} | {mean(r['phi'] for r in here)} | {mean(r['z'] for r in here)} | "
              f"{mean(r['z_plus'] for r in here)} | {mean(r['z_minus'] for r in here)} | "
              f"{mean(r['bulk'] for r in ok)} | {mean(r['shear'] for r in ok)} | "
              f"{mean(r['bulk_voigt'] / r['bulk'] for r in ok)} | "
              f"{mean(r['bulk'] / r['bulk_reuss'] for r in ok if r.get('bulk_reuss'))} | "
              f"{mean(r['pore_radius'] for r in here if 'pore_radius' in r)} |")
    print()

print("## Table III: eq. (9), fits of the service ± standard error; distance from the paper in standard errors\n")
print("| μ_R/a | stages | samples | P*0 | Φ at P*0 | λ | Φmax | α | P*1 | rms to the paper's curve, P* ≥ 0.05 |")
print("|---|---|---|---|---|---|---|---|---|---|")
PAPER_3 = {0.0: ((0.349, 0.019), (0.7808, 0), (0.91, 0.10), (0.271, 0.033)),
           0.005: ((0.194, 0.004), (0.7745, 0), (1.08, 0.16), (0.9, 0.064)),
           0.5: ((0.25, 0.01), (0.724, 0), (0.86, 0.24), (2.6, 0.4))}
for fit in sorted(json.loads((HERE / "fits.json").read_text()), key=lambda f: f["mu_r"]):
    cells = []
    for name, (value, error) in zip(("lambda", "phi_max", "alpha", "p_star_1"), PAPER_3[fit["mu_r"]]):
        ours, own = fit[name]
        cells.append(f"{ours:.3f} ± {own:.3f} ({(ours - value) / math.hypot(own, error):+.1f})")
    p0 = fit["p_star_0"]
    table = consolidation(p0, *TABLE_3[fit["mu_r"]])
    start = f"{fit['phi_0'][0]:.3f} ± {fit['phi_0'][1]:.3f} (Table III there: {table:.3f})"
    print(f"| {fit['mu_r']:g} | {fit['method'].replace('_', '-')} | {fit['samples']} | {p0:.3g} | {start} | "
          + " | ".join(cells) + f" | {fit['rms_to_paper']:.3f} |")

print("\n## Contacts from P* = 0.178 to 0.237 (Table IV)\n")
print("| μ_R/a | samples | ΔΦ/Φ [%] | kept [%] | lost [%] | gained [%] |\n|---|---|---|---|---|---|")
for mu_r in (0.0, 0.005, 0.5):
    rows = series("type2", mu_r)
    first = {r["seed"]: r for r in at(rows, 0.17782794)}
    second = {r["seed"]: r for r in at(rows, 0.23713737)}
    both = sorted(first.keys() & second.keys())
    if both:
        before = {s: second[s]["contacts_kept"] + second[s]["contacts_lost"] for s in both}
        part = lambda name: mean(100 * second[s][name] / before[s] for s in both)
        change = mean(100 * (second[s]["phi"] / first[s]["phi"] - 1) for s in both)
        print(f"| {mu_r:g} | {len(both)} | {change} | {part('contacts_kept')} | {part('contacts_lost')} | {part('contacts_gained')} |")

print("\n## Contacts lost and gained per densification, steps of first loading with ΔΦ/Φ > 1 %\n")
print("| μ_R/a | to P* | samples | lost / (ΔΦ/Φ) | gained / (ΔΦ/Φ) |\n|---|---|---|---|---|")
for mu_r in (0.005, 0.5):
    rows = [r for r in series("type2", mu_r) if r["branch"] in ("assembly", "compression")]
    by_seed = {seed: sorted((r for r in rows if r["seed"] == seed), key=lambda r: r["p"]) for seed in {r["seed"] for r in rows}}
    found = {}
    for states in by_seed.values():
        for first, second in zip(states, states[1:]):
            change = second["phi"] / first["phi"] - 1
            if change > 0.01 and 0.1 < second["p"] < 0.8:
                before = second["contacts_kept"] + second["contacts_lost"]
                found.setdefault(round(second["p"], 3), []).append(
                    [second[name] / before / change for name in ("contacts_lost", "contacts_gained")])
    for p, values in sorted(found.items()):
        print(f"| {mu_r:g} | {p:g} | {len(values)} | " + " | ".join(mean(v[k] for v in values) for k in (0, 1)) + " |")
print("| 0.005, paper | 0.237 | 1 | 1.59 | 1.63 |\n| 0.5, paper | 0.237 | 1 | 0.48 | 0.87 |")

print("\n## Structure of type 2\n")
print("| μ_R/a | P* | samples with a fractal range | d_F | ξ [a] | ξ' [a] |\n|---|---|---|---|---|---|")
for mu_r in (0.0, 0.005, 0.5):
    for p, rows in [(0, [r for r in series("type2", mu_r) if r["branch"] == "rest"]),
                    (0.01, at(series("type2", mu_r), 0.01))]:
        if rows:
            fractal = [r for r in rows if "fractal_dimension" in r]
            print(f"| {mu_r:g} | {p} | {len(fractal)} of {len(rows)} | {mean(r['fractal_dimension'] for r in fractal)} | "
                  f"{mean(r['correlation_length'] for r in fractal)} | {mean(r['pore_radius'] for r in rows if 'pore_radius' in r)} |")
bad = [r for r in ROWS if r["converged"] not in ("True", "true")]
print(f"\n{len(ROWS)} states, {len(bad)} not converged, "
      f"{sum(r['stiffness_sign'] != 1 for r in ROWS if 'stiffness_sign' in r)} whose stiffness matrix is not positive definite, "
      f"{sum(r['bulk'] > r['bulk_voigt'] for r in ROWS if trusted(r))} above the Voigt bound")

COLORS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"]


class Plot:
    """One panel 560 × 400 as SVG text, x linear or logarithmic."""

    def __init__(self, title, xlabel, ylabel, xs, ys, logx=False, logy=False, legend=52):
        self.fx, self.fy = (math.log10 if logx else float), (math.log10 if logy else float)
        self.logx, self.logy = logx, logy
        self.x0, self.x1 = self.fx(min(xs)), self.fx(max(xs))
        self.y0, self.y1 = self.fy(min(ys)), self.fy(max(ys))
        pad = 0.04 * (self.y1 - self.y0)
        self.y0, self.y1 = self.y0 - pad, self.y1 + pad
        self.parts = [f'<text x="330" y="22" text-anchor="middle" font-size="15">{title}</text>',
                      f'<text x="330" y="436" text-anchor="middle">{xlabel}</text>',
                      f'<text x="16" y="215" text-anchor="middle" transform="rotate(-90 16 215)">{ylabel}</text>',
                      '<rect x="70" y="35" width="520" height="360" fill="none" stroke="#444"/>']
        for value in self.ticks(self.x0, self.x1, logx):
            x = self.px(value)
            label = f"{10 ** value:g}" if logx else f"{value:g}"
            self.parts += [f'<line x1="{x:.1f}" y1="395" x2="{x:.1f}" y2="390" stroke="#444"/>',
                           f'<text x="{x:.1f}" y="412" text-anchor="middle">{label}</text>']
        for value in self.ticks(self.y0, self.y1, logy):
            y = self.py(value)
            label = f"{10 ** value:g}" if logy else f"{value:g}"
            self.parts += [f'<line x1="70" y1="{y:.1f}" x2="75" y2="{y:.1f}" stroke="#444"/>',
                           f'<text x="64" y="{y + 4:.1f}" text-anchor="end">{label}</text>']
        self.names, self.legend = 0, legend

    @staticmethod
    def ticks(low, high, log):
        step = 1.0 if log else 10 ** math.floor(math.log10((high - low) / 3))
        if not log and (high - low) / step > 8:
            step *= 2 if (high - low) / step <= 14 else 5
        first = math.ceil(low / step - 1e-9)
        return [round(k * step, 9) for k in range(first, math.floor(high / step + 1e-9) + 1)]

    def px(self, value):
        return 70 + 520 * (value - self.x0) / (self.x1 - self.x0)

    def py(self, value):
        return 395 - 360 * (value - self.y0) / (self.y1 - self.y0)

    def line(self, name, points, color, dots=True):
        at = [(self.px(self.fx(x)), self.py(self.fy(y))) for x, y in points if not self.logy or y > 0]
        self.parts.append(f'<polyline fill="none" stroke="{color}" stroke-width="1.5" points="'
                          + " ".join(f"{x:.1f},{y:.1f}" for x, y in at) + '"/>')
        if dots:
            self.parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.5" fill="{color}"/>' for x, y in at]
        y = self.legend + 16 * self.names
        self.parts += [f'<line x1="390" y1="{y}" x2="414" y2="{y}" stroke="{color}" stroke-width="2"/>',
                       f'<text x="420" y="{y + 4}">{name}</text>']
        self.names += 1

    def save(self, name):
        (HERE / name).write_text('<svg xmlns="http://www.w3.org/2000/svg" width="610" height="446" '
                                 'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="#fff"/>\n'
                                 + "\n".join(self.parts) + "\n</svg>\n")


def curve(rows, column):
    pressures = sorted({round(r["p"], 8) for r in rows if r["branch"] in ("assembly", "compression")})
    return [(p, statistics.fmean(r[column] for r in at(rows, p))) for p in pressures]


def draw(name, title, ylabel, curves, logy=False, lines=()):
    every = [point for _, points in curves for point in points]
    if not every:
        return
    plot = Plot(title, "P* = aP/F0", ylabel, [x for x, _ in every], [y for _, y in every], logx=True, logy=logy,
                legend=290)
    for (label, points), color in zip(curves, COLORS):
        plot.line(label, points, color)
    for (label, points), color in lines:
        plot.line(label, [(x, y) for x, y in points if plot.y0 <= y <= plot.y1], color, dots=False)
    plot.save(name)


present = [m for m in (0.0, 0.005, 0.5) if at(series("type2", m), 0.01)]
label = {m: f"μR/a = {m:g}, {len(at(series('type2', m), 0.01))} samples" for m in present}
draw("coordination.svg", "Coordination number on first loading, type 2", "z",
     [(label[m], curve(series("type2", m), "z")) for m in present])
draw("phi.svg", "Consolidation of type 2; thin: Table III of the paper", "Φ",
     [(label[m], curve(series("type2", m), "phi")) for m in present],
     lines=[((f"paper, {m:g}", [(p, consolidation(p, *TABLE_3[m])) for p in (10 ** (e / 16 - 2) for e in range(51))
                                if p > TABLE_3[m][0]]), "#999999") for m in present])
draw("elastic.svg", "Elastic moduli on first loading, type 2", "modulus [K_N]",
     [(f"{symbol}, μR/a = {m:g}", curve([r for r in series("type2", m) if trusted(r)], column))
      for m in present for symbol, column in (("B", "bulk"), ("G", "shear")) if any(map(trusted, series("type2", m)))],
     logy=True)

with open(HERE / "forces.csv") as file:
    FORCES = [r for r in csv.DictReader(file) if r["assembly"] == "type2" and float(r["mu_r"]) == 0.005]
curves = []
for p in sorted({float(r["p"]) for r in FORCES}):
    scale = max(1.0, p)
    curves.append((f"P* = {p:.3g}", [(float(r["normal_force"]) / scale, float(r["density"]) * scale)
                                     for r in FORCES if float(r["p"]) == p]))
curves = [(name, [(x, y) for x, y in points if abs(x) < 6]) for name, points in curves]
every = [point for _, points in curves for point in points]
if every:
    plot = Plot("Normal forces, type 2, μR/a = 0.005", "F_N / max(F0, Pa)", "density",
                [x for x, _ in every], [y for _, y in every], logy=True)
    for (name, points), color in zip(curves, COLORS):
        plot.line(name, points, color, dots=False)
    plot.save("forces.svg")
