"""The example runs from its first cell to its last."""

from __future__ import annotations

import re
from pathlib import Path

import nbclient
import nbformat

#: One of the two sentences that it can end with, with its numbers.
VERDICT = re.compile(r"the blade survives all speeds|up to \d[\d.]* times its strength: do not run near \d[\d,]*")

NOTEBOOK = Path(__file__).parent.parent / "examples" / "from_matrices_to_a_verdict.ipynb"


def test_the_notebook_comes_to_a_verdict() -> None:
    notebook = nbformat.read(NOTEBOOK, as_version=4)  # type: ignore[no-untyped-call]
    assert not any(cell.get("outputs") for cell in notebook.cells), "outputs are not kept"
    done = nbclient.NotebookClient(
        notebook, timeout=300, resources={"metadata": {"path": str(NOTEBOOK.parent)}}
    ).execute()
    text = "".join(output.get("text", "") for cell in done.cells for output in cell.get("outputs", []))
    assert VERDICT.search(text), text
