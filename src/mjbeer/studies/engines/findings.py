"""What the can test shows, in sentences with its numbers, causes and sources.

Two numbers that stand together are those of the two cases, rock first.
"""

import numpy as np

from mjbeer.output.numbers import number
from mjbeer.studies.can_test import CASES, DURATION
from mjbeer.studies.engines.engine_tables import (
    COARSE,
    FINE,
    Way,
    closest,
    closest_defaults,
    order_cell,
    row_at,
    worst_error,
)
from mjbeer.studies.engines.results import CurveKey, Results, Row, order_of

_DEFAULT = Way("MuJoCo", "cylinder", "default")
_STIFF = Way("MuJoCo", "cylinder", "stiff contact, RK4")
_STIFF_EULER = Way("MuJoCo", "cylinder", "stiff contact")
_NEWTON = Way("Newton", "cylinder, MuJoCo", "stiff contact, RK4")
_CENIC = Way("Drake", "cylinder", "stiff contact, CENIC, error control")
_CENIC_STEPS = Way("Drake", "cylinder", "stiff contact, CENIC")
_CONSTRAINT = Way("Exudyn", "constraint", "default")
_PRISM = Way("PhysX (SAPIEN)", "cylinder", "default")
_ALL_SETTINGS = "([all settings](../engines/SETTINGS.md))"
"""Stands behind numbers that the main table lacks."""
_CONTACT = "https://mujoco.readthedocs.io/en/stable/modeling.html#solver-parameters"
_CREEP = "https://github.com/google-deepmind/mujoco/issues/3328"
_REST_OFFSET = "https://github.com/NVIDIAGameWorks/PhysX/issues/50"
_ROUND = (
    "https://nvidia-omniverse.github.io/PhysX/physx/5.4.1/_api_build/classPxCustomGeometryExt.html"
)
_ROLLING_POINTS = "https://github.com/siconos/siconos/issues/106"
_HYDROELASTIC = "https://drake.mit.edu/doxygen_cxx/group__hydroelastic__user__guide.html"


class _Reader:
    """Finds numbers in the results, as texts."""

    def __init__(self, results: Results) -> None:
        self._curves = {case: results.curves(case) for case in CASES}

    def row(self, case: str, way: Way, timestep: float = COARSE) -> Row:
        return row_at(self._curves[case][way.key(case)], timestep)

    def both(self, way: Way, timestep: float = COARSE) -> str:
        """Return the errors of both cases."""
        errors = (number(self.row(case, way, timestep).error) for case in CASES)
        return f"{' and '.join(errors)} rad"

    def fine_too(self, case: str, way: Way) -> str:
        """Return the errors of a case at both timesteps of the tables."""
        errors = (number(self.row(case, way, timestep).error) for timestep in (COARSE, FINE))
        return " and ".join(errors)

    def time(self, case: str, way: Way) -> str:
        """Return the least run time at 1 ms [ms]."""
        return number(1e3 * min(self.row(case, way).seconds))

    def least_of_others(self, case: str) -> tuple[str, CurveKey]:
        """Return the least error of a case at 1 ms among contacts that are not MuJoCo's, and its
        curve."""
        errors = {
            key: row_at(rows, COARSE).error
            for key, rows in self._curves[case].items()
            if rows[0].has_timestep
            and key.shape != _CONSTRAINT.shape
            and "MuJoCo" not in (key.engine, key.shape.partition(", ")[2])
        }
        least = min(errors, key=errors.__getitem__)
        return f"{number(errors[least])} rad", least

    def power(self, way: Way) -> str:
        """Return how the errors of both cases fall with the timestep."""
        falls = (order_cell(order_of(self._curves[case][way.key(case)])) for case in CASES)
        return " and ".join(dict.fromkeys(falls))


