"""A scene in words, for titles and captions."""

import math
from collections.abc import Collection

from mjbeer.theory.damping import Damping
from mjbeer.theory.scene import Scene

_FILLS = {0.25: "quarter-full", 0.5: "half-full", 0.75: "three-quarters-full", 1.0: "full"}


def in_words(scene: Scene, varied: Collection[str] = ()) -> str:
    """Return what a scene is, as "half-full massless can, beer frozen, incline 10°".

    `varied` names what differs between the scenes of a plot and is therefore left out: "fill", "can" (its mass),
    "load" (how it is attached, or the masses of a hoop or a pendulum), "incline", "damping" (and the drag).
    """
    parts = _beer(scene, varied) if scene.load.inertia > 0 else _point(scene, varied)
    if scene.dissipates and "damping" not in varied:
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
    units = ("N m s", "N m s^2 |w|", "N m s^3 w^2")
    shares = zip(scene.damping_law.coefficients, units, strict=True)
    return " + ".join(f"{share:.4g} {unit}" for share, unit in shares if share) or "0"


def _beer(scene: Scene, varied: Collection[str]) -> list[str]:
    fill, mass = scene.load.fill, scene.can.mass
    full = "" if fill is None or "fill" in varied else _FILLS.get(fill, f"{100 * fill:.3g} % full") + " "
    can = "can" if "can" in varied else "massless can" if mass == 0 else f"can of {1e3 * mass:.3g} g"
    load = "load" if fill is None else "beer"
    own = f"its centre of mass {1e3 * scene.load.offset:.3g} mm from the axis" if fill is None else ""
    return [full + can, "" if "load" in varied else f"{load} {scene.attachment}", own]


def _point(scene: Scene, varied: Collection[str]) -> list[str]:
    """Return the words for a load without size: a pendulum's bob or a weight on a hoop."""
    body = "wheel with a pendulum" if scene.attachment == "sliding" else "hoop with a weight on its rim"
    masses = f"M = {1e3 * scene.can.mass:.3g} g, m = {1e3 * scene.load.mass:.3g} g"
    return [body, "" if "load" in varied else masses]
