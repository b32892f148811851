"""The scenes of the paper, as functions that make them."""

import functools
import inspect
from collections.abc import Callable
from typing import ParamSpec

from mjbeer import require
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.damping import Damping
from mjbeer.theory.load import BEER, Load
from mjbeer.theory.scene import GRAVITY, INCLINE, Scene

Parameters = ParamSpec("Parameters")


def remembers_call(make: Callable[Parameters, Scene]) -> Callable[Parameters, Scene]:
    """Return the function with scenes that remember it and its arguments."""

    @functools.wraps(make)
    def remembering(*arguments: Parameters.args, **others: Parameters.kwargs) -> Scene:
        scene = make(*arguments, **others)
        require.set_fields(scene, made_by=(remembering, inspect.signature(make).bind(*arguments, **others).arguments))
        return scene

    return remembering


@remembers_call
def sliding(
    incline: float = INCLINE,
    fill: float = 0.5,
    can: Can | None = None,
    density: float = BEER,
    gravity: float = GRAVITY,
    damping: float | Damping = 0.0,
    drag: float = 0.0,
) -> Scene:
    """Return the scene of beer that slides in a can: sections 2 (massless can, the default) and 3 of the paper.

    `incline` is in [rad], `fill` is h/2a of eq. (32), and `density` is the beer's [kg/m^3]. `damping` [N m s] and the
    `drag` of the air [kg/m] are fields of `Scene`.

    Raises:
      ParameterError: as `Scene`.
    """
    can, load = _of_beer(can, fill, density)
    return Scene(can, load, incline, "sliding", gravity, damping, drag)


@remembers_call
def frozen(
    incline: float = INCLINE, fill: float = 0.5, can: Can | None = None, density: float = BEER, gravity: float = GRAVITY
) -> Scene:
    """Return the scene of beer frozen to the can, with parameters as of `sliding`: appendix A (massless can).

    Raises:
      ParameterError: as `Scene`.
    """
    can, load = _of_beer(can, fill, density)
    return Scene(can, load, incline, "frozen", gravity)


def _of_beer(can: Can | None, fill: float, density: float) -> tuple[Can, Load]:
    can = Can.massless() if can is None else require.instance("can", can, Can)
    return can, Load.segment(can.radius, can.length, fill=fill, density=density)


@remembers_call
def pendulum(
    incline: float = INCLINE,
    wheel_mass: float = 0.2,
    load_mass: float = 0.1,
    offset: float = 0.025,
    radius: float = RADIUS,
    length: float = LENGTH,
    gravity: float = GRAVITY,
) -> Scene:
    """Return the scene of a hoop wheel with a simple pendulum on its axle: appendix B.

    `incline` is in [rad]; `wheel_mass` and `load_mass` are M and m [kg], and `offset` is the pendulum's length b [m].
    The paper gives no numbers: the defaults are a wheel of the can's size and a bob of half its mass.

    Raises:
      ParameterError: as `Scene`.
    """
    return Scene(Can.hoop(radius, length, wheel_mass), Load.point(load_mass, offset), incline, "sliding", gravity)


@remembers_call
def hoop(
    incline: float = 0.0,
    hoop_mass: float = 0.01,
    load_mass: float = 0.2,
    radius: float = RADIUS,
    length: float = LENGTH,
    gravity: float = GRAVITY,
) -> Scene:
    """Return the scene of a hoop with a point load on its rim, the hopping hoop: appendix A.4.

    `incline` is in [rad]; `hoop_mass` and `load_mass` are M and m [kg]. The default M/m = 1/20 is light enough to hop,
    for which M/m must be below 1/13.

    Raises:
      ParameterError: as `Scene`.
    """
    return Scene(Can.hoop(radius, length, hoop_mass), Load.point(load_mass, radius), incline, "frozen", gravity)
