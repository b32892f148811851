"""What is drawn at the can is true: the angle, the paths, the forces, and the ghost."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pytest

from mjbeer import Scene, Trajectory, exact, frozen, hoop, pendulum, sliding
from mjbeer.drawing.annotations import LONGEST, Annotations
from mjbeer.drawing.camera import View, follow, on_incline, scale
from mjbeer.drawing.quantities import mean_forces
from mjbeer.drawing.scene import coordinates
from mjbeer.drawing.style import FilmStyle, Mark
from mjbeer.model.looks import WALL
from mjbeer.theory.can import RADIUS
from tests.support.recorder import Recorder

TIMES = np.linspace(0, 0.5, 501)
PIXELS = (1280, 430)
PLANE = -0.06
"""The coordinate y of the can's near end [m]."""
# Rounding of places of some hundred pixels; the arcs are polygons, whose ends are exact.
ROUNDING = 1e-6


class Drawn(NamedTuple):
    """What was drawn of a motion at a time."""

    sheet: Recorder
    view: View
    u: float
    phi: float
    roll: float


def drawn(motion: Trajectory, time: float, *marks: Mark) -> Drawn:
    """Draw marks at a time [s] of a motion."""
    view = follow(motion, "fixed", PLANE, PIXELS).view(time)
    (now,) = coordinates(motion, np.array([time]))
    sheet = Recorder(*PIXELS)
    Annotations(motion, FilmStyle("", marks=marks), PLANE).draw(sheet, view, time, now)
    u, phi, roll, _ = now
    return Drawn(sheet, view, u, phi, roll)


def place(motion: Trajectory, view: View, along: float, height: float) -> np.ndarray:
    """Return where a point of the incline's plane is seen, given in the scene's metres."""
    x, z = on_incline(motion.scene, along * scale(motion.scene), height * scale(motion.scene))
    return view.pixel(np.array([x, PLANE, z]))


def direction(first: np.ndarray, last: np.ndarray) -> float:
    """Return the direction from place to place [rad], counter-clockwise from the right."""
    right, down = last - first
    return math.atan2(-down, right)


def difference(one: float, other: float) -> float:
    """Return the angle between two directions [rad]."""
    return abs(math.remainder(one - other, 2 * math.pi))


@pytest.mark.parametrize("make", [frozen, sliding, pendulum, hoop])
@pytest.mark.parametrize("phi", [-3.0, -1.0, -0.1, 0.1, 1.0, 3.0, 10.0])
def test_the_angle_is_phi_from_the_incline_to_the_surface(
    make: Callable[[], Scene], phi: float
) -> None:
    """One line is along the incline, or upright from it over a bob.

    The other is turned by phi, clockwise.
    """
    motion = exact(make(), TIMES, phi)

    sheet = drawn(motion, 0.0, "phi").sheet

    first, second, arc = sheet.lines
    still = direction(first[0], first[-1])
    turned = direction(second[0], second[-1])
    expected = -motion.scene.incline
    if motion.scene.load.fill is None:
        expected += math.pi / 2
    # It may be drawn from either end; twice the angles are alike then.
    assert difference(2 * still, 2 * expected) < ROUNDING
    assert difference(turned, still - phi) < ROUNDING
    assert difference(direction(first[0], arc[0]), still) < ROUNDING
    assert difference(direction(second[0], arc[-1]), turned) < ROUNDING
    assert sheet.words == ["φ"]


@pytest.mark.parametrize("make", [frozen, sliding, pendulum, hoop])
def test_paths_are_those_of_fig_3(make: Callable[[], Scene]) -> None:
    motion = exact(make(), TIMES, 2.0)
    a = motion.scene.can.radius
    b = motion.scene.load.offset

    sheet, view, u, phi, roll = drawn(motion, 0.3, "paths")

    rim, centre = sheet.lines
    start = place(motion, view, motion.u[0] - b * math.sin(2.0), a - b * math.cos(2.0))
    load = place(motion, view, u - b * math.sin(phi), a - b * math.cos(phi))
    mark = place(motion, view, u + a * math.sin(roll), a + a * math.cos(roll))
    assert centre[0] == pytest.approx(start, abs=ROUNDING)
    assert centre[-1] == pytest.approx(load, abs=ROUNDING)
    assert sheet.discs[0] == pytest.approx(load, abs=ROUNDING)
    assert rim[-1] == pytest.approx(mark, abs=ROUNDING)


