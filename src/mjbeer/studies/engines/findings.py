"""What the can test shows, in sentences with its numbers, causes and sources."""

import math

import numpy as np

from mjbeer.studies.engines.engine_tables import COARSE, FINE, Way, order_cell, row_at, ways
from mjbeer.studies.engines.results import CASES, DURATION, EQUATION, Results, Row, order_of

_STIFF = Way("MuJoCo", "cylinder", "stiff contact, RK4")
_SOFT = Way("MuJoCo", "cylinder", "default")
_CONSTRAINT = Way("Exudyn", "constraint", "default")
_DRAKE_MANUAL = "https://drake.mit.edu/doxygen_cxx/group__hydroelastic__user__guide.html"
_MUJOCO_MANUAL = "https://mujoco.readthedocs.io/en/stable/modeling.html#solver-parameters"


class _Reader:
    """Finds numbers in the results, as texts."""

    def __init__(self, results: Results) -> None:
        self._curves = {case: results.curves(case) for case in CASES}

    def row(self, case: str, way: Way, timestep: float = COARSE) -> Row:
        return row_at(self._curves[case][way.key(case)], timestep)

    def error(self, case: str, way: Way, timestep: float = COARSE) -> str:
        return f"{self.row(case, way, timestep).error:.2g}"

    def both(self, way: Way, timestep: float = COARSE) -> str:
        """Return the errors of both cases."""
        rock, roll = (self.error(case, way, timestep) for case in CASES)
        return f"{rock} rad (rock) and {roll} rad (roll)"

    def worst(self, way: Way) -> float:
        """Return the larger error of both cases at 1 ms [rad]."""
        return max(self.row(case, way).error for case in CASES)

    def least_of_others(self) -> str:
        """Return the least errors of both cases at 1 ms among contacts that are not MuJoCo's."""
        texts = []
        for case, of_case in self._curves.items():
            errors = [
                row_at(rows, COARSE).error
                for key, rows in of_case.items()
                if key.engine not in (EQUATION, "MuJoCo") and key.shape != _CONSTRAINT.shape
            ]
            texts.append(f"{min(errors):.2g} rad ({case})")
        return " and ".join(texts)

    def power(self, way: Way) -> str:
        """Return how the errors of both cases fall with the timestep."""
        return " and ".join(
            order_cell(order_of(self._curves[case][way.key(case)])) for case in CASES
        )


def answer(results: Results) -> str:
    """Return the answer of the test in some sentences."""
    read = _Reader(results)
    engines = [way for way in ways(results) if way.engine != EQUATION]
    defaults = [read.worst(way) for way in engines if way.setting == "default"]
    nearest: dict[str, float] = {}
    for way in engines:
        nearest[way.engine] = min(read.worst(way), nearest.get(way.engine, math.inf))
    stiff = nearest.pop("MuJoCo")
    constraint = nearest.pop("Exudyn")
    others = nearest.values()
    return (
        f"At a timestep of 1 ms, {len(nearest) + 2} engines at their defaults are "
        f"{min(defaults):.1g} to {max(defaults):.2g} rad off in 2 s (the larger error of two "
        "cases). Each at the closest of its settings that we tried, it is "
        f"{stiff:.1g} rad with MuJoCo's contact, {constraint:.1g} rad with Exudyn's rolling "
        f"constraint, and {min(others):.1g} to {max(others):.1g} rad with the contacts of the "
        f"other {len(others)}. MuJoCo's default contact does not converge: "
        f"{read.both(_SOFT, FINE)} remain at 0.1 ms."
    )


