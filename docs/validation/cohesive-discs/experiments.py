"""Experiments on the preparation: writes experiments.csv and prints the table of README.md.

usage: experiments.py            (table from experiments.csv)
       experiments.py DIRECTORY  (first takes in LABEL_sSEED.jsonl, the output of `consolidate`; other labels stay)

Standard library only."""
import collections
import csv
import json
import math
import pathlib
import re
import statistics
import sys

HERE = pathlib.Path(__file__).parent
COLUMNS = ["branch", "p", "phi", "z", "z_star", "rattler_share", "steps", "converged", "contacts_kept",
           "contacts_lost", "contacts_gained", "correlation_length", "z_plus", "z_minus", "mean_normal_force", "time", "x22"]
if len(sys.argv) > 1:
    with open(HERE / "experiments.csv") as file:
        width = 2 + len(COLUMNS)
        known = [row + [""] * (width - len(row)) for row in list(csv.reader(file))[1:]]
    found = []
    for path in sorted(pathlib.Path(sys.argv[1]).glob("*.jsonl")):
        label, seed = re.fullmatch(r"(.+)_s(\d+)", path.stem).groups()
        for line in map(json.loads, open(path)):
            if "row" in line:
                values = [line["row"].get(name, "") for name in COLUMNS]
                found.append([label, seed] + [f"{v:.8g}" if isinstance(v, float) else str(v) for v in values])
    labels = {row[0] for row in found}
    with open(HERE / "experiments.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["label", "seed"] + COLUMNS)
        out.writerows(sorted([row for row in known if row[0] not in labels] + found, key=lambda r: (r[0], int(r[1]))))
groups = collections.defaultdict(list)
with open(HERE / "experiments.csv") as file:
    for row in csv.DictReader(file):
        groups[row["label"], row["branch"], float(row["p"])].append(row)


def told(rows, column, digits):
    values = [float(r[column]) for r in rows if r[column] != ""]
    if len(values) < 2:
        return f"{values[0]:.{digits}f}" if values else "-"
    return f"{statistics.fmean(values):.{digits}f} ± {statistics.stdev(values) / math.sqrt(len(values)):.{digits}f}"


def broken(rows):
    """Contacts lost and gained since the state before, per densification, of the states whose predecessor is known."""
    found = []
    for row in rows:
        before = [r for r in groups_of[row["label"], row["seed"]] if float(r["p"]) < float(row["p"])]
        if row.get("contacts_lost") and before:
            change = float(row["phi"]) / float(max(before, key=lambda r: float(r["p"]))["phi"]) - 1
            count = float(row["contacts_kept"]) + float(row["contacts_lost"])
            if change > 0.01:
                found.append([float(row[name]) / count / change for name in ("contacts_lost", "contacts_gained")])
    return " | ".join(f"{statistics.fmean(column):.2f}" for column in zip(*found)) if found else "- | -"


groups_of = collections.defaultdict(list)
for rows in groups.values():
    for row in rows:
        groups_of[row["label"], row["seed"]].append(row)
print("| label | state | P* | samples | Φ | scatter of Φ | z | z* | x0 | lost / (ΔΦ/Φ) | gained / (ΔΦ/Φ) |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|")
for (label, branch, p), rows in groups.items():
    phi = [float(r["phi"]) for r in rows]
    scatter = f"{statistics.stdev(phi):.4f}" if len(phi) > 1 else "-"
    print(f"| {label} | {branch} | {p:g} | {len(rows)} | {told(rows, 'phi', 4)} | {scatter} | {told(rows, 'z', 3)} | "
          f"{told(rows, 'z_star', 3)} | {told(rows, 'rattler_share', 3)} | {broken(rows)} |")
