"""Appendix A of the paper, equations (50)-(55) and sections A.1 to A.3: beer frozen to a massless can.

The load has the I_axis = m a^2/2 of a half can, and any b.
"""

import math
from functools import cache, partial
from typing import Any

import mujoco
import numpy as np
from scipy.optimize import brentq

from mjbeer.model.build import build
from mjbeer.model.setting import DOP853
from mjbeer.paper.claim import Bound, Claim, Limit, Misprint, Motion, SceneConstants, Terms, Witness, equation
from mjbeer.paper.witness import (
    CONTACT,
    DRIFT,
    EQUALITY,
    EXACT,
    FOOTNOTE_8,
    HELD,
    ROLL_DOWN,
    SMALL,
    balanced,
    footnote_scene,
    frequency,
    measure_motion,
    resting,
)
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import exact
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.scene import Scene
from mjbeer.theory.scenes import frozen

_CREEP = 1e-3
"""A can counts as slipping if it slips by more than this in a second, in radii; one that holds slips by 1e-7."""


_EQ_52 = "3*a**2/2*phi_ddot - 2*a*b*cos_phi*phi_ddot + {}a*b*sin_phi*phi_dot**2 - g*a*sin_alpha + g*b*sin_theta"
"""Eq. (52), of which footnote 8 has ab as half of what it is."""


def equilibrium_53(scene: Scene) -> float:
    """Return phi_0 [rad] by eq. (53), extended to a can with mass.

    That is sin(alpha + phi_0) = (m + m_can) a sin(alpha) / (m b).

    Raises:
      ValueError: if the incline is too steep for an equilibrium.
    """
    sine = scene.mass * scene.can.radius * math.sin(scene.incline) / scene.load.moment
    return math.asin(sine) - scene.incline


def eq_55(c: SceneConstants, cos_phi: Any, cos_theta: Any, factor: int = 2) -> Any:
    """Return omega^2 [1/s^2] by eq. (55), corrected; its misprint has the `factor` 1.

    omega^2 = g b cos(alpha + phi_0) / (3a^2/2 - `factor` ab cos(phi_0)).
    """
    return c.g * c.b * cos_theta / (3 * c.a**2 / 2 - factor * c.a * c.b * cos_phi)


def frequency_55(scene: Scene, factor: int = 2) -> float:
    """Return omega [rad/s] by eq. (55), corrected, or with the `factor` 1 as printed."""
    phi = scene.equilibrium()
    return math.sqrt(eq_55(SceneConstants.of(scene), math.cos(phi), math.cos(scene.incline + phi), factor))


def long_run(form: Oscillator) -> float:
    """Return the mean phi_ddot [rad/s^2] of a long roll-down: the slope over (mean of sqrt(J) over a turn)^2.

    Energy gives J phi_dot^2/2 = slope phi + terms that stay bounded. Far down, therefore, dt = sqrt(J/(2 slope phi))
    dphi. The trapezoid rule for the mean converges geometrically, since J is smooth and periodic.
    """
    turn = 2 * np.pi * np.arange(64) / 64
    return form.ramp / float(np.mean(np.sqrt(form.inertia(turn)))) ** 2


@cache
def _rocking_in_contact() -> Motion:
    """Return half a second of a can in contact, let go at phi = 0."""
    return measure_motion(simulate(frozen(), 0.5, 0.0, rolling="contact", times=np.linspace(0, 0.5, 51)))


def _acceleration(scene: Scene, phi: float) -> float:
    """Return MuJoCo's phi_ddot [rad/s^2] of a can that is let go at `phi` [rad]."""
    model = build(scene, "equality", integrator=DOP853)
    data = mujoco.MjData(model)
    data.joint("slide").qpos[0], data.joint("roll").qpos[0] = scene.can.radius * phi, phi
    mujoco.mj_forward(model, data)
    return float(data.joint("roll").qacc[0])


@cache
def _rest() -> tuple[SceneConstants, float]:
    """Return the constants, and the sine of alpha + phi where MuJoCo's acceleration changes sign, below 60 degrees."""
    scene = frozen()
    phi = float(brentq(lambda phi: _acceleration(scene, phi), 0.0, math.pi / 3, xtol=1e-15))
    return SceneConstants.of(scene), math.sin(phi + scene.incline)


@cache
def _steepest_incline() -> float:
    """Return the incline [rad] above which MuJoCo's can rolls off from any angle."""
    return float(brentq(lambda incline: _acceleration(frozen(incline), math.pi / 2 - incline), 0.2, 0.8, xtol=1e-15))


