"""Random starts: an angle phi [rad] and its rate [rad/s]."""

import math
from dataclasses import replace

from mjbeer.exceptions import NoEquilibriumError
from mjbeer.studies.stability.search.pick import Pick
from mjbeer.studies.stability.search.scenes import slow
from mjbeer.theory.scene import Scene

Start = tuple[float, float]


def ordinary(pick: Pick, scene: Scene) -> Start:
    """Return a start such as one makes by hand: let go, pushed or spun."""
    phi0 = pick.one(0.0, 1.0, math.pi, pick.between(-math.pi, math.pi), pick.decades(1e-9, 1))
    return phi0, pick.one(0.0, 0.0, pick.between(-3, 3)) / slow(scene)


def fast(pick: Pick, scene: Scene) -> Start:
    """Return a start with a spin much faster than any swing."""
    spin = pick.one(pick.decades(2, 500), pick.decades(2, 500), pick.decades(1e2, 1e6))
    return pick.between(-4, 4), pick.sign() * spin / slow(scene)


def far(pick: Pick, scene: Scene) -> Start:
    """Return a start many turns away, at rest, slow, or so fast that seconds take it many turns away."""
    phi0 = pick.sign() * pick.decades(1e2, 1e4)
    rate = pick.one(0.0, pick.between(-3, 3) / slow(scene), pick.sign() * pick.decades(1e2, 1e6))
    return phi0, rate


def beside_the_separatrix(pick: Pick, scene: Scene) -> Start:
    """Return a start at rest beside a barrier's top, or anywhere with nearly the energy of that top.

    The top is that of the scene without damping and drag.
    """
    form = scene.oscillator
    try:
        low, high = replace(scene, damping=0.0, drag=0.0).separatrix()
    except NoEquilibriumError:
        return ordinary(pick, scene)
    beside = pick.sign() * pick.decades(1e-15, 0.1)
    if pick.chance(0.5):
        return pick.one(low, high) + beside, 0.0
    phi0 = pick.between(low, high)
    missing = max(0.0, float(form.drop(phi0, high)))
    rate = math.sqrt(2 * missing / float(form.inertia(phi0)))
    return phi0, pick.sign() * rate * (1 + beside)


def anything(pick: Pick, scene: Scene) -> Start:
    """Return any of these starts."""
    return pick.one(ordinary, ordinary, fast, far, beside_the_separatrix)(pick, scene)
