"""How long a timestep of GaussJackson may be, from the shape of the motion alone.

As a function of complex time a motion has singularities, beside the real axis, where J vanishes or phi becomes
infinite. The nearest one says how fast the errors of a method fall with its timestep, once it is short of that
distance. J = base + chord sin^2(phi/2) + swing sin^2(phi) vanishes at complex angles above phi = 0, and with a sliding
load above pi as well. The time on the way there, from the nearest angle that the motion reaches, is the integral of
sqrt(J / 2 (E - V)), as that along the motion itself.
"""

import cmath
import math

from numba import njit

from mjbeer.theory.scene import Scene

_ANGLES = 64
"""Number of angles in a turn at which the motion is looked at."""
_PART = 2 * math.pi / _ANGLES
_NODES = 16
"""Number of angles on the way to a singularity. They lie more closely at its ends, where a speed or J vanishes."""
_HIGHEST = 5.0
"""Imaginary part [rad] at which a way to infinity ends: what is left of it takes next to no time."""
_BISECTIONS = 8
_SHARE, _SHARE_BY_HEIGHT, _HIGH = 0.055, 0.03, 1.0
"""Timestep over the distance of the nearest singularity for an error of 1e-9 rad, the same for each radian of the angle
at which J vanishes, and the largest such angle that counts (measured: nine of ten random motions allow more)."""
_TURNING = 1.25
"""How much longer it may be where the load turns over, and the nearest singularity is that of its last turn."""
_OF_SWING = 0.2
"""The same over the time of a radian of phase of the fastest small swing, from where on small swings lose digits."""
_BRIEFEST = 1 / 150
"""Angle [rad] by which the load would turn in the time to the nearest singularity with its largest inertia, below which
DOP853 takes fewer evaluations (measured on light wheels: equal at 1/50 to 1/300)."""
_REFERENCE, _ORDER = 1e-9, 13
_FEWEST = 8
"""Least number of timesteps in a run, for motions that hardly move."""


def longest(scene: Scene, phi0: float, phi_dot0: float, duration: float, tolerance: float) -> float:
    """Return a timestep [s] with which runs of some `duration` [s] should keep a tolerance [rad].

    It is 0 where the load passes the place of its least inertia so briefly that long steps elsewhere gain more.
    """
    form = scene.oscillator
    numbers = form.base, form.chord, form.swing, form.slope, form.depth, form.bottom
    distance, swinging, bulk, height = _shape(numbers, phi0, phi_dot0, duration)
    if distance * bulk < _BRIEFEST:
        return 0.0
    timestep = min((_SHARE + _SHARE_BY_HEIGHT * min(height, _HIGH)) * distance, _OF_SWING / max(swinging, 1e-300))
    return min(timestep * (tolerance / _REFERENCE) ** (1 / _ORDER), duration / _FEWEST)


@njit(cache=True)
def _kinetic(numbers, start, phi0, phi):
    """Return J phi_dot^2 / 2 at an angle `phi`, complex or not, of a motion that had `start` of it at `phi0`."""
    slope, depth, bottom = numbers[3:]
    return start + slope * (phi - phi0) - 2 * depth * cmath.sin((phi + phi0) / 2 - bottom) * cmath.sin((phi - phi0) / 2)


@njit(cache=True)
def _inertia(numbers, phi):
    """Return J at an angle, complex or not."""
    half, whole = cmath.sin(phi / 2), cmath.sin(phi)
    return numbers[0] + numbers[1] * half * half + numbers[2] * whole * whole


