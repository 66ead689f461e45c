"""Contacts lost with large rolling resistance: steps of states.csv and experiments.csv (labels l_v…, whole paths) that start from
1640 to 1770 contacts, as the paper's sample of Table IV with 1705, and densify by more than 1 %. Standard library only."""
import collections
import csv
import pathlib
import statistics

HERE = pathlib.Path(__file__).parent
PAPER = 26 / 1705 / 0.031, 46 / 1705 / 0.031
curves = collections.defaultdict(list)
with open(HERE / "states.csv") as file:
    for row in csv.DictReader(file):
        if row["assembly"] == "type2" and float(row["mu_r"]) == 0.5 and row["branch"] in ("rest", "assembly", "compression"):
            curves["default", row["seed"]].append(row)
with open(HERE / "experiments.csv") as file:
    for row in csv.DictReader(file):
        if row["label"].startswith("l_v"):
            label = "default" if row["label"] == "l_v9.5" else row["label"]
            curves[label, row["seed"]].append(row)
print("| label | samples | z at P* = 0, 0.178 | x22 at 0.178 [%] | steps | lost / (ΔΦ/Φ): mean, scatter, range | gained / (ΔΦ/Φ) |\n"
      "|---|---|---|---|---|---|---|")
for label in [*sorted({key[0] for key in curves}), "all"]:
    own = [sorted(rows, key=lambda r: float(r["p"])) for key, rows in curves.items() if label in (key[0], "all")]
    lost, gained = [], []
    for rows in own:
        for before, row in zip(rows, rows[1:]):
            change = float(row["phi"]) / float(before["phi"]) - 1
            count = float(row["contacts_kept"] or 0) + float(row["contacts_lost"] or 0)
            if change > 0.01 and 1640 <= count <= 1770:
                lost.append(float(row["contacts_lost"]) / count / change)
                gained.append(float(row["contacts_gained"]) / count / change)
    state = [min(rows, key=lambda r: abs(float(r["p"]) - 0.1778)) for rows in own]
    z = [statistics.fmean(float(r["z"]) for r in rows) for rows in ([rows[0] for rows in own], state)]
    strands = statistics.fmean(float(r["x22"]) for r in state)
    if len(lost) > 1:
        print(f"| {label} | {len(own)} | {z[0]:.2f}, {z[1]:.2f} | {100 * strands:.0f} | {len(lost)} | {statistics.fmean(lost):.2f}, "
              f"{statistics.stdev(lost):.2f}, {min(lost):.2f} … {max(lost):.2f} ({(PAPER[0] - statistics.fmean(lost)) / statistics.stdev(lost):+.1f})"
              f" | {statistics.fmean(gained):.2f} ± {statistics.stdev(gained):.2f} |")
print(f"| paper | 1 | near 2, 2.44 | at most 12 | 1 | {PAPER[0]:.2f} | {PAPER[1]:.2f} |")
