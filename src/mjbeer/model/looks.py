"""The looks of a can: geoms, meshes and cameras, fitted to its sizes and its load.

Across the can's axis, the y axis, everything grows with the radius, and along it with the can's
length.
"""

import functools
import math
import pathlib
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from typing import Any, NamedTuple

import mujoco
import numpy as np

from mjbeer.exceptions import TemplateError
from mjbeer.model import mjcf_file
from mjbeer.model.beer_mesh import EDGES, Mesh, beer, foam
from mjbeer.model.looks_tree import add_looks
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.scene import Scene
from mjbeer.theory.standing import Standing

VISUAL_GROUP = 2
"""The group of the geoms that are only drawn, as in the class "visual" of the mechanics files."""
TURNING = ("can_mark", "can_spot", "can_tab", "can_mouth", "can_spokes")
"""The geoms that show how far the can has turned."""
WALL = 0.06
"""Thickness of the drawn wall of the can, in radii. It lies outside the radius, so that the beer
fills the inside."""
FOAM = 0.025
"""Largest thickness of the foam, in radii."""
PLAIN_EDGES = 32
"""Number of edges around the arc of the beer where it is drawn plainly: its area is within 4 %."""
_PLAIN = ("can_wall", "can_end", "can_mark")
"""The geoms of a can that are there too if it is drawn plainly."""
_GLASS = (0.86, 0.88, 0.91, 0.25)
"""Colour and opacity of a wall that is drawn plainly, through which the beer is seen."""
_UPRIGHT_GEOMS = ("can_wall", "can_end")
"""The geoms of a standing can, except its beer."""
_NEEDED = {
    "camera": ("side", "quarter", "overview"),
    "mesh": ("can", "load"),
    "material": ("grid", "planks"),
    "geom": ("board", "wall"),
}
"""The elements of all looks that mjbeer addresses by name."""


class Cylinder(NamedTuple):
    """A cylinder along the axis of a body."""

    low: float
    """Where it begins [m]."""
    high: float
    """Where it ends [m]."""
    radius: float
    """Its radius [m]."""


def name(can: Scene | Standing) -> str:
    """Return the name of a can's looks; a load without a fill is drawn as a ball."""
    if isinstance(can, Standing):
        return "standing"
    if can.attachment == "sliding":
        return "pendulum" if can.load.fill is None else "sliding"
    return "hoop" if can.load.fill is None else "frozen"


def drawn_spec(root: ET.Element, path: pathlib.Path, can: Scene | Standing) -> mujoco.MjSpec:
    """Return the specification of a mechanics file, the tree from a `path`, with a can's looks."""
    folder = path.parents[1]
    add_looks(root, name(can), folder)
    spec = mjcf_file.parse_spec(root, path)
    _require_elements(spec, can, folder / "looks")
    _fit_sizes(spec, can.can, folder / "assets")
    if isinstance(can, Standing):
        _fit_to_standing(spec, can)
    else:
        _fit_to_scene(spec, can)
    _delete_unused(spec.meshes, {geom.meshname for geom in spec.geoms}, spec)
    return spec


def _require_elements(spec: mujoco.MjSpec, can: Scene | Standing, folder: pathlib.Path) -> None:
    """Refuse looks without an element that mjbeer addresses by name."""
    own_geoms = (*_UPRIGHT_GEOMS, *beer_column(can)) if isinstance(can, Standing) else ("load",)
    for kind, names in (*_NEEDED.items(), ("geom", own_geoms)):
        find = getattr(spec, kind)
        for needed in names:
            if find(needed) is None:
                raise TemplateError(
                    f"{folder} has no {kind} named {needed!r}, which mjbeer uses; restore it"
                )


