"""The scenes that have a name, as functions that make them; and what a scene is in words."""

import functools
import math
from collections.abc import Callable, Collection
from typing import ParamSpec

from mjbeer import require
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.damping import Damping
from mjbeer.theory.load import BEER, Load
from mjbeer.theory.scene import GRAVITY, INCLINE, Scene

Parameters = ParamSpec("Parameters")


def named(make: Callable[Parameters, Scene]) -> Callable[Parameters, Scene]:
    """Return a function that makes a scene, and has it remember by which arguments."""

    @functools.wraps(make)
    def made(*arguments: Parameters.args, **others: Parameters.kwargs) -> Scene:
        scene = make(*arguments, **others)
        require.store(scene, made_by=(made, arguments, others))
        return scene

    return made


@named
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

    `incline` is in [rad], `fill` is h/2a of eq. (32), and `density` is the beer's [kg/m^3]. The beer slides without
    friction unless `damping` [N m s] is given; `drag` [kg/m] is that of the air. Both are fields of `Scene`.

    Raises:
      ParameterError: as `Scene`.
    """
    can, load = _of_beer(can, fill, density)
    return Scene(can, load, incline, "sliding", gravity, damping, drag)


@named
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


@named
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


@named
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


_FILLS = {0.25: "quarter-full", 0.5: "half-full", 0.75: "three-quarters-full", 1.0: "full"}


def in_words(scene: Scene, varied: Collection[str] = ()) -> str:
    """Return what a scene is, as "half-full massless can, beer frozen, incline 10°".

    `varied` names what differs between the scenes of a plot and is therefore left out: "fill", "can" (its mass),
    "load" (how it is attached, or the masses of a hoop or a pendulum), "incline", "damping" (and the drag).
    """
    can, load = scene.can, scene.load
    if load.inertia > 0:
        full = "" if load.fill is None or "fill" in varied else _FILLS.get(load.fill, f"{100 * load.fill:.3g} % full")
        kind = "can" if "can" in varied else "massless can" if can.mass == 0 else f"can of {1e3 * can.mass:.3g} g"
        parts = [f"{full} {kind}".strip()]
        parts.append("" if "load" in varied else f"{'load' if load.fill is None else 'beer'} {scene.attachment}")
        parts.append(f"its centre of mass {1e3 * load.offset:.3g} mm from the axis" if load.fill is None else "")
    else:  # a load without size: a pendulum's bob or a weight on a hoop
        body = "wheel with a pendulum" if scene.attachment == "sliding" else "hoop with a weight on its rim"
        parts = [body, "" if "load" in varied else f"M = {1e3 * can.mass:.3g} g, m = {1e3 * load.mass:.3g} g"]
    if "damping" not in varied:
        law = scene.damping_law
        parts.append("" if not law else f"damping {law.linear:.3g} N m s" if law == Damping(law.linear) else "damped")
        parts.append(f"drag {scene.drag:.3g} kg/m" if scene.drag else "")
    if "incline" not in varied:
        parts.append(f"incline {in_degrees(scene.incline)}" if scene.incline else "level ground")
    return ", ".join(part for part in parts if part)


def in_degrees(angle: float) -> str:
    """Return an angle [rad] in degrees with their sign, to a tenth of a degree."""
    return f"{round(math.degrees(angle), 1):g}°".replace("-", "\N{MINUS SIGN}")


def damping_in_words(scene: Scene) -> str:
    """Return the torque between can and load over their slip rate w, as "0.001 N m s"; "0" if there is none."""
    shares = zip(scene.damping_law.coefficients, ("N m s", "N m s^2 |w|", "N m s^3 w^2"), strict=True)
    return " + ".join(f"{share:.4g} {unit}" for share, unit in shares if share) or "0"
