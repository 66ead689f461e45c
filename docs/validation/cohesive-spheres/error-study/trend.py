"""Tables of the stop rule `evidence`: what still moves, and what the rule costs against runs 1.4 to 25 times as long.

python3 trend.py   # numpy; prints Markdown from stop-n1000.csv and stop-n1000.series.csv.gz beside it

Rules are read off the samples as sim-core/src/equilibrium/evidence.rs does it: windows are the last fifth of the time and
the last fifth of its first half; Z+ and Z- are extrapolated in 1/t. The energy of the motion along normals between
held particles is in the rows on the way (every tenth more steps), so its mean over the window is that of the rows in it.
"""
import collections
import csv
import gzip
import pathlib

import numpy as np

HERE = pathlib.Path(__file__).parent
PLACE = ["sigma_c", "p", "sigma_e"]
Z = ["z", "z_plus", "z_minus"]


def rows(opened):
    with opened as file:
        return list(csv.DictReader(file))


def table(head, lines):
    print("\n| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|")
    for line in lines:
        print("| " + " | ".join(line) + " |")
    print()


way, ends, series = collections.defaultdict(list), {}, collections.defaultdict(list)
for row in rows(open(HERE / "stop-n1000.csv")):
    way[row["scene"]].append(row)
    if row["mark"] == "end":
        ends[row["scene"]] = row
for row in rows(gzip.open(HERE / "stop-n1000.series.csv.gz", "rt")):
    series[row["scene"]].append(row)
place = lambda row: tuple(float(row[k]) for k in PLACE)
label = lambda where: [f"{where[0] / 1e6:g}", f"{where[1] / 1e6:g}", f"{where[2] / 1e9:g}"]
places = sorted({place(end) for end in ends.values()})

print("## What still moves\n\nKinetic over elastic energy, medians over seeds, at a tenth, a third and the end of the long run: of particles with "
      "no, one, two, three, at least four contacts; the last with all neighbours alike; of the relative motion at contacts, across and along normals.")
lines = []
for where in places:
    for share in (0.1, 0.3, 1.0):
        near = [min(way[s], key=lambda r: abs(float(r["sim_time"]) - share * float(end["sim_time"])))
                for s, end in ends.items() if place(end) == where]
        median = lambda *names: f"{np.median([sum(float(r[n]) for n in names) for r in near]):.1e}"
        lines.append(label(where) + [f"{share:g}"] + [median(f"ke_{k}") for k in range(5)]
                     + [median("ke_inner"), median("ke_shear"), median("ke_normal"), median("ke_normal_held"), median("unbalanced_force")])
table(["σc [MPa]", "p [MPa]", "σe [GPa]", "time", "0", "1", "2", "3", "≥ 4", "≥ 4, so have neighbours", "across contacts", "along normals", "the same, ≥ 4", "unbalanced force"], lines)


def evidence(scene):
    """What was known at every sample, and the state to compare with: means over the last tenth of the long run."""
    get = {k: np.array([float(r[k]) for r in series[scene]]) for k in ["step", "t", "e", *Z, "ke", "ke_held", "eel", "unbalanced_force"]}
    walls = np.array([[float(r[f"wall_{w}"]) for w in range(1, 7)] for r in series[scene]])
    marks = np.array([[float(r["sim_time"]), float(r["ke_normal_held"])] for r in way[scene]])
    t, found = get["t"], []
    for k in range(len(t)):
        first = np.searchsorted(t[:k + 1], t[k] / 1.25)
        late = slice(max(first - 1, 0), k + 1)
        early = slice(np.searchsorted(t, 0.4 * t[k]), np.searchsorted(t, 0.5 * t[k], side="right"))
        if first == 0 or k + 1 - late.start < 4 or early.stop - early.start < 2:
            continue
        inside = (marks[:, 0] >= t[k] / 1.25) & (marks[:, 0] <= t[k])
        now = {"k": k, "step": get["step"][k], "e": get["e"][k], "e_drift": np.ptp(get["e"][late]), "rest": 0.0,
               "walls": np.max(np.abs(walls[late].mean(axis=0) - 1)), "unbalanced": get["unbalanced_force"][k],
               "contacts": marks[inside, 1].mean() if inside.any() else np.inf,
               "ke": get["ke"][k] / get["eel"][k], "held": get["ke_held"][k] / get["eel"][k]}
        then, lately = np.mean(1 / t[early]), np.mean(1 / t[late])
        for name in Z:
            slope = (get[name][late].mean() - get[name][early].mean()) / (then - lately)
            now[name], now[name + "_limit"] = get[name][k], get[name][late].mean() + slope * lately
            if name != "z":
                now["rest"] = max(now["rest"], abs(slope / t[k]))
        half = late.start + (k + 1 - late.start) // 2
        now["z_drift"] = max(2 * abs(get[n][half:k + 1].mean() - get[n][late.start:half].mean()) for n in Z[1:])
        found.append(now)
    last = t >= 0.9 * t[-1]
    return found, {k: get[k][last].mean() for k in ["e", *Z]} | {"steps": get["step"][-1]}