def _fit_to_scene(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Draw the load of a scene, and nothing that turns with a can that has no joint."""
    if scene.attachment == "sliding" and spec.joint("phi") is not None:
        for geom in filter(None, map(spec.geom, TURNING)):
            spec.delete(geom)
    draw_load = _place_point_load if scene.load.fill is None else shape_beer
    draw_load(spec, scene)


def _fit_to_standing(spec: mujoco.MjSpec, standing: Standing) -> None:
    """Fit what is drawn to a standing can: the can, and the cylinders of its beer."""
    for wall in _UPRIGHT_GEOMS:
        spec.geom(wall).pos = [0, 0, standing.can.length / 2]
    for beer_geom, cylinder in beer_column(standing).items():
        geom = spec.geom(beer_geom)
        geom.pos = [0, 0, (cylinder.low + cylinder.high) / 2]
        geom.size = [cylinder.radius, (cylinder.high - cylinder.low) / 2, 0]


def beer_column(standing: Standing) -> dict[str, Cylinder]:
    """Return the cylinders that draw the beer of a standing can, by the names of their geoms.

    The upper cylinder tilts about the pivot of the first mode, and must stay in the can at every
    tilt. So it is narrower than the can: it lies in the largest ball about the pivot that the can
    has room for. If that ball does not reach down to the cylinder's lower face, as in a nearly full
    can, the cylinder is made too small to be seen.
    """
    height = standing.height
    radius = standing.can.radius
    if standing.moving_modes == 0:
        return {"beer": Cylinder(0.0, height, radius)}
    pivot = standing.pivots(1)[0]
    thickness = min(0.2 * radius, height / 4)
    top = height - pivot
    depth = max(top, thickness - top)  # of the lower face below the pivot
    ball = min(radius, pivot, standing.can.length - pivot)
    if ball <= depth:
        dot = 1e-4 * radius
        return {"beer": Cylinder(0.0, height, radius), "beer_top": Cylinder(-dot, dot, dot)}
    width = math.sqrt(ball**2 - depth**2)
    return {
        "beer": Cylinder(0.0, height - thickness, radius),
        "beer_top": Cylinder(-depth, top, width),
    }


def simplify(spec: mujoco.MjSpec, can: Scene | Standing) -> None:
    """Draw a can plainly, in a specification of `drawn_spec`: by a few geoms that need no mesh.

    The wall is a cylinder that one can see through, with a disc at its far end and a rod along it
    that shows how far it has turned. The only mesh that is left is that of a load with a fill, with
    fewer edges. The can's materials have no textures.
    """
    for geom in list(spec.geoms):
        if geom.meshname not in ("", "load") and geom.name not in _PLAIN:
            spec.delete(geom)
    _plain_wall(spec, can)
    if isinstance(can, Scene) and can.load.fill is not None:
        shape_beer(spec, can, PLAIN_EDGES)
    for material in spec.materials:
        if material.name not in ("grid", "planks"):
            material.textures = [""] * len(material.textures)
    _delete_unused(spec.meshes, {geom.meshname for geom in spec.geoms}, spec)
    painted = (*spec.geoms, *spec.sites, *spec.tendons)
    _delete_unused(spec.materials, {element.material for element in painted}, spec)
    used_textures = {texture for material in spec.materials for texture in material.textures}
    _delete_unused(spec.textures, used_textures | {"sky"}, spec)


def _plain_wall(spec: mujoco.MjSpec, can: Scene | Standing) -> None:
    """Replace the meshes of wall, end and mark by cylinders."""
    radius = can.can.radius
    thickness = WALL * radius
    half_length = can.can.length / 2
    upright = isinstance(can, Standing)
    # A cylinder's axis is z, and that of a lying can y. The end of a standing can is its bottom.
    along = np.array([0, 0, -1]) if upright else np.array([0, 1, 0])
    turn = [1, 0, 0, 0] if upright else [math.sqrt(0.5), math.sqrt(0.5), 0, 0]
    middle = np.array([0, 0, half_length if upright else 0])
    mark = np.array([0, 0, radius + thickness])
    shapes = {
        # Longer by a little, so that its ends do not lie in those of the beer.
        "can_wall": (middle, radius + thickness, half_length + thickness / 4),
        "can_end": (
            middle + along * (half_length + thickness / 2),
            radius + thickness,
            thickness / 2,
        ),
        "can_mark": (middle + mark, thickness, half_length),
    }
    for geom_name, (place, width, half_height) in shapes.items():
        geom = spec.geom(geom_name)
        if geom is not None:
            geom.meshname = ""
            geom.type = mujoco.mjtGeom.mjGEOM_CYLINDER
            geom.pos = place
            geom.quat = turn
            geom.alt.type = mujoco.mjtOrientation.mjORIENTATION_QUAT
            geom.size = [width, half_height, 0]
    wall = spec.geom("can_wall")
    if wall is not None:  # Somebody's own looks may lack it.
        wall.material = ""
        wall.rgba = _GLASS


def _delete_unused(elements: Iterable[Any], used: set[str], spec: mujoco.MjSpec) -> None:
    """Delete those elements of a specification whose names are not used."""
    for element in list(elements):
        if element.name not in used:
            spec.delete(element)


def _fit_sizes(spec: mujoco.MjSpec, can: Can, assets: pathlib.Path) -> None:
    """Fit what is drawn to the sizes of a can."""
    size = can.radius / RADIUS
    stretch = np.array([size, can.length / LENGTH, size])
    for geom in spec.geoms:
        if geom.group == VISUAL_GROUP:
            geom.pos = geom.pos * stretch
            geom.fromto = geom.fromto * np.tile(stretch, 2)
            geom.size = geom.size * (stretch if geom.type == mujoco.mjtGeom.mjGEOM_BOX else size)
    for camera in spec.cameras:  # as many radii from the can's near end
        camera.pos = size * camera.pos - [0, (can.length - size * LENGTH) / 2, 0]
    spec.material("grid").texrepeat /= size
    spec.stat.extent *= size
    spec.stat.center *= size
    for mesh in spec.meshes:
        path = assets / mesh.file
        try:
            content = path.read_bytes()
        except OSError as error:
            raise TemplateError(f"{path} is no mesh that can be read: {error}") from error
        shape, mesh.usertexcoord = _read_mesh(path, content)
        _reshape(mesh, Mesh(shape.vertices * mesh.scale * stretch, shape.faces))
    spec.meshdir = ""


@functools.lru_cache(maxsize=32)
def _read_mesh(path: pathlib.Path, content: bytes) -> tuple[Mesh, np.ndarray]:
    """Return a mesh as MuJoCo reads a file of this content, and its texture coordinates, as one
    row."""
    spec = mujoco.MjSpec()
    spec.assets = {path.name: content}
    spec.add_mesh(name="mesh", file=path.name, inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL)
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_MESH, meshname="mesh")
    try:
        model = spec.compile()
    except ValueError as error:
        raise TemplateError(f"{path} is no mesh that MuJoCo can read: {error}") from error
    principal_axes = np.zeros(9)  # along which MuJoCo turns a mesh
    mujoco.mju_quat2Mat(principal_axes, model.mesh_quat[0])
    vertices = model.mesh_vert @ principal_axes.reshape(3, 3).T + model.mesh_pos[0]
    return Mesh(vertices, model.mesh_face.copy()), model.mesh_texcoord.astype(float).ravel()


def _reshape(element: mujoco.MjsMesh, shape: Mesh) -> None:
    """Replace the file of a mesh by a shape."""
    element.scale = [1, 1, 1]
    element.file = ""
    element.content_type = ""
    element.uservert = shape.vertices.ravel()
    element.userface = shape.faces.ravel()


def _place_point_load(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Put the bob with its arm, or the bar on the rim, where the scene has it."""
    offset = scene.load.offset
    ball = spec.geom("load")
    arm = spec.geom("load_arm")
    if arm is not None:
        thickness = arm.size[0]
        arm.pos = [0, arm.pos[1], -offset / 2]
        arm.size = [thickness, max(offset / 2, thickness / 100), 0]
    else:
        # A load on the rim is drawn just inside it.
        offset = min(offset, scene.can.radius - ball.size[0])
    if math.isnan(ball.fromto[0]):
        ball.pos = [0, ball.pos[1], -offset]
    else:
        ball.fromto = [*ball.fromto[:2], -offset, *ball.fromto[3:5], -offset]


def shape_beer(spec: mujoco.MjSpec, scene: Scene, edges: int = EDGES) -> None:
    """Give the beer its fill, and put foam on it, thinner where there is little room or beer."""
    radius = scene.can.radius
    length = scene.can.length
    fill = max(scene.load.fill or 0.0, 1e-6)  # A mesh must not be flat.
    liquid = spec.mesh("load")
    shape = beer(fill, radius, length, edges)
    if len(liquid.usertexcoord):
        # The texture covers the can's cross-section. Multiples of 1/512 have few digits.
        places = shape.vertices[:, [0, 2]] / (2 * radius) + 0.5
        liquid.usertexcoord = (np.round(512 * places) / 512).ravel()
    _reshape(liquid, shape)
    # At most a quarter of the beer's depth, and of the room above it.
    thickness = min(FOAM, fill / 2, (1 - fill) / 2)
    foam_mesh = spec.mesh("foam")
    foam_geom = spec.geom("foam")
    if foam_mesh is not None and thickness >= 1e-4:  # What is thinner is not seen.
        _reshape(foam_mesh, foam(fill, thickness, radius, length))
    elif foam_geom is not None:
        spec.delete(foam_geom)
