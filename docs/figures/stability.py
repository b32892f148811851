"""Draws the maps in docs/stability.md anew, which come with mjbeer.

Run it as `python docs/figures/stability.py`.
"""

import pathlib

from mjbeer.studies.stability import map_plots, stability_maps

for name, draw in map_plots.figures(stability_maps.load()).items():
    draw(pathlib.Path(__file__).with_name(name))
