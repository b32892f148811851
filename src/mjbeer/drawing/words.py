"""A scene in words, for titles and captions, and what a notebook shows of a run."""

import html
import math
from collections.abc import Collection

from mjbeer.theory.damping import Damping
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

_FILLS = {0.25: "quarter-full", 0.5: "half-full", 0.75: "three-quarters-full", 1.0: "full"}


def in_words(scene: Scene, varied: Collection[str] = ()) -> str:
    """Return a scene in words, as "half-full massless can, beer frozen, incline 10°".

    `varied` names the differences between the scenes of a plot, which are left out: "load" (its attachment, or the
    masses of a hoop or a pendulum) and "incline".
    """
    can, load = scene.can, scene.load
    if load.inertia > 0:
        full = "" if load.fill is None else _FILLS.get(load.fill, f"{100 * load.fill:.3g} % full")
        parts = [f"{full} {'massless can' if can.mass == 0 else f'can of {1e3 * can.mass:.3g} g'}".strip()]
        parts.append("" if "load" in varied else f"{'load' if load.fill is None else 'beer'} {scene.attachment}")
        parts.append(f"its centre of mass {1e3 * load.offset:.3g} mm from the axis" if load.fill is None else "")
    else:  # a load without size: a pendulum's bob or a weight on a hoop
        body = "wheel with a pendulum" if scene.attachment == "sliding" else "hoop with a weight on its rim"
        parts = [body, "" if "load" in varied else f"M = {1e3 * can.mass:.3g} g, m = {1e3 * load.mass:.3g} g"]
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


def trajectory_html(trajectory: Trajectory) -> str:
    """Return the key figures of a trajectory, and what it says about itself, as an HTML table."""
    time, radius, record = trajectory.time, trajectory.scene.can.radius, trajectory.record
    rows = {
        "scene": in_words(trajectory.scene),
        "rolling, integrator": f"{trajectory.rolling}, {trajectory.integrator}",
        "samples": f"{len(time)}, from {time[0]:.6g} s to {time[-1]:.6g} s",
        "φ at the last sample": f"{math.degrees(trajectory.phi[-1]):.6g} degrees",
        "u at the last sample": f"{trajectory.u[-1]:.6g} m",
        "largest slip and lift": f"{record.slip / radius:.2g} and {record.lift / radius:.2g} radii",
    }
    if trajectory.error_estimate is not None:
        rows["estimated error of φ and u/a"] = f"{trajectory.error_estimate:.2g} rad"
    rows["trusted"] = "yes" if trajectory.trusted else "no: " + "; ".join(trajectory.warnings)
    cells = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(text)}</td></tr>" for name, text in rows.items())
    return f'<table style="text-align: left">{cells}</table>'
