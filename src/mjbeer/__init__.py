"""mjbeer: the rolling half-full beer can as a MuJoCo model that can be trusted.

All quantities are in SI units and radians. The letters of the formulas and the numbers of equations
are those of K. T. McDonald, "The Rolling Motion of a Half-Full Beer Can".
"""

from importlib import import_module
from typing import TYPE_CHECKING

from mjbeer.exceptions import (
    AngleWarning,
    DivergenceError,
    LiquidWarning,
    MjbeerError,
    ParameterError,
    ToleranceError,
    UntrustedWarning,
)
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.liquid import liquid
from mjbeer.theory.paper_scenes import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing, standing
from mjbeer.theory.trajectory import Trajectory, exact

if TYPE_CHECKING:
    from mjbeer.drawing.video import render
    from mjbeer.model.attach import attach, refill, wall_rise
    from mjbeer.model.build import build, specify
    from mjbeer.model.export import export
    from mjbeer.model.joints import reset
    from mjbeer.simulation.run import Run
    from mjbeer.simulation.simulate import simulate
    from mjbeer.studies.sweep import sweep
    from mjbeer.tracks.fit import Fit, fit
    from mjbeer.tracks.track import Track, read_track

__all__ = [
    "AngleWarning",
    "Can",
    "Damping",
    "DivergenceError",
    "Fit",
    "LiquidWarning",
    "Load",
    "MjbeerError",
    "ParameterError",
    "Run",
    "Scene",
    "Standing",
    "ToleranceError",
    "Track",
    "Trajectory",
    "UntrustedWarning",
    "attach",
    "build",
    "exact",
    "export",
    "fit",
    "frozen",
    "hoop",
    "liquid",
    "pendulum",
    "read_track",
    "refill",
    "render",
    "reset",
    "simulate",
    "sliding",
    "specify",
    "standing",
    "sweep",
    "wall_rise",
]

# Imported on first use, so that the exact theory works without MuJoCo.
_LAZY = {
    "model.attach": ("attach", "refill", "wall_rise"),
    "model.build": ("build", "specify"),
    "model.export": ("export",),
    "model.joints": ("reset",),
    "simulation.run": ("Run",),
    "simulation.simulate": ("simulate",),
    "drawing.video": ("render",),
    "studies.sweep": ("sweep",),
    "tracks.fit": ("Fit", "fit"),
    "tracks.track": ("Track", "read_track"),
}


def __getattr__(name: str) -> object:
    for module, names in _LAZY.items():
        if name in names:
            return getattr(import_module(f"mjbeer.{module}"), name)
    if name == "__version__":
        return import_module("importlib.metadata").version("mjbeer")
    raise AttributeError(f"module 'mjbeer' has no attribute {name!r}")


def __dir__() -> list[str]:
    return __all__
