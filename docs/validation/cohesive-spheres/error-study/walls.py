"""What the balance of the walls costs the rule `settled`: stop-n1000 with it, judged by samples of the force, and without.

python3 walls.py   # numpy; prints Markdown from stop-n1000.csv and stop-n1000.series.csv.gz beside it

Physics version 4 takes the balance from the walls' momentum, which these series do not have; it is met when e stands still or
soon after, so version 4 lies between the two columns, near the second.
"""
import collections
import csv
import gzip
import pathlib

import numpy as np

HERE = pathlib.Path(__file__).parent
series, place = collections.defaultdict(list), {}
with gzip.open(HERE / "stop-n1000.series.csv.gz", "rt") as file:
    for row in csv.DictReader(file):
        series[row["scene"]].append(row)
with open(HERE / "stop-n1000.csv") as file:
    for row in csv.DictReader(file):
        if row["mark"] == "end":
            place[row["scene"]] = tuple(float(row[k]) for k in ["sigma_c", "p", "sigma_e"])

found = collections.defaultdict(list)
for scene, rows in series.items():
    get = {k: np.array([float(r[k]) for r in rows]) for k in ["step", "t", "e", "unbalanced_force"]}
    walls = np.array([[float(r[f"wall_{w}"]) for w in range(1, 7)] for r in rows])
    t, e = get["t"], get["e"]
    end = e[t >= 0.9 * t[-1]].mean()
    stops = {}
    for k in range(len(t)):
        first = max(np.searchsorted(t, t[k] / 1.25) - 1, 0)
        if k - first < 3 or t[first] > t[k] / 1.25:
            continue
        if np.ptp(e[first:k + 1]) <= 1e-3 and get["unbalanced_force"][k] <= 0.5:
            imbalance = np.max(np.abs(walls[first:k + 1].mean(axis=0) - 1))
            stops.setdefault("without", (get["step"][k], e[k] - end, imbalance))
            if imbalance <= 0.01:
                stops.setdefault("with", (get["step"][k], e[k] - end, imbalance))
                break
    found[place[scene]].append(stops)

print("| σc [MPa] | p [MPa] | σe [GPa] | runs | steps with walls | without | Δe with | without | imbalance by samples, without |\n" + "|---" * 9 + "|")
for where, runs in sorted(found.items()):
    mean = lambda rule, column: np.mean([run[rule][column] for run in runs])
    print(f"| {where[0] / 1e6:g} | {where[1] / 1e6:g} | {where[2] / 1e9:g} | {len(runs)} | {mean('with', 0):.0f} | {mean('without', 0):.0f} | {mean('with', 1):+.5f} | "
          f"{mean('without', 1):+.5f} | {mean('without', 2):.3f} |")
for rule in ["with", "without"]:
    values = np.array([run[rule] for runs in found.values() for run in runs])
    print(f"\n{rule} walls: Δe {values[:, 1].mean():+.5f} ± {values[:, 1].std(ddof=1) / np.sqrt(len(values)):.5f}, median of steps {np.median(values[:, 0]):.0f}, sum {values[:, 0].sum():.0f}")
