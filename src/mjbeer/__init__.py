"""mjbeer: the rolling half-full beer can as a MuJoCo model that can be trusted.

SI units and radians throughout; the letters of the formulas are those of K. T. McDonald,
"The Rolling Motion of a Half-Full Beer Can", whose equation numbers the docstrings cite.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from mjbeer.can import Can
from mjbeer.exact import exact
from mjbeer.exceptions import MjbeerError
from mjbeer.load import Load
from mjbeer.scene import Scene, frozen, hoop, pendulum, sliding
from mjbeer.trajectory import Trajectory

if TYPE_CHECKING:
    from mjbeer.model import build
    from mjbeer.simulation import simulate
    from mjbeer.video import render

__all__ = [
    "Can",
    "Load",
    "MjbeerError",
    "Scene",
    "Trajectory",
    "build",
    "exact",
    "frozen",
    "hoop",
    "pendulum",
    "render",
    "simulate",
    "sliding",
]

# Imported on first use, so that the exact theory is there without MuJoCo.
_SIMULATION = {"build": "mjbeer.model", "simulate": "mjbeer.simulation", "render": "mjbeer.video"}


def __getattr__(name: str) -> object:
    if name in _SIMULATION:
        return getattr(import_module(_SIMULATION[name]), name)
    raise AttributeError(f"module 'mjbeer' has no attribute {name!r}")
