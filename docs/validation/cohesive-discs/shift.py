"""How far curves of type 2 with small rolling resistance lie above Table III between P* = 0.056 and 0.42, where they
collapse: mean of Φ − Φ of eq. (9) over the eight pressures, per sample, then mean ± standard error over samples.

Reads states.csv (the default) and experiments.csv (labels of README.md). Standard library only."""
import collections
import csv
import math
import pathlib
import statistics

HERE = pathlib.Path(__file__).parent
P0, PHI_0, SLOPE, ALPHA, P1 = 0.0316, 0.515, 0.194, 1.08, 0.9
LOW, HIGH = 0.056, 0.43


def paper(p):
    return 1 / (1 / PHI_0 - SLOPE * math.log(p / P0 * (-math.expm1(-(P1 / p) ** ALPHA)) ** (1 / ALPHA)))


samples = collections.defaultdict(dict)
with open(HERE / "states.csv") as file:
    for row in csv.DictReader(file):
        if row["assembly"] == "type2" and float(row["mu_r"]) == 0.005 and row["branch"] in ("assembly", "compression"):
            samples[f"default, N = {row['n']}", row["seed"]][float(row["p"])] = float(row["phi"])
with open(HERE / "experiments.csv") as file:
    for row in csv.DictReader(file):
        if row["label"].startswith("r_") and row["branch"] == "compression":
            samples[row["label"], row["seed"]][float(row["p"])] = float(row["phi"])
away = {}
for key, curve in samples.items():
    differences = [phi - paper(p) for p, phi in curve.items() if LOW < p < HIGH]
    if len(differences) == 8:
        away[key] = statistics.fmean(differences)


def told(values):
    if not values:
        return "-"
    error = f" ± {statistics.stdev(values) / math.sqrt(len(values)):.4f}" if len(values) > 1 else ""
    return f"{statistics.fmean(values):+.4f}{error}"


print("| label | samples | mean of Φ − Table III | minus that of the default with the same seed |\n|---|---|---|---|")
for label in sorted({key[0] for key in away}):
    seeds = [seed for name, seed in away if name == label]
    base = None if label.startswith("default") or label == "r_n400" else "default, N = " + ("5600" if "big" in label else "1400")
    paired = [away[label, seed] - away[base, seed] for seed in seeds if (base, seed) in away]
    print(f"| {label} | {len(seeds)} | {told([away[label, seed] for seed in seeds])} | {told(paired)} |")
