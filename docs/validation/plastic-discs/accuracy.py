"""Run time against error: `python3 accuracy.py PLASTIC_SCENE [disc|explicit|packing|SERIES]` (SERIES: one of the packings) runs the example `plastic_scene` on one
thread and writes `accuracy-disc.csv`, `accuracy-packing.csv` and `accuracy.svg` (only the picture without a program)."""

import csv
import json
import math
import os
import resource
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
REFERENCE = os.path.join(HERE, "../../../sim-core/tests/plastic/reference.csv")
YOUNG = 10.0  # MPa
STRAINS = (0.04, 0.05, 0.1, 0.12, 0.17)


def run(program, scene):
    """States of a scene and its CPU time."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "states.csv")
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run([program, json.dumps({"model": "plastic_discs", **scene}), path, "1"], capture_output=True, text=True)
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        if done.returncode:
            raise SystemExit(done.stderr)
        with open(path) as file:
            states = [{k.split("[")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    record = json.loads(done.stdout[done.stdout.index("\n{"):done.stdout.rindex("}") + 1])
    return states, seconds, record


def reference(quantity, hardening):
    with open(REFERENCE) as file:
        rows = [r for r in csv.DictReader(file) if r["case"] == "diam_single_disc" and r["quantity"] == quantity and r["H_MPa"] == hardening]
    return {float(r["x"]): float(r["y"]) for r in rows}


def at(states, strain, value):
    for a, b in zip(states, states[1:]):
        if a["strain"] <= strain <= b["strain"] + 1e-9:
            share = min(1.0, (strain - a["strain"]) / (b["strain"] - a["strain"]))
            return value(a) + share * (value(b) - value(a))
    raise SystemExit(f"no state at {strain}")


def one_disc(program, only=""):
    base = {"setup": "diametrical", "strain_step": 0.01}
    scenes = []
    for name, material in (("elastic", {"material": "elastic"}), ("h1", {"h": 1e6})):
        for cells in (4, 6, 8, 12, 16, 24, 32):
            scenes.append(("mesh", name, {**base, **material, "cells": cells}))
        for dt in (0.03e-6, 0.06e-6, 0.24e-6, 0.6e-6, 1.2e-6):
            scenes.append(("time step", name, {**base, **material, "cells": 16, "dt": dt}))
        for speed in (0.5, 0.1):
            for cells in (6, 8, 12, 16, 24):
                scenes.append((f"explicit {speed} m/s", name, {**base, **material, "cells": cells, "method": "explicit", "wall_speed": speed, "strain_step": 0.002, "strain_end": 0.172}))
    scenes = [one for one in scenes if one[0].startswith(only)]
    kept = []
    if only:
        with open(os.path.join(HERE, "accuracy-disc.csv")) as file:
            kept = [line for line in list(file)[1:] if not line.startswith(only)]
    with open(os.path.join(HERE, "accuracy-disc.csv"), "w") as file:
        file.write("series,material,cells,dt_us,steps,cpu_s,force_rms,work_error\n")
        file.writelines(kept)
        for series, name, scene in scenes:
            states, seconds, record = run(program, scene)
            hardening = "el" if name == "elastic" else "1"
            force, work = reference("F_over_D_MPa", hardening), reference("work_over_A0_MPa", hardening)
            # an explicit run records means over the strain step before
            lag = 0.5 * scene["strain_step"] if scene.get("method") == "explicit" else 0.0
            scene_end = states[-1]["strain"]
            errors = [at(states, min(x + lag, scene_end), lambda s: 0.5 * (s["sigma"] + s["sigma_top"])) * YOUNG / force[x] - 1 for x in STRAINS]
            rms = math.sqrt(sum(e * e for e in errors) / len(errors))
            error = at(states, 0.17, lambda s: s["work"]) * YOUNG / (math.pi / 4) / work[0.17] - 1
            dt = record["dt"] * 0.6  # d √(ρ/E) = 60 µm / 100 m/s
            file.write(f"{series},{name},{scene['cells']},{dt:.4g},{record['steps']},{seconds:.2f},{rms:.4f},{error:.4f}\n")
            file.flush()


def packing(program, series=""):
    """24 discs, two packings; a series asked for is added to the table, the whole of it made anew."""
    base = {"n": 24, "h": 1e6, "phi_i": 0.72, "phi_end": 0.935, "start_velocity": "uniform", "strain_step": 0.005}
    scenes = [("cells", {"cells": cells}) for cells in (6, 8, 12, 16)]
    scenes += [("time step", {"cells": 8, "dt": dt}) for dt in (0.0015e-6, 0.02e-6, 0.1e-6)]
    scenes += [("explicit", {"cells": cells, "method": "explicit"}) for cells in (6, 8, 12, 16)]
    path = os.path.join(HERE, "accuracy-packing.csv")
    kept = []
    if series:
        with open(path) as file:
            kept = [line for line in list(file)[1:] if not line.startswith(series + ",")]
    with open(path, "w") as file:
        file.write("series,variant,method,seed,cells,dt_us,steps,cpu_s,sigma_0.86_MPa,sigma_0.90_MPa,sigma_0.93_MPa,z_0.90,work_0.93\n")
        file.writelines(kept)
        wanted = [one for one in scenes if one[0].startswith(series)]
        for seed in (1, 2):
            for name, scene in sorted(wanted, key=lambda one: one[1]["cells"]):
                states, seconds, record = run(program, {**base, **scene, "seed": seed})

                def by(phi, value):
                    for one, two in zip(states, states[1:]):
                        if one["phi"] <= phi <= two["phi"]:
                            return value(one) + (phi - one["phi"]) / (two["phi"] - one["phi"]) * (value(two) - value(one))
                    return float("nan")

                stress = [by(phi, lambda s: 0.5 * (s["sigma"] + s["sigma_top"]) * YOUNG) for phi in (0.86, 0.90, 0.93)]
                kinds = (name, scene.get("variant", "total_bilinear"), scene.get("method", "implicit"), seed, scene["cells"])
                file.write(",".join(map(str, kinds)))
                dt = record["dt"] * 0.04  # d √(ρ/E) = 4 µm / 100 m/s
                file.write(f",{dt:.4g},{record['steps']},{seconds:.1f}," + ",".join(f"{one:.4f}" for one in stress))
                file.write(f",{by(0.90, lambda s: s['z']):.3f},{by(0.93, lambda s: s['work']):.5f}\n")
                file.flush()


def picture():
    """Error of the work of one disc against CPU time, log–log."""
    with open(os.path.join(HERE, "accuracy-disc.csv")) as file:
        rows = list(csv.DictReader(file))
    colors = {"mesh": "#0072b2", "time step": "#d55e00", "explicit 0.5 m/s": "#009e73", "explicit 0.1 m/s": "#cc79a7"}
    names = {"mesh": "implicit, cells 4 … 32", "time step": "implicit, 16 cells, Δt 0.03 … 1.2 µs", "explicit 0.5 m/s": "explicit, cells 6 … 24, 0.5 m/s", "explicit 0.1 m/s": "explicit, cells 6 … 24, 0.1 m/s"}
    panels = [("work_error", "error of the work"), ("force_rms", "rms error of the force")]
    out = ['<svg xmlns="http://www.w3.org/2000/svg" width="800" height="400" font-family="sans-serif" font-size="12">', '<rect width="800" height="400" fill="white"/>']
    low, high = math.log10(0.01), math.log10(30)
    y0, y1 = math.log10(5e-4), math.log10(0.2)
    for k, (column, label) in enumerate(panels):
        left = 400 * k + 70
        px = lambda t: left + (math.log10(max(t, 0.01)) - low) / (high - low) * 310
        py = lambda e: 30 + (y1 - math.log10(min(max(abs(e), 5e-4), 0.2))) / (y1 - y0) * 260
        out.append(f'<rect x="{left}" y="30" width="310" height="260" fill="none" stroke="#1e1e1e"/>')
        for t in (0.01, 0.1, 1, 10):
            out.append(f'<line x1="{px(t):.1f}" x2="{px(t):.1f}" y1="290" y2="294" stroke="#1e1e1e"/><text x="{px(t):.1f}" y="307" text-anchor="middle">{t:g}</text>')
        for e in (0.001, 0.01, 0.1):
            out.append(f'<line x1="{left - 4}" x2="{left}" y1="{py(e):.1f}" y2="{py(e):.1f}" stroke="#1e1e1e"/><text x="{left - 7}" y="{py(e) + 4:.1f}" text-anchor="end">{e:g}</text>')
        out.append(f'<text x="{left + 155}" y="326" text-anchor="middle">CPU time, one thread [s]</text>')
        out.append(f'<text x="{left - 48}" y="160" text-anchor="middle" transform="rotate(-90 {left - 48} 160)">{label} (H = 1 MPa)</text>')
        for series, color in colors.items():
            points = [(float(r["cpu_s"]), float(r[column])) for r in rows if r["series"] == series and r["material"] == "h1"]
            if series != "time step":
                out.append('<polyline points="' + " ".join(f"{px(t):.1f},{py(e):.1f}" for t, e in points) + f'" fill="none" stroke="{color}"/>')
            out += [f'<circle cx="{px(t):.1f}" cy="{py(e):.1f}" r="3.5" fill="{color}"/>' for t, e in points]
    for k, (series, name) in enumerate(names.items()):
        x, y = 70 + 360 * (k % 2), 352 + 20 * (k // 2)
        out.append(f'<circle cx="{x}" cy="{y - 4}" r="3.5" fill="{colors[series]}"/><text x="{x + 10}" y="{y}">{name}</text>')
    with open(os.path.join(HERE, "accuracy.svg"), "w") as file:
        file.write("\n".join(out + ["</svg>", ""]))


if len(sys.argv) > 1:
    which = sys.argv[2:] or ["disc", "packing"]
    for part in which:
        parts = {"disc": one_disc, "explicit": lambda program: one_disc(program, "explicit"), "packing": packing}
        parts.get(part, lambda program: packing(program, part))(sys.argv[1])
picture()
