"""What the parameters of eq. (9) hang on: fits to the mean curve of type 2 (states.csv) with λ held, on several ranges.

For every μ_R/a: λ as fitted freely on the straight part by (7), the slope of the paper's own curve on the same points, and
α, P*1, Φmax of (9) with λ held at the paper's value. Errors: jackknife over samples. Standard library only."""
import collections
import csv
import itertools
import math
import pathlib
import statistics

HERE = pathlib.Path(__file__).parent
TABLE_3 = {0.0: (0.0237, 0.469, 0.349, 0.91, 0.271), 0.005: (0.0316, 0.515, 0.194, 1.08, 0.9),
           0.5: (0.0178, 0.382, 0.25, 0.86, 2.6)}
STRAIGHT = {0.0: (0.042, 0.134), 0.005: (0.056, 0.178), 0.5: (0.042, 0.317)}
curves = collections.defaultdict(dict)
with open(HERE / "states.csv") as file:
    for row in csv.DictReader(file):
        if row["assembly"] == "type2" and row["n"] == "1400" and row["branch"] in ("assembly", "compression"):
            curves[float(row["mu_r"])].setdefault(int(row["seed"]), {})[round(float(row["p"]), 6)] = 1 / float(row["phi"])


def bend(p, alpha, p1):
    """ln{P* [1 − exp(−(P*1/P*)^α)]^(1/α)}"""
    return math.log(p) + math.log(-math.expm1(-((p1 / p) ** alpha))) / alpha


def paper(mu_r, p):
    p0, phi_0, slope, alpha, p1 = TABLE_3[mu_r]
    return 1 / phi_0 - slope * (bend(p, alpha, p1) - math.log(p0))


def line(points):
    mx, my = (statistics.fmean(c) for c in zip(*points))
    return -sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points)


def mean(samples, low, high):
    pressures = sorted(p for p in samples[0] if low * 0.999 <= p <= high * 1.001)
    return [(p, statistics.fmean(s[p] for s in samples)) for p in pressures]


def held(points, slope):
    """α, P*1 and the shift with λ held: grid in (α, ln P*1), refined; returns (P*1, α, Φmax)."""
    best, centre, width = None, (1.0, 0.0), (0.7, 3.0)
    for _ in range(9):
        for i, j in itertools.product(range(-8, 9), repeat=2):
            alpha, log_p1 = centre[0] + width[0] * i / 8, centre[1] + width[1] * j / 8
            if alpha < 0.2:
                continue
            shape = [(y + slope * bend(p, alpha, math.exp(log_p1))) for p, y in points]
            shift = statistics.fmean(shape)
            cost = sum((s - shift) ** 2 for s in shape)
            if best is None or cost < best[0]:
                best = (cost, alpha, log_p1, shift)
        centre, width = best[1:3], (width[0] / 2, width[1] / 2)
    return math.exp(best[2]), best[1], 1 / (best[3] - slope * best[2])


def told(samples, measure):
    whole = measure(samples)
    parts = [measure([s for s in samples if s is not left]) for left in samples]
    count = len(samples)
    cells = []
    for k, value in enumerate(whole):
        error = math.sqrt((count - 1) / count * sum((part[k] - value) ** 2 for part in parts))
        cells.append(f"{value:.3f} ± {error:.3f}")
    return cells


print("| μ_R/a | samples | λ of (7) on P* | | the paper's curve on the same points | λ held | from P* | P*1 | α | Φmax |\n"
      "|---|---|---|---|---|---|---|---|---|---|")
for mu_r, by_seed in sorted(curves.items()):
    samples = [by_seed[seed] for seed in sorted(by_seed)]
    low, high = STRAIGHT[mu_r]
    free, = told(samples, lambda s: [line([(math.log(p), y) for p, y in mean(s, low, high)])])
    theirs = line([(math.log(p), paper(mu_r, p)) for p, _ in mean(samples, low, high)])
    slope = TABLE_3[mu_r][2]
    for start in (low, 0.2):
        p1, alpha, phi_max = told(samples, lambda s: held(mean(s, start, 20), slope))
        print(f"| {mu_r:g} | {len(samples)} | {low:g} … {high:g} | {free} | {theirs:.3f} | {slope:g} | {start:g} | {p1} | {alpha} | {phi_max} |")
