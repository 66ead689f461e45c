"""Times LIGGGHTS on a jammed packing: hooke/stiffness, tangential history, six primitive plane walls.

usage: liggghts_case.py PACKING.csv STEPS

Reduced units d = m = k_n = 1. Prints one JSON line: seconds (LIGGGHTS's own loop time), version.
"""
import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from common import ALPHA_N, DT, KT_OVER_KN, MU, SKIN, read_packing

packing, steps = sys.argv[1], int(sys.argv[2])
lo, hi, x = read_packing(packing)
n = len(x)
gamma_n = 2 * ALPHA_N * math.sqrt(1.0 / 0.5)
with tempfile.TemporaryDirectory() as folder:
    work = Path(folder)
    density = 6.0 / math.pi
    with open(work / "packing.data", "w") as data:
        data.write(f"packing\n\n{n} atoms\n1 atom types\n\n")
        for axis, a, b in zip("xyz", lo, hi):
            data.write(f"{a - 2} {b + 2} {axis}lo {axis}hi\n")
        data.write("\nAtoms\n\n")
        for k, (px, py, pz) in enumerate(x):  # granular: id type diameter density x y z
            data.write(f"{k + 1} 1 1.0 {density:.17g} {px:.17g} {py:.17g} {pz:.17g}\n")
    walls = "\n".join(
        f"fix w{axis}{side} all wall/gran model hooke/stiffness tangential history primitive type 1 {axis}plane {value:.17g}"
        for axis, a, b in zip("xyz", lo, hi) for side, value in (("lo", a), ("hi", b)))
    script = f"""
units si
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
read_data packing.data
neighbor {SKIN} bin
neigh_modify delay 0 every 1 check yes
fix m1 all property/global kn peratomtypepair 1 1.0
fix m2 all property/global kt peratomtypepair 1 {KT_OVER_KN}
fix m3 all property/global gamman peratomtypepair 1 {gamma_n}
fix m4 all property/global gammat peratomtypepair 1 0.0
fix m5 all property/global coefficientFriction peratomtypepair 1 {MU}
fix m6 all property/global characteristicVelocity scalar 1.0
pair_style gran model hooke/stiffness tangential history
pair_coeff * *
{walls}
fix move all nve/sphere
timestep {DT}
thermo 1000000000
run 200
run {steps}
"""
    (work / "in.case").write_text(script)
    done = subprocess.run(["liggghts", "-in", "in.case", "-log", "none"], cwd=work, capture_output=True, text=True)
    loops = re.findall(r"Loop time of ([0-9.eE+-]+)", done.stdout)
    if done.returncode or len(loops) < 2:
        sys.exit(f"liggghts failed:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    version = re.search(r"Version (LIGGGHTS\S+ [0-9.]+)", done.stdout)
    print(json.dumps({"seconds": float(loops[-1]), "steps": steps, "n": n,
                      "version": version.group(1) if version else "LIGGGHTS"}))
