"""Hours of the 291-run study at n = 17 657 on two cores, from full-size runs and the counts of the study at n = 1000.

python3 hours.py NANOSECONDS…: a particle-step on one core, two scenes side by side. Standard library only.

The stop rule is that of physics version 4. A full-size run takes R times the simulated time of the same point at n = 1000
(e drift 1e-3 both); a point that was run counts with its own steps, the others with the mean R of their group: σc below p, where
the packing forms from a gas, or not. Runs of version 3 count where e, not the walls, was the last to settle (drift of e near 1e-3
at their end): both versions then end at the same step.
The time step is the full-size one: 0.13 τ, less for strong damping and light walls.
"""
import csv
import math
import pathlib
import statistics
import sys

HERE = pathlib.Path(__file__).parent
N, CORES, LONGEST = 17657, 2, 10
KEYS = ["sigma_c", "p", "sigma_e", "alpha_n", "mw", "ei"]
NAMES = ["σc [MPa]", "p [MPa]", "σe [GPa]", "α_n", "m_w", "e_i"]


def key(row):
    return tuple(f"{float(row[k]):.6g}" for k in KEYS)


def read(name, *marks):
    path = HERE / name
    if not path.exists():
        return []
    with open(path) as file:
        return [r for r in csv.DictReader(file) if not marks or r["mark"] in marks]


def dt(row):
    alpha, mw = float(row["alpha_n"]), float(row["mw"])
    if mw == 24:
        return 0.050
    return 0.065 if alpha == 0.9 else 0.11 if alpha == 0.5 else 0.13


def table(head, lines):
    print("| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|")
    for line in lines:
        print("| " + " | ".join(line) + " |")
    print()


def place(k):
    return [f"{float(k[0]) / 1e6:.3g}", f"{float(k[1]) / 1e6:g}", f"{float(k[2]) / 1e9:.3g}", *k[3:]]


def value(row, name, digits):
    return f"{float(row[name]):.{digits}f}" if row and row[name] else "–"


def limit_of_z(row):
    return f"{float(row['z_plus_limit']) + float(row['z_minus_limit']):.3f}"


def spread_of(values):
    """Mean of logarithms, their scatter, standard error of the mean."""
    return statistics.fmean(values), statistics.stdev(values), statistics.stdev(values) / math.sqrt(len(values))


def about(sample):
    center, width, share = sample
    return f"{math.exp(center):.2f}, from point to point a factor {math.exp(width):.2f}, of the mean ± {100 * share:.0f} %"


def mean_of(sample):
    return math.exp(sample[0] + sample[1] ** 2 / 2)


# n = 1000: time to settled e, by versions 3 (walls by samples of their force) and 4 (by their momentum)
before = {key(r): r for r in read("../study-n1000/results.csv")}
small = {**before, **{key(r): r for r in read("../study-n1000/version-4.csv")}}
time_at = lambda k: float(small[k]["sim_time"])
counts = {k: time_at(k) / dt(r) for k, r in small.items()}
counts_before = {k: float(r["sim_time"]) / dt(r) for k, r in before.items()}
longest = sorted(counts_before, key=counts_before.get, reverse=True)[:LONGEST]
missing = 291 / len(counts)

# full size: settled by version 3 where e was last, by version 4 where it was run
double = {key(r): r for r in read("settled.csv", "end") + read("longest.csv", "settled")}
mixed = {key(r): r for r in read("settled-mixed.csv", "end") + read("longest-mixed.csv", "settled", "end")}
again = {key(r): r for r in read("settled-4.csv", "end") + read("longest-4.csv", "settled")}
by_walls = {k for k, r in {**mixed, **double}.items() if k in again or float(r["e_drift"]) < 5e-4}
known = {k: r for k, r in {**mixed, **double, **again}.items() if k in again or k not in by_walls}
loose = lambda k: float(k[0]) < float(k[1])

print("To settled e:\n")
lines = []
for k in sorted(known, key=lambda k: float(known[k]["steps"])):
    r, old = known[k], double.get(k) or mixed[k] if k in double or k in mixed else None
    lines.append(place(k) + ["double" if k in double and k not in again else "mixed", r["steps"], value(r, "dt", 3), value(r, "sim_time", 0), f"{time_at(k):.0f}",
                             f"{float(r['sim_time']) / time_at(k):.2f}", value(r, "cpu_s", 0), value(r, "e", 4), value(r, "z", 3), value(r, "z_plus", 3),
                             value(r, "z_minus", 3), value(r, "beta_plus", 2), value(r, "beta_minus", 2),
                             old["steps"] + (", the same" if k not in by_walls else "") if old else "not run", value(old, "e", 4) if old and k in by_walls else ""])
table(NAMES + ["precision", "steps", "dt [τ]", "time [τ]", "time at n = 1000 [τ]", "ratio", "CPU [s]", "e", "Z", "Z+", "Z−", "β+", "β−", "steps by version 3", "its e"], lines)
missed = [" ".join(place(k)[:3]) for k in longest if k not in known]
print(f"of the ten longest by version 3 not run: {'; '.join(missed) or 'none'}\n")

