"""Numbers shared by the peer cases: the cohesive study's standard parameters in units d = m = k_n = 1."""
import csv

ALPHA_N = 0.25
KT_OVER_KN = 1.5
MU = 0.4
DT = 0.1
SKIN = 0.25


def read_packing(path):
    """Positions and wall faces from a CSV: first line `# lo_x lo_y lo_z hi_x hi_y hi_z`, then x,y,z rows [d]."""
    with open(path) as file:
        faces = [float(v) for v in file.readline().lstrip("# ").split()]
        rows = [[float(v) for v in row[:3]] for row in csv.reader(file) if not row[0].startswith("x")]
    return faces[:3], faces[3:], rows
