#!/usr/bin/env python3
"""Compacts the same loose cohesionless spheres in our engine, in LAMMPS and in YADE, and compares void ratio and contacts.

usage: bench/peers/compaction.py [--n N] [--seeds S] [--steps STEPS] [--every K] [--mu MU] [--dt DT] [--python PY]
                                 [--json FILE] [--no-build]

All start from the same centres and velocities between six walls under p = 1e-3 sigma_e (bench/scenes/cohesionless-17657
with n spheres), once for every seed: the same springs, dashpot, tangential history, friction and wall mass. Collisions make
trajectories part soon; then means over seeds are compared with their scatter. What differs in the laws: the peers take the
Coulomb limit of the whole normal force, dashpot included, and YADE cuts a dashpot that pulls. With --mu 0 LAMMPS has our
law exactly. LAMMPS: see run.py; YADE: Debian package yade. Z counts pairs only.
"""
import argparse
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def last_json(command, env=None):
    done = subprocess.run(command, capture_output=True, text=True, env=env, cwd=HERE)
    lines = [line[:line.rindex("}") + 1] for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode or not lines:
        sys.exit(f"{command[0]}: exit status {done.returncode}: {done.stderr.strip()[-500:]}")
    return json.loads(lines[-1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--n", type=int, default=1000)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--steps", type=int, default=4000)
    parser.add_argument("--every", type=int, default=200)
    parser.add_argument("--mu", default="0.4")
    parser.add_argument("--dt", default="0.1")
    parser.add_argument("--python", default=sys.executable, help="python with LAMMPS")
    parser.add_argument("--no-build", action="store_true", help="take the program as it was built before")
    parser.add_argument("--json", help="write all rows here")
    options = parser.parse_args()

    if not options.no_build:
        subprocess.run(["cargo", "build", "--release", "-p", "sim-core", "--example", "peer_compaction"], cwd=ROOT, check=True)
    program = str(Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release/examples/peer_compaction")
    env = dict(os.environ)
    env["LD_LIBRARY_PATH"] = f"{Path(options.python).parent.parent / 'lib'}:{env.get('LD_LIBRARY_PATH', '')}"
    codes = {"Tamp": (lambda *words: last_json([program, "run", *words]))}
    if subprocess.run([options.python, "-c", "import lammps, numpy"], capture_output=True, env=env).returncode:
        print(f"LAMMPS skipped: no python modules lammps and numpy for {options.python}")
    else:
        codes["LAMMPS"] = lambda *words: last_json([options.python, str(HERE / "lammps_compaction_case.py"), *words], env)
    if shutil.which("yade"):
        codes["YADE"] = lambda *words: last_json(["yade", "-n", "-x", str(HERE / "yade_compaction_case.py"), *words])
    else:
        print("YADE skipped: yade is not installed")

    runs = []
    with tempfile.TemporaryDirectory() as folder:
        scene = json.loads((ROOT / "bench/scenes/cohesionless-17657.json").read_text()) | {"n": options.n}
        (Path(folder) / "scene.json").write_text(json.dumps(scene))
        for seed in range(1, options.seeds + 1):
            start = f"{folder}/{seed}.csv"
            subprocess.run([program, "start", f"{folder}/scene.json", str(seed), start], check=True)
            words = [start, str(options.steps), str(options.every), options.dt, options.mu]
            runs.append({"seed": seed, **{name: run(*words) for name, run in codes.items()}})
            if options.json:
                Path(options.json).write_text(json.dumps(runs))

    print(f"{', '.join(runs[0][name]['version'] for name in codes)}; n = {options.n}, mu = {options.mu}, dt = {options.dt}, "
          f"{options.seeds} seeds: mean +- standard error; differences from ours pair by seed; scatter of one run\n")
    head = ["t"]
    for quantity in ("e", "Z"):
        head += [f"{quantity} {name}" for name in codes] + [f"{name} - ours" for name in list(codes)[1:]] + ["scatter"]
    print("| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|")
    rows = range(1, len(runs[0]["Tamp"]["rows"]))
    for k in sorted({k for k in rows if k in (1, 2, 3, 5, 8, 12)} | {rows[-1]}):
        cells = [f"{runs[0]['Tamp']['rows'][k][0] * float(options.dt):.0f}"]
        for column, factor, digits in ((1, 1, 4), (2, 2, 3)):
            of = {name: [factor * run[name]["rows"][k][column] for run in runs] for name in codes}
            error = lambda values: statistics.stdev(values) / math.sqrt(len(values))
            cells += [f"{statistics.mean(v):.{digits}f} ± {error(v):.{digits}f}" for v in of.values()]
            for name in list(codes)[1:]:
                less = [b - a for a, b in zip(of["Tamp"], of[name])]
                cells.append(f"{statistics.mean(less):+.{digits}f} ± {error(less):.{digits}f}")
            cells.append(f"{statistics.stdev(of['Tamp']):.{digits}f}")
        print("| " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