@cache
def _least_friction() -> float:
    """Return the least friction coefficient at which the can stays for a second in contact, by bisection."""
    scene, low, high = frozen(), 0.1, 0.3
    while high - low > 1e-4:
        middle = (low + high) / 2
        run = simulate(scene, 1.0, scene.equilibrium(), rolling="contact", friction=middle)
        slides = float(np.abs(run.slip).max()) > _CREEP * scene.can.radius
        low, high = (middle, high) if slides else (low, middle)
    return high


def _turned() -> tuple[float, float, float]:
    """Return the equilibrium, the angle 1e-3 rad further, and alpha [rad]."""
    scene = frozen()
    return scene.equilibrium(), scene.equilibrium() + SMALL, scene.incline


def _sine_54(at: tuple[float, float, float], sign: int) -> Terms:
    rest, turned, alpha = at
    return math.sin(alpha + turned) - math.sin(alpha + rest), -sign * SMALL * math.cos(alpha + rest)


def _omega(start: float) -> float:
    """Return omega [rad/s] of a can that is let go at `start` [rad], rolled by a constraint."""
    return frequency(frozen(), start, rolling="equality")


@cache
def _mean_acceleration(part: float = 1.0) -> tuple[Scene, float]:
    """Return footnote 8's scene with a `part` of its b, and the axis's mean acceleration [m/s^2] in a roll-down.

    It is that between the whole turns after 8 s and 16 s from phi = pi.
    """
    scene = footnote_scene(part)
    run = simulate(scene, 16, math.pi, rolling="equality", integrator=DOP853)
    moments, angles = [], []
    for time in (8.0, 16.0):
        last = float(np.interp(time, run.time, run.phi))
        angles.append(2 * math.pi * math.floor((last - math.pi) / (2 * math.pi)))
        moments.append(float(np.interp(math.pi + angles[-1], run.phi, run.time)))
    # At a constant acceleration A the angle is A t^2/2, so that its root grows evenly.
    growth = (math.sqrt(angles[1]) - math.sqrt(angles[0])) / (moments[1] - moments[0])
    return scene, 2 * growth**2 * scene.can.radius


@cache
def _lift_off_time() -> float:
    """Return when a can in contact that rolls down from the top has lifted off by a millionth of its radius [s]."""
    run = simulate(footnote_scene(), 0.9, math.pi, rolling="contact", timestep=1e-4, friction=1e3)
    return float(run.time[np.argmax(run.lift > 1e-6 * run.scene.can.radius)])


_TOUCHES, _TAYLOR = Witness(CONTACT, _rocking_in_contact), Witness("Taylor's series", _turned)
_STEEPEST = Witness(EQUALITY, _steepest_incline)
_SMALL_SWING = Witness(EQUALITY, lambda: _omega(frozen().equilibrium() + SMALL))
_AMPLITUDE = Bound(1e-6, "the amplitude: 3e-7")
_SLIPS = Bound(1e-6, "the can slips a little in its soft contact")

