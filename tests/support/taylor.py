"""The witness of exact theory: J and V in 40 digits, and motions by heyoka's Taylor series in
extended precision.

Motions are those of Lagrange's two equations as they stand, solved for the accelerations; a frozen
load has u = a phi, and one equation: the first times a, plus the second.

M u_ddot - m b (cos(phi) phi_ddot - sin(phi) phi_dot^2)
    = m_t g sin(alpha) - T(w)/a - drag u_dot |u_dot|
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
    a = mp.mpf(scene.can.radius)
    can_mass = mp.mpf(scene.can.mass)
    can_inertia = mp.mpf(scene.can.inertia)
    m = mp.mpf(scene.load.mass)
    b = mp.mpf(scene.load.offset)
    load_inertia = mp.mpf(scene.load.inertia)
    g = mp.mpf(scene.gravity)
    alpha = mp.mpf(scene.incline)
    moment = m * b
    drive = (m + can_mass) * g * mp.sin(alpha)
    sine = moment * g * mp.sin(alpha)
    common = {
        "a": a,
        "moment": moment,
        "drive": drive,
        "cosine": moment * g * mp.cos(alpha),
    }
    if scene.attachment == "frozen":
        return common | {
            "sine": sine,
            "base": load_inertia + m * (a - b) ** 2 + can_inertia + can_mass * a**2,
            "chord": 4 * moment * a,
            "swing": mp.mpf(0),
            "slope": drive * a,
        }
    rolling = can_mass + can_inertia / a**2
    whole = m + rolling
    c1, c2, c3 = map(mp.mpf, scene.damping_law.coefficients)
    return common | {
        "sine": sine - moment * drive / whole,
        "base": load_inertia + moment * b * rolling / whole,
        "chord": mp.mpf(0),
        "swing": moment**2 / whole,
        "slope": mp.mpf(0),
        "whole": whole,
        "axial": load_inertia + moment * b,
        "drag": mp.mpf(scene.drag),
        "c1": c1,
        "c2": c2,
        "c3": c3,
    }


def inertia(form: dict[str, Any], phi: Any) -> Any:
    """J at an angle [kg m^2]."""
    return _inertia(form, phi, mp.sin(phi))


def height(form: dict[str, Any], phi: Any) -> Any:
    """V at an angle [J]."""
    return _height(form, phi, *mp.cos_sin(phi))


def fall(form: dict[str, Any], begin: Any, end: Any) -> Any:
    """V(begin) - V(end) [J], as the plain difference."""
    return height(form, begin) - height(form, end)


def slowness(form: dict[str, Any], energy: Any, phi: Any) -> Any:
    """dt/dphi [s/rad] at an angle of a motion with an energy [J], sqrt(J/(2 (E - V)))."""
    cos, sin = mp.cos_sin(phi)
    kinetic = energy - _height(form, phi, cos, sin)
    return mp.sqrt(_inertia(form, phi, sin) / (2 * kinetic))


def _inertia(form: dict[str, Any], phi: Any, sin: Any) -> Any:
    inertia = form["base"] + form["swing"] * sin**2
    if form["chord"]:
        inertia += form["chord"] * mp.sin(phi / 2) ** 2
    return inertia


def _height(form: dict[str, Any], phi: Any, cos: Any, sin: Any) -> Any:
    return form["sine"] * sin - form["cosine"] * cos - form["slope"] * phi


def well(form: dict[str, Any]) -> tuple[Any, Any, Any]:
    """The barrier uphill of the rest, the rest and the barrier downhill of it [rad], on either
    slope."""
    lean = mp.asin(form["slope"] / mp.hypot(form["cosine"], form["sine"]))
    bottom = -mp.atan2(form["sine"], form["cosine"])
    return bottom - mp.pi - lean, bottom + lean, bottom + mp.pi - lean


def integral(rate: Callable[[Any], Any], pieces: Sequence[Any]) -> Any:
    """By Gauss-Legendre with at most 24 nodes in each piece, as pieces are cut to fit."""
    return mp.quad(rate, pieces, method="gauss-legendre", maxdegree=4)


def motion(
    scene: Scene, times: Any, phi0: float, phi_dot0: float, steps: int = 100_000
) -> np.ndarray:
    """phi - phi0, u, phi_dot and u_dot at increasing times, of shape (times, 4); NaN after so many
    steps."""
    known = letters(scene)
    start = mp.mpf(phi0)
    rate = EXTENDED(phi_dot0)
    radius = _extended(known["a"])
    if scene.attachment == "frozen":
        u = radius * _extended(start)
        u_dot = radius * rate
    else:
        offset = _extended(mp.mpf(scene.load.offset))
        u = offset * _extended(mp.sin(start))
        u_dot = offset * _extended(mp.cos(start)) * rate
    corners = bool(scene.drag or scene.damping_law.quadratic)
    names, integrator = _integrator(scene.attachment, corners)
    known |= {
        "s0": mp.sin(start),
        "c0": mp.cos(start),
        "h0": mp.sin(start / 2),
        "k0": mp.cos(start / 2),
    }
    # Steps are as short as the largest numbers ask for: without damping, they are those of phi
    # however far it rolls.
    known["unit"] = known["a"] * (1 if scene.dissipates else 10**12)
    unit = _extended(known["unit"])
    integrator.pars[: len(names)] = [_extended(known[name]) for name in names]
    integrator.time = EXTENDED(0)
    integrator.state[:] = [0, u / unit, rate, u_dot / unit]
    if corners:  # the sign of what starts at zero is that of its derivative
        # Events of the motion before must not keep those of this one from being seen.
        integrator.reset_cooldowns()
        u_ddot, phi_ddot = accelerations(scene, phi0, phi_dot0, float(u_dot))
        sign_of_slip = np.sign(u_dot / radius - rate)
        sign_of_speed = np.sign(u_dot)
        integrator.pars[len(names) :] = [
            sign_of_slip or np.sign(u_ddot / scene.can.radius - phi_ddot),
            sign_of_speed or np.sign(u_ddot),
        ]
    grid = np.unique(np.append(0, times)).astype(EXTENDED)
    states = np.full((len(grid), 4), np.nan, EXTENDED)
    reached = integrator.propagate_grid(grid, max_steps=steps)[-1]
    states[: len(reached)] = reached
    return states[np.searchsorted(grid, times)] * [1, unit, 1, unit]


def _extended(number: Any) -> Any:
    """The extended number nearest to one of 40 digits."""
    return EXTENDED(float(number)) + EXTENDED(float(number - mp.mpf(float(number))))


@functools.cache
def _integrator(attachment: str, corners: bool) -> tuple[list[str], Any]:
    """The names of the parameters, and heyoka's integrator; |w| and |u_dot| have corners, which are
    events."""
    import heyoka

    names = ["a", "unit", "moment", "drive", "cosine", "sine", "base", "s0", "c0", "h0", "k0"]
    if attachment == "frozen":
        names += ["chord", "slope"]
    else:
        names += ["whole", "axial", "swing", "drag", "c1", "c2", "c3"]
    at = {name: heyoka.par[place] for place, name in enumerate(names)}
    turned, way, phi_dot, speed = heyoka.make_vars("turned", "way", "phi_dot", "speed")
    u_dot = speed * at["unit"]
    sin = at["s0"] * heyoka.cos(turned) + at["c0"] * heyoka.sin(turned)
    cos = at["c0"] * heyoka.cos(turned) - at["s0"] * heyoka.sin(turned)
    events = []
    if attachment == "frozen":
        half = at["h0"] * heyoka.cos(turned / 2) + at["k0"] * heyoka.sin(turned / 2)
        pull = (
            at["slope"]
            - at["cosine"] * sin
            - at["sine"] * cos
            - at["moment"] * at["a"] * sin * phi_dot**2
        )
        phi_ddot = pull / (at["base"] + at["chord"] * half**2)
        u_ddot = at["a"] * phi_ddot
    else:
        slip = u_dot / at["a"] - phi_dot
        sign_of_slip = 1.0
        sign_of_speed = 1.0
        if corners:
            place = len(names)
            sign_of_slip = heyoka.par[place]
            sign_of_speed = heyoka.par[place + 1]
            events = [_corner(heyoka, place, slip), _corner(heyoka, place + 1, u_dot)]
        quadratic = sign_of_slip * at["c2"] * slip**2
        # A power of 3 would be divided by its base.
        torque = at["c1"] * slip + quadratic + at["c3"] * slip * slip * slip
        drag = torque / at["a"] + sign_of_speed * at["drag"] * u_dot**2
        along = at["drive"] - drag - at["moment"] * sin * phi_dot**2
        # sine lacks what the axis takes of gravity's torque along cos(phi): it is in J's V, and not
        # in this equation.
        sine = at["sine"] + at["moment"] * at["drive"] / at["whole"]
        around = torque - at["cosine"] * sin - sine * cos
        couple = at["moment"] * cos
        determinant = at["whole"] * (at["base"] + at["swing"] * sin**2)
        phi_ddot = (at["whole"] * around + couple * along) / determinant
        u_ddot = (at["axial"] * along + couple * around) / determinant
    system = [(turned, phi_dot), (way, speed), (phi_dot, phi_ddot), (speed, u_ddot / at["unit"])]
    integrator = heyoka.taylor_adaptive(
        system,
        np.zeros(4, EXTENDED),
        pars=np.ones(len(names) + 2 * corners, EXTENDED),
        t_events=events,
        fp_type=EXTENDED,
    )
    return names, integrator


def _corner(heyoka: Any, place: int, rate: Any) -> Any:
    """An event that changes the sign of a rate in the equations where the rate changes its own."""

    def turn(integrator: Any, sign: int) -> bool:
        integrator.pars[place] = sign
        return True

    return heyoka.t_event(rate, callback=turn, fp_type=EXTENDED)
