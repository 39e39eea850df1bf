"""The MATLAB code of docs/matlab-julia.md, executed by Octave."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/matlab-julia.md"
OCTAVE = ["octave-cli", "--norc", "--no-history", "--eval"]


def octave(folder, text):
    assert shutil.which("octave-cli"), "no octave-cli; scripts/test-python installs it"
    program = Path(os.environ.get("SLCBEAM") or ROOT / "target/release/slcbeam").resolve()
    assert program.name == "slcbeam" and program.is_file(), f"no program at {program}; scripts/test-python builds it"
    environment = os.environ | {"PATH": f"{program.parent}:{os.environ['PATH']}"}
    told = subprocess.run([*OCTAVE, text], cwd=folder, env=environment, capture_output=True, text=True)
    assert told.returncode == 0, told.stdout + told.stderr
    return told.stdout


def blocks(kind):
    return re.findall(rf"```{kind}\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)


def functions(folder):
    """Saves the blocks that are functions, as the page says; returns the others."""
    others = []
    for block in blocks("matlab"):
        name = re.match(r"function \w+ = (\w+)\(", block)
        if name:
            (folder / f"{name[1]}.m").write_text(block)
        else:
            others.append(block)
    return others


def test_the_page_says_what_octave_prints(tmp_path):
    (tmp_path / "cases").symlink_to(ROOT / "cases")
    scripts = functions(tmp_path)
    assert len(list(tmp_path.glob("*.m"))) == 4 and len(scripts) == 3
    # without a screen Octave draws nothing; what would be drawn is looked at
    (tmp_path / "plot.m").write_text("function plot(x, y)\n assert(size(x), size(y)); assert(all(isfinite([x; y])));\nend\n")
    for label in ("xlabel", "ylabel"):
        (tmp_path / f"{label}.m").write_text(f"function {label}(text)\n assert(ischar(text));\nend\n")
    printed = octave(tmp_path, "\n".join(scripts))
    for block in blocks("text"):
        for line in block.splitlines():
            assert line in printed, f"{line}\n---\n{printed}"
    assert "length_m" in printed and "E004" in printed


def test_arrays_of_every_kind_are_read_as_numpy_reads_them(tmp_path):
    functions(tmp_path)
    random = np.random.default_rng(1)
    kinds = {"f8": (3, 4), "f4": (5,), "i8": (2, 3, 4), "i4": (1, 3), "u1": (4, 1), "u8": (2,), "b1": (3,)}
    arrays = {f"x_{kind}": (10 * random.standard_normal(shape)).astype("u1").astype(kind) for kind, shape in kinds.items()}
    arrays["fortran"] = np.asfortranarray(random.standard_normal((3, 5)))
    np.savez(tmp_path / "all.npz", **arrays)
    text = "a = slcbeam_npz('all.npz'); for [x, name] = a\n printf('%s:', name); printf(' %.17g', x, size(x)); printf('\\n'); end"
    told = dict(line.split(":") for line in octave(tmp_path, text).splitlines())
    assert set(told) == set(arrays)
    for name, array in arrays.items():
        # columns first, as MATLAB stores them
        shape = array.shape if array.ndim > 1 else (*array.shape, 1)
        np.testing.assert_array_equal(np.array(told[name].split(), float), [*array.ravel("F"), *shape], err_msg=name)
