"""What docs/python.md and the help of every name show runs."""

import doctest
import importlib
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


@pytest.mark.parametrize("module", ["slcbeam", "slcbeam._case", "slcbeam._run", "slcbeam._result", "slcbeam._errors"])
def test_examples_in_the_help_hold(module):
    told = doctest.testmod(importlib.import_module(module), optionflags=doctest.ELLIPSIS)
    assert told.failed == 0


def test_everything_public_has_help():
    for name in slcbeam.__all__:
        one = getattr(slcbeam, name)
        assert one.__doc__, name
        if isinstance(one, type):
            for key, value in vars(one).items():
                if not key.startswith("_") and (callable(value) or isinstance(value, property)):
                    assert value.__doc__, f"{name}.{key}"
