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
PARTING = partial(LIFT_OFF, times=np.arange(2250, 4901) * 2e-4)
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


def share_time(panels: Sequence[Axes]) -> None:
    """Let panels, one below the other, have the time axis of the last one."""
    for axes in panels[:-1]:
        axes.tick_params(labelbottom=False)
    panels[-1].set_xlabel(_TIME)


def draw_trivial(panels: Sequence[Axes]) -> None:
    """Draw φ, and how far u and s are ahead of an even acceleration, for two starts."""
    angle, ahead = panels
    swinging = COLOURS[0]
    still = COLOURS[4]
    leads = []
    for degrees, colour, width in ((0, still, 4.0), (60, swinging, 1.5)):
        run = let_go(degrees)
        even = run.scene.acceleration() * run.time**2 / 2
        centre = run.u - run.scene.load.offset * np.sin(run.phi)
        leads.append(np.abs(run.u - even).max())
        angle.plot(run.time, np.degrees(run.phi), color=colour, linewidth=width)
        ahead.plot(run.time, 1e3 * (run.u - even), color=colour, linewidth=width)
        ahead.plot(run.time, 1e3 * (centre - even), "k--")
    for axes in panels:
        axes.set_xlim(-0.02, 1.38)
        axes.set_xticks(np.linspace(0, 1, 6))
    # The last run of the loop is the one that swings.
    end = run.time[-1]
    last_phi = math.degrees(run.phi[-1])
    last_lead = 1e3 * (run.u[-1] - even[-1])
    dark = "#9A6A00"  # `still` is too pale for letters
    note(angle, "let go at 60°", (end, last_phi), (7, 0), color=swinging)
    note(angle, "let go at 0°", (end, 0), (7, 0), color=dark)
    note(ahead, "let go at 60°", (end, last_lead), (7, 0), color=swinging)
    note(ahead, "let go at 0°", (end, 0), (7, -7), color=dark)
    note(ahead, "centre of mass\nof the beer, in both", (end, 0), (7, 13), color="black")
    angle.set(ylabel="φ [°]", title=_TILT)
    ahead.set(
        ylabel="u − ½ g sin α t² [mm]",
        title=f"Lead over an even acceleration: ±{1e3 * max(leads):.0f} mm for the can that swings",
    )
    share_time(panels)


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
    truth = exact(scene, times, SWING)
    period = scene.period(SWING)
    largest = scene.load.offset * math.sin(SWING)
    (axes,) = panels
    axes.plot(times, 1e3 * (truth.u - even), **THEORY)
    axes.plot(times, 1e3 * (run.u - even), **SIMULATED)
    axes.plot(times, 1e3 * printed, **_PRINTED)
    axes.axhline(0, **REFERENCE)
    blue = COLOURS[0]
    # The beer passes phi = 0 a quarter of a swing after it was let go, and once in every swing.
    for passing in (period / 4, 5 * period / 4):
        axes.plot([passing, passing], [-18, 0], linestyle=":", color=blue)
        note(axes, "hesitates", (passing, -16.5), (5, 0), color=blue)
    note(
        axes,
        "MuJoCo, on exact theory (grey): b sin φ",
        (period, 1e3 * largest),
        (0, 12),
        color=blue,
        ha="center",
    )
    note(
        axes,
        "eq. (25) as printed:\ntwice in a swing",
        (3 * period / 2, 4),
        (0, 16),
        color=COLOURS[1],
        ha="center",
    )
    axes.set(
        xlabel=_TIME,
        ylabel="u − ½ g sin α t² [mm]",
        title=f"Lead over an even acceleration: ±{1e3 * largest:.0f} mm, once in {period:.2f} s",
        ylim=(-19, 17.5),
    )