def test_forces_push_the_can_where_it_touches_the_incline() -> None:
    motion = exact(frozen(), TIMES, 2.0)
    normal = float(np.interp(0.1, TIMES, motion.forces.normal))
    friction = float(np.interp(0.1, TIMES, motion.forces.friction))

    sheet, view, u, _, _ = drawn(motion, 0.1, "normal", "friction")

    pressing, pushing = sheet.arrows
    away = math.pi / 2 - motion.scene.incline
    # Friction is positive up the incline, which is to the left.
    along = math.pi * (friction > 0) - motion.scene.incline
    under_the_wall = place(motion, view, u, -WALL * 0.033)
    assert pressing.tail == pytest.approx(under_the_wall, abs=ROUNDING)
    assert difference(direction(pressing.tail, pressing.tip), away) < ROUNDING
    assert difference(direction(pushing.tail, pushing.tip), along) < ROUNDING

    length_of_normal = np.hypot(*(pressing.tip - pressing.tail))
    length_of_friction = np.hypot(*(pushing.tip - pushing.tail))
    radius = RADIUS * view.scale(np.array([0.0, PLANE, 0.0]))
    # What is drawn are means over 10 ms.
    assert length_of_friction / length_of_normal == pytest.approx(abs(friction) / normal, rel=0.02)
    assert length_of_normal <= LONGEST * radius * (1 + 1e-9)
    assert sheet.words == ["N", "F"]


def test_the_longest_arrow_is_that_of_the_largest_force() -> None:
    """No force of a can that rolls is too long to be drawn as long as it is."""
    motion = exact(frozen(), np.linspace(0, 0.82, 821), math.pi)
    forces = np.hypot(*mean_forces(motion))

    def length(time: float) -> float:
        sheet, view, *_ = drawn(motion, time, "normal")
        (arrow,) = sheet.arrows
        radius = RADIUS * view.scale(np.array([0.0, PLANE, 0.0]))
        return float(np.hypot(*(arrow.tip - arrow.tail))) / radius

    largest = forces.argmax()
    expected = mean_forces(motion).normal / forces[largest] * LONGEST
    for sample in (0, 300, largest):
        assert length(motion.time[sample]) == pytest.approx(expected[sample], rel=1e-6)


def test_the_line_of_the_equilibrium_goes_through_the_axis_at_its_angle() -> None:
    motion = exact(frozen(), TIMES, 0.0)

    sheet, view, u, _, _ = drawn(motion, 0.2, "equilibrium")

    (line,) = sheet.lines
    expected = -motion.scene.incline - motion.scene.equilibrium()
    assert difference(2 * direction(line[0], line[1]), 2 * expected) < ROUNDING
    axis = place(motion, view, u, motion.scene.can.radius)
    assert line.mean(axis=0) == pytest.approx(axis, abs=ROUNDING)


def test_the_ghost_is_where_even_acceleration_has_it() -> None:
    """s = g sin(alpha) t^2/2 in a massless can, eq. (9); the can itself is b sin(phi) ahead."""
    motion = exact(sliding(), TIMES, 1.0)

    sheet, view, u, phi, _ = drawn(motion, 0.4, "ghost")

    ring = sheet.lines[0]
    middle = (ring.min(axis=0) + ring.max(axis=0)) / 2
    even = 9.81 * math.sin(motion.scene.incline) * 0.4**2 / 2
    # A polygon of 48 corners.
    assert middle == pytest.approx(place(motion, view, even, 0.033), abs=0.2)
    assert u - even == pytest.approx(motion.scene.load.offset * math.sin(phi))
