"""Hours of the 291-run study at n = 17 657 on two cores, from full-size runs and the counts of the study at n = 1000.

python3 hours.py NANOSECONDS…: a particle-step on one core, two scenes side by side. Standard library only.

A full-size run takes R times the simulated time of the same point at n = 1000 (e drift 1e-3 both); R is measured on the
points of settled.csv and on those of the ten longest that are in longest.csv; a point that was run counts with its own
steps. The time step is the full-size one: 0.13 τ, less for strong damping and light walls.
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


def dt(row):
    alpha, mw = float(row["alpha_n"]), float(row["mw"])
    if mw == 24:
        return 0.050
    return 0.065 if alpha == 0.9 else 0.11 if alpha == 0.5 else 0.13


LONGEST = 10
ranked = sorted(small.values(), key=lambda r: float(r["sim_time"]) / dt(r), reverse=True)
counts = {key(r): float(r["sim_time"]) / dt(r) for r in ranked}
longest = [key(r) for r in ranked[:LONGEST]]
missing = 1 + (291 - len(counts)) / 291

# the longest ten, run at full size: where e counts as settled, and their ends
measured, ended, others = {}, {}, {}
for r in read(HERE / "longest.csv") + read(HERE / "longest-mixed.csv"):
    # A point that was run in both precisions counts as it went in double.
    if r["mark"] == "settled":
        measured.setdefault(key(r), r)
    if r["mark"] == "end":
        ended[key(r)] = r
    if r["mark"] == "cut":
        others[key(r)] = r
print("\nThe ten longest of the study:\n\n| σc [MPa] | p [MPa] | σe [GPa] | steps from n = 1000, R = 1 | steps | time [τ] | ratio | CPU [s] | ns per particle-step | e | Z | "
      "`evidence`: status | steps | steps/settled | CPU [s] | e | Z | Z limit |\n" + "|---" * 18 + "|")
for k in longest:
    r, last = measured.get(k), ended.get(k)
    cells = [f"{float(k[0]) / 1e6:.3g}", f"{float(k[1]) / 1e6:g}", f"{float(k[2]) / 1e9:.3g}", f"{counts[k]:.0f}"]
    if r:
        cells += [r["steps"], f"{float(r['sim_time']):.0f}", f"{float(r['sim_time']) / float(small[k]['sim_time']):.2f}", f"{float(r['cpu_s']):.0f}",
                  f"{float(r['cpu_s']) * 1e9 / float(r['steps']) / N:.0f}", f"{float(r['e']):.4f}", f"{float(r['z']):.3f}"]
    elif k in others:
        cells += [f"> {others[k]['steps']} (cut)", f"> {float(others[k]['sim_time']):.0f}", "", f"> {float(others[k]['cpu_s']):.0f}", "", others[k]["e"], others[k]["z"]]
    else:
        cells += ["not run"] + [""] * 6
    if last:
        limits = float(last["z_plus_limit"]) + float(last["z_minus_limit"])
        cells += [last["status"], last["steps"], f"{float(last['steps']) / float(r['steps']):.2f}", f"{float(last['cpu_s']):.0f}", f"{float(last['e']):.4f}",
                  f"{float(last['z']):.3f}", f"{limits:.3f}"]
    else:
        cells += ["not run to it"] + [""] * 6
    print("| " + " | ".join(cells) + " |")


def spread_of(values):
    """Mean of logarithms, their scatter, standard error of the mean."""
    if len(values) < 2:
        return statistics.fmean(values), math.nan, math.nan
    return statistics.fmean(values), statistics.stdev(values), statistics.stdev(values) / math.sqrt(len(values))


def about(sample):
    center, width, share = sample
    return f"{math.exp(center):.2f}, from point to point a factor {math.exp(width):.2f}, of the mean ± {100 * share:.0f} %"


# settled: measured steps where there are any, else the count at n = 1000 times the mean ratio of its group
rest = spread_of(ratios)
own = [math.log(float(r["sim_time"]) / float(small[k]["sim_time"])) for k, r in measured.items()]
long = spread_of(own) if len(own) > 1 else rest
mean_of = lambda sample: math.exp(sample[0] + sample[1] ** 2 / 2)
known = {k: float(r["steps"]) for k, r in {**{key(r): r for r in full}, **measured}.items()}
groups = {True: 0.0, False: 0.0}
for k, count in counts.items():
    if k not in known:
        groups[k in longest] += count
settled = missing * (sum(known.values()) + groups[True] * mean_of(long) + groups[False] * mean_of(rest))
parts = [groups[True] * mean_of(long) * long[2], groups[False] * mean_of(rest) * rest[2]]
# one ratio for both groups is wrong for both at once
wrong = missing * (sum(parts) if long is rest else math.hypot(*parts))
print(f"\nratio R of the {len(ratios)} points: {about(rest)}")
print(f"ratio R of {len(own)} of the ten longest: {about(long) if len(own) > 1 else ', '.join(f'{math.exp(r):.2f}' for r in own)}")
print(f"steps of {len(counts)} runs at n = 1000 and the full-size time step: {sum(counts.values()) / 1e6:.1f} million; the ten longest hold "
      f"{100 * sum(counts[k] for k in longest) / sum(counts.values()):.0f} %; measured at full size: {sum(known.values()) / 1e6:.1f} million "
      f"of {settled / 1e6:.1f} ± {wrong / 1e6:.1f} million")
for ns in map(float, sys.argv[1:] or ["30"]):
    hours = N * ns * 1e-9 / 3600 / CORES
    print(f"{ns:g} ns per particle-step: {settled * hours:.1f} h to settled e ({(settled - wrong) * hours:.1f} to {(settled + wrong) * hours:.1f}) on {CORES} cores; "
          f"longest run measured {max(known.values()) * hours * CORES:.2f} h on one")

whole_ends = {**{key(r): r for r in read(HERE / "evidence-3.csv") if r["mark"] == "end"}, **ended}
both = [(float(r["steps"]), known[k], r) for k, r in whole_ends.items() if k in known]
print("\n| σc [MPa] | p [MPa] | σe [GPa] | α_n | m_w | status | steps | steps/settled | CPU [s] | ns per particle-step | e | Z | Z+ | Z− | Z limit | Z+ limit | Z− limit | β+ | β− |\n" + "|---" * 19 + "|")
for steps_to, before, r in both:
    value = lambda name, digits: f"{float(r[name]):.{digits}f}" if r[name] else "–"
    limits = float(r["z_plus_limit"]) + float(r["z_minus_limit"])
    print("| " + " | ".join([f"{float(r['sigma_c']) / 1e6:.3g}", f"{float(r['p']) / 1e6:g}", f"{float(r['sigma_e']) / 1e9:.3g}", f"{float(r['alpha_n']):g}", f"{float(r['mw']):g}",
                              r["status"], f"{steps_to:.0f}", f"{steps_to / before:.2f}", f"{float(r['cpu_s']):.0f}", f"{float(r['cpu_s']) * 1e9 / steps_to / N:.0f}", value("e", 4), value("z", 3),
                              value("z_plus", 3), value("z_minus", 3), f"{limits:.3f}", value("z_plus_limit", 3), value("z_minus_limit", 3), value("beta_plus", 2), value("beta_minus", 2)]) + " |")
factor = spread_of([math.log(a / b) for a, b, _ in both])
done = {k: float(r["steps"]) for k, r in whole_ends.items()}
remaining = settled / missing - sum(known[k] for k in done if k in known)
whole = missing * (sum(done.values()) + remaining * mean_of(factor))
total = math.hypot(wrong / settled, factor[2])
print(f"\nsteps to `evidence` over steps to settled, {len(both)} points: {about(factor)}; by their sums {sum(b[0] for b in both) / sum(b[1] for b in both):.2f}; "
      f"{whole / 1e6:.0f} million steps, {sum(done.values()) / 1e6:.1f} million of them measured")
for ns in map(float, sys.argv[1:] or ["30"]):
    hours = whole * N * ns * 1e-9 / 3600 / CORES
    print(f"{ns:g} ns per particle-step: {hours:.1f} h to `evidence` ({hours * math.exp(-total):.1f} to {hours * math.exp(total):.1f}) on {CORES} cores")


def limit(row):
    """Step limit of the rule `evidence`: 20 settling times 0.452 (σe/p)^0.7 τ."""
    return 20 * 0.452 * (float(row["sigma_e"]) / float(row["p"])) ** 0.7 / dt(row)


limits = sum(limit(r) for r in small.values()) * missing
print(f"all to the step limit of `evidence`: {limits / 1e6:.0f} million steps, {limits * N * 30e-9 / 3600 / CORES:.0f} h at 30 ns")
