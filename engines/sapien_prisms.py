"""Prisms of the can test's roll in PhysX: which corners it keeps, and where the prisms end.

tools/physx_prisms.py runs it in the environment of `sapien_can.py`. It reads the case as JSON from
the standard input, and prints what src/mjbeer/studies/physx_prisms.json has.
"""

import json
import math
import pathlib
import sys
import tempfile
from typing import Any

import numpy as np
import sapien_can
from common import Case, Setting
from sapien import physx

PRISMS = [(16, 1.0), (32, 1.0), (64, 1.0), (120, 1.0), (32, 30.0), (64, 30.0), (120, 30.0)]
"""Numbers of facets, and factors of all lengths and of gravity."""
TIMESTEPS = ("1e-3", "1e-4")
"""[s]"""


def write_prism(path: pathlib.Path, case: Case, facets: int) -> None:
    """Write a prism along x as an OBJ file; an edge points to where the can touches at phi = 0."""
    lines = []
    for x in (-case.length / 2, case.length / 2):
        for place in range(facets):
            angle = math.tau * place / facets
            y = case.radius * math.sin(angle)
            z = -case.radius * math.cos(angle)
            lines.append(f"v {x:.9g} {y:.9g} {z:.9g}")
    for place in range(facets):
        after = (place + 1) % facets
        first = (place + 1, after + 1, facets + place + 1)
        second = (after + 1, facets + after + 1, facets + place + 1)
        lines += [f"f {a} {b} {c}" for a, b, c in (first, second)]
    path.write_text("\n".join(lines) + "\n")


def edges(corners: np.ndarray) -> list[float]:
    """Return the angles of corners at one end of a prism, from downward to downhill [rad].

    `roll` turns the prism so that its y axis points uphill.
    """
    angles = np.arctan2(-corners[:, 1], -corners[:, 2]) % math.tau
    return sorted(round(float(angle), 6) for angle in angles)


def prism(case: Case, facets: int, path: pathlib.Path) -> dict[str, Any]:
    """Return what becomes of a prism."""
    write_prism(path, case, facets)
    material = physx.PhysxMaterial(case.friction, case.friction, 0.0)
    hull = physx.PhysxCollisionShapeConvexMesh(str(path), np.ones(3, np.float32), material)
    corners = np.array(hull.vertices)
    setting = Setting("mesh", "PGS, 50 iterations", "", {**sapien_can.TUNED, "mesh": str(path)})
    ends = {}
    for timestep in TIMESTEPS:
        motion = sapien_can.roll(case, float(timestep), setting)
        ends[timestep] = round(motion.phi[-1], 3)
    return {
        "asked": facets,
        "scale": case.scale,
        "left": edges(corners[corners[:, 0] < 0]),
        "right": edges(corners[corners[:, 0] > 0]),
        "end": ends,
    }


if __name__ == "__main__":
    real = Case(**json.load(sys.stdin))
    with tempfile.TemporaryDirectory() as folder:
        found = []
        for facets, scale in PRISMS:
            file = pathlib.Path(folder) / f"{facets}-{scale:g}.obj"  # SAPIEN keeps meshes by name
            found.append(prism(real.scaled(scale), facets, file))
    print("\n" + json.dumps({"prisms": found}))
