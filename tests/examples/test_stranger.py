"""A notebook of twelve cells, as someone writes it who has read the README, the documents and `help`, and no source."""

import json
import pathlib

import nbformat
import pytest

from tests.support import notebook

CELLS = (
    """
    import json
    import math
    import warnings

    import mujoco
    import numpy as np
    import pandas as pd

    import mjbeer
    """,
    """
    scene = mjbeer.sliding(incline=math.radians(5), fill=0.5, can=mjbeer.Can.sheet_metal())
    scene
    """,
    """
    rest = scene.equilibrium()
    print(f"the beer's surface is {math.degrees(rest):.2f} degrees off the incline")
    """,
    """
    degrees = [1, 30, 60, 120, 170]
    pd.DataFrame({"amplitude [degrees]": degrees, "period [s]": [scene.period(math.radians(x)) for x in degrees]})
    """,
    """
    run = mjbeer.simulate(scene, duration=3, phi0=math.radians(60), rolling="equality")
    run
    """,
    """
    run.plot(theory=True);
    """,
    """
    run.to_csv("motion.csv")
    table = pd.read_csv("motion.csv")
    again = run.to_dataframe()
    list(table.columns) == list(again.columns) and np.array_equal(table["phi [rad]"], run.phi)
    """,
    """
    for attempt in (
        lambda: mjbeer.frozen(can="metal"),
        lambda: mjbeer.simulate(scene, 1, phi0=1.0, rolling="contac"),
        lambda: mjbeer.simulate("sliding", 1, phi0=1.0),
        lambda: mjbeer.export(scene, "can.urdf"),
    ):
        try:
            attempt()
        except mjbeer.MjbeerError as error:
            print(error)
    """,
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        mjbeer.simulate(scene, 1, phi0=60)
    caught[0].message
    """,
    """
    mjbeer.export(scene, "can.xml", phi0=math.radians(60), rolling="equality")
    model = mujoco.MjModel.from_xml_path("can.xml")
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)
    times, angles = [], []
    while data.time < 2:
        times.append(data.time)
        angles.append(data.joint("roll").qpos[0] + data.joint("swing").qpos[0])
        mujoco.mj_step(model, data)
    distance = abs(np.array(angles) - mjbeer.exact(scene, times, phi0=math.radians(60)).phi).max()
    """,
    """
    errors = []
    for timestep in (1e-3, 5e-4, 2.5e-4):
        coarse = mjbeer.simulate(scene, 2, phi0=1.0, integrator="RK4", timestep=timestep)
        errors.append(abs(coarse.phi - mjbeer.exact(scene, coarse.time, phi0=1.0).phi).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    """,
    """
    fine = mjbeer.simulate(scene, 2, phi0=1.0, tolerance=1e-9)
    error = abs(fine.phi - mjbeer.exact(scene, fine.time, phi0=1.0).phi).max()
    print(json.dumps({"orders": orders.tolist(), "own loop": distance, "tolerance": error, "trusted": fine.trusted}))
    """,
)
MESSAGES = (
    "can must be a Can, got 'metal'",
    "rolling must be one of 'reduced', 'equality', 'contact'; got 'contac'",
    "scene must be a Scene, got 'sliding'",
    "MJCF is written: the file's name must end in .xml, got 'can.urdf'",
)


@pytest.mark.costly
def test_a_stranger_s_notebook_runs(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cells = [nbformat.v4.new_code_cell("\n".join(line[4:] for line in cell.strip("\n").splitlines())) for cell in CELLS]
    assert len(cells) == 12
    outputs = notebook.execute(nbformat.v4.new_notebook(cells=cells), tmp_path, monkeypatch)
    text, html = notebook.text(outputs), notebook.text(outputs, "text/html")
    assert "<th>incline</th><td>5 degrees</td>" in html
    assert "<th>trusted</th><td>yes</td>" in html
    assert sum("image/png" in output.data for output in outputs if "data" in output) == 1
    assert "True" in text  # the CSV is the table
    assert not [message for message in MESSAGES if f"{message}\n" not in text]
    assert "phi0 = 60 is taken as radians, 9.549 turns: if degrees are meant, write math.radians(60)" in text
    found = json.loads(next(line for line in text.splitlines() if line.startswith("{")))
    assert found["orders"] == pytest.approx([4, 4], abs=0.2)  # what is next in the timestep
    assert found["own loop"] < 1e-7  # RK4 at 1 ms over two seconds, as the document of the validation has it
    assert found["tolerance"] < 1e-9
    assert found["trusted"]