def findings(results: Results) -> list[str]:
    """Return what the errors show: a cause and a source for each."""
    read = _Reader(results)
    prism = Way("PhysX (SAPIEN)", "cylinder", "default")
    capsule = Way("PhysX (SAPIEN)", "capsule", "PGS, 50 iterations")
    turned = read.row("roll", prism).motion
    end = turned.phi[-1] if turned else 0.0
    exact_end = CASES["roll"].truth(np.array([0.0, DURATION]), 0.0).phi[-1]
    cylinder = Way("PyBullet", "cylinder", "default")
    sphere = Way("PyBullet", "sphere", "default")
    hydroelastic = Way("Drake", "cylinder, hydroelastic", "fine mesh")
    xpbd = Way("Newton", "cylinder, XPBD", "default")
    newton = Way("Newton", "cylinder, MuJoCo", "stiff contact")
    first = {
        "DART's cylinder with ODE's contact points": Way("DART", "cylinder", "ODE finds contacts"),
        "Pymunk's circle": Way("Pymunk", "circle", "default"),
        "PyBullet's sphere": sphere,
        "Drake's cylinder with CENIC": Way("Drake", "cylinder", "stiff contact, CENIC"),
    }
    falls = "; ".join(f"{name} {read.power(way)}" for name, way in first.items())
    single = {
        "Box2D": Way("Box2D", "circle", "long, stiff contact"),
        "Rapier": Way("Rapier", "cylinder", "stiff contact"),
        "PhysX's capsule": capsule,
    }
    floors = "; ".join(
        f"{name} {read.error('roll', way)} and {read.error('roll', way, FINE)} rad"
        for name, way in single.items()
    )
    return [
        f"**MuJoCo's default contact slides.** It is {read.both(_SOFT)} off at 1 ms, and "
        f"{read.both(_SOFT, FINE)} at 0.1 ms. Friction in a soft contact is a damping, which any "
        "steady force overcomes, and its softness has a time constant of its own, 20 ms "
        "(`solref`), that does not shrink with the timestep "
        f"([MuJoCo's manual]({_MUJOCO_MANUAL}), "
        "[issue 3328](https://github.com/google-deepmind/mujoco/issues/3328)).",
        "**With a `solref` of two timesteps and a `solimp` of 0.9999** the softness shrinks with "
        f"the timestep: {read.both(_STIFF)} at 1 ms, and the errors fall as {read.power(_STIFF)}. "
        f"The least errors of other contacts at 1 ms are {read.least_of_others()}.",
        f"**A constraint needs no contact.** Exudyn's rolling disc is {read.both(_CONSTRAINT)} "
        f"off, and the errors fall as {read.power(_CONSTRAINT)}.",
        f"**PhysX's cylinder is a prism.** PhysX had no cylinder, so SAPIEN passes it a convex "
        f"mesh, and each edge that strikes the incline takes energy: after 2 s it has turned "
        f"{end:.1f} rad instead of {exact_end:.1f} rad. The capsule is round: {read.both(capsule)} "
        "([issue 50](https://github.com/NVIDIAGameWorks/PhysX/issues/50)).",
        f"**Bullet's cylinder differs from its sphere**: {read.both(cylinder)} against "
        f"{read.both(sphere)}. We think that this is because a cylinder keeps contact points from "
        "step to step, which do not follow a body that rolls "
        "([Siconos found so](https://github.com/siconos/siconos/issues/106)), while the single "
        "point of a sphere is found anew.",
        "**Drake's hydroelastic cylinder is a mesh**, here with edges of at most a tenth of the "
        f"radius: {read.both(hydroelastic)}. Its point contact has a round cylinder "
        f"([Drake's manual]({_DRAKE_MANUAL})).",
        f"**Newton's solvers differ**: XPBD's cylinder is {read.both(xpbd)} off, and MuJoCo's, "
        f"with a stiff contact, {read.both(newton)}. XPBD with 20 iterations instead of 2 is as "
        "far off; we do not know the cause.",
        f"**Where a contact does not slide, the integrator's order remains**: the errors fall as "
        f"the first power of the timestep h, as those of semi-implicit Euler do. In the two cases: "
        f"{falls}.",
        "**Single precision ends what a shorter timestep gains**: in 0.1 ms the can moves by "
        "0.2 mm at most, of which single precision keeps three digits 2 m down the incline. "
        f"Errors of roll at 1 and at 0.1 ms: {floors}.",
    ]
