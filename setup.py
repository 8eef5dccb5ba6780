"""Builds the compiled part of the Python package by CMake; pyproject.toml has what is fixed.

LOCKSTEP_BUILD_FOLDER: a build folder that was configured already, build/release, say, in place of one of its own.
"""
import os
import re
import shutil
import subprocess
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


class BuildByCMake(build_ext):
    def build_extension(self, extension):
        given = os.environ.get("LOCKSTEP_BUILD_FOLDER")
        folder = ROOT / given if given else ROOT / "build" / "package"
        if not given:
            subprocess.run(["cmake", "--preset", "package"], cwd=ROOT, check=True)
        subprocess.run(["cmake", "--build", folder, "--target", "lockstep_python"], check=True)
        built, = (folder / "drivers" / "python" / "lockstep").glob("_core*.so")
        target = Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(built, target)


setup(version=re.search(r"project\(Lockstep VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1],
      ext_modules=[Extension("lockstep._core", sources=[])], cmdclass={"build_ext": BuildByCMake})
