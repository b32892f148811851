"""The cross-section of what lies in a can: a segment of a circle."""

import math
from typing import NamedTuple


class Segment(NamedTuple):
    """A segment of a circle of radius a, in units of a."""

    half_angle: float
    """Half of the angle that the segment subtends at the axis, beta [rad]."""
    area: float
    """Area [a^2], eq. (33)."""
    offset: float
    """Distance of the centroid from the axis [a], eq. (35)."""
    inertia: float
    """Moment of inertia about the centroid per mass [a^2], eq. (37)."""
    mean_square_across: float
    """Mean square of the distance from the line of symmetry [a^2]."""


def segment(fill: float) -> Segment:
    """Return the segment whose height is `fill` times the diameter: eqs. (32), (33), (35), (37).

    At a fill of 0.01 the differences cancel to relative errors of 1e-14 in area and offset, and of
    2e-12 in the inertia; from a fill of 0.1 on they are below 2e-14.
    """
    beta = 2 * math.atan2(math.sqrt(fill), math.sqrt(1 - fill))
    # From eq. (32), h = a (1 - cos(beta)), so that a full can has its centroid exactly on the axis:
    cosine = 1 - 2 * fill
    sine = 2 * math.sqrt(fill * (1 - fill))
    sine_of_twice = 2 * sine * cosine
    area = beta - sine_of_twice / 2
    offset = 2 * sine**3 / (3 * area)
    # By eq. (36), I_axis = m a^2 (1 + excess)/2; excess is 0 in a full and in a half-full can, and
    # negative between. I_axis adds the mean squares of both coordinates; the one across the line of
    # symmetry is (1 - excess)/4.
    excess = sine_of_twice * sine**2 / (3 * area)
    return Segment(
        half_angle=beta,
        area=area,
        offset=offset,
        inertia=(1 + excess) / 2 - offset**2,
        mean_square_across=(1 - excess) / 4,
    )