def answer(results: Results) -> str:
    """Return the answer of the test in some sentences, or why there is none.

    Raises:
      ValueError: if another engine is closer than those that the sentences name.
    """
    if results.absent:
        return f"There is no answer without {', '.join(results.absent)}, which could not be had."
    read = _Reader(results)
    defaults = {
        engine: worst_error(results, way) for engine, way in closest_defaults(results).items()
    }
    least = {engine: worst_error(results, way) for engine, way in closest(results).items()}
    by_mujoco = least.pop("MuJoCo")
    by_newton = least.pop("Newton")
    by_constraint = least.pop("Exudyn")
    is_as_told = (
        by_mujoco < by_newton < by_constraint < min(least.values())
        and max(defaults, key=defaults.__getitem__) == "MuJoCo"
        and worst_error(results, _CENIC) < worst_error(results, _CENIC_STEPS)
    )
    if not is_as_told:
        raise ValueError("the results are others than those that the answer is written for")
    return (
        f"Take for each of {len(defaults)} engines the shape that is closest to theory at its "
        "defaults. "
        f"At a timestep of 1 ms they are {number(min(defaults.values()))} to "
        f"{number(max(defaults.values()))} rad off within 2 s (the larger error of two cases); "
        "other shapes are further off. MuJoCo's error is the largest of these, and it hardly falls "
        "with the timestep: "
        f"{read.both(_DEFAULT, FINE)} (rock and roll) remain at 0.1 ms. SAPIEN's cylinder is "
        f"{number(worst_error(results, _PRISM))} rad off, as SAPIEN makes a prism of it. At the "
        "closest of the settings that we tried, MuJoCo's contact is "
        f"{number(by_mujoco)} rad off, and {number(by_newton)} rad in Newton, which has single "
        f"precision; Exudyn's rolling constraint is {number(by_constraint)} rad off; and the "
        f"contacts of the other {len(least)} engines are {number(min(least.values()))} to "
        f"{number(max(least.values()))} rad off. With an error control that chooses the steps, "
        f"Drake's contact is {number(worst_error(results, _CENIC))} rad off. The integrator RK4 "
        "has its part in MuJoCo's result: with its default integrator, the stiff contact is "
        f"{number(worst_error(results, _STIFF_EULER))} rad off."
    )


def findings(results: Results) -> list[str]:
    """Return what the errors show: a cause and a source for each. They are about all engines."""
    if results.absent:
        return []
    return [
        *_of_contact(results),
        *_of_shapes(results),
        *_of_timesteps(results),
    ]


def _of_contact(results: Results) -> list[str]:
    """Return what MuJoCo's contact and a constraint do."""
    read = _Reader(results)
    least_rock, rocker = read.least_of_others("rock")
    least_roll, roller = read.least_of_others("roll")
    return [
        f"**MuJoCo's default contact slides.** It is {read.both(_DEFAULT)} off, and "
        f"{read.both(_DEFAULT, FINE)} at 0.1 ms. Its friction is a damping, so that any steady "
        f"force moves the wheel ([issue 3328]({_CREEP})). How soft it is depends on `solref`, "
        "which is 20 ms by default, and not on the timestep "
        f"([MuJoCo's manual]({_CONTACT})).",
        "**A contact that gets stiffer with the timestep cures this**: a `solref` of two timesteps "
        "and a `solimp` of 0.9999. With MuJoCo's default integrator the errors are then "
        f"{read.both(_STIFF_EULER)} and fall as {read.power(_STIFF_EULER)}, like those of other "
        f"engines {_ALL_SETTINGS}. With RK4, which computes the forces four times in a step, they "
        f"are {read.both(_STIFF)} and fall as {read.power(_STIFF)}. Newton calls MuJoCo's library, "
        f"and is {read.both(_NEWTON)} off at the same setting. Of other contacts with steps of "
        f"1 ms, two settings have the least errors: {least_rock} for rock in {rocker.engine} "
        f"({rocker.shape}, {rocker.setting}), and {least_roll} for roll in {roller.engine} "
        f"({roller.shape}, {roller.setting}) {_ALL_SETTINGS}.",
        f"**An error control helps as well.** Drake's integrator CENIC is {read.both(_CENIC)} off "
        f"at an accuracy of 1e-7, and takes {read.time('roll', _CENIC)} ms for roll. With steps of "
        f"1 ms it is {read.both(_CENIC_STEPS)} off, and takes {read.time('roll', _CENIC_STEPS)} "
        "ms.",
        f"**A constraint needs no contact.** Exudyn's rolling disc is {read.both(_CONSTRAINT)} "
        f"off, and the errors fall as {read.power(_CONSTRAINT)}.",
    ]


