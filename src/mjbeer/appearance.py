"""How a scene looks: geoms of the templates fitted to its sizes, or taken away."""

import mujoco

from mjbeer import mesh
from mjbeer.can import RADIUS
from mjbeer.scene import Scene

WALL = 0.02
"""Thickness of the can's drawn wall, in radii: outside of the radius, so that the beer fills the inside."""


def strip(spec: mujoco.MjSpec) -> None:
    """Take away all that is only drawn."""
    drawn = [each for each in spec.geoms if each.classname.name == "visual"]
    for each in [*drawn, *spec.cameras, *spec.lights, *spec.keys, *spec.meshes, *spec.materials, *spec.textures]:
        spec.delete(each)


def dress(spec: mujoco.MjSpec, scene: Scene) -> None:
    """Fit what is drawn to the scene's sizes; the template's keyframes go, as they were another scene's."""
    for each in spec.keys:
        spec.delete(each)
    radius, length = scene.can.radius, scene.can.length
    size = radius / RADIUS  # whatever is not given by radius and length grows with the radius
    _shape(spec, "can", mesh.tube(radius, radius * (1 + WALL), length))
    rim, side = radius * (1 + WALL / 2), length / 2
    for name, half_size, position in (
        ("can_end", [radius, 0.0003 * size, 0], [0, side - 0.0003 * size, 0]),
        ("can_mark", [0.0016 * size, side + 0.0002 * size, 0.0006 * size], [0, 0, rim]),
        ("can_spot", [0.0022 * size, 0.0006 * size, radius * 0.15], [0, -side - 0.0002 * size, radius * 0.87]),
        ("board", [6 * size, 0.1 * size, 0.01], [4 * size, 0, -WALL * radius]),
        ("board_side", [6 * size, 0.1 * size, 0.006 * size], [4 * size, 0, -WALL * radius - 0.007 * size]),
    ):
        geom = spec.geom(name)
        if geom is not None:
            geom.size, geom.pos = half_size, position
    _load(spec, scene, size)
    for camera in spec.cameras:
        camera.pos = camera.pos * size
    spec.stat.extent, spec.stat.center = 0.3 * size, [0, 0, radius]


def _load(spec: mujoco.MjSpec, scene: Scene, size: float) -> None:
    load, side = scene.load, scene.can.length / 2
    if load.fill is not None:
        _shape(spec, "load", mesh.beer(load.fill, scene.can.radius, scene.can.length))
        return
    drawn, arm = spec.geom("load"), spec.geom("load_arm")
    if drawn.type == mujoco.mjtGeom.mjGEOM_SPHERE:
        drawn.size, drawn.pos = [0.008 * size, 0, 0], [0, 0, -load.offset]
        arm.fromto, arm.size = [0, 0, 0, 0, 0, -max(load.offset, 1e-6 * size)], [0.0012 * size, 0, 0]
    else:  # a bar along the rim, drawn just inside
        depth = -min(load.offset, scene.can.radius - 0.004 * size)
        drawn.fromto, drawn.size = [0, -side, depth, 0, side, depth], [0.004 * size, 0, 0]


def _shape(spec: mujoco.MjSpec, name: str, shape: mesh.Mesh) -> None:
    """Put vertices in the place of the template's mesh file: the model is then complete in itself."""
    vertices, faces = shape
    element = spec.mesh(name)
    element.file, element.content_type = "", ""
    element.uservert, element.userface = vertices.ravel(), faces.ravel()
