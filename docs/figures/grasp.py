"""Films the example that grasps a can: `python docs/figures/grasp.py` writes renders/grasp.webp."""

import pathlib
import runpy

import mujoco
from PIL import Image, ImageDraw, ImageFont

import mjbeer
from mjbeer.output import files

WIDTH, HEIGHT, FPS = 720, 450, 18
"""Width and height [pixels] and pictures per second."""
CHECKOUT = pathlib.Path(__file__).parents[2]


def film(path: pathlib.Path) -> None:
    """Draw the can in its fingers, and tell how high the beer rises now and has risen at most."""
    example = runpy.run_path(str(CHECKOUT / "examples" / "grasp.py"))
    model = example["world"]()
    model.vis.global_.offwidth = WIDTH
    model.vis.global_.offheight = HEIGHT
    model.vis.headlight.ambient[:] = 0.45
    model.vis.headlight.diffuse[:] = 0.35
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)  # The first picture is drawn before the first step.
    camera = mujoco.MjvCamera()
    camera.lookat[:] = [example["CARRY"] / 2, 0, 0.145]
    camera.distance = 0.64
    camera.azimuth = 60
    camera.elevation = -12
    font = ImageFont.load_default(20)
    pictures = []
    rise = 0.0
    highest = 0.0
    with mujoco.Renderer(model, HEIGHT, WIDTH) as renderer:
        while data.time < example["END"]:
            if data.time >= len(pictures) / FPS:
                renderer.update_scene(data, camera)
                picture = Image.fromarray(renderer.render())
                said = (
                    f"{data.time:.1f} s: the beer rises by {rise:.2f} R (at most {highest:.2f} R)"
                )
                ImageDraw.Draw(picture).text((16, 12), said, (40, 50, 60), font)
                pictures.append(picture)
            example["control"](data)
            mujoco.mj_step(model, data)
            rise = mjbeer.wall_rise(model, data)
            highest = max(highest, rise)
    with files.atomic_write(path) as temporary:
        pictures[0].save(
            temporary,
            "WEBP",
            save_all=True,
            append_images=pictures[1:],
            duration=1000 // FPS,
            loop=0,
            quality=60,
            method=4,
        )


if __name__ == "__main__":
    film(CHECKOUT / "renders" / "grasp.webp")
