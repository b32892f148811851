"""Draws the maps in docs/stability.md anew, which come with mjbeer.

Run it as `python docs/figures/stability.py`.
"""

import pathlib

from mjbeer.studies.stability import stability_maps

for name, draw in stability_maps.figures(stability_maps.load()).items():
    draw(pathlib.Path(__file__).with_name(name))
