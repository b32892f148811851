"""The tutorial runs from top to bottom, and its cells show what the text beside them says."""

import pathlib
import re
import sys
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient

TUTORIAL = pathlib.Path(__file__).parents[2] / "examples" / "tutorial.ipynb"


def text_of(outputs: list[Any], kind: str = "text/plain") -> str:
    """What was printed, and what was shown as text or as another kind of data."""
    shown = [output.data.get(kind, "") for output in outputs if "data" in output]
    return "".join(output.get("text", "") for output in outputs) + "".join(shown)


@pytest.mark.costly
@pytest.mark.draws
def test_the_tutorial_runs_and_shows_plots_a_video_and_a_table(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In a kernel of its own, as Jupyter runs it."""
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    notebook = nbformat.read(TUTORIAL, as_version=4)
    client = NotebookClient(
        notebook, timeout=600, resources={"metadata": {"path": str(TUTORIAL.parent)}}
    )
    kernel = client.create_kernel_manager().kernel_spec
    assert kernel is not None
    kernel.argv[0] = sys.executable
    client.execute()
    outputs = [
        output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs
    ]
    text = text_of(outputs)
    html = text_of(outputs, "text/html")
    assert sum("image/png" in output.data for output in outputs if "data" in output) == 3
    assert "<video" in html
    assert not [
        output.text for output in outputs if output.get("name") == "stderr"
    ]  # a warning that nobody explains
    assert "\ntrusted\n" in text
    # "The error is the smaller one."
    shown = re.search(r"error of phi (\S+) rad, estimated (\S+) rad", text)
    assert shown
    assert float(shown[1]) < float(shown[2])
    assert "this run is not to be relied on: " in text
    assert "the can slips by" in text
    assert "tolerance 1e-9 rad, error" in text
    # This share of the runs can be relied on; a few are at the edge of it.
    assert re.search(r"0\.8[0-4]\d{6}", text)


def test_the_tutorial_is_kept_with_its_output() -> None:
    """So that it can be read where nothing is installed."""
    cells = [
        cell for cell in nbformat.read(TUTORIAL, as_version=4).cells if cell.cell_type == "code"
    ]
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    assert all(cell.outputs for cell in cells[1:])  # the first one imports
    outputs = [output for cell in cells for output in cell.outputs]
    assert not [
        output
        for output in outputs
        if output.output_type == "error" or output.get("name") == "stderr"
    ]
    assert "<video" in text_of(outputs, "text/html")
