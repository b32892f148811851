"""How wheels with facets roll in MuJoCo and in PhysX, beside the theory of rigid prisms.

`python -m mjbeer.studies.polygon` rolls MuJoCo's own convex meshes down the incline of the can test
and writes two tables into `STORED`, in a few seconds. What PhysX did is in `physx_prisms.json`: how
its hulls came out and where they ended. `python -m tools.physx_prisms` makes it, with SAPIEN.
`mjbeer.theory.prism` rolls the same hulls.
"""

import json
import pathlib
from collections.abc import Sequence
from dataclasses import dataclass

from mjbeer.output.terminal import Table
from mjbeer.studies import mujoco_bodies, stored_tables
from mjbeer.studies.can_test import DURATION, ROLL
from mjbeer.theory import prism

FACETS = (16, 32, 64, 120)
TIME_CONSTANTS = (2e-4, 1e-3, 5e-3)
"""Time constants of stiff contacts of MuJoCo [s], from twice the timestep on."""
TIMESTEP = 1e-4
"""[s]"""
STORED = pathlib.Path(__file__).with_name("polygon.json")
"""The tables "mujoco" and "physx"."""
PHYSX = pathlib.Path(__file__).with_name("physx_prisms.json")


@dataclass(frozen=True)
class PhysxPrism:
    """A prism that PhysX rolled."""

    asked: int
    """Number of facets that PhysX was given."""
    scale: float
    """Factor of all lengths, and of gravity."""
    left: list[float]
    """Angles of the edges that it kept at one end of the prism [rad]."""
    right: list[float]
    """Those at the other end."""
    end: dict[str, float]
    """phi at the end [rad] at each timestep [s]."""


def physx_prisms() -> list[PhysxPrism]:
    """Return the prisms that PhysX rolled."""
    stored = json.loads(PHYSX.read_text(encoding="utf-8"))
    return [PhysxPrism(**row) for row in stored["prisms"]]


def theory_end(edges: Sequence[float], flies: bool = True, duration: float = DURATION) -> float:
    """Return phi of a rigid prism at the end [rad]."""
    motion = prism.roll(ROLL.scene, edges, duration, ROLL.phi0, ROLL.phi_dot0, flies)
    return float(motion.phi[-1])


def mujoco_end(
    facets: int,
    time_constant: float | None = None,
    timestep: float = TIMESTEP,
    duration: float = DURATION,
) -> float:
    """Return phi of a mesh at the end [rad] on a stiff contact of a `time_constant` [s].

    Without one, the contact is MuJoCo's default.
    """
    option = 'integrator="RK4"'
    contact = ""
    if time_constant is not None:
        option += ' cone="elliptic" impratio="100"'
        contact = f'solref="{time_constant!r} 1" solimp="0.9999 0.9999 0.001"'
    edges = prism.regular(facets).tolist()
    model = mujoco_bodies.free_body(ROLL, timestep, option, contact, edges)
    return float(mujoco_bodies.run(ROLL, model, duration).phi[-1])


def mujoco_table() -> Table:
    """Return where prisms end by theory and in MuJoCo."""
    stiff = [f"MuJoCo, {constant * 1e3:g} ms" for constant in TIME_CONSTANTS]
    columns = ("facets", "theory, held down", "theory", *stiff, "MuJoCo's default")
    lines = []
    for facets in FACETS:
        edges = prism.regular(facets).tolist()
        ends = [theory_end(edges, flies=False), theory_end(edges)]
        ends += [mujoco_end(facets, constant) for constant in TIME_CONSTANTS]
        ends.append(mujoco_end(facets))
        lines.append((str(facets), *(f"{end:.1f}" for end in ends)))
    return Table("", columns, lines)


def physx_table() -> Table:
    """Return where PhysX's hulls end by theory and in PhysX."""
    columns = ("asked for", "kept at the ends", "theory of the two ends", "PhysX, 1 ms", "0.1 ms")
    lines = []
    for rolled in physx_prisms():
        ends = [f"{theory_end(edges):.1f}" for edges in (rolled.left, rolled.right)]
        name = f"{rolled.asked}" if rolled.scale == 1 else f"{rolled.asked}, {rolled.scale:g} times"
        kept = f"{len(rolled.left)}, {len(rolled.right)}"
        measured = [f"{rolled.end[timestep]:.1f}" for timestep in ("1e-3", "1e-4")]
        lines.append((name, kept, ", ".join(ends), *measured))
    return Table("", columns, lines)


if __name__ == "__main__":
    stored_tables.save(STORED, {"mujoco": mujoco_table(), "physx": physx_table()})
