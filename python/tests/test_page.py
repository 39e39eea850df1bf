"""What the pages on Python and the help of every name show runs."""

import doctest
import importlib
import pkgutil
import re
from pathlib import Path

import pytest

import slcbeam

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.mark.parametrize("page, least", [("python.md", 8), ("python-clusters.md", 6), ("measured-data.md", 1), ("roles.md", 1)])
def test_the_page_runs(page, least, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (DOCS / page).read_text(encoding="utf-8"), re.S)
    assert len(blocks) >= least
    names = {"__name__": "page"}
    for block in blocks:
        exec(compile(block, page, "exec"), names)


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
