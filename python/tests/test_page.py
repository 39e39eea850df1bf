"""What docs/python.md and the help of every name show runs."""

import doctest
import importlib
import pkgutil
import re
from pathlib import Path

import pytest

import slcbeam

PAGE = Path(__file__).resolve().parents[2] / "docs/python.md"


def test_the_page_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
    assert len(blocks) > 3
    names = {"__name__": "page"}
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), names)


def test_examples_in_the_help_hold():
    modules = [f"slcbeam.{one.name}" for one in pkgutil.iter_modules(slcbeam.__path__) if one.name != "_slcbeam"]
    told = [doctest.testmod(importlib.import_module(module), optionflags=doctest.ELLIPSIS) for module in ["slcbeam", *modules]]
    assert sum(one.failed for one in told) == 0 and sum(one.attempted for one in told) > 20


def test_everything_public_has_help():
    for name in slcbeam.__all__:
        one = getattr(slcbeam, name)
        assert one.__doc__, name
        if isinstance(one, type):
            for key, value in vars(one).items():
                if not key.startswith("_") and (callable(value) or isinstance(value, property)):
                    assert value.__doc__, f"{name}.{key}"
