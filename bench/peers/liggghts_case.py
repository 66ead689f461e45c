"""Times LIGGGHTS on a packing, jammed (six primitive plane walls) or under compaction at a fixed rate (six moving
meshes of two triangles; primitive walls do not move): hooke/stiffness, tangential history.

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
case = read_packing(packing)
lo, hi, x = case.lo, case.hi, case.x
n = len(x)
gamma_n = 2 * ALPHA_N * math.sqrt(1.0 / 0.5)


def meshes(work, case):
    """Six rectangles as STL files, wider than the box, and the commands that move them."""
    lines, names = [], []
    for axis in range(3):
        u, w = (axis + 1) % 3, (axis + 2) % 3
        for side, face in enumerate((case.lo[axis], case.hi[axis])):
            corners = []
            for a, b in ((case.lo[u] - 2, case.lo[w] - 2), (case.hi[u] + 2, case.lo[w] - 2),
                         (case.hi[u] + 2, case.hi[w] + 2), (case.lo[u] - 2, case.hi[w] + 2)):
                corner = [0.0] * 3
                corner[axis], corner[u], corner[w] = face, a, b
                corners.append(" ".join(f"{c:.17g}" for c in corner))
            normal = " ".join("1" if k == axis else "0" for k in range(3))
            facets = "".join(f"facet normal {normal}\nouter loop\n" + "".join(f"vertex {corners[k]}\n" for k in triangle)
                             + "endloop\nendfacet\n" for triangle in ((0, 1, 2), (0, 2, 3)))
            name = f"w{axis}{side}"
            (work / f"{name}.stl").write_text(f"solid {name}\n{facets}endsolid {name}\n")
            speed = ["0."] * 3
            speed[axis] = f"{(1 - 2 * side) * case.wall_speed(axis):.17g}"
            lines += [f"fix {name} all mesh/surface file {name}.stl type 1",
                      f"fix m{name} all move/mesh mesh {name} linear {' '.join(speed)}"]
            names.append(name)
    wall = f"fix wall all wall/gran model hooke/stiffness tangential history mesh n_meshes 6 meshes {' '.join(names)}"
    return "\n".join([*lines[0::2], wall, *lines[1::2]])


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
        data.write("\nVelocities\n\n")
        for k, (vx, vy, vz) in enumerate(case.v):
            data.write(f"{k + 1} {vx:.17g} {vy:.17g} {vz:.17g} 0 0 0\n")
    walls = meshes(work, case) if case.rate else "\n".join(
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
compute c all contact/atom
compute z all reduce sum c_c
thermo_style custom step c_z ke
thermo_modify norm no lost error
thermo 1000000000
run {0 if case.rate else 200}
run {steps}
"""
    (work / "in.case").write_text(script)
    done = subprocess.run(["liggghts", "-in", "in.case", "-log", "none"], cwd=work, capture_output=True, text=True)
    loops = re.findall(r"Loop time of ([0-9.eE+-]+)", done.stdout)
    if done.returncode or len(loops) < 2:
        sys.exit(f"liggghts failed:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    version = re.search(r"Version (LIGGGHTS\S+ [0-9.]+)", done.stdout)
    last = [line.split() for line in done.stdout.splitlines() if re.fullmatch(r"\s*\d+(\s+[-+0-9.eE]+){2}\s*", line)][-1]
    print(json.dumps({"seconds": float(loops[-1]), "steps": steps, "n": n,
                      "contacts_per_particle": float(last[1]) / n / 2, "kinetic_energy_per_particle": float(last[2]) / n,
                      "version": version.group(1) if version else "LIGGGHTS"}))
