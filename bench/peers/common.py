"""Numbers shared by the peer cases: the cohesive study's standard parameters in units d = m = k_n = 1."""
import csv
from typing import NamedTuple

ALPHA_N = 0.25
KT_OVER_KN = 1.5
MU = 0.4
DT = 0.1
SKIN = 0.25


class Packing(NamedTuple):
    """Wall faces, centres, velocities, and the rate at which every box edge shrinks per unit of its first length."""
    lo: list
    hi: list
    x: list
    v: list
    rate: float

    def wall_speed(self, axis):
        """Speed of each of the two walls of an axis, inwards [d/tau]."""
        return 0.5 * self.rate * (self.hi[axis] - self.lo[axis])


def read_packing(path):
    """A CSV: first line `# lo_x lo_y lo_z hi_x hi_y hi_z [rate]`, then rows x,y,z[,vx,vy,vz] [d, d/tau]."""
    with open(path) as file:
        head = [float(v) for v in file.readline().lstrip("# ").split()]
        rows = [[float(v) for v in row[:6]] for row in csv.reader(file) if not row[0].startswith("x")]
    return Packing(head[:3], head[3:6], [r[:3] for r in rows], [(r + [0.0] * 3)[3:6] for r in rows],
                   head[6] if len(head) > 6 else 0.0)
