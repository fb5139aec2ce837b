"""Runs the notebooks in examples/ from top to bottom; they show pictures and controls."""

import os
import pathlib
import sys

import pytest

nbclient = pytest.importorskip("nbclient", reason="needs nbclient, ipykernel and ipywidgets")
nbformat = pytest.importorskip("nbformat")
pytest.importorskip("ipykernel")
pytest.importorskip("ipywidgets")

FOLDER = pathlib.Path(__file__).parents[2] / "examples" / "notebooks"
WIDGETS_SHOWN = {"first_pictures": 0, "walk_around": 2, "what_accuracy_costs": 0}


def test_every_notebook_is_known():
    assert {path.stem for path in FOLDER.glob("*.ipynb")} == set(WIDGETS_SHOWN)


@pytest.mark.parametrize("name", WIDGETS_SHOWN)
def test_it_runs(name, tmp_path, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    book = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    assert all(not cell.get("outputs") for cell in book.cells), "must be stored without outputs"
    client = nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": str(tmp_path)}})
    # Ignore messages of widgets to a front end: ipywidgets 6 and nbclient of Debian 12 do not agree on them.
    client.comm_open_handlers = {"jupyter.widget": lambda message: None}
    client.execute()
    outputs = [output for cell in book.cells for output in cell.get("outputs", [])]
    shown = [kind for output in outputs for kind in output.get("data", {})]
    assert "image/png" in shown
    assert shown.count("application/vnd.jupyter.widget-view+json") == WIDGETS_SHOWN[name]
    said = [line for output in outputs if output.get("name") == "stderr" for line in output["text"].splitlines()]
    assert not [line for line in said if "Widget Javascript not detected" not in line]  # ipywidgets 6 without a browser
