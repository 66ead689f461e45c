"""Times YADE on a packing, jammed or under compaction at a fixed rate: Cundall-Strack law with friction history, six wall bodies.

usage: yade-batch style call: yade -n -x yade_case.py PACKING.csv STEPS

Reduced units d = m = k_n = 1; damping is YADE's local one (0.2), its usual choice. Prints one JSON line.
"""
import json
import math
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))
from common import DT, KT_OVER_KN, MU, SKIN, read_packing  # noqa: E402

packing, steps = sys.argv[-2], int(sys.argv[-1])
case = read_packing(packing)
lo, hi, x = case.lo, case.hi, case.x
# series springs of two radii r: kn = 2 E r r / (r + r) = E r, so E = 2 gives k_n = 1 for r = 1/2; k_t = poisson k_n
O.materials.append(FrictMat(young=2.0, poisson=KT_OVER_KN, density=6 / math.pi, frictionAngle=math.atan(MU)))
for axis in range(3):
    for side, value in enumerate((lo[axis], hi[axis])):
        face = wall(value, axis=axis)
        face.state.vel[axis] = (1 - 2 * side) * case.wall_speed(axis)
        O.bodies.append(face)
for p, v in zip(x, case.v):
    body = sphere(p, 0.5)
    body.state.vel = v
    O.bodies.append(body)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=SKIN / 2),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                    [Law2_ScGeom_FrictPhys_CundallStrack()]),
    NewtonIntegrator(damping=0.2),  # a wall's velocity is given, forces do not change it
]
O.dt = DT
O.run(1 if case.rate else 20, True)
start = time.perf_counter()
O.run(steps, True)
seconds = time.perf_counter() - start
contacts = sum(1 for i in O.interactions if i.isReal and i.id1 > 5 and i.id2 > 5 and i.geom.penetrationDepth > 0)
kinetic = sum(0.5 * b.state.vel.squaredNorm() for b in O.bodies if b.id > 5)
import yade.config  # noqa: E402

print(json.dumps({"seconds": seconds, "steps": steps, "n": len(x), "contacts_per_particle": contacts / len(x),
                  "kinetic_energy_per_particle": kinetic / len(x),
                  "version": "YADE " + yade.config.version}))
