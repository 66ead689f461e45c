"""Close pairs of the initial fluid: twice the pairs with a gap below t over the number of discs, mean over files.

usage: fluid.py TABLES.json...   (third argument of `consolidate`, stopped at once: `consolidate 1 - TABLES.json`)

Standard library only."""
import json
import math
import statistics
import sys

GAPS = [0.002, 0.01, 0.03, 0.05, 0.1, 0.2, 0.4]


def column(table, name):
    return next(c["values"] for c in table["columns"] if c["name"] == name)


def close_pairs(path):
    with open(path) as file:
        tables = json.load(file)
    x, y, radius = (column(tables["particles"], name) for name in ("x", "y", "radius"))
    edges = [column(tables["cell"], name)[0] for name in ("l1", "l2")]
    counts = [0] * len(GAPS)
    for i in range(len(x)):
        for j in range(i):
            dx, dy = abs(x[i] - x[j]), abs(y[i] - y[j])
            gap = math.hypot(min(dx, edges[0] - dx), min(dy, edges[1] - dy)) - radius[i] - radius[j]
            if gap < GAPS[-1]:
                for k, limit in enumerate(GAPS):
                    counts[k] += gap < limit
    return [2 * count / len(x) for count in counts]


rows = [close_pairs(path) for path in sys.argv[1:]]
print(f"| gap [a] below | {' | '.join(f'{t:g}' for t in GAPS)} |\n|" + "---|" * (len(GAPS) + 1))
print(f"| pairs per disc, {len(rows)} samples | " + " | ".join(f"{statistics.fmean(c):.3f}" for c in zip(*rows)) + " |")
