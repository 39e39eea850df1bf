"""The package as it is built and installed: types, stubs, libraries that are not there."""

import ast
import inspect
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

import slcbeam

HERE = Path(slcbeam.__file__).parent


def test_stubs_are_those_of_the_library():
    """Names and parameters of `_slcbeam.pyi` are those of what was compiled, and nothing is missing."""
    own = slcbeam._slcbeam
    told = {one.name: one for one in ast.parse((HERE / "_slcbeam.pyi").read_text()).body if hasattr(one, "name")}
    assert set(told) == {name for name in vars(own) if not name.startswith("_")}
    for name, one in told.items():
        methods = {of.name: of for of in one.body if isinstance(of, ast.FunctionDef)} if isinstance(one, ast.ClassDef) else {}
        if methods:
            assert set(methods) == {key for key in vars(getattr(own, name)) if not key.startswith("_")} | set(methods) & {"__init__"}
        functions = [(getattr(own, name), one)] if isinstance(one, ast.FunctionDef) else []
        functions += [(getattr(getattr(own, name), key), of) for key, of in methods.items() if key != "__init__"]
        for compiled, stub in functions:
            if callable(compiled):
                parameters = [key for key in inspect.signature(compiled).parameters if key != "self"]
                assert parameters == [of.arg for of in stub.args.args if of.arg != "self"], (name, stub.name)


def test_types_hold():
    """Those of the package, strictly; editors and type checkers see them where it is installed."""
    assert (HERE / "py.typed").is_file() and (HERE / "_slcbeam.pyi").is_file()
    settings = Path(__file__).parents[1] / "pyproject.toml"
    command = [sys.executable, "-m", "mypy", "--config-file", settings, "--no-incremental", "-p", "slcbeam"]
    told = subprocess.run(command, capture_output=True, text=True)
    assert told.returncode == 0, told.stdout


@pytest.mark.parametrize("library", ["libsundials_idas", "libsundials_nvecserial", "libklu"])
def test_a_library_that_is_not_there_is_named_with_what_brings_it(tmp_path, library):
    """The library's name is spoilt in a copy of the package, so that the loader does not find it."""
    shutil.copytree(HERE, tmp_path / "slcbeam", ignore=shutil.ignore_patterns("cases"))
    (own,) = (tmp_path / "slcbeam").glob("_slcbeam*.so")
    content = own.read_bytes()
    assert content.count(library.encode() + b".so") == 1
    own.write_bytes(content.replace(library.encode() + b".so", library.encode() + b".s-"))
    told = subprocess.run([sys.executable, "-c", "import slcbeam"], env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True)
    assert told.returncode == 1 and f"{library}.s-" in told.stderr
    assert "apt-get install libsundials-idas5 libsundials-kinsol6 libsundials-nvecserial6 libklu1" in told.stderr


def test_the_version_is_that_of_the_package():
    assert slcbeam.__version__ == metadata.version("slcbeam")