def _of_shapes(results: Results) -> list[str]:
    """Return what is not round, and what becomes of it."""
    read = _Reader(results)
    rounded = Way("PhysX (SAPIEN)", "cylinder", "rest offset")
    capsule = Way("PhysX (SAPIEN)", "capsule", "PGS, 50 iterations")
    turned = read.row("roll", _PRISM).motion
    end = turned.phi[-1] if turned else 0.0
    exact_end = CASES["roll"].truth(np.array([0.0, DURATION]), 0.0).phi[-1]
    cylinder = Way("PyBullet", "cylinder", "default")
    sphere = Way("PyBullet", "sphere", "default")
    hydroelastic = Way("Drake", "cylinder, hydroelastic", "fine mesh")
    xpbd = Way("Newton", "cylinder, XPBD", "default")
    xpbd_sphere = Way("Newton", "sphere, XPBD", "default")
    return [
        "**A cylinder of SAPIEN's is a prism**: SAPIEN passes PhysX a convex mesh. Each edge that "
        f"strikes the incline takes energy, so that after 2 s it has turned {end:.1f} rad instead "
        f"of {exact_end:.1f} rad. PhysX's makers "
        f"[advise]({_REST_OFFSET}) to make the prism smaller and to add a rest offset: with one of "
        f"32 mm, it is {read.both(rounded)} off {_ALL_SETTINGS}. The capsule, which is round, is "
        f"{read.both(capsule)} off. PhysX itself has a [round cylinder]({_ROUND}) since version "
        "5.1. SAPIEN does not offer it, so that it is not measured here.",
        f"**Bullet's cylinder differs from its sphere**: {read.both(cylinder)} against "
        f"{read.both(sphere)} at the defaults {_ALL_SETTINGS}. We think that this is because a "
        "cylinder keeps contact points from step to step, which do not follow a body that rolls "
        f"([Siconos found so]({_ROLLING_POINTS})), while the single point of a sphere is found "
        "anew.",
        "**Drake's hydroelastic cylinder is a mesh**, here with edges of at most a tenth of the "
        f"radius: {read.both(hydroelastic)} {_ALL_SETTINGS}. Its point contact has a round "
        f"cylinder ([Drake's manual]({_HYDROELASTIC})).",
        f"**Newton's XPBD** is {read.both(xpbd)} off with a cylinder and {read.both(xpbd_sphere)} "
        f"with a sphere {_ALL_SETTINGS}. We do not know the cause.",
    ]


def _of_timesteps(results: Results) -> list[str]:
    """Return what a shorter timestep does where nothing slides."""
    read = _Reader(results)
    of_first_order = {
        "DART's cylinder with ODE's contact points": Way("DART", "cylinder", "ODE finds contacts"),
        "Pymunk's circle": Way("Pymunk", "circle", "default"),
        "PyBullet's sphere": Way("PyBullet", "sphere", "default"),
        "MuJoCo's stiff contact with its default integrator": _STIFF_EULER,
    }
    falls = ", ".join(f"{read.power(way)} for {name}" for name, way in of_first_order.items())
    in_single_precision = {
        "Box2D": Way("Box2D", "circle", "long, stiff contact"),
        "Rapier": Way("Rapier", "cylinder", "stiff contact"),
        "Newton on MuJoCo's contact": _NEWTON,
        "PhysX's capsule at its defaults": Way("PhysX (SAPIEN)", "capsule", "default"),
    }
    floors = ", ".join(
        f"{read.fine_too('roll', way)} rad for {name}" for name, way in in_single_precision.items()
    )
    return [
        "**Where a contact does not slide, the integrator's order remains**: the errors fall as "
        "about the first power of the timestep, as those of semi-implicit Euler do. "
        f"They fall as {falls} {_ALL_SETTINGS}.",
        "**Four engines in single precision do not gain from 0.1 ms**: their errors of roll at 1 "
        f"and at 0.1 ms are {floors} {_ALL_SETTINGS}. We do not know the cause. In "
        "Rapier it is not the digits of the position: the errors stay as they are if the can "
        "starts 10 m from the origin.",
    ]
