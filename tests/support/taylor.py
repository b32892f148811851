"""The witness of exact theory: J and V in 40 digits, and motions by heyoka's Taylor series in extended precision.

Motions are those of Lagrange's two equations as they stand, solved for the accelerations; a frozen load has u = a phi,
and one equation: the first times a, plus the second.

M u_ddot - m b (cos(phi) phi_ddot - sin(phi) phi_dot^2) = m_t g sin(alpha) - T(w)/a - drag u_dot |u_dot|
I phi_ddot - m b cos(phi) u_ddot = -m g b sin(alpha + phi) + T(w),    w = u_dot/a - phi_dot
"""

import functools
import importlib.util
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from mpmath import MPContext

from mjbeer import Scene
from mjbeer.theory.equations import accelerations

EXTENDED = np.longdouble
NEEDED = pytest.mark.skipif(
    importlib.util.find_spec("heyoka") is None or np.finfo(EXTENDED).eps > 1e-18,
    reason="no heyoka here, or its long double has no more digits than double",
)
"""The mark of tests that need motions in extended precision, which there are on x86."""

mp = MPContext()
mp.dps = 40


def letters(scene: Scene) -> dict[str, Any]:
    """The coefficients of the equations of motion in 40 digits, those of J and V among them."""
    can, load = scene.can, scene.load
    a, can_mass, can_inertia = (mp.mpf(each) for each in (can.radius, can.mass, can.inertia))
    m, b, inertia = (mp.mpf(each) for each in (load.mass, load.offset, load.inertia))
    g, alpha = mp.mpf(scene.gravity), mp.mpf(scene.incline)
    rolling, moment = can_mass + can_inertia / a**2, m * b
    whole, drive = m + rolling, (m + can_mass) * g * mp.sin(alpha)
    common = {
        "a": a, "moment": moment, "drive": drive, "sine": moment * g * mp.sin(alpha),
        "cosine": moment * g * mp.cos(alpha), "chord": mp.mpf(0), "swing": mp.mpf(0), "slope": mp.mpf(0),
    }  # fmt: skip
    if scene.attachment == "frozen":
        base = inertia + m * (a - b) ** 2 + can_inertia + can_mass * a**2
        return common | {"base": base, "chord": 4 * moment * a, "slope": drive * a}
    return common | {
        "whole": whole, "axial": inertia + moment * b, "base": inertia + moment * b * rolling / whole,
        "swing": moment**2 / whole, "sine": common["sine"] - moment * drive / whole, "drag": mp.mpf(scene.drag),
        **dict(zip(("c1", "c2", "c3"), map(mp.mpf, scene.damping_law.coefficients), strict=True)),
    }  # fmt: skip


def inertia(form: dict[str, Any], phi: Any) -> Any:
    """J at an angle [kg m^2]."""
    return form["base"] + form["chord"] * mp.sin(phi / 2) ** 2 + form["swing"] * mp.sin(phi) ** 2


def fall(form: dict[str, Any], begin: Any, end: Any) -> Any:
    """V(begin) - V(end) [J], as the plain difference."""

    def height(phi: Any) -> Any:
        return form["sine"] * mp.sin(phi) - form["cosine"] * mp.cos(phi) - form["slope"] * phi

    return height(begin) - height(end)


def well(form: dict[str, Any]) -> tuple[Any, Any, Any]:
    """The barrier uphill of the rest, the rest and the barrier downhill of it [rad], on either slope."""
    lean = mp.asin(form["slope"] / mp.hypot(form["cosine"], form["sine"]))
    bottom = -mp.atan2(form["sine"], form["cosine"])
    return bottom - mp.pi - lean, bottom + lean, bottom + mp.pi - lean


def integral(rate: Callable[[Any], Any], pieces: Sequence[Any]) -> Any:
    """By Gauss-Legendre with at most 24 nodes in each piece, as pieces are cut to fit."""
    return mp.quad(rate, pieces, method="gauss-legendre", maxdegree=4)


