"""How d_F and ξ depend on the function and the range of the fit to I(k): reads scattering.csv, prints a table.

smooth  I_0 [1 + (kξ/2π)²]^(−d_F/2), the function of the service
broken  I_0 for k < 2π/ξ, I_0 (kξ/2π)^(−d_F) above: the words of the 2008 study, section IV
Least squares in ln I, shells weighted by k^w: w = 1 as by their number of wave vectors, 0 as one fits points of a plot, −1 as by
their share of an axis of ln k. Single samples with w = 1, mean curves with all three. Standard library only.
"""
import collections
import csv
import math
import pathlib
import statistics

HERE = pathlib.Path(__file__).parent
samples = collections.defaultdict(list)
with open(HERE / "scattering.csv") as file:
    for row in csv.DictReader(file):
        samples[int(row["n"]), float(row["mu_r"]), float(row["p"]), int(row["seed"])].append((float(row["k"]), float(row["intensity"])))


def smooth(x):
    return 0.5 * math.log1p(x * x)


def broken(x):
    return max(0.0, math.log(x))


def cost(shells, shape, xi, power):
    """Best slope at this ξ by linear regression of ln I on the shape: (cost, d_F)."""
    rows = [(k ** power, shape(k * xi / (2 * math.pi)), math.log(intensity)) for k, intensity in shells]
    total = sum(w for w, _, _ in rows)
    mx = sum(w * x for w, x, _ in rows) / total
    my = sum(w * y for w, _, y in rows) / total
    sxx = sum(w * (x - mx) ** 2 for w, x, _ in rows)
    if sxx == 0:
        return math.inf, 0.0
    slope = sum(w * (x - mx) * (y - my) for w, x, y in rows) / sxx
    return sum(w * (y - my - slope * (x - mx)) ** 2 for w, x, y in rows) / total, -slope


def fit(shells, shape, power=1):
    lengths = [2 * 1.01 ** n for n in range(320)]
    best = min(lengths, key=lambda xi: cost(shells, shape, xi, power)[0])
    error, dimension = cost(shells, shape, best, power)
    return best, dimension, math.sqrt(error)


def told(values):
    if len(values) == 1:
        return f"{values[0]:.2f}"
    return f"{statistics.fmean(values):.2f} ± {statistics.stdev(values) / math.sqrt(len(values)):.2f}"


print("| N | μ_R/a | P* | k below [1/a] | function | samples | d_F | ξ [a] | rms of ln I |\n|---|---|---|---|---|---|---|---|---|")
def averaged(curves):
    """Shell by shell, in the order of k: the cells of the samples differ a little."""
    return [tuple(statistics.fmean(c) for c in zip(*shells)) for shells in zip(*curves)]


def jackknife(curves, shape, power):
    """Fit of the mean curve: d_F, ξ, rms, with the error of leaving one sample out."""
    whole = fit(averaged(curves), shape, power)
    parts = [fit(averaged([c for c in curves if c is not left]), shape, power) for left in curves]
    share = (len(curves) - 1) / len(curves)
    errors = [math.sqrt(share * sum((part[k] - whole[k]) ** 2 for part in parts)) for k in range(3)]
    return [f"{whole[k]:.2f} ± {errors[k]:.2f}" for k in (1, 0, 2)]


for n, mu_r, p in sorted({key[:3] for key in samples}):
    for largest in (2.0, math.pi, 4.5, 6.3):
        for shape in (smooth, broken):
            curves = [[s for s in samples[key] if s[0] <= largest] for key in sorted(samples) if key[:3] == (n, mu_r, p)]
            found = [fit(curve, shape) for curve in curves]
            print(f"| {n} | {mu_r:g} | {p:g} | {largest:.2f} | {shape.__name__} | {len(found)} | {told([f[1] for f in found])} | "
                  f"{told([f[0] for f in found])} | {told([f[2] for f in found])} |")
            for power in (1, 0, -1) if len(curves) > 1 else ():
                print(f"| {n} | {mu_r:g} | {p:g} | {largest:.2f} | {shape.__name__}, mean curve, w = {power} | {len(found)} | "
                      + " | ".join(jackknife(curves, shape, power)) + " |")
