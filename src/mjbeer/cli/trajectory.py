"""A trajectory as CSV, and a table of its key figures for the terminal."""

import io
import math

import numpy as np
from rich.table import Table

from mjbeer.theory.trajectory import Trajectory


def csv(trajectory: Trajectory) -> str:
    """Return a trajectory as CSV: one line per sample, units in the header, numbers with all their digits."""
    columns = {
        "time [s]": trajectory.time,
        "u [m]": trajectory.u,
        "phi [rad]": trajectory.phi,
        "u_dot [m/s]": trajectory.u_dot,
        "phi_dot [rad/s]": trajectory.phi_dot,
        "roll [rad]": trajectory.roll,
        "lift [m]": trajectory.lift,
        "slip [m]": trajectory.slip,
        "energy [J]": trajectory.energy,
        "normal force needed [N]": trajectory.forces.normal,
        "friction force needed [N]": trajectory.forces.friction,
    }
    text = io.StringIO()
    np.savetxt(
        text, np.column_stack(list(columns.values())), fmt="%.17g", delimiter=",", header=",".join(columns), comments=""
    )
    return text.getvalue()


def summary(trajectory: Trajectory) -> Table:
    """Return a table of the key figures of a trajectory, for the terminal."""
    table = Table(show_header=False, box=None)
    radius = trajectory.scene.can.radius
    parted, needed = trajectory.rolls_until(), trajectory.forces.needed
    slip = trajectory.slip / radius
    facts = {
        "rolling, integrator": f"{trajectory.rolling}, {trajectory.integrator}",
        "samples": f"{len(trajectory.time)} to t = {trajectory.time[-1]:.6g} s",
        "phi at the end": f"{math.degrees(trajectory.phi[-1]):.9g} degrees",
        "u at the end": f"{trajectory.u[-1]:.9g} m",
        "energy drift": f"{trajectory.energy_drift:.2e} of the largest kinetic energy of the swing",
        "slip, largest and final": f"{np.abs(slip).max():.2e}, {slip[-1]:.2e} radii",
        "lift, lowest and highest": f"{trajectory.lift.min() / radius:.2e}, {trajectory.lift.max() / radius:.2e} radii",
        "normal force needed": f"{trajectory.forces.normal.min():.4g} to {trajectory.forces.normal.max():.4g} N",
        "friction coefficient needed": f"{needed.max():.4g}",
        "can roll without slipping": "to the end" if math.isinf(parted) else f"until t = {parted:.6g} s (then N < 0)",
    }
    if trajectory.error_estimate is not None:
        facts["estimated error of phi and u/a"] = f"{trajectory.error_estimate:.2e} rad"
    for name, value in facts.items():
        table.add_row(name, value)
    return table
