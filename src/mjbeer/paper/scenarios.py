"""Scenes and numbers that the audit and the stories of the paper share."""

import math

import numpy as np

from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.load import Load
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

TOP = math.pi - 0.05
"""Angle phi [rad] from which a hoop falls: a little beside pi, the top, where it would stay in balance."""


def fall_from_top(scene: Scene, timestep: float, friction: float) -> Trajectory:
    """Return the fall of a hoop in contact, let go at `TOP`, until just after it lifts off or passes the bottom."""
    times = np.linspace(0, 3, 3001)
    fall = exact(scene, times, TOP)
    parts = fall.rolls_until()
    bottom = times[np.argmax(fall.phi < 0)]
    duration = parts * 1.02 if math.isfinite(parts) else float(bottom)
    return simulate(scene, duration, TOP, rolling="contact", timestep=timestep, friction=friction)


GRIP = 1e6
"""Friction coefficient so large that nothing slips."""
RATIO = 1 / 20
"""M/m of the hoop that hops."""
MU = 0.8
"""Friction coefficient of the hoop that skids: the kinetic one in the paper's last figure."""
DECADE = (50.0, 100.0, 200.0, 400.0)
"""Rates phi_dot [rad/s] at phi = 0 of loads that loop; their mean rates span a decade, 35 to 354 rad/s."""


def footnote_scene(part: float = 1.0) -> Scene:
    """Return the scene of footnote 8: a = 3 cm, b = 1 cm, alpha = 10 degrees, g = 980 cm/s^2, I_axis = m a^2/2.

    `part` scales b.
    """
    a, b, mass = 0.03, 0.01 * part, 1.0
    return Scene(Can.massless(a), Load(mass, b, mass * (a**2 / 2 - b**2)), math.radians(10), "frozen", 9.8)


def balanced(k: float, gravity: float = 9.81) -> Scene:
    """Return a rolling cylinder of inertia k m a^2 about its axis: a balanced load frozen to a massless can."""
    can = Can.massless()
    return Scene(can, Load(0.2, 0.0, k * 0.2 * can.radius**2), attachment="frozen", gravity=gravity)
