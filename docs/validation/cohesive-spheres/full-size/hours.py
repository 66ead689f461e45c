"""Hours of the study at n = 17 657 on two cores: to settled e as it was run, to `evidence` from full-size runs that went on.

python3 hours.py NANOSECONDS…: a particle-step on one core, two scenes side by side. Standard library only.

A run that went on to `evidence` counts with its own steps. The others with σc ≥ p count with their steps to settled e times the mean
ratio of those that went on; of the others with σc < p, where Z creeps for long, every one counts to its step limit: an upper bound.
"""
import csv
import math
import pathlib
import statistics
import sys

HERE = pathlib.Path(__file__).parent
N, CORES = 17657, 2
KEYS = ["sigma_c", "p", "sigma_e", "alpha_n", "mw", "ei"]
NAMES = ["σc [MPa]", "p [MPa]", "σe [GPa]", "α_n", "m_w"]
#: Series and the marks of the rows that count: `evidence` is where a run of physics version 3 met all of the rule but its own
#: balance of walls; `cut` one that was left before its end.
SERIES = [("longest-mixed.csv", "cut"), ("longest-4.csv", "cut"), ("evidence-3.csv", "end"), ("longest-mixed.csv", "evidence"),
          ("longest-4.csv", "end"), ("end-5.csv", "end")]


def key(row):
    return tuple(f"{float(row[k]):.6g}" for k in KEYS)


def read(name):
    with open(HERE / name) as file:
        return list(csv.DictReader(file))


def value(row, name, digits):
    return f"{float(row[name]):.{digits}f}" if row[name] else "–"


study = {key(r): r for r in read("../study-n17657/results.csv")}
steps = {k: float(r["steps"]) for k, r in study.items()}
loose = lambda k: float(k[0]) < float(k[1])
ends = {key(r): r for name, mark in SERIES for r in read(name) if r["mark"] == mark and key(r) in study}
ratio = {k: float(r["steps"]) / steps[k] for k, r in ends.items()}

print("| " + " | ".join(NAMES + ["status", "steps", "steps/settled", "CPU [s]", "e", "e settled", "Z", "Z+", "Z−", "Z limit", "β+", "β−"]) + " |\n" + "|---" * 17 + "|")
for k, r in sorted(ends.items(), key=lambda pair: float(pair[1]["steps"])):
    says = {"end": r["status"], "evidence": "met", "cut": f"left, `z_rest` {value(r, 'z_rest', 2)}"}[r["mark"]]
    limit = f"{float(r['z_plus_limit']) + float(r['z_minus_limit']):.3f}"
    print("| " + " | ".join([f"{float(k[0]) / 1e6:.3g}", f"{float(k[1]) / 1e6:g}", f"{float(k[2]) / 1e9:.3g}", *k[3:5], says, ("> " if r["mark"] == "cut" else "") + r["steps"],
                             f"{ratio[k]:.2f}", value(r, "cpu_s", 0), value(r, "e", 4), value(study[k], "e", 4), value(r, "z", 3), value(r, "z_plus", 3),
                             value(r, "z_minus", 3), limit, value(r, "beta_plus", 2), value(r, "beta_minus", 2)]) + " |")

settled = sum(steps.values())
print(f"\n{len(study)} runs to settled e: {settled / 1e6:.2f} million steps, {sum(map(float, (r['wall_s'] for r in study.values()))) / 3600:.2f} h of workers' time; "
      f"{sum(s for k, s in steps.items() if loose(k)) / 1e6:.2f} million of them in {sum(map(loose, steps))} runs with σc < p")
done = sum(float(r["steps"]) for r in ends.values())
logs = [math.log(f) for k, f in ratio.items() if not loose(k)]
mean, error = math.exp(statistics.fmean(logs) + statistics.variance(logs) / 2), statistics.stdev(logs) / math.sqrt(len(logs))
rest = sum(s for k, s in steps.items() if k not in ends and not loose(k))
bound = sum(float(r["step_limit"]) for k, r in study.items() if k not in ends and loose(k))
print(f"steps to `evidence` over steps to settled, {len(logs)} points with σc ≥ p: mean {mean:.2f} ± {100 * error:.0f} %, {min(map(math.exp, logs)):.2f} to {max(map(math.exp, logs)):.2f}; "
      f"{sum(map(loose, ratio))} with σc < p: {', '.join(f'{f:.1f}' for k, f in sorted(ratio.items(), key=lambda p: p[1]) if loose(k))}")
whole, wrong = done + rest * mean + bound, rest * mean * error
print(f"to `evidence`: {done / 1e6:.1f} million steps run, {rest * mean / 1e6:.0f} ± {wrong / 1e6:.0f} of the others with σc ≥ p, {bound / 1e6:.0f} to the step limits of the others with σc < p")
for ns in map(float, sys.argv[1:] or ["28"]):
    hours = N * ns * 1e-9 / 3600 / CORES
    print(f"{ns:g} ns per particle-step: {settled * hours:.2f} h to settled e, at most {whole * hours:.1f} h ({(whole - wrong) * hours:.1f} to {(whole + wrong) * hours:.1f}) to `evidence` on {CORES} cores")