@njit(cache=True)
def _reach(numbers, start, phi0):
    """Return the lowest and highest angle of a motion, within a turn of its start, and what it shows on the way.

    That is its largest kinetic energy there and where that is, the smallest J, the mean of sqrt(J), and whether the
    load turns over.
    """
    ends, turns, mean = [phi0, phi0], False, 1.0
    most, place, least = start, phi0, _inertia(numbers, phi0 + 0j).real
    for side in range(2):
        sign, total = 2 * side - 1, 0.0
        first = math.floor(phi0 / _PART) + side
        for step in range(_ANGLES + 1):
            phi = (first + sign * step) * _PART
            kinetic, inertia = _kinetic(numbers, start, phi0, phi + 0j).real, _inertia(numbers, phi + 0j).real
            least, total = min(least, inertia), total + math.sqrt(inertia)
            if kinetic <= 0:
                ends[side] = _turn(numbers, start, phi0, ends[side], phi)
                break
            ends[side] = phi
            if kinetic > most:
                most, place = kinetic, phi
        else:
            turns, mean = True, total / (_ANGLES + 1)
    return ends[0], ends[1], most, place, least, mean, turns


@njit(cache=True)
def _turn(numbers, start, phi0, inside, outside):
    """Return the last angle that a motion reaches between two, by bisection."""
    for _ in range(_BISECTIONS):
        middle = (inside + outside) / 2
        if _kinetic(numbers, start, phi0, middle + 0j).real > 0:
            inside = middle
        else:
            outside = middle
    return inside


@njit(cache=True, nogil=True, error_model="numpy")
def _shape(numbers, phi0, rate, duration):
    """Return the distance of the nearest singularity [s] and where it is above the real angles [rad], as the last one.

    Between them are the rates [rad/s] of the fastest small swing, and of the load where it is fast and J is not small.
    `numbers` are base, chord, swing, slope, depth and bottom of an `Oscillator`.
    """
    base, chord, swing, slope, depth, _ = numbers
    start = _inertia(numbers, phi0 + 0j).real * rate**2 / 2
    low, high, most, place, least, mean, turns = _reach(numbers, start, phi0)
    if turns:  # a turn at the energy E takes 2 pi mean(sqrt(J)) / sqrt(2 E), and E then grows by 2 pi slope
        gained = max(0.0, (math.sqrt(2 * most) + abs(slope) * duration / mean) ** 2 / 2 - most)
        start, most = start + gained, most + gained
    above, period = _HIGHEST, 2 * math.pi
    if swing > 0:
        above, period = math.asinh(math.sqrt(base / swing)), math.pi
    elif chord > 0:
        above = 2 * math.asinh(math.sqrt(base / chord))
    # From where the load is fastest straight up, and to each place where J vanishes from the nearest angle.
    nearest, first = abs(_time(numbers, start, phi0, place, complex(place, min(above, _HIGHEST))).imag), low // period
    for count in range(int(math.ceil(high / period) - first) + 1):
        top = (first + count) * period
        foot = min(max(top, low), high)
        time = _time(numbers, start, phi0, foot, complex(top, min(above, _HIGHEST)))
        nearest = min(nearest, abs(time.imag) if foot == top else abs(time))
    bulk = math.sqrt(2 * most / (base + chord + swing))
    return nearest * (_TURNING if turns else 1.0), math.sqrt(depth / least), bulk, above


@njit(cache=True, error_model="numpy")
def _time(numbers, start, phi0, foot, top):
    """Return the time, a complex number [s], that a motion takes straight from one complex angle to another."""
    time, last = 0j, 0j
    for node in range(_NODES):
        angle = (node + 0.5) * math.pi / _NODES
        phi = foot + (top - foot) * (1 - math.cos(angle)) / 2
        kinetic = _kinetic(numbers, start, phi0, phi)
        if kinetic == 0:  # what does not move never gets there
            return complex(math.inf, math.inf)
        slowness = cmath.sqrt(_inertia(numbers, phi) / (2 * kinetic))
        if slowness.real * last.real + slowness.imag * last.imag < 0:  # the other root goes on
            slowness = -slowness
        time, last = time + slowness * math.sin(angle), slowness
    return time * (top - foot) * math.pi / (2 * _NODES)
