"""The tutorial runs from top to bottom, and its cells show what the text beside them says."""

import pathlib
import sys

import nbformat
import pytest
from nbclient import NotebookClient

TUTORIAL = pathlib.Path(__file__).parents[2] / "examples" / "tutorial.ipynb"


@pytest.mark.slow
@pytest.mark.draws
def test_the_tutorial_runs_and_shows_a_plot_a_video_and_tables(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    notebook = nbformat.read(TUTORIAL, as_version=4)
    client = NotebookClient(notebook, timeout=120, resources={"metadata": {"path": str(TUTORIAL.parent)}})
    kernel = client.create_kernel_manager().kernel_spec
    assert kernel is not None
    kernel.argv[0] = sys.executable
    client.execute()
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    html = "".join(output.data.get("text/html", "") for output in outputs if "data" in output)
    text = "".join(output.get("text", "") for output in outputs)
    assert sum("image/png" in output.data for output in outputs if "data" in output) == 2
    assert "<video" in html
    assert "<th>trusted</th><td>yes</td>" in html
    assert "this run is not to be relied on: " in text
    assert "the can slips by" in text
    assert "tolerance 1e-9 rad, error" in text


def test_the_tutorial_is_kept_without_its_output() -> None:
    """So that a change of it is a change of its text, and nothing in it can be out of date."""
    notebook = nbformat.read(TUTORIAL, as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells)
