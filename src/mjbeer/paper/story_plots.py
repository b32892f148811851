"""The plots of the paper's stories, and the motions that they and the films show."""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from scipy.integrate import solve_ivp

from mjbeer.output.plots import (
    COLOURS,
    GREY,
    REFERENCE,
    SIMULATED,
    THEORY,
    UNPHYSICAL,
    name_below,
    note,
)
from mjbeer.paper import hopping, oscillation
from mjbeer.paper.claim import Observation, value
from mjbeer.paper.frozen import PRINTED_8
from mjbeer.paper.hopping import MU
from mjbeer.paper.oscillation import SLOW
from mjbeer.paper.witness import GRIP, loop
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.paper_scenes import frozen, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory, exact

SWING = math.radians(60)
"""Amplitude [rad] of the swing that shows the hesitation: wide enough for the can to slow down."""
FRICTION = 1.0
"""Friction coefficient of the incline from which the can lifts off."""
HESITATION = partial(
    simulate, sliding(), 0.8, SWING, integrator="DOP853", times=np.linspace(0, 0.8, 401)
)
LOOPING = partial(simulate, sliding(), 0.5, 0.0, SLOW, integrator="DOP853")
"""The motion of a film: the beer loops slowly enough for its can to stay on the incline."""
ROCKING = partial(simulate, frozen(), 2.0, 0.0, integrator="DOP853")
LIFT_OFF = partial(
    simulate, frozen(), 1.0, math.pi, rolling="contact", timestep=2e-4, friction=FRICTION
)
PARTING = partial(LIFT_OFF, times=np.linspace(0.68, 1.0, 1601))
_PRINTED: dict[str, Any] = {"color": COLOURS[1], "linestyle": "--"}
"""The style of an equation that the paper prints wrong."""
_JUMP = 3.0
"""Change of an angle [degrees] from point to point at which a line breaks off; elsewhere it is
below 1."""
_TIME = "time t [s]"
_TILT = "φ, the angle of the beer's surface to the incline"


def let_go(degrees: float, duration: float = 1.0) -> Trajectory:
    """Return the motion of beer let go at an angle to the incline, for a `duration` [s]."""
    return simulate(sliding(), duration, math.radians(degrees), integrator="DOP853", timestep=1e-3)


def draw_trivial(panels: Sequence[Axes]) -> None:
    """Draw φ, and how far u and s are ahead of an even acceleration, for two starts."""
    angle, ahead = panels
    for degrees, colour, width in ((0, COLOURS[4], 4.0), (60, COLOURS[0], 1.5)):
        run = let_go(degrees)
        even = run.scene.acceleration() * run.time**2 / 2
        centre = run.u - run.scene.load.offset * np.sin(run.phi)
        angle.plot(
            run.time,
            np.degrees(run.phi),
            color=colour,
            linewidth=width,
            label=f"can let go at φ = {degrees}°",
        )
        ahead.plot(run.time, 1e3 * (run.u - even), color=colour, linewidth=width)
        ahead.plot(
            run.time, 1e3 * (centre - even), "k--", label="the beer's centre of mass, in both cans"
        )
    angle.set(ylabel="φ [°]", title=_TILT)
    ahead.set(
        xlabel=_TIME,
        ylabel="u − ½ g sin α t² [mm]",
        title="How far it is ahead of an even acceleration",
    )
    name_below((angle, ahead), 2)


def draw_hesitation(panels: Sequence[Axes]) -> None:
    """Draw how far a can is ahead of one that accelerates evenly, and eq. (25) as printed."""
    run = HESITATION()
    scene = run.scene
    times = run.time
    even = scene.acceleration() * times**2 / 2
    # The paper's swing begins at phi = 0, this one a quarter of a swing later, at its largest phi:
    # there cos(2 omega t) has the opposite sign.
    amplitude = scene.load.offset * SWING**2 / 2
    printed = -amplitude / 2 - amplitude * np.cos(2 * scene.frequency() * times)
    (axes,) = panels
    axes.plot(
        times, 1e3 * (exact(scene, times, SWING).u - even), label="exact theory: b sin φ", **THEORY
    )
    axes.plot(times, 1e3 * (run.u - even), label="MuJoCo", **SIMULATED)
    axes.plot(
        times,
        1e3 * printed,
        label="eq. (25) as printed, but for a constant: twice in a swing",
        **_PRINTED,
    )
    axes.axhline(0, **REFERENCE)
    axes.set(
        xlabel=_TIME,
        ylabel="u − ½ g sin α t² [mm]",
        title="Lead of the can over one that accelerates evenly",
    )
    name_below([axes], 1)


