"""The scenes of the paper: beer that slides, beer that is frozen, a pendulum, and a hoop that hops.

Each scene remembers the call that made it.
"""

import functools
import inspect
from collections.abc import Callable
from typing import ParamSpec

from mjbeer import require
from mjbeer.theory.can import BEER, LENGTH, RADIUS, Can, Damping, Load
from mjbeer.theory.scene import GRAVITY, INCLINE, Call, Scene

Parameters = ParamSpec("Parameters")


def remembers_call(make: Callable[Parameters, Scene]) -> Callable[Parameters, Scene]:
    """Return the function, changed so that each scene has the call that made it as `made_by`."""
    names = tuple(inspect.signature(make).parameters)

    @functools.wraps(make)
    def remembering(*arguments: Parameters.args, **named: Parameters.kwargs) -> Scene:
        scene = make(*arguments, **named)
        given = dict(zip(names, arguments, strict=False)) | named
        require.set_fields(scene, made_by=Call(remembering, given))
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
    """Return the scene of beer that slides in a can: sections 2 and 3 of the paper.

    `incline` is in [rad], `fill` is h/2a of eq. (32), and `density` [kg/m^3] is that of the beer.
    The can is massless, as in section 2, unless one is given. `damping` [N m s] and the `drag` of
    the air [kg/m] are fields of `Scene`.

    Raises:
      ParameterError: as `Scene`.
    """
    can = _given_or_massless(can)
    load = Load.segment(can.radius, can.length, fill, density)
    return Scene(can, load, incline, "sliding", gravity, damping, drag)


@remembers_call
def frozen(
    incline: float = INCLINE,
    fill: float = 0.5,
    can: Can | None = None,
    density: float = BEER,
    gravity: float = GRAVITY,
) -> Scene:
    """Return the scene of beer frozen to the can, with parameters as of `sliding`: appendix A.

    Raises:
      ParameterError: as `Scene`.
    """
    can = _given_or_massless(can)
    load = Load.segment(can.radius, can.length, fill, density)
    return Scene(can, load, incline, "frozen", gravity)


def _given_or_massless(can: Can | None) -> Can:
    return Can.massless() if can is None else require.instance("can", can, Can)


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

    `incline` is in [rad]; `wheel_mass` and `load_mass` are M and m [kg], and `offset` is the
    pendulum's length b [m]. The paper gives no numbers: the defaults are a wheel of the can's size
    and a bob of half its mass.

    Raises:
      ParameterError: as `Scene`.
    """
    wheel = Can.hoop(radius, length, wheel_mass)
    bob = Load.point(load_mass, offset)
    return Scene(wheel, bob, incline, "sliding", gravity)


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

    `incline` is in [rad]; `hoop_mass` and `load_mass` are M and m [kg]. It hops if M/m is below
    1/13; the default is 1/20.

    Raises:
      ParameterError: as `Scene`.
    """
    rim = Can.hoop(radius, length, hoop_mass)
    weight = Load.point(load_mass, radius)
    return Scene(rim, weight, incline, "frozen", gravity)