def draw_looping(panels: Sequence[Axes]) -> None:
    """Draw how unevenly beer loops, slowly and fast, beside eqs. (26) and (28)."""
    phase = np.linspace(0, 2 * math.pi, 201)
    x = np.degrees(phase)
    for axes, start, about in zip(panels, (SLOW, 400.0), ("Slow", "Fast"), strict=True):
        turn = loop(sliding(), start)
        phi = sum(turn.ripple[k] * np.sin(k * phase) for k in range(1, 40))
        once = value(oscillation.CORRECTED_28, turn) * np.sin(phase)
        corrected = np.degrees(once + turn.delta / 4 * np.sin(2 * phase))
        printed = np.degrees(value(oscillation.PRINTED_28, turn) * np.sin(phase))
        axes.plot(x, printed, label="(26) and (28) as printed: sin Ωt alone", **_PRINTED)
        axes.plot(x[::5], corrected[::5], "k.", label="corrected: sin Ωt and sin 2Ωt")
        axes.plot(x, np.degrees(phi), label="MuJoCo", **SIMULATED)
        most = math.degrees(np.abs(phi).max())
        axes.set(
            ylabel="φ − Ωt [°]",
            title=f"{about} ({turn.Omega:.0f} rad/s): up to {most:.2g}° ahead, as printed "
            f" {np.abs(printed).max():.2g}°",
        )
        axes.set_xticks(range(0, 361, 90))
    slow, fast = panels
    slow.set_ylim(top=31)
    slow.legend(loc="upper right", fontsize=9.5, borderaxespad=0.0)
    slow.tick_params(labelbottom=False)
    fast.set_xlabel("how far it would have turned evenly, Ωt [°]")


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
    angle.plot(times, np.degrees(truth), **THEORY)
    angle.plot(times, np.degrees(run.phi), **SIMULATED)
    angle.plot(times, np.degrees(printed), **_PRINTED)
    rest = math.degrees(scene.equilibrium())
    angle.axhline(rest, **REFERENCE)
    error.plot(times, np.degrees(run.phi - truth), **SIMULATED)
    error.plot(times, np.degrees(printed - truth), **_PRINTED)
    end = times[-1]
    note(angle, "MuJoCo", (end, 27), (6, 0), color=COLOURS[0])
    note(angle, f"equilibrium,\neq. (53): {rest:.1f}°", (end, rest), (6, 15))
    note(angle, "footnote 8\nas printed", (end, 5), (6, 0), color=COLOURS[1])
    furthest = math.degrees(np.abs(printed - truth).max())
    note(error, "MuJoCo", (end, 0), (6, 0), color=COLOURS[0])
    note(error, "footnote 8\nas printed", (end, -0.7), (6, 0), color=COLOURS[1])
    angle.set(ylabel="φ [°]", title="Angle of the beer's surface; grey: exact theory, eq. (52)")
    for axes in panels:
        axes.set_xlim(-0.04, 2.72)
        axes.set_xticks(np.linspace(0, 2, 5))
    error.set(
        ylabel="error of φ [°]",
        title=f"Footnote 8 as printed is up to {furthest:.1f}° from exact theory",
    )
    share_time(panels)


def draw_roll_down(panels: Sequence[Axes]) -> None:
    """Draw the roll-down of frozen beer: its angle and the normal force."""
    times = np.linspace(0, 1, 1001)
    run = simulate(frozen(), times[-1], math.pi, integrator="DOP853", times=times)
    scene = run.scene
    leaves_at = exact(scene, times, math.pi).rolls_until()
    rolls = times <= leaves_at
    pulled = times >= leaves_at
    angle, normal = panels
    even = np.degrees(scene.acceleration() / scene.can.radius * times**2 / 2)
    angle.plot(times, even, "--", color=GREY, linewidth=1.2)
    printed = np.degrees(footnote_8_as_printed(scene, times, math.pi) - math.pi)
    angle.plot(times[rolls], printed[rolls], **_PRINTED)
    weights = run.forces.normal / (scene.mass * scene.gravity)
    turned = np.degrees(run.phi - math.pi)
    for axes, values in ((angle, turned), (normal, weights)):
        axes.plot(times[rolls], values[rolls], **SIMULATED)
        axes.plot(times[pulled], values[pulled], **UNPHYSICAL)
        axes.axvline(leaves_at, **REFERENCE)
        axes.set_xlim(0, times[-1])
    normal.axhline(0, **REFERENCE)
    note(angle, "MuJoCo, a can that rolls", (0.1, 860), (0, 0), color=COLOURS[0])
    note(angle, "footnote 8 as printed", (0.1, 700), (0, 0), color=COLOURS[1])
    note(angle, "solid cylinder: g sin α t² / 3a", (leaves_at, 110), (-6, 0), ha="right")
    note(
        normal,
        "dotted: if the incline could pull",
        (leaves_at, 6.8),
        (-6, 0),
        ha="right",
        color="#707070",
    )
    angle.set(
        ylabel="φ − 180° [°]",
        title=f"It has turned by {turned[rolls][-1]:.0f}°, a solid cylinder by "
        f"{even[rolls][-1]:.0f}°, at {leaves_at:.3f} s",
    )
    normal.set(
        ylabel="normal force / weight",
        title=f"The incline pushes with up to {weights[rolls].max():.1f} weights, and with none "
        f"at {leaves_at:.3f} s",
    )
    share_time(panels)


