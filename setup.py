"""Packs what CMake builds into a wheel (docs/python.md). Everything else stands in pyproject.toml."""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = pathlib.Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    """Configures, builds, and installs the component `python` where setuptools looks for modules."""

    def build_extension(self, ext):
        # A folder that has been built in already (./dev python) saves building everything once more.
        folder = os.environ.get("EDGESPLAT_BUILD_FOLDER")
        build = pathlib.Path(folder or self.build_temp).resolve()
        if not folder:
            options = ["-DCMAKE_BUILD_TYPE=Release", "-DEDGESPLAT_PYTHON=ON", "-DEDGESPLAT_TESTS=OFF"]
            configure = ["cmake", "-S", SOURCE, "-B", build, "-G", "Ninja", f"-DPython_EXECUTABLE={sys.executable}"]
            subprocess.run([*configure, *options], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "edgesplat_python"], check=True)
        target = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve().parents[1]
        subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", target], check=True)


version = re.search(r"project\(edgesplat VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
setup(
    version=version,
    packages=["edgesplat"],
    package_dir={"edgesplat": "python/edgesplat"},
    package_data={"edgesplat": ["*.pyi", "py.typed"]},
    ext_modules=[Extension("edgesplat._core", [])],
    cmdclass={"build_ext": CMakeBuild},
)