def draw_looping(panels: Sequence[Axes]) -> None:
    """Draw how unevenly beer loops, slowly and fast, beside eqs. (26) and (28)."""
    phase = np.linspace(0, 2 * math.pi, 201)
    x = np.degrees(phase)
    for axes, start, about in zip(
        panels, (SLOW, 400.0), ("Slowly", "Fast, in a can held down"), strict=True
    ):
        turn = loop(sliding(), start)
        phi = sum(turn.ripple[k] * np.sin(k * phase) for k in range(1, 40))
        once = value(oscillation.CORRECTED_28, turn) * np.sin(phase)
        corrected = np.degrees(once + turn.delta / 4 * np.sin(2 * phase))
        printed = np.degrees(value(oscillation.PRINTED_28, turn) * np.sin(phase))
        axes.plot(x, printed, label="one ripple in a turn: (26) and (28) as printed", **_PRINTED)
        axes.plot(x[::5], corrected[::5], "k.", label="and a second, twice in a turn: corrected")
        axes.plot(x, np.degrees(phi), label="MuJoCo", **SIMULATED)
        axes.set(
            ylabel="beer ahead, φ − Ωt [°]",
            title=f"{about}: Ω = {turn.Omega:.0f} rad/s in the mean",
        )
        axes.set_xticks(range(0, 361, 90))
    panels[-1].set_xlabel("even turning, Ωt [°]")
    name_below(panels, 1)


def footnote_8_as_printed(scene: Scene, times: np.ndarray, phi0: float) -> np.ndarray:
    """Return phi [rad] by footnote 8's equation as printed, from rest at `phi0` [rad]."""

    def residual(phi: float, phi_dot: float, phi_ddot: float) -> float:
        theta = scene.incline + phi
        state = Observation.of(scene, phi=phi, theta=theta, phi_dot=phi_dot, phi_ddot=phi_ddot)
        return value(PRINTED_8, state)

    def slope(_: float, state: np.ndarray) -> list[float]:
        phi, phi_dot = state
        without = residual(phi, phi_dot, 0.0)
        # The residual is linear in phi_ddot.
        phi_ddot = without / (without - residual(phi, phi_dot, 1.0))
        return [phi_dot, phi_ddot]

    return solve_ivp(slope, (0, times[-1]), [phi0, 0.0], t_eval=times, rtol=1e-10, atol=1e-12).y[0]


def draw_rocking(panels: Sequence[Axes]) -> None:
    """Draw how frozen beer rocks by MuJoCo and by footnote 8, and the distance from theory."""
    run = ROCKING()
    scene = run.scene
    times = run.time
    angle, error = panels
    truth = exact(scene, times, run.phi0).phi
    printed = footnote_8_as_printed(scene, times, run.phi0)
    angle.plot(times, np.degrees(truth), label="exact theory, eq. (52)", **THEORY)
    angle.plot(times, np.degrees(run.phi), label="MuJoCo", **SIMULATED)
    angle.plot(times, np.degrees(printed), label="footnote 8 as printed", **_PRINTED)
    angle.axhline(math.degrees(scene.equilibrium()), label="equilibrium, eq. (53)", **REFERENCE)
    error.plot(times, np.degrees(run.phi - truth), **SIMULATED)
    error.plot(times, np.degrees(printed - truth), **_PRINTED)
    angle.set(ylabel="φ [°]", title=_TILT)
    error.set(
        xlabel=_TIME, ylabel="φ less that of theory [°]", title="How far each is from exact theory"
    )
    name_below([angle], 2)


def draw_roll_down(panels: Sequence[Axes]) -> None:
    """Draw the roll-down of frozen beer: its angle and the normal force."""
    times = np.linspace(0, 1, 1001)
    run = simulate(frozen(), times[-1], math.pi, integrator="DOP853", times=times)
    scene = run.scene
    leaves_at = exact(scene, times, math.pi).rolls_until()
    rolls = times <= leaves_at
    pulled = times >= leaves_at
    angle, normal = panels
    even = scene.acceleration() / scene.can.radius * times**2 / 2
    angle.plot(
        times,
        np.degrees(even),
        "--",
        label="solid cylinder: g sin α t² / 3a",
        color=GREY,
        linewidth=1.2,
    )
    printed = footnote_8_as_printed(scene, times, math.pi) - math.pi
    angle.plot(times[rolls], np.degrees(printed[rolls]), label="footnote 8 as printed", **_PRINTED)
    weights = run.forces.normal / (scene.mass * scene.gravity)
    for axes, values in ((angle, np.degrees(run.phi - math.pi)), (normal, weights)):
        axes.plot(times[rolls], values[rolls], label="MuJoCo, can that rolls", **SIMULATED)
        axes.plot(times[pulled], values[pulled], label="if the incline could pull it", **UNPHYSICAL)
        axes.axvline(leaves_at, **REFERENCE)
        axes.set_xlim(0, times[-1])
    normal.axhline(0, **REFERENCE)
    note(normal, f"no push at {leaves_at:.3f} s", (leaves_at, 7), (-6, 0), ha="right")
    angle.set(ylabel="φ − 180° [°]", title="How far the can has turned")
    normal.set(
        xlabel=_TIME,
        ylabel="normal force / weight",
        title="How hard the incline pushes; below 0 it would have to pull",
    )
    name_below(panels, 2)


