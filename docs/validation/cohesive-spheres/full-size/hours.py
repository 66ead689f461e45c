"""Hours of the 291-run study at n = 17 657 on two cores, from full-size runs and the counts of the study at n = 1000.

python3 hours.py NANOSECONDS…: a particle-step on one core, two scenes side by side. Standard library only.

A full-size run takes R times the simulated time of the same point at n = 1000 (e drift 1e-3 both); R is measured on the
points of settled.csv. The time step is the full-size one: 0.13 τ, less for strong damping and light walls.
"""
import csv
import math
import pathlib
import statistics
import sys

HERE = pathlib.Path(__file__).parent
N, CORES = 17657, 2
KEYS = ["sigma_c", "p", "sigma_e", "alpha_n", "mw", "ei"]


def key(row):
    return tuple(f"{float(row[k]):.6g}" for k in KEYS)


def read(path):
    with open(path) as file:
        return list(csv.DictReader(file))


small = {key(r): r for r in read(HERE.parent / "study-n1000" / "results.csv")}
full = [r for r in read(HERE / "settled.csv") if r["mark"] == "end"]
ratios = []
print("| " + " | ".join(["σc [MPa]", "p [MPa]", "σe [GPa]", "α_n", "m_w", "e_i", "status", "steps", "dt [τ]", "time [τ]", "time at n = 1000 [τ]",
                          "ratio", "CPU [s]", "ns per particle-step", "e", "Z", "Z+", "Z−", "β+", "β−"]) + " |")
print("|" + "---|" * 20)
for r in full:
    t, t1000 = float(r["sim_time"]), float(small[key(r)]["sim_time"])
    ratios.append(math.log(t / t1000))
    short = lambda name, digits: f"{float(r[name]):.{digits}f}" if r[name] else "–"
    print("| " + " | ".join([f"{float(r['sigma_c']) / 1e6:.3g}", f"{float(r['p']) / 1e6:g}", f"{float(r['sigma_e']) / 1e9:.3g}", f"{float(r['alpha_n']):g}",
                              f"{float(r['mw']):g}", f"{float(r['ei']):g}", r["status"], f"{float(r['steps']):.0f}", f"{float(r['dt']):.3f}", f"{t:.0f}",
                              f"{t1000:.0f}", f"{t / t1000:.2f}", f"{float(r['cpu_s']):.0f}", f"{float(r['cpu_s']) * 1e9 / float(r['steps']) / N:.0f}",
                              short("e", 4), short("z", 3), short("z_plus", 3), short("z_minus", 3), short("beta_plus", 2), short("beta_minus", 2)]) + " |")
middle, spread = statistics.fmean(ratios), statistics.stdev(ratios)
error = spread / math.sqrt(len(ratios))


def dt(row):
    alpha, mw = float(row["alpha_n"]), float(row["mw"])
    if mw == 24:
        return 0.050
    return 0.065 if alpha == 0.9 else 0.11 if alpha == 0.5 else 0.13


counts = sorted((float(r["sim_time"]) / dt(r) for r in small.values()), reverse=True)
missing = 291 - len(counts)
steps = sum(counts) * (1 + missing / 291)
print(f"\nratio R: {math.exp(middle):.2f}, from point to point a factor {math.exp(spread):.2f}, of the mean ± {100 * error:.0f} %")
print(f"steps of {len(counts)} runs at n = 1000 and the full-size time step: {sum(counts) / 1e6:.1f} million; the ten longest hold {100 * sum(counts[:10]) / sum(counts):.0f} %")
for ns in map(float, sys.argv[1:] or ["30"]):
    hours = steps * math.exp(middle + spread * spread / 2) * N * ns * 1e-9 / 3600 / CORES
    print(f"{ns:g} ns per particle-step: {hours:.1f} h to settled e on {CORES} cores; longest run {counts[0] * math.exp(middle) * N * ns * 1e-9 / 3600:.1f} h")


ended = {key(r): r for r in read(HERE / "evidence-3.csv") if r["mark"] == "end"}
both = [(float(ended[key(r)]["steps"]), float(r["steps"]), ended[key(r)]) for r in full if key(r) in ended]
print("\n| σc [MPa] | p [MPa] | σe [GPa] | α_n | m_w | status | steps | steps/settled | CPU [s] | ns per particle-step | e | Z | Z+ | Z− | Z limit | Z+ limit | Z− limit | β+ | β− |\n" + "|---" * 19 + "|")
for steps_to, before, r in both:
    value = lambda name, digits: f"{float(r[name]):.{digits}f}" if r[name] else "–"
    limits = float(r["z_plus_limit"]) + float(r["z_minus_limit"])
    print("| " + " | ".join([f"{float(r['sigma_c']) / 1e6:.3g}", f"{float(r['p']) / 1e6:g}", f"{float(r['sigma_e']) / 1e9:.3g}", f"{float(r['alpha_n']):g}", f"{float(r['mw']):g}",
                              r["status"], f"{steps_to:.0f}", f"{steps_to / before:.2f}", f"{float(r['cpu_s']):.0f}", f"{float(r['cpu_s']) * 1e9 / steps_to / N:.0f}", value("e", 4), value("z", 3),
                              value("z_plus", 3), value("z_minus", 3), f"{limits:.3f}", value("z_plus_limit", 3), value("z_minus_limit", 3), value("beta_plus", 2), value("beta_minus", 2)]) + " |")
factors = [math.log(a / b) for a, b, _ in both]
center, width = statistics.fmean(factors), statistics.stdev(factors)
share = width / math.sqrt(len(factors))
whole = steps * math.exp(middle + spread * spread / 2) * math.exp(center + width * width / 2)
print(f"\nsteps to `evidence` over steps to settled: {math.exp(center):.2f}, from point to point a factor {math.exp(width):.2f}, of the mean ± {100 * share:.0f} %; "
      f"{whole / 1e6:.0f} million steps")
for ns in map(float, sys.argv[1:] or ["30"]):
    hours = whole * N * ns * 1e-9 / 3600 / CORES
    total = math.hypot(error, share)
    print(f"{ns:g} ns per particle-step: {hours:.1f} h to `evidence` ({hours * math.exp(-total):.1f} to {hours * math.exp(total):.1f}) on {CORES} cores")


def limit(row):
    """Step limit of the rule `evidence`: 20 settling times 0.452 (σe/p)^0.7 τ."""
    return 20 * 0.452 * (float(row["sigma_e"]) / float(row["p"])) ** 0.7 / dt(row)


limits = sum(limit(r) for r in small.values()) * (1 + missing / 291)
print(f"all to the step limit of `evidence`: {limits / 1e6:.0f} million steps, {limits * N * 30e-9 / 3600 / CORES:.0f} h at 30 ns")
