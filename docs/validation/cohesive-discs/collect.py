"""Collects the states of finished sweeps of cohesive discs from coordinators; `add_runs.py` adds runs of `consolidate`.

usage: collect.py SERVER NAME... [SERVER NAME...]
       (for example collect.py http://127.0.0.1:8300 consolidation-2008)

Writes beside this file
  states.csv   one row per equilibrium state: scene, observables, residuals
  forces.csv   P(F_N) of the states at P* = 0.01, 0.1, 1 and 13.3 on loading, mean over samples
  scattering.csv   I(k) of type 2 at P* = 0 and 0.01, every sample
A scene run by two physics versions counts once, as it was collected last. Only the standard library is needed.
"""
import collections
import csv
import json
import pathlib
import sys
import urllib.request

from columns import RUN, SCENE, STATE, short

HERE = pathlib.Path(__file__).parent
PRESSURES = [0.01, 0.1, 1.0, 13.335214]


def get(url):
    with urllib.request.urlopen(url) as answer:
        return answer.read().decode()


def sample(row):
    return tuple(row[name] for name in SCENE)


states, jobs, server = {}, {}, None
for word in sys.argv[1:]:
    if word.startswith("http"):
        server = word.rstrip("/") + "/v1"
        sweeps = json.loads(get(f"{server}/sweeps"))["items"]
    else:
        for sweep in sweeps:
            if sweep["name"] == word:
                runs = collections.defaultdict(list)
                for line in get(f"{server}/sweeps/{sweep['id']}/states?format=ndjson").splitlines():
                    row = json.loads(line)
                    runs[row["scene_key"]].append(row)
                for rows in runs.values():
                    key = sample(rows[0])
                    if not rows[-1]["converged"]:
                        print(f"left out: {key}, state {rows[-1]['state']} did not converge")
                        continue
                    for row in rows:
                        states[key, row["state"]] = row
                    jobs[key] = server, rows[0]["job"]
rows = sorted(states.values(), key=lambda r: (r["assembly"], r["mu_r"], r["n"], r["seed"], r["state"]))
with open(HERE / "states.csv", "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(SCENE + STATE + RUN)
    out.writerows([short(row.get(name)) for name in SCENE + STATE + RUN] for row in rows)

bins = collections.defaultdict(list)
scattering = []
for key, (server, job) in jobs.items():
    tables = json.loads(get(f"{server}/jobs/{job}/snapshot"))
    column = {c["name"]: c["values"] for c in tables["normal_forces"]["columns"]}
    for state, force, density in zip(column["state"], column["normal_force"], column["density"]):
        row = states[key, int(state)]
        loading = row["branch"] in ("assembly", "compression")
        if row["assembly"] == "cohesionless" or not loading:
            continue
        near = [p for p in PRESSURES if abs(row["p"] / p - 1) < 1e-3]
        if near:
            bins[row["assembly"], row["mu_r"], near[0], round(force, 9)].append(density)
    column = {c["name"]: c["values"] for c in tables["scattering"]["columns"]}
    for state, k, intensity in zip(column["state"], column["k"], column["intensity"]):
        row = states[key, int(state)]
        if row["assembly"] == "type2" and row["branch"] in ("rest", "assembly"):
            scattering.append([row["n"], row["mu_r"], row["seed"], row["p"], short(k), short(intensity)])
with open(HERE / "scattering.csv", "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(["n", "mu_r", "seed", "p", "k", "intensity"])
    out.writerows(sorted(scattering, key=lambda r: (*r[:4], float(r[4]))))
with open(HERE / "forces.csv", "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(["assembly", "mu_r", "p", "normal_force", "density", "samples"])
    for (assembly, mu_r, p, force), densities in sorted(bins.items()):
        mean = sum(densities) / len(densities)
        if mean > 0:
            out.writerow([assembly, mu_r, p, short(force), short(mean), len(densities)])
print(f"{len(jobs)} runs, {len(rows)} states")