def draw_slip_and_hop(panels: Sequence[Axes]) -> None:
    """Draw the friction that rolling needs, and how a can with less of it slips and hops."""
    contact = LIFT_OFF()
    times = np.linspace(0, 1, 1001)
    rolling = exact(contact.scene, times, math.pi)
    leaves_at = rolling.rolls_until()
    friction, moved = panels
    needed = rolling.forces.needed_friction
    too_little = times[np.argmax(needed > FRICTION)]
    slid = 1e3 * contact.slip
    lifted = 1e3 * contact.lift
    before = contact.time < leaves_at
    needed = np.where((needed < 2.5) & (times < leaves_at), needed, np.nan)
    friction.plot(times, needed, color="black")
    friction.axhline(FRICTION, **REFERENCE)
    note(friction, f"all that there is: μ = {FRICTION:g}", (0.5, FRICTION), (6, 8))
    note(friction, "needed to roll,\nexact theory", (0.5, 0.3), (6, 16), color="black")
    moved.plot(contact.time, slid, color=COLOURS[1])
    moved.plot(contact.time, lifted, color=COLOURS[0])
    note(moved, "slid instead\nof rolled", (0.94, 15), (-2, 0), color=COLOURS[1], ha="right")
    note(moved, "height", (0.89, 5.5), (-4, 0), color=COLOURS[0], ha="right")
    for axes in panels:
        axes.axvline(leaves_at, **REFERENCE)
        axes.set_xlim(0.5, times[-1])
    note(friction, "from here on rolling\nwould need a pull", (leaves_at, 1.5), (6, 0))
    _draw_slip_closer(moved, contact.time[before], slid[before])
    friction.set(
        ylabel="friction / normal force",
        title=f"Rolling needs more friction than there is from {too_little:.2f} s",
        ylim=(0, 2.2),
    )
    moved.set(
        ylabel="distance [mm]",
        title=f"MuJoCo's can slides by {np.abs(slid[before]).max():.1f} mm, then hops "
        f"{lifted.max():.1f} mm high",
    )
    share_time(panels)


def _draw_slip_closer(axes: Axes, times: np.ndarray, slid: np.ndarray) -> None:
    """Draw the slip [mm] before the hop into an inset at the top left."""
    closer = axes.inset_axes((0.1, 0.48, 0.42, 0.4))
    closer.plot(times, slid, color=COLOURS[1])
    closer.set(xlim=(0.7, times[-1]), ylim=(-0.1, 0.8), xticks=(0.7, 0.75, 0.8), yticks=(0, 0.6))
    closer.tick_params(labelsize=9)
    closer.set_title("the slip before, seen closer [mm]", fontsize=9.5, color=COLOURS[1])


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
    axes.plot(ratios, lifts, color=COLOURS[0])
    axes.plot(few, measured, "o", color=COLOURS[0])
    note(
        axes,
        "lifts off if it cannot skid:\ntheory, and MuJoCo (dots)",
        (few[2], measured[2]),
        (-8, 22),
        color=COLOURS[0],
        ha="right",
    )
    for mu, colour, raised in ((2.0, COLOURS[2], 2), (MU, COLOURS[1], -2), (0.5, "black", 0)):
        angles = skids(ratios, mu)
        axes.plot(ratios, angles, "--", color=colour)
        note(axes, f"skids, μ = {mu:g}", (ratios[-1], angles[-1]), (7, raised), color=colour)
    lightest = math.degrees(hopping.slip(float(ratios[0]), MU))
    axes.axhline(90, **REFERENCE)
    axes.axvline(1 / 13, **REFERENCE)
    note(axes, "Littlewood: 90°", (0.0012, 90), (0, -9))
    gap = int(np.argmax(np.isnan(skids(ratios, MU))))
    note(
        axes,
        "A hoop just too heavy\nto skid here grips\nuntil it has passed 90°.",
        (ratios[gap], 81),
        (7, -3),
        color=COLOURS[1],
    )
    note(axes, "heavier hoops,\nM/m > 1/13,\nnever lift off", (1 / 13, 76), (7, 0))
    axes.set_xscale("log")
    axes.set(
        xlabel="mass of the hoop / weight on its rim, M / m",
        ylabel="angle of the weight from the top [°]",
        title=f"With μ = {MU:g} a hoop of m/1000 skids at {lightest:.0f}°, not at 90°",
        xlim=(9e-4, 0.24),
    )
    marks = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05)
    axes.set_xticks(marks, map(str, marks))
    axes.tick_params(which="minor", labelbottom=False)
