"""Compacts loose spheres in YADE between six walls under constant pressure, as `peer_compaction run` does in ours.

usage: yade -n -x yade_compaction_case.py START.csv STEPS EVERY DT MU

Law: ViscElBasic, linear springs and dashpot, tangential history; springs and dashpots of two bodies in series, so a
material has twice the value wanted of a pair. The law cuts a normal force that pulls and takes the Coulomb limit of what is
left, dashpot included; ours keeps the pull of the dashpot and takes the limit of the spring. Walls are bodies of given velocity, moved by leapfrog:
m_w dv/dt = p S - F with the force that YADE puts on them. Prints one JSON line of rows as `peer_compaction run`.
"""
import json
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))
from common import ALPHA_N, KT_OVER_KN, SKIN  # noqa: E402

start, steps, every = sys.argv[-5], int(sys.argv[-4]), int(sys.argv[-3])
dt, MU = float(sys.argv[-2]), float(sys.argv[-1])
with open(start) as file:
    pressure, wall_mass, *faces = [float(v) for v in file.readline().lstrip("# ").split()]
    rows = [[float(v) for v in line.split(",")] for line in file]
n = len(rows)
pair = 2 * ALPHA_N * math.sqrt(0.5)  # m_eff = 1/2
with_wall = 2 * ALPHA_N
sphere_dashpot = 2 * pair
wall_dashpot = 1 / (1 / with_wall - 1 / sphere_dashpot)
friction = math.atan(MU)
common = dict(kn=2.0, ks=2 * KT_OVER_KN, cs=0.0, frictionAngle=friction)
ball = O.materials.append(ViscElMat(cn=sphere_dashpot, density=6 / math.pi, **common))
plate = O.materials.append(ViscElMat(cn=wall_dashpot, density=1.0, **common))
for k in range(6):
    O.bodies.append(wall(faces[k], axis=k // 2, material=plate))
for row in rows:
    body = sphere(row[:3], 0.5, material=ball)
    body.state.vel = row[3:]
    O.bodies.append(body)
position, velocity = list(faces), [0.0] * 6
outward = [-1.0, 1.0] * 3
first = True


def move_walls():
    """After the forces, before the motion: gives every wall the velocity of the next half step."""
    global first
    gaps = [O.bodies[2 * a + 1].state.pos[a] - O.bodies[2 * a].state.pos[a] for a in range(3)]
    for k in range(6):
        axis = k // 2
        load = pressure * gaps[(axis + 1) % 3] * gaps[(axis + 2) % 3]
        force = O.forces.f(k)[axis] * outward[k]
        velocity[k] += (0.5 if first else 1.0) * O.dt * outward[k] * (force - load) / wall_mass
        moved = [0.0] * 3
        moved[axis] = velocity[k]
        O.bodies[k].state.vel = moved
    first = False


O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=SKIN / 2),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
                    [Law2_ScGeom_ViscElPhys_Basic()]),
    PyRunner(command="move_walls()", iterPeriod=1, initRun=True, firstIterRun=0),
    NewtonIntegrator(damping=0.0),
]
O.dt = dt


def observe():
    gaps = [O.bodies[2 * a + 1].state.pos[a] - O.bodies[2 * a].state.pos[a] for a in range(3)]
    touching = [i for i in O.interactions if i.isReal and i.geom.penetrationDepth > 0]
    pairs = sum(1 for i in touching if i.id1 > 5 and i.id2 > 5)
    kinetic = sum(0.5 * O.bodies[k].state.vel.squaredNorm() for k in range(6, n + 6))
    return [O.iter, gaps[0] * gaps[1] * gaps[2] / (n * math.pi / 6) - 1, pairs / n, (len(touching) - pairs) / n, kinetic / n]


table = [observe()]
while O.iter < steps:
    O.run(min(every, steps - O.iter), True)
    table.append(observe())
import yade.config  # noqa: E402

print(json.dumps({"rows": table, "version": "YADE " + yade.config.version}))