logs = {k: math.log(float(r["sim_time"]) / time_at(k)) for k, r in known.items()}
groups = {group: spread_of([v for k, v in logs.items() if loose(k) == group]) for group in (True, False)}
todo = {group: sum(c for k, c in counts.items() if k not in known and loose(k) == group) for group in groups}
measured = sum(float(r["steps"]) for r in known.values())
settled = missing * (measured + sum(todo[g] * mean_of(groups[g]) for g in groups))
wrong = missing * math.hypot(*(todo[g] * mean_of(groups[g]) * groups[g][2] for g in groups))
for group, text in [(True, "σc < p"), (False, "σc ≥ p")]:
    print(f"ratio R of {sum(loose(k) == group for k in logs)} points with {text}: {about(groups[group])}; "
          f"{todo[group] / 1e6:.1f} million steps of the others, counted at n = 1000")
print(f"steps of {len(counts)} runs at n = 1000 and the full-size time step: {sum(counts.values()) / 1e6:.1f} million (version 3: {sum(counts_before.values()) / 1e6:.1f}); "
      f"the ten longest of version 3 hold {100 * sum(counts[k] for k in longest) / sum(counts.values()):.0f} % ({100 * sum(counts_before[k] for k in longest) / sum(counts_before.values()):.0f} %)")
print(f"at full size: {settled / 1e6:.1f} ± {wrong / 1e6:.1f} million steps, {measured / 1e6:.2f} million of them measured")
for ns in map(float, sys.argv[1:] or ["28"]):
    hours = N * ns * 1e-9 / 3600 / CORES
    print(f"{ns:g} ns per particle-step: {settled * hours:.2f} h to settled e ({(settled - wrong) * hours:.2f} to {(settled + wrong) * hours:.2f}) on {CORES} cores; "
          f"longest run measured {max(float(r['steps']) for r in known.values()) * hours * CORES:.2f} h on one")

print("\nTo `evidence`:\n")
# `evidence` marks the row, to 2 % of the steps, at which a run of version 3 met all of the rule but the walls; `cut` one that was left before
ends = {}
left = [r | {"mark": "cut"} for r in read("longest-mixed.csv", "settled") if key(r) in by_walls]
for rows in (left, read("longest-mixed.csv", "cut"), read("longest-4.csv", "cut"), read("evidence-3.csv", "end"), read("longest-mixed.csv", "evidence"), read("longest-4.csv", "end")):
    for r in rows:
        # of two runs that were left, the longer
        longer = r["mark"] != "cut" or float(r["steps"]) > max(float(f[key(r)]["steps"]) for f in (known, ends) if key(r) in f)
        if key(r) in known and longer:
            ends[key(r)] = r
lines, factors = [], {}
for k, r in sorted(ends.items(), key=lambda pair: float(pair[1]["steps"])):
    factors[k] = float(r["steps"]) / float(known[k]["steps"])
    more = "> " if r["mark"] == "cut" else ""
    says = {"end": r["status"], "evidence": "met", "cut": f"left, `z_rest` {value(r, 'z_rest', 2)}"}[r["mark"]]
    lines.append(place(k)[:5] + [says, more + r["steps"], f"{more}{factors[k]:.2f}", value(r, "cpu_s", 0), value(r, "e", 4), value(r, "z", 3), value(r, "z_plus", 3), value(r, "z_minus", 3),
                                 limit_of_z(r), value(r, "z_plus_limit", 3), value(r, "z_minus_limit", 3), value(r, "beta_plus", 2), value(r, "beta_minus", 2)])
table(NAMES[:5] + ["status", "steps", "steps/settled", "CPU [s]", "e", "Z", "Z+", "Z−", "Z limit", "Z+ limit", "Z− limit", "β+", "β−"], lines)
factor = spread_of([math.log(f) for f in factors.values()])
done = sum(float(r["steps"]) for r in ends.values())
remaining = settled / missing - sum(float(known[k]["steps"]) for k in ends)
whole = missing * (done + remaining * mean_of(factor))
total = math.hypot(wrong / settled, factor[2])
cut = sum(r["mark"] == "cut" for r in ends.values())
print(f"steps to `evidence` over steps to settled, {len(factors)} points ({cut} of them left before, counted as they were left): {about(factor)}; by their sums "
      f"{done / sum(float(known[k]['steps']) for k in ends):.2f}; {whole / 1e6:.0f} million steps, {done / 1e6:.2f} million of them measured")
for ns in map(float, sys.argv[1:] or ["28"]):
    hours = whole * N * ns * 1e-9 / 3600 / CORES
    print(f"{ns:g} ns per particle-step: {hours:.1f} h to `evidence` ({hours * math.exp(-total):.1f} to {hours * math.exp(total):.1f}) on {CORES} cores")

gas = missing * sum(float(known[k]["steps"]) if k in known else c * mean_of(groups[True]) for k, c in counts.items() if loose(k))
for times in (10, 13.4):
    most = whole + (times - mean_of(factor)) * gas
    print(f"if every run with σc < p took {times:g} times its steps to settled e: {most / 1e6:.0f} million steps, "
          + ", ".join(f"{most * N * ns * 1e-9 / 3600 / CORES:.1f} h at {ns:g} ns" for ns in map(float, sys.argv[1:] or ["28"])))
limits = missing * sum(20 * 0.452 * (float(r["sigma_e"]) / float(r["p"])) ** 0.7 / dt(r) for r in small.values())
print(f"all to the step limit, 20 settling times 0.452 (σe/p)^0.7 τ: {limits / 1e6:.0f} million steps")