def draw_slip_and_hop(panels: Sequence[Axes]) -> None:
    """Draw the friction that rolling needs, and how a can with less of it slips and hops."""
    contact = LIFT_OFF()
    times = np.linspace(0, 1, 1001)
    rolling = exact(contact.scene, times, math.pi)
    leaves_at = rolling.rolls_until()
    friction, moved = panels
    needed = rolling.forces.needed_friction
    needed = np.where((needed < 2.5) & (times < leaves_at), needed, np.nan)
    friction.plot(times, needed, label="needed to roll, exact theory", color="black")
    friction.axhline(FRICTION, **REFERENCE)
    note(friction, f"all that there is: μ = {FRICTION:g}", (0, FRICTION), (6, 8))
    moved.plot(
        contact.time, 1e3 * contact.slip, color=COLOURS[1], label="slid instead of rolled, MuJoCo"
    )
    moved.plot(
        contact.time, 1e3 * contact.lift, color=COLOURS[0], label="height above the incline, MuJoCo"
    )
    for axes in panels:
        axes.axvline(leaves_at, **REFERENCE)
        axes.set_xlim(0, times[-1])
    note(moved, "from here on rolling\nwould need a pull", (leaves_at, 5), (-6, 0), ha="right")
    friction.set(
        ylabel="friction / normal force", title="Friction that rolling needs", ylim=(0, 2.2)
    )
    moved.set(xlabel=_TIME, ylabel="distance [mm]", title="What the can does")
    name_below(panels, 2)


def skids(ratios: np.ndarray, mu: float) -> np.ndarray:
    """Return the angles from the top [degrees] at which hoops of the `ratios` M/m skid.

    An angle is NaN where it has jumped, so that the line has a gap there.
    """
    angles = np.degrees([hopping.slip(float(ratio), mu) for ratio in ratios])
    angles[1:][np.abs(np.diff(angles)) > _JUMP] = math.nan
    return angles


def draw_lift_off(panels: Sequence[Axes]) -> None:
    """Draw the angles at which a hoop lifts off and skids, against its mass."""
    most = np.geomspace(1e-3, 0.07, 300)
    # Just below 1/13 the angle of lift-off rises like a square root, and needs denser points.
    last = 1 / 13 * (1 - np.geomspace(0.1, 1e-6, 20))
    ratios = np.unique(np.append(most, last))
    few = np.array([2e-3, 8e-3, 0.03, 0.06])
    simulated = [hopping.takeoff(hopping.fall(float(ratio), GRIP, 5e-5)) for ratio in few]
    measured = [math.nan if angle is None else math.degrees(angle) for angle in simulated]
    lifts = [math.degrees(hopping.lift_off(float(ratio))) for ratio in ratios]
    (axes,) = panels
    axes.plot(ratios, lifts, color=COLOURS[0], label="lifts off if it cannot skid, theory")
    axes.plot(few, measured, "o", color=COLOURS[0], label="the same, MuJoCo")
    for mu, colour in ((2.0, COLOURS[3]), (MU, COLOURS[1]), (0.5, COLOURS[4])):
        axes.plot(
            ratios, skids(ratios, mu), "--", color=colour, label=f"skids if μ = {mu:g}, theory"
        )
    axes.axhline(90, **REFERENCE)
    axes.axvline(1 / 13, **REFERENCE)
    note(axes, "Littlewood: 90°", (0.01, 90), (4, -9))
    note(axes, "heavier hoops never lift off: M/m = 1/13", (1 / 13, 70), (-4, 0), ha="right")
    axes.set_xscale("log")
    axes.set(
        xlabel="mass of the hoop / weight on its rim, M / m",
        ylabel="angle of the weight from the top [°]",
    )
    marks = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05)
    axes.set_xticks(marks, map(str, marks))
    axes.tick_params(which="minor", labelbottom=False)
    name_below([axes], 2)
