"""Regions of random trials: what one has on a desk, and what nobody has.

Each region takes one quantity, or all of them, to extremes, some of which lie beyond the domain. A
trial depends on its number alone.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from mjbeer import require
from mjbeer.model.setting import MUJOCO_INTEGRATORS, ROLLINGS, supported
from mjbeer.studies.stability.judge import Trial
from mjbeer.studies.stability.random_motions import (
    BESIDE_THE_SEPARATRIX,
    RESONANT,
    random_pace,
    random_start,
)
from mjbeer.studies.stability.random_picker import LogUniform, OneOf, RandomPicker, Uniform
from mjbeer.studies.stability.random_scenes import (
    ANYTHING,
    HEAVY_CAN,
    RATIOS,
    ordinary,
    real_liquid,
    sheet_metal,
    steep,
    thin_or_full,
    weak_or_strong_gravity,
    with_damping,
)
from mjbeer.theory.scene import Scene

_MANY = 200
"""Largest number of regular samples in half of the trials; in the others, ten times as many."""


def _with_setting(pick: RandomPicker, trial: Trial, kind: str) -> Trial:
    """Return a trial with any setting that its scene allows; every fourth has a tolerance.

    The kind "contact" has hardly any friction, or plenty, and no tolerance. "any" includes ways of
    rolling that the scene does not support. "attached" is a can in another world, which steps it
    accurately.
    """
    if kind == "attached":
        return replace(trial, rolling="contact", integrator="RK4", attached=True)
    if kind == "contact":
        rolling = "contact"
        friction = pick.number(LogUniform(0.01, 10))
    else:
        rollings = [rolling for rolling in ROLLINGS if supported(trial.scene, rolling)]
        if kind == "any":
            rollings += ROLLINGS
        rolling = pick.one(*rollings)
        friction = pick.number(OneOf(1.0, 1.0, LogUniform(0.01, 1e3)))
    trial = replace(trial, rolling=rolling, friction=friction)
    if rolling != "contact" and pick.one(True, False, False, False):
        return replace(trial, tolerance=pick.number(LogUniform(1e-12, 0.03)))
    integrator = pick.one(*MUJOCO_INTEGRATORS, "RK4", "DOP853", "DOP853")
    return replace(trial, integrator=integrator)


def _with_samples(pick: RandomPicker, trial: Trial, kind: str) -> Trial:
    """Return a trial with samples of a kind.

    "regular" samples are at every timestep, or every so many, "sparse" ones are two to six at
    random times, and "late" is the last alone or with the one before. MuJoCo's integrators have
    samples at whole numbers of timesteps only.
    """
    steps = trial.steps
    if kind == "regular":
        most = pick.one(_MANY, 10 * _MANY)
        return replace(trial, every=max(1, math.ceil(steps / most)))
    if kind == "late":
        before = max(0, steps - pick.one(0, 0, 1))
        moments = {float(before), float(steps)}
    else:
        count = pick.one(2, 3, 4, 5, 6)
        moments = {pick.number(Uniform(0, steps)) for _ in range(count)}
        if trial.integrator not in (None, "DOP853"):
            moments = {float(round(moment)) for moment in moments}
    return replace(trial, moments=tuple(sorted(moments)))


class Region(NamedTuple):
    """A part of the search. A trial chooses one of each tuple, all of which are equally likely."""

    name: str
    scenes: tuple[Callable[[RandomPicker], Scene], ...] = (ordinary,)
    starts: tuple[str, ...] = ("by hand",)
    paces: tuple[str, ...] = ("usual",)
    setting: str = "usual"
    samples: tuple[str, ...] = ("regular",)
    damped: bool = False

    def draw(self, pick: RandomPicker) -> Trial:
        """Return a random trial of this region.

        Raises:
          ParameterError: if the choices make a scene that cannot be, or a start or timestep outside
            the domain.
        """
        make_scene = pick.one(*self.scenes)
        scene = make_scene(pick)
        if self.damped:
            scene = with_damping(pick, scene)
        phi0, phi_dot0 = random_start(pick, scene, pick.one(*self.starts))
        timestep, steps = random_pace(pick, scene, phi0, phi_dot0, pick.one(*self.paces))
        trial = Trial(scene, phi0, phi_dot0, timestep=timestep, steps=steps)
        trial = _with_setting(pick, trial, self.setting)
        trial = _with_samples(pick, trial, pick.one(*self.samples))
        require.start(phi0, phi_dot0)
        require.within("timestep", timestep, *require.TIMESTEP)
        return trial


_EVERY_SCENE = (ordinary, HEAVY_CAN, ANYTHING, RATIOS, thin_or_full, steep, weak_or_strong_gravity)
_EVERY_START = ("by hand", "by hand", "spun", "far", BESIDE_THE_SEPARATRIX)
_EVERY_PACE = ("usual", "swinging", "extreme", "turning", RESONANT, "few", "long")
_EVERY_SAMPLING = ("regular", "sparse", "late")
_MOSTLY_ORDINARY = (ordinary, ordinary, ANYTHING)
_MOSTLY_HEAVY = (HEAVY_CAN, HEAVY_CAN, ordinary)
_USUAL_OR_SWINGING = ("usual", "swinging")
REGIONS = (
    Region("ordinary"),
    Region("anything", (ANYTHING,), _EVERY_START, ("extreme",), "any"),
    Region("sparse samples", _MOSTLY_ORDINARY, paces=_USUAL_OR_SWINGING, samples=("sparse",)),
    Region("single late sample", _MOSTLY_ORDINARY, paces=_USUAL_OR_SWINGING, samples=("late",)),
    Region("few steps", paces=("few",)),
    Region("fast rotation", _MOSTLY_HEAVY, ("spun",), ("turning",)),
    Region("resonance", _MOSTLY_HEAVY, ("spun",), (RESONANT,), samples=_EVERY_SAMPLING),
    Region("contact friction", setting="contact"),
    Region("mass ratios", (RATIOS,), paces=_USUAL_OR_SWINGING),
    Region("thin or full", (thin_or_full,), paces=_USUAL_OR_SWINGING, samples=_EVERY_SAMPLING),
    Region("long", paces=("long",), samples=_EVERY_SAMPLING),
    Region("far angles", starts=("far",), samples=_EVERY_SAMPLING),
    Region("steep", (steep,)),
    Region("weak or strong gravity", (weak_or_strong_gravity,)),
    Region("beside the separatrix", starts=(BESIDE_THE_SEPARATRIX,), samples=_EVERY_SAMPLING),
    Region("mixed", _EVERY_SCENE, _EVERY_START, _EVERY_PACE, "any", _EVERY_SAMPLING),
    Region("liquids", (real_liquid,), paces=_USUAL_OR_SWINGING),
    Region("attached", (sheet_metal,), ("let go",), ("desk",), "attached"),
    Region("damped", paces=_USUAL_OR_SWINGING, damped=True),
    Region(
        "damped, mixed",
        _EVERY_SCENE,
        _EVERY_START,
        _EVERY_PACE,
        "any",
        _EVERY_SAMPLING,
        damped=True,
    ),
)
"""All regions, from which equally many trials are drawn."""


def random_trial(number: int) -> Trial:
    """Return the trial of a number from 0 on; the regions take turns.

    The regions are wider than the domain. A trial outside it counts as refused, and is not replaced
    by another.

    Raises:
      ParameterError: if the scene, the start or the timestep is outside the domain.
    """
    return REGIONS[number % len(REGIONS)].draw(RandomPicker(number))
