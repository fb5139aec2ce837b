"""The stub lists exactly the module's public names."""

import ast
import pathlib

import edgesplat
from edgesplat import _core


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_names_agree():
    stub = ast.parse((pathlib.Path(edgesplat.__file__).parent / "_core.pyi").read_text())
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    assert public(classes) | public(functions) == public(dir(_core))
    for name, node in classes.items():
        if name in ("Error", "SceneError", "Interrupted", "DeviceLost"):
            continue
        members = {item.name for item in node.body if isinstance(item, ast.FunctionDef)}
        assert public(members) == public(vars(getattr(_core, name))), name


def test_everything_public_has_a_docstring():
    for name in edgesplat.__all__:
        entry = getattr(edgesplat, name)
        if isinstance(entry, str):
            continue
        assert entry.__doc__, name
        if isinstance(entry, type) and not issubclass(entry, Exception):
            for member in public(vars(entry)):
                found = vars(entry)[member]
                if callable(found) or isinstance(found, property):
                    assert found.__doc__, f"{name}.{member}"
