"""What the tests of the package share."""

import os
import shutil
import signal
import subprocess
from pathlib import Path

import pytest

import slcbeam

# what runs behind a shell is started with Ctrl-C ignored
signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def program():
    """The command line: that of ``SLCBEAM``, or what the sources were built to."""
    built = os.environ.get("SLCBEAM") or ROOT / "target/release/slcbeam"
    found = shutil.which(built)
    assert found, f"no program at {built}; scripts/test-python builds it"

    def run(*arguments):
        told = subprocess.run([found, *map(str, arguments)], capture_output=True, text=True)
        assert told.returncode == 0, told.stderr
        return told.stdout

    return run


@pytest.fixture
def quick():
    """A run of some 20 ms."""
    return slcbeam.load("bend-wet", set={"/time/end_s": 0.1, "/time/output_interval_s": 0.001})


@pytest.fixture
def endless():
    """A run that takes minutes."""
    return slcbeam.load("wiring-2", set={"/time/end_s": 1e4, "/time/output_interval_s": 100, "/time/fields_interval_s": 100})
