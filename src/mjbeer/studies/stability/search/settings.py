"""Random settings: how a can is made to roll, and how it is stepped."""

from dataclasses import dataclass

from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, Integrator, Rolling, supported
from mjbeer.studies.stability.search.pick import Pick
from mjbeer.theory.scene import Scene


@dataclass(frozen=True)
class Choice:
    """What a random run chooses of a setting besides its timestep."""

    rolling: Rolling
    integrator: Integrator
    tolerance: float | None
    friction: float


def ordinary(pick: Pick, scene: Scene) -> Choice:
    """Return any way of rolling that the scene allows, any integrator, and in every fourth run a tolerance."""
    rolling = pick.one(*(way for way in ROLLINGS if supported(scene, way)))
    tolerance = None
    if rolling != "contact" and pick.chance(0.25):  # a stiff contact would need too many steps to reach it
        tolerance = 10 ** -pick.between(1.5, 12)
    friction = pick.one(1.0, 1.0, pick.decades(0.01, 10), pick.decades(1e-2, 1e3))
    return Choice(rolling, pick.one(*INTEGRATORS, "RK4", DOP853, DOP853), tolerance, friction)


def contact(pick: Pick, scene: Scene) -> Choice:
    """Return a contact with next to no friction, or plenty."""
    return Choice("contact", pick.one(*INTEGRATORS, "RK4", DOP853), None, pick.decades(0.01, 10))


def anything(pick: Pick, scene: Scene) -> Choice:
    """Return any setting, also where MuJoCo cannot have the scene that way."""
    choice = ordinary(pick, scene)
    rolling = pick.one(choice.rolling, choice.rolling, *ROLLINGS)
    return Choice(rolling, choice.integrator, choice.tolerance if rolling != "contact" else None, choice.friction)
