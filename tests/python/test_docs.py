"""Runs the code of docs/python.md from top to bottom."""

import pathlib
import re

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "python.md"


def test_the_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)
    assert len(blocks) >= 6
    names = {}
    for place, block in enumerate(blocks):
        exec(compile(block, f"{PAGE.name}, block {place}", "exec"), names)
    assert {"sphere.png", "cloud.png", "two.png", "two.toml", "two.exr", "frame_003.png"} <= {
        path.name for path in tmp_path.iterdir()
    }