def motion(scene: Scene, times: Any, phi0: float, phi_dot0: float, steps: int = 100_000) -> np.ndarray:
    """phi - phi0, u, phi_dot and u_dot at increasing times, of shape (times, 4); NaN after so many steps."""
    known, start = letters(scene), mp.mpf(phi0)
    rate, offset, radius = EXTENDED(phi_dot0), _extended(mp.mpf(scene.load.offset)), _extended(known["a"])
    sine, cosine = _extended(mp.sin(start)), _extended(mp.cos(start))
    frozen = scene.attachment == "frozen"
    u, u_dot = (radius * _extended(start), radius * rate) if frozen else (offset * sine, offset * cosine * rate)
    names, integrator = _integrator(scene.attachment, bool(scene.drag or scene.damping_law.quadratic))
    known |= {"s0": mp.sin(start), "c0": mp.cos(start), "h0": mp.sin(start / 2), "k0": mp.cos(start / 2)}
    # Steps are as short as the largest numbers ask for: without damping, they are those of phi however far it rolls.
    known["unit"] = known["a"] * (1 if scene.dissipates else 10**12)
    unit = _extended(known["unit"])
    integrator.pars[: len(names)] = [_extended(known[name]) for name in names]
    integrator.time, integrator.state[:] = EXTENDED(0), [0, u / unit, rate, u_dot / unit]
    if len(names) < len(integrator.pars):  # the sign of what starts at zero is that of its derivative
        u_ddot, phi_ddot = accelerations(scene, phi0, phi_dot0, float(u_dot))
        ahead = np.sign([u_ddot / scene.can.radius - phi_ddot, u_ddot])
        integrator.pars[len(names) :] = [np.sign(u_dot / radius - rate) or ahead[0], np.sign(u_dot) or ahead[1]]
    grid = np.unique(np.append(0, times)).astype(EXTENDED)
    found = np.full((len(grid), 4), np.nan, EXTENDED)
    result = integrator.propagate_grid(grid, max_steps=steps)[-1]
    found[: len(result)] = result
    return found[np.searchsorted(grid, times)] * [1, unit, 1, unit]


def _extended(number: Any) -> Any:
    """The extended number nearest to one of 40 digits."""
    return EXTENDED(float(number)) + EXTENDED(float(number - mp.mpf(float(number))))


@functools.cache
def _integrator(attachment: str, corners: bool) -> tuple[list[str], Any]:
    """The names of the parameters, and heyoka's integrator; |w| and |u_dot| have corners, which are events."""
    import heyoka

    names = ["a", "unit", "moment", "drive", "cosine", "sine", "base", "s0", "c0", "h0", "k0"]
    names += ["chord", "slope"] if attachment == "frozen" else ["whole", "axial", "swing", "drag", "c1", "c2", "c3"]
    at = {name: heyoka.par[place] for place, name in enumerate(names)}
    turned, way, phi_dot, speed = heyoka.make_vars("turned", "way", "phi_dot", "speed")
    u_dot = speed * at["unit"]
    sin, cos = heyoka.sin(turned), heyoka.cos(turned)
    sin, cos = at["s0"] * cos + at["c0"] * sin, at["c0"] * cos - at["s0"] * sin
    events = []
    if attachment == "frozen":
        half = at["h0"] * heyoka.cos(turned / 2) + at["k0"] * heyoka.sin(turned / 2)
        pull = at["slope"] - at["cosine"] * sin - at["sine"] * cos - at["moment"] * at["a"] * sin * phi_dot**2
        phi_ddot = pull / (at["base"] + at["chord"] * half**2)
        u_ddot = at["a"] * phi_ddot
    else:
        slip, sides = (
            u_dot / at["a"] - phi_dot,
            [heyoka.par[len(names) + place] if corners else 1.0 for place in (0, 1)],
        )
        torque = (
            at["c1"] * slip + sides[0] * at["c2"] * slip**2 + at["c3"] * slip * slip * slip
        )  # heyoka divides by the base of a cube
        drag = torque / at["a"] + sides[1] * at["drag"] * u_dot**2
        along = at["drive"] - drag - at["moment"] * sin * phi_dot**2
        # sine lacks what the axis takes of gravity's torque along cos(phi): it is in J's V, and not in this equation.
        around = torque - at["cosine"] * sin - (at["sine"] + at["moment"] * at["drive"] / at["whole"]) * cos
        couple = at["moment"] * cos
        determinant = at["whole"] * (at["base"] + at["swing"] * sin**2)
        phi_ddot = (at["whole"] * around + couple * along) / determinant
        u_ddot = (at["axial"] * along + couple * around) / determinant
        if corners:
            events = [_corner(heyoka, len(names) + place, each) for place, each in enumerate((slip, u_dot))]
    system = [(turned, phi_dot), (way, speed), (phi_dot, phi_ddot), (speed, u_ddot / at["unit"])]
    count = len(names) + 2 * corners
    start, ones = np.zeros(4, EXTENDED), np.ones(count, EXTENDED)
    return names, heyoka.taylor_adaptive(system, start, pars=ones, t_events=events, fp_type=EXTENDED)


def _corner(heyoka: Any, place: int, rate: Any) -> Any:
    """An event that changes the sign of a rate in the equations where the rate changes its own."""

    def turn(integrator: Any, sign: int) -> bool:
        integrator.pars[place] = sign
        return True

    return heyoka.t_event(rate, callback=turn, fp_type=EXTENDED)
