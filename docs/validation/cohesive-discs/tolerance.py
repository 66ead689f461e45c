"""Run time against error for the tolerance of equilibrium and the strain-rate cap.

usage: tolerance.py [SERVER]     with a server: collects the sweep `tolerance type1` into tolerance.csv first

Type 1, N = 400, μ_R = 0.005 a: up to the first stop all tolerances share one trajectory, so what a looser one leaves
out is its error, free of the scatter of samples. The cap changes the trajectory from the start: there the differences
hold that scatter. Prints the table and draws tolerance.svg. Standard library only.
"""
import csv
import json
import math
import pathlib
import statistics
import sys
import urllib.request

HERE = pathlib.Path(__file__).parent
COLUMNS = ["seed", "tolerance", "ia", "steps", "converged", "phi", "z", "bulk", "shear", "residual_force", "residual_moment",
           "residual_stress", "residual_kinetic", "kernel", "physics_version"]
if len(sys.argv) > 1:
    server = sys.argv[1].rstrip("/") + "/v1"
    read = lambda url: urllib.request.urlopen(url).read().decode()
    sweep = next(s for s in json.loads(read(f"{server}/sweeps"))["items"] if s["name"] == "tolerance type1")
    rows = [json.loads(line) for line in read(f"{server}/sweeps/{sweep['id']}/states?format=ndjson").splitlines()]
    rows.sort(key=lambda r: (r["ia"], r["tolerance"], r["seed"]))
    with open(HERE / "tolerance.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(COLUMNS)
        out.writerows([row.get(name, "") for name in COLUMNS] for row in rows)
with open(HERE / "tolerance.csv") as file:
    ROWS = [{k: float(v) for k, v in row.items() if k not in ("converged", "kernel") and v} for row in csv.DictReader(file)]


def group(tolerance, cap):
    return {r["seed"]: r for r in ROWS if r["tolerance"] == tolerance and r["ia"] == cap}


def told(values, digits=2):
    values = list(values)
    error = statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else math.nan
    return f"{statistics.fmean(values):.{digits}g} ± {error:.1g}"


tolerances = sorted({r["tolerance"] for r in ROWS})
caps = sorted({r["ia"] for r in ROWS})
exact, usual = group(tolerances[0], 0.05), group(1.0, 0.05)
print("| tolerance / paper's | cap I_a | samples | steps [1000] | Φ − Φ_tight | z − z_tight | B/B_tight − 1 | G/G_tight − 1 |\n|---|---|---|---|---|---|---|---|")
errors = []
for tolerance, cap in [(t, 0.05) for t in tolerances] + [(1.0, c) for c in caps if c != 0.05]:
    rows, against = group(tolerance, cap), exact if cap == 0.05 else usual
    seeds = sorted(rows.keys() & against.keys())
    if not seeds:
        continue
    steps = statistics.fmean(rows[s]["steps"] for s in seeds)
    change = lambda name: [rows[s][name] - against[s][name] for s in seeds]
    ratio = lambda name: [rows[s][name] / against[s][name] - 1 for s in seeds if name in rows[s] and name in against[s]] or [math.nan]
    print(f"| {tolerance:g} | {cap:g} | {len(seeds)} | {steps / 1000:.0f} | {told(change('phi'))} | {told(change('z'))} | "
          f"{told(ratio('bulk'))} | {told(ratio('shear'))} |")
    if cap == 0.05 and tolerance > tolerances[0]:
        errors.append((steps / 1000, statistics.fmean(abs(v) for v in change("phi")), statistics.fmean(abs(v) for v in change("z")), tolerance))

parts = ['<text x="330" y="22" text-anchor="middle" font-size="15">Error of an equilibrium state and steps to it, type 1, N = 400</text>',
         '<text x="330" y="436" text-anchor="middle">tolerance over the paper&#39;s</text>',
         '<rect x="70" y="35" width="520" height="360" fill="none" stroke="#444"/>']
px = lambda x: 110 + 140 * math.log10(x)
py = lambda y: 385 - 340 * (math.log10(max(y, 1e-11)) + 11) / 12
for decade in range(-10, 2, 2):
    parts.append(f'<text x="64" y="{py(10.0 ** decade) + 4:.1f}" text-anchor="end">1e{decade}</text>')
for steps, _, _, tolerance in errors:
    parts.append(f'<text x="{px(tolerance):.1f}" y="412" text-anchor="middle">{tolerance:g}</text>')
    parts.append(f'<text x="{px(tolerance):.1f}" y="50" text-anchor="middle">{steps:.0f} 000 steps</text>')
for column, name, color in ((1, "|Φ − Φ_tight|", "#0072B2"), (2, "|z − z_tight|", "#D55E00")):
    seen = [e for e in errors if e[column] > 0]
    parts += [f'<circle cx="{px(e[3]):.1f}" cy="{py(e[column]):.1f}" r="3" fill="{color}"/>' for e in seen]
    parts.append(f'<polyline fill="none" stroke="{color}" points="' + " ".join(f"{px(e[3]):.1f},{py(e[column]):.1f}" for e in seen) + '"/>')
    parts.append(f'<text x="470" y="{320 + 18 * column}" fill="{color}">{name}</text>')
(HERE / "tolerance.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg" width="610" height="446" font-family="sans-serif" '
                                    'font-size="12"><rect width="100%" height="100%" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n")
