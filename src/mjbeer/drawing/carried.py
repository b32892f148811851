"""Standing cans in grippers, to be drawn: cut open in front, and with a liquid whose plane surface can tilt."""

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import mujoco
import numpy as np
from scipy.optimize import brentq
from scipy.spatial import ConvexHull, QhullError

from mjbeer.drawing.camera import circle
from mjbeer.drawing.scene import Display, prefix, side_by_side
from mjbeer.model.build import specify
from mjbeer.model.looks import WALL
from mjbeer.theory.standing import Standing

_EDGES, _TRIANGLES = 64, 400  # edges around a liquid, and room for the triangles of its mesh
_PLATES = 24  # of the wall behind the liquid
_HIGH = 0.015  # height at which a gripper holds its can [m]
_UNSEEN = 5  # MuJoCo's group of geoms that OpenGL does not draw
_STEEL = (0.32, 0.36, 0.42, 1.0)


def cut(radius: float, length: float, fill: float, up: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the triangles of the liquid in a can under a plane surface, shape (n, 3, 3) [m], and their normals.

    The can is a cylinder from the origin along z, and filled to a share `fill` of its volume. `up` is a unit vector
    normal to the surface, in any direction. The triangles and their outward normals (n, 3, 3), one at each corner, are
    those of a prism with 64 edges.
    """
    low, high = (np.insert(circle(radius, _EDGES)[:-1], 2, z, axis=1) for z in (0.0, length))
    corners = np.concatenate([low, high])
    starts = np.concatenate([low, high, low])
    ends = np.concatenate([np.roll(low, 1, axis=0), np.roll(high, 1, axis=0), high])

    def below(level: float) -> ConvexHull | None:
        """Return what is below a level, None if there is nothing."""
        first, last = level - starts @ up, level - ends @ up
        crosses = first * last < 0
        share = (first[crosses] / (first - last)[crosses])[:, np.newaxis]
        crossings = starts[crosses] + share * (ends - starts)[crosses]
        try:
            return ConvexHull(np.concatenate([corners[corners @ up <= level], crossings]))
        except (QhullError, ValueError):  # a point or a plane
            return None

    whole = _EDGES / 2 * radius**2 * math.sin(2 * math.pi / _EDGES) * length
    heights = corners @ up

    def excess(level: float) -> float:
        hull = below(level)
        return (hull.volume if hull else 0.0) - fill * whole

    hull = below(brentq(excess, heights.min(), heights.max(), xtol=1e-9 * length))
    assert hull is not None
    triangles, outwards = hull.points[hull.simplices], hull.equations[:, :3]
    turned = np.einsum("ij,ij->i", np.cross(*np.diff(triangles, axis=1).transpose(1, 0, 2)), outwards) < 0
    triangles[turned] = triangles[turned][:, ::-1]
    normals = np.repeat(outwards[:, np.newaxis], 3, axis=1)
    radial = triangles * [1 / radius, 1 / radius, 0]
    on_wall = np.einsum("ijk,ijk->ij", radial, normals).min(axis=1) > 0.99  # so that the wall looks round
    normals[on_wall] = radial[on_wall]
    return triangles, normals


@dataclass(frozen=True, eq=False, kw_only=True)
class CarriedCans(Display):
    """Grippers side by side over a table, each with a can of one kind."""

    can: Standing

    @classmethod
    def held(cls, can: Standing, colours: Sequence[tuple[float, float, float]], apart: float) -> Self:
        """Return grippers with pads of some colours, the nearest first, `apart` from each other [m]."""
        lanes, length, radius = [lane * apart for lane in range(len(colours))], can.can.length, can.can.radius
        wall, hand = (1 + WALL) * radius, length + 0.03
        half, high = wall + 0.024, hand / 2 - 0.015
        fingers = [([0.005, 0.01, high], side * (half - 0.01), high + 0.03) for side in (-1, 1)]
        steel = [*fingers, ([half, 0.014, 0.008], 0, hand), ([0.014, 0.012, 0.02], 0, hand + 0.02)]
        specs = [specify(can, visuals=True) for _ in colours]
        for number, (spec, colour) in enumerate(zip(specs, colours, strict=True)):
            for geom in [each for each in spec.geoms if each.name not in ("board", "wall", "can_end")]:
                spec.delete(geom)
            triangles, normals = _padded(*cut(radius, length, can.fill, np.array([0.0, 0.0, 1.0])))
            liquid = spec.add_mesh(name="liquid", inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL)
            liquid.uservert, liquid.usernormal = triangles.ravel(), normals.ravel()
            liquid.userface = liquid.userfacenormal = np.arange(3 * _TRIANGLES)
            add = functools.partial(spec.body("can").add_geom, type=mujoco.mjtGeom.mjGEOM_BOX)
            add(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="liquid", material="beer")
            for angle in math.pi * (np.arange(_PLATES) + 0.5) / _PLATES:
                place = [wall * math.cos(angle), wall * math.sin(angle), length / 2]
                size = [0.001, 0.55 * math.pi * wall / _PLATES, length / 2]  # they overlap a little
                add(size=size, pos=place, quat=[math.cos(angle / 2), 0, 0, math.sin(angle / 2)], material="metal")
            for size, x, z in steel:
                add(size=size, pos=[x, 0, z], rgba=_STEEL)
            for x in (-wall - 0.005, wall + 0.005):
                add(size=[0.004, 0.012, 0.03], pos=[x, 0, length / 2], rgba=[*colour, 1])
            for geom in spec.geoms:
                geom.group = _UNSEEN if geom.name in ("board", "wall") else number
                geom.contype = geom.conaffinity = 0
        model = side_by_side(specs, lanes)
        changing = [model.mesh(f"{prefix(number)}liquid").id for number in range(len(lanes))]
        return cls(model=model, data=mujoco.MjData(model), scenes=(), lanes=lanes, changing=changing, can=can)

    def pose(self, positions: np.ndarray) -> None:
        """Put each can at x [m], with a surface that rises at the wall ahead by so many radii: a row for each."""
        model, can = self.model, self.can.can
        for number, (mesh, (x, rise)) in enumerate(zip(self.changing, positions, strict=True)):
            self.data.joint(f"{prefix(number)}free").qpos[:3] = x, self.lanes[number], _HIGH
            up = np.array([-rise, 0.0, 1.0]) / math.hypot(rise, 1.0)
            triangles, normals = _padded(*cut(can.radius, can.length, self.can.fill, up))
            turn = np.zeros(9)
            mujoco.mju_quat2Mat(turn, model.mesh_quat[mesh])
            begin, first = model.mesh_vertadr[mesh], model.mesh_normaladr[mesh]
            vertices = (triangles - model.mesh_pos[mesh]).reshape(-1, 3) @ turn.reshape(3, 3)
            model.mesh_vert[begin : begin + 3 * _TRIANGLES] = vertices
            model.mesh_normal[first : first + 3 * _TRIANGLES] = normals.reshape(-1, 3) @ turn.reshape(3, 3)
        mujoco.mj_kinematics(model, self.data)
        mujoco.mj_camlight(model, self.data)

    def outline(self, number: int, position: np.ndarray) -> np.ndarray:
        """Return the corners of the near and the far side of what is around a gripper [m], shape (2, 4, 3)."""
        top, wall = _HIGH + self.can.can.length + 0.07, (1 + WALL) * self.can.can.radius
        left, right = position[0] - wall - 0.026, position[0] + wall + 0.026
        corners = np.array([[left, _HIGH], [right, _HIGH], [right, top], [left, top]])
        return np.stack([np.insert(corners, 1, self.lanes[number] + y, axis=1) for y in (-wall, wall)])

    def wall(self, number: int, x: float, rise: float) -> np.ndarray:
        """Return points [m] around the front of a can where its surface is when it has risen by so many radii."""
        turn = np.linspace(math.pi, 2 * math.pi, 24)
        height = _HIGH + self.can.height + rise * self.can.can.radius
        wall = (1 + WALL) * self.can.can.radius
        points = [x + wall * np.cos(turn), self.lanes[number] + wall * np.sin(turn), np.full_like(turn, height)]
        return np.stack(points, axis=1)


def _padded(triangles: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the triangles and normals of a mesh of a fixed size: the last of them is repeated."""
    last = np.minimum(np.arange(_TRIANGLES), len(triangles) - 1)
    return triangles[last], normals[last]
