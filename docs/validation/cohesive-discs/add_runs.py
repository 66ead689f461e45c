"""Adds runs of the example `consolidate` to states.csv and scattering.csv; what is there of other samples stays.

usage: add_runs.py RUN.jsonl[=TABLES.json] ...   (TABLES.json: the third argument of `consolidate`, for I(k))

A sample (n, assembly, mu_r, seed) that is there already is replaced. Standard library only."""
import csv
import json
import pathlib
import sys

from columns import RUN, SCENE, STATE, short

HERE = pathlib.Path(__file__).parent
PHYSICS_VERSION = 4
with open(HERE / "states.csv") as file:
    states = list(csv.DictReader(file))
with open(HERE / "scattering.csv") as file:
    shells = [dict(row, n=row.get("n", "1400")) for row in csv.DictReader(file)]


def same(row, scene, keys):
    return all(str(row[k]) == str(scene[k]) or float(row[k]) == float(scene[k]) for k in keys)


for word in sys.argv[1:]:
    name, _, tables = word.partition("=")
    lines = [json.loads(line) for line in open(name)]
    scene, end = lines[0]["reduced"], lines[-1]
    rows = [line["row"] for line in lines if "row" in line]
    states = [row for row in states if row["assembly"] != scene["assembly"] or not same(row, scene, ["n", "mu_r", "seed"])]
    about = {key: scene[key] for key in SCENE} | {"kernel": end["kernel"], "physics_version": PHYSICS_VERSION}
    states += [dict(row, **about) for row in rows]
    if tables and scene["assembly"] == "type2":
        shells = [row for row in shells if not same(row, scene, ["n", "mu_r", "seed"])]
        column = {c["name"]: c["values"] for c in json.load(open(tables))["scattering"]["columns"]}
        for state, k, intensity in zip(column["state"], column["k"], column["intensity"]):
            row = rows[int(state)]
            if row["branch"] in ("rest", "assembly"):
                shells.append({"n": scene["n"], "mu_r": scene["mu_r"], "seed": scene["seed"], "p": row["p"],
                               "k": short(float(k)), "intensity": short(float(intensity))})
states.sort(key=lambda r: (r["assembly"], float(r["mu_r"]), int(r["n"]), int(r["seed"]), int(r["state"])))
with open(HERE / "states.csv", "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(SCENE + STATE + RUN)
    out.writerows([short(row.get(name)) for name in SCENE + STATE + RUN] for row in states)
columns = ["n", "mu_r", "seed", "p", "k", "intensity"]
shells.sort(key=lambda r: [float(r[c]) for c in columns[:5]])
with open(HERE / "scattering.csv", "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(columns)
    out.writerows([row[c] for c in columns] for row in shells)
print(f"{len(states)} states, {len(shells)} shells")