# fmt: off
CLAIMS = (
    Claim("(50)", "u = a phi", _TOUCHES, _SLIPS, equation("u - a*phi")),
    Claim("(50)", "s = a phi - b sin(phi)", _TOUCHES, _SLIPS, equation("s - a*phi + b*sin_phi")),
    Claim("(51)", "T", ROLL_DOWN, HELD,
        equation("3*m*a**2/4*phi_dot**2 - m*a*b*cos_phi*phi_dot**2 - kinetic")),
    Claim("(51)", "V", ROLL_DOWN, EXACT, equation("-m*g*a*phi*sin_alpha - m*g*b*cos_theta - potential")),
    Claim("(52)", "equation of motion of phi", ROLL_DOWN, HELD, equation(_EQ_52.format(""))),
    Claim("footnote 8", "the equation as typed in: 3(1) sin(x) (x')^2; printed 3(0.5)", FOOTNOTE_8, HELD,
        equation(_EQ_52.format("")),
        Misprint(0.32, equation(_EQ_52.format("0.5*")),
            "Frozen beer: the term ab sin φ φ̇² as typed in, with a = 3 cm and b = 1 cm", r"3(<0.5|1>)\sin(x)\,(x')^2"),
        quote="3(0.5) sin(x)(x')² …, which corresponds to a = 3 cm, b = 1 cm"),
    Claim("(53)", "angle at which nothing turns the can", Witness(EQUALITY, _rest), EXACT,
        lambda rest: (rest[1], -rest[0].a * rest[0].sin_alpha / rest[0].b)),
    Claim("(53)", "there the centre of mass is above the contact", Witness(EQUALITY, _rest), EXACT,
        lambda rest: (rest[0].b * rest[1], -rest[0].a * rest[0].sin_alpha),
        quote="the center of mass of the half cylinder is directly above the point of contact"),
    Claim("sec. A.1", "steepest incline with an equilibrium, sin(alpha) = 4/(3 pi)", _STEEPEST, EXACT,
        lambda steepest: (math.sin(steepest), -4 / (3 * math.pi)),
        quote="This equilibrium exists only for sin α ≤ 4/3π"),
    Claim("sec. A.1", "that is 25 degrees", _STEEPEST, Bound(2e-2, "half a unit of the last digit"),
        lambda steepest: (25.0, -math.degrees(steepest)), quote="for α ≤ 25°"),
    Claim("footnote 7", "least friction coefficient at which the can stays: tan(alpha)",
        Witness(CONTACT, _least_friction), Bound(1e-3, "bisection, and what counts as slipping"),
        lambda least: (least, -math.tan(frozen().incline)),
        quote="only if the coefficient μ of static friction is larger than tan α"),
    Claim("(54)", "change of cos(phi) to first order",
        _TAYLOR, Bound(3e-3, "the next order: swing cot(phi_0)/2 = 2e-3"),
        lambda at: (math.cos(at[1]) - math.cos(at[0]), SMALL * math.sin(at[0]))),
    Claim("(54)", "change of sin(alpha + phi) to first order: its sign",
        _TAYLOR, Bound(3e-4, "the next order: swing tan(alpha + phi_0)/2 = 2e-4"), lambda at: _sine_54(at, 1),
        Misprint(2.0, lambda at: _sine_54(at, -1), "Frozen beer: the sine near the equilibrium",
            r"\sin(\alpha+\varphi)\approx\sin(\alpha+\varphi_0)\\ "
            r"{}<-|+>\,\epsilon\cos\omega t\,\cos(\alpha+\varphi_0)")),
    Claim("(55)", "omega of small oscillations: 2ab cos(phi_0); printed ab cos(phi_0)", _SMALL_SWING, _AMPLITUDE,
        lambda omega: (frequency_55(frozen()), -omega),
        Misprint(0.21, lambda omega: (frequency_55(frozen(), 1), -omega), "Frozen beer: frequency of small swings",
            r"\omega^2=\frac{gb\cos(\alpha+\varphi_0)}{\frac{3a^2}{2}-<|2>ab\cos\varphi_0}")),
    Claim("sec. A.2", "from phi = 0 the can rocks with omega of (55): there, and within, at 1e-3 rad",
        _SMALL_SWING, _AMPLITUDE, lambda omega: (frequency_55(frozen()), -omega),
        limit=Limit(0.0154, partial(_omega, 0.0)),
        quote="it does not roll, but executes oscillations with frequency approximately given by eq. (55)"),
    Claim("footnote 9", "b = 0: phi = g sin(alpha) t^2/(3a)",
        Witness(EQUALITY, partial(resting, balanced(0.5))), Bound(1e-7, DRIFT),
        equation("phi - g*sin_alpha*time**2/(3*a)"), quote="φ = g sin αt²/3a"),
    Claim("sec. A.3", "mean acceleration of a long roll-down (2/3) g sin(alpha): b = a/3; within, b = a/300",
        Witness(EQUALITY, partial(_mean_acceleration, 0.01)),
        Bound(1e-3, "the start, of whose waves 1e-4 is left between 8 s and 16 s"),
        lambda found: (found[1], -found[0].acceleration()), limit=Limit(0.0264, _mean_acceleration),
        quote="A solid cylinder that rolls without slipping would have acceleration (2/3)g sin α down the incline"),
    Claim("sec. A.3", "the same by exact theory: that over (mean of sqrt(J))^2 / (3 m a^2/2)",
        Witness(EQUALITY, _mean_acceleration), Bound(1e-3, "the start, as above"),
        lambda found: (found[1], -long_run(found[0].oscillator) * found[0].can.radius),
        quote="Angle φ varies almost quadratically in time, with a small oscillation about this"),
    Claim("figure of A.3", "phi(t) of the roll-down from phi = pi, a = 3 cm, b = 1 cm", FOOTNOTE_8, Bound(1e-7, DRIFT),
        lambda q: (q.phi, -exact(footnote_scene(), q.time, math.pi).phi),
        quote="for a = 3 cm, b = 1 cm, α = 10°, φ(0) = π and φ̇(0) = 0"),
    Claim("figure of A.3", "time at which N = 0, after which a real can is not on the incline: 0.848 s",
        Witness(CONTACT, _lift_off_time),
        Bound(4e-3, "the soft contact, and that the can slips a moment before"),
        lambda time: (time, -exact(footnote_scene(), np.linspace(0, 1, 10_001), math.pi).rolls_until()),
        quote="A rigid can that is somehow constrained to roll without slipping cannot hop"),
)
# fmt: on
