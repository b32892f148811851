"""The tutorial runs from top to bottom, and its cells show what the text beside them says."""

import pathlib
import re

import nbformat
import pytest

from tests.support import notebook

TUTORIAL = pathlib.Path(__file__).parents[2] / "examples" / "tutorial.ipynb"


@pytest.mark.costly
@pytest.mark.draws
def test_the_tutorial_runs_and_shows_a_plot_a_video_and_tables(monkeypatch: pytest.MonkeyPatch) -> None:
    outputs = notebook.execute(nbformat.read(TUTORIAL, as_version=4), TUTORIAL.parent, monkeypatch)
    text, html = notebook.text(outputs), notebook.text(outputs, "text/html")
    assert sum("image/png" in output.data for output in outputs if "data" in output) == 3
    assert "<video" in html
    assert not [output.text for output in outputs if output.get("name") == "stderr"]  # a warning that nobody explains
    assert "<th>trusted</th><td>yes</td>" in html
    assert "this run is not to be relied on: " in text
    assert "the can slips by" in text
    assert "tolerance 1e-9 rad, error" in text
    assert re.search(r"0\.8[0-4]\d{6}", text)  # of the runs can be relied on; a few are at the edge of it


def test_the_tutorial_is_kept_with_its_output() -> None:
    """So that it can be read where nothing is installed."""
    cells = [cell for cell in nbformat.read(TUTORIAL, as_version=4).cells if cell.cell_type == "code"]
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    assert all(cell.outputs for cell in cells[1:])  # the first one imports
    outputs = [output for cell in cells for output in cell.outputs]
    assert not [output for output in outputs if output.output_type == "error" or output.get("name") == "stderr"]
    assert "<video" in notebook.text(outputs, "text/html")
