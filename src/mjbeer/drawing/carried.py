"""Standing cans in grippers, to be drawn: cut open in front, and with a liquid whose plane surface can tilt."""

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from scipy.optimize import brentq
from scipy.spatial import ConvexHull, QhullError

from mjbeer.drawing.camera import circle
from mjbeer.model.build import compile_spec, specify
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


class CarriedCans:
    """Grippers side by side over a table, each with a can of one kind; a `Painter` draws it like a `Display`."""

    def __init__(self, can: Standing, colours: Sequence[tuple[float, float, float]], apart: float) -> None:
        """Prepare grippers with pads of some colours, the nearest first, `apart` from each other [m]."""
        self.can, self.lanes = can, [lane * apart for lane in range(len(colours))]
        shell, radius = can.can, can.can.radius
        self._wall, self.top = (1 + WALL) * radius, _HIGH + shell.length + 0.07
        specs = [specify(can, visuals=True) for _ in colours]
        for number, (spec, colour) in enumerate(zip(specs, colours, strict=True)):
            for geom in [each for each in spec.geoms if each.name not in ("board", "wall", "can_end")]:
                spec.delete(geom)
            body, box = spec.body("can"), mujoco.mjtGeom.mjGEOM_BOX
            triangles, normals = _padded(*cut(radius, shell.length, can.fill, np.array([0.0, 0.0, 1.0])))
            spec.add_mesh(
                name="liquid",
                uservert=triangles.ravel(),
                usernormal=normals.ravel(),
                userface=np.arange(3 * _TRIANGLES),
                userfacenormal=np.arange(3 * _TRIANGLES),
                inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
            )
            body.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="liquid", material="beer", mass=0)
            wide = math.pi * self._wall / _PLATES / 2
            for angle in math.pi * (np.arange(_PLATES) + 0.5) / _PLATES:
                place = [self._wall * math.cos(angle), self._wall * math.sin(angle), shell.length / 2]
                quat = [math.cos(angle / 2), 0, 0, math.sin(angle / 2)]
                size = [0.001, 1.1 * wide, shell.length / 2]
                body.add_geom(type=box, size=size, pos=place, quat=quat, material="metal", mass=0)
            hand, half = shell.length + 0.03, self._wall + 0.024
            fingers = [([0.005, 0.01, hand / 2 - 0.015], side * (half - 0.01), hand / 2 + 0.015) for side in (-1, 1)]
            for size, x, z in (*fingers, ([half, 0.014, 0.008], 0, hand), ([0.014, 0.012, 0.02], 0, hand + 0.02)):
                body.add_geom(type=box, size=size, pos=[x, 0, z], rgba=_STEEL, mass=0)
            for x in (-self._wall - 0.005, self._wall + 0.005):
                body.add_geom(type=box, size=[0.004, 0.012, 0.03], pos=[x, 0, 0.06], rgba=[*colour, 1], mass=0)
            for geom in spec.geoms:
                geom.group = _UNSEEN if geom.name in ("board", "wall") else number
                geom.contype = geom.conaffinity = 0
        table, *others = specs
        for number, (lane, spec) in enumerate(zip(self.lanes[1:], others, strict=True), start=1):
            table.worldbody.add_frame(pos=[0, lane, 0]).attach_body(spec.body("can"), f"{number}-", "")
        for plane in (table.geom("board"), table.geom("wall")):
            plane.pos += [0, self.lanes[-1] * (0.5 if plane.name == "board" else 1), 0]
        table.geom("board").size += [0, self.lanes[-1] / 2, 0]
        self.model = compile_spec(table)
        self.data = mujoco.MjData(self.model)
        self.changing = [self.model.mesh(f"{prefix}liquid").id for prefix in self._prefixes()]
        """Meshes that are to be uploaded again after each pose."""

    def _prefixes(self) -> list[str]:
        return [f"{number}-" if number else "" for number in range(len(self.lanes))]

    def pose(self, positions: np.ndarray) -> None:
        """Put each can at x [m], with a surface that rises at the wall ahead by so many radii: a row for each."""
        for prefix, lane, mesh, (x, rise) in zip(self._prefixes(), self.lanes, self.changing, positions, strict=True):
            self.data.joint(f"{prefix}free").qpos[:3] = x, lane, _HIGH
            up = np.array([-rise, 0.0, 1.0]) / math.hypot(rise, 1.0)
            triangles, normals = _padded(*cut(self.can.can.radius, self.can.can.length, self.can.fill, up))
            turn = np.zeros(9)
            mujoco.mju_quat2Mat(turn, self.model.mesh_quat[mesh])
            for field, values in (("vert", triangles - self.model.mesh_pos[mesh]), ("normal", normals)):
                first = getattr(self.model, f"mesh_{field}adr")[mesh]
                kept = getattr(self.model, f"mesh_{field}")[first : first + 3 * _TRIANGLES]
                kept[:] = values.reshape(-1, 3) @ turn.reshape(3, 3)
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def outline(self, number: int, position: np.ndarray) -> np.ndarray:
        """Return the corners of the near and the far side of what is around a gripper [m], shape (2, 4, 3)."""
        side, depth = self._wall + 0.026, self._wall + 0.002
        left, right = position[0] - side, position[0] + side
        corners = np.array([[left, _HIGH], [right, _HIGH], [right, self.top], [left, self.top]])
        return np.stack([np.insert(corners, 1, self.lanes[number] + y, axis=1) for y in (-depth, depth)])

    def wall(self, number: int, x: float, rise: float) -> np.ndarray:
        """Return points [m] around the front of a can where its surface is when it has risen by so many radii."""
        turn = np.linspace(math.pi, 2 * math.pi, 24)
        height = _HIGH + self.can.height + rise * self.can.can.radius
        across = x + self._wall * np.cos(turn), self.lanes[number] + self._wall * np.sin(turn)
        return np.stack([*across, np.full_like(turn, height)], axis=1)


def _padded(triangles: np.ndarray, normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the triangles and normals of a mesh of a fixed size: the last of them is repeated."""
    last = np.minimum(np.arange(_TRIANGLES), len(triangles) - 1)
    return triangles[last], normals[last]
