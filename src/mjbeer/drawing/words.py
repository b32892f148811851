"""A scene in words, for titles and captions."""

import math

from mjbeer.theory.can import Damping
from mjbeer.theory.scene import Scene

_FILLS = {0.25: "quarter-full", 0.5: "half-full", 0.75: "three-quarters-full", 1.0: "full"}
"""Words for the usual fills; others are given in per cent."""


def in_words(scene: Scene) -> str:
    """Return a scene in words, such as "half-full massless can, beer frozen, incline 10°"."""
    if scene.load.inertia == 0:
        parts = _point_load_in_words(scene)
    elif scene.load.fill is None:
        parts = _load_in_words(scene)
    else:
        parts = _beer_in_words(scene, scene.load.fill)
    law = scene.damping_law
    if law and not law.liquid:
        is_linear = law == Damping(law.linear)
        parts.append(f"damping {law.linear:.3g} N m s" if is_linear else "damped")
    if scene.drag:
        parts.append(f"drag {scene.drag:.3g} kg/m")
    parts.append(f"incline {in_degrees(scene.incline)}" if scene.incline else "level ground")
    return ", ".join(parts)


def _beer_in_words(scene: Scene, fill: float) -> list[str]:
    full = _FILLS.get(fill, f"{100 * fill:.3g} % full")
    contents = scene.damping_law.liquid or f"beer {scene.attachment}"
    return [f"{full} {_can_in_words(scene)}", contents]


def _load_in_words(scene: Scene) -> list[str]:
    offset = f"its centre of mass {1e3 * scene.load.offset:.3g} mm from the axis"
    return [_can_in_words(scene), f"load {scene.attachment}", offset]


def _point_load_in_words(scene: Scene) -> list[str]:
    """Return the words for a load without size: a pendulum's bob, or a weight on a hoop."""
    body = f"{1e3 * scene.can.mass:.3g} g"
    load = f"{1e3 * scene.load.mass:.3g} g"
    if scene.attachment == "sliding":
        return [f"wheel of {body} with a bob of {load}"]
    return [f"hoop of {body} with {load} on its rim"]


def _can_in_words(scene: Scene) -> str:
    return "massless can" if scene.can.mass == 0 else f"can of {1e3 * scene.can.mass:.3g} g"


def in_degrees(angle: float) -> str:
    """Return an angle [rad] in degrees with their sign, to a tenth of a degree."""
    return f"{round(math.degrees(angle), 1):g}°".replace("-", "\N{MINUS SIGN}")


def damping_in_words(scene: Scene) -> str:
    """Return the torque between can and load, divided by their slip rate w, in words.

    It reads "0.001 N m s", or "1e-05 N m s + 2e-08 N m s^3 w^2", or "0" if there is none.
    """
    units = ("N m s", "N m s^2 |w|", "N m s^3 w^2")
    coefficients = scene.damping_law.coefficients
    terms = [
        f"{coefficient:.4g} {unit}"
        for coefficient, unit in zip(coefficients, units, strict=True)
        if coefficient
    ]
    return " + ".join(terms) or "0"
