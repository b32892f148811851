"""A trajectory as CSV."""

import io

import numpy as np

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
