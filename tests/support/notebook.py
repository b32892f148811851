"""A notebook, run from top to bottom in a kernel of its own, as Jupyter runs it."""

import pathlib
import sys
from typing import Any

import nbformat
import pytest
from nbclient import NotebookClient


def execute(notebook: nbformat.NotebookNode, folder: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Run the cells in a folder, to the first error, and return the outputs of the cells of code."""
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    client = NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(folder)}})
    kernel = client.create_kernel_manager().kernel_spec
    assert kernel is not None
    kernel.argv[0] = sys.executable
    client.execute()
    return [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]


def text(outputs: list[Any], kind: str = "text/plain") -> str:
    """Return what was printed, and what was shown as text or as another kind of data."""
    shown = [output.data.get(kind, "") for output in outputs if "data" in output]
    return "".join(output.get("text", "") for output in outputs) + "".join(shown)