settled = lambda f, drift=1e-3: f["e_drift"] <= drift and f["walls"] <= 0.01 and f["unbalanced"] <= 0.5
RULES = {
    "settled": settled,
    "version 2 (held KE 2e-7, drift of Z± 0.02)": lambda f: settled(f) and min(f["ke"], f["held"]) <= 2e-7 and f["z_drift"] <= 0.02,
    "z_rest 0.05 alone": lambda f: settled(f) and f["rest"] <= 0.05,
    "ke_contacts 2e-6 alone": lambda f: settled(f) and f["contacts"] <= 2e-6,
    "**evidence: ke_contacts 2e-6, z_rest 0.05**": lambda f: settled(f) and f["contacts"] <= 2e-6 and f["rest"] <= 0.05,
    "ke_contacts 2e-6, z_rest 0.1": lambda f: settled(f) and f["contacts"] <= 2e-6 and f["rest"] <= 0.1,
    "ke_contacts 2e-7, z_rest 0.05": lambda f: settled(f) and f["contacts"] <= 2e-7 and f["rest"] <= 0.05,
    "ke_contacts 2e-7, z_rest 0.03": lambda f: settled(f) and f["contacts"] <= 2e-7 and f["rest"] <= 0.03,
}
QUANTITIES = ["e", "z", "z_limit", "z_plus", "z_plus_limit", "z_minus", "z_minus_limit", "beta_plus", "beta_minus"]
HEAD = ["Δe", "ΔZ", "Z limit", "ΔZ+", "Z+ limit", "ΔZ−", "Z− limit", "Δβ+", "Δβ−"]
digits = lambda q: 5 if q == "e" else 2 if q.startswith("beta") else 3
known = {scene: evidence(scene) for scene in ends}


def beta(scene, step, name):
    """The row on the way that is nearest to a step, less the end."""
    near = [r for r in way[scene] if r[name] and abs(np.log(float(r["steps"]) / step)) < 0.1]
    if not near or not ends[scene][name]:
        return np.nan
    return float(min(near, key=lambda r: abs(np.log(float(r["steps"]) / step)))[name]) - float(ends[scene][name])


def judged(rule):
    """Scene -> the deviations where the rule stops."""
    found = {}
    for scene, (samples, final) in known.items():
        hit = next((f for f in samples if RULES[rule](f)), None)
        base = next((f for f in samples if settled(f)), None)
        if hit is None or base is None:
            continue
        found[scene] = {"steps": hit["step"], "ratio": hit["step"] / base["step"], "long": final["steps"] / hit["step"]} | {
            q: beta(scene, hit["step"], q) if q.startswith("beta") else hit[q] - final[q.removesuffix("_limit")] for q in QUANTITIES}
    return found


print("## Rules\n\nMean over all runs ± standard error; mean of the worst scene. Steps over those to `settled`: mean.")
lines = []
for rule in RULES:
    found = judged(rule)
    line = [rule, f"{len(found)} of {len(ends)}", f"{np.median([f['steps'] for f in found.values()]):.0f}", f"{np.mean([f['ratio'] for f in found.values()]):.1f}"]
    for q in QUANTITIES:
        values = np.array([f[q] for f in found.values()])
        values = values[~np.isnan(values)]
        means = [np.nanmean([f[q] for s, f in found.items() if place(ends[s]) == where]) for where in places
                 if any(not np.isnan(f[q]) for s, f in found.items() if place(ends[s]) == where)]
        d = digits(q)
        line.append(f"{values.mean():+.{d}f} ± {values.std(ddof=1) / np.sqrt(len(values)):.{d}f}; {max(means, key=abs):+.{d}f}")
    lines.append(line)
single = ["scatter of a single run", "", "", ""]
for q in QUANTITIES:
    name = q.removesuffix("_limit")
    of = (lambda s: float(ends[s][name] or "nan")) if name.startswith("beta") else (lambda s: known[s][1][name])
    single.append(f"{np.sqrt(np.mean([np.nanvar([of(s) for s in ends if place(ends[s]) == w], ddof=1) for w in places if np.sum(~np.isnan([of(s) for s in ends if place(ends[s]) == w])) > 1])):.{digits(q)}f}")
table(["rule", "stopped", "steps, median", "steps/settled", *HEAD], lines + [single])

print("## `evidence`, scene by scene\n")
found = judged("**evidence: ke_contacts 2e-6, z_rest 0.05**")
lines = []
for where in places:
    here = [f for s, f in found.items() if place(ends[s]) == where]
    lines.append(label(where) + [str(len(here)), f"{np.median([f['steps'] for f in here]):.0f}", f"{np.mean([f['ratio'] for f in here]):.1f}",
                                 f"{np.median([f['long'] for f in here]):.1f}"] + [f"{np.nanmean([f[q] for f in here]):+.{digits(q)}f}" for q in QUANTITIES])
table(["σc [MPa]", "p [MPa]", "σe [GPa]", "runs", "steps", "steps/settled", "long run longer by", *HEAD], lines)
