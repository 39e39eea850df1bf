"""The packages of scripts/package: what is in them, and that the tarball needs nothing of SUNDIALS and SuiteSparse on the machine.

`scripts/test-packages` installs and tries them on a fresh Debian, which takes minutes.
"""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CASE = ["run", "cases/bend-wet.json", "--quiet", "--lean", "--out"]


def told(*command, **how):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **how)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("packages")
    program = os.environ.get("SLCBEAM") or ROOT / "target/release/slcbeam"
    told(ROOT / "scripts/package", folder, "deb", "tarball", env=os.environ | {"SLCBEAM": str(program)})
    return folder


def test_the_deb_holds_the_program_and_names_its_libraries(packages, tmp_path):
    (deb,) = packages.glob("slcbeam_*.deb")
    depends = told("dpkg-deb", "--field", deb, "Depends")
    for library in ("libc6", "libgcc-s1", "libklu1", "libsundials-idas5", "libsundials-kinsol6", "libsundials-nvecserial6"):
        assert re.search(rf"{library} \(>=", depends), depends
    told("dpkg-deb", "--extract", deb, tmp_path)
    assert re.search(r"Version: \d", told("dpkg-deb", "--info", deb)) and (tmp_path / "usr/share/bash-completion/completions/slcbeam").stat().st_size > 1000
    documents = tmp_path / "usr/share/doc/slcbeam"
    told(tmp_path / "usr/bin/slcbeam", *CASE, tmp_path / "result", cwd=documents)
    assert (tmp_path / "result/summary.json").is_file() and "MIT" in (documents / "copyright").read_text()


def test_the_tarball_runs_where_no_library_is(packages, tmp_path):
    """In a root folder of its own, which has the C library, the program and nothing else."""
    (tarball,) = packages.glob("slcbeam-*.tar.gz")
    root = tmp_path / "root"
    (root / "slcbeam").mkdir(parents=True)
    told("tar", "--extract", "--file", tarball, "--directory", root / "slcbeam", "--strip-components", "1")
    program = root / "slcbeam/slcbeam"
    own = {path.name for path in (root / "slcbeam/lib").iterdir()}
    assert {"libklu.so.1", "libsundials_idas.so.5"} <= own
    assert {path.name for path in (root / "slcbeam/licences").iterdir()} >= {"libklu1", "libsundials-idas5"}
    for library in re.findall(r"(?:=> )?(/\S+) \(0x", told("ldd", program)):
        if Path(library).name not in own:
            place = root / library.lstrip("/")
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(library, place)
    placed = {path.name for path in root.rglob("*.so*") if root / "slcbeam" not in path.parents}
    assert {name for name in placed if not name.startswith("ld-linux")} == {"libc.so.6", "libm.so.6", "libgcc_s.so.1"}, placed
    (root / "proc").mkdir()
    (root / "tmp").mkdir()
    alone = ["unshare", "--mount", "--pid", "--fork", "--mount-proc=/proc"] + ([] if os.getuid() == 0 else ["--map-root-user"])
    if subprocess.run([*alone, "true"], capture_output=True).returncode == 0:
        inside = [*alone, f"--root={root}", "--wd=/slcbeam", "/slcbeam/slcbeam"]
        told(*inside, *CASE, "/tmp/result")
    else:  # a machine that gives no process a root folder of its own: at least none but its own libraries are taken
        taken = dict(re.findall(r"(\S+) => (/\S+) \(0x", told("ldd", program)))
        assert all(Path(taken[name]).is_relative_to(root / "slcbeam/lib") for name in own & taken.keys()) and own & taken.keys()
        told(program, *CASE, root / "tmp/result", cwd=root / "slcbeam", env={})
    assert (root / "tmp/result/summary.json").is_file()
