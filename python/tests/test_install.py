"""The packages of scripts/package: what is in them, and that the tarball needs nothing of SUNDIALS and SuiteSparse on the machine.

`scripts/test-packages` installs and tries them on a fresh Debian, which takes minutes.
"""

import os
import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FMU = ["export", "cases/tour-actuator.json", "--input", "/network/chains/0/ends/0/pressure_pa", "--fmu"]
CASE = ["run", "cases/bend-wet.json", "--quiet", "--lean", "--out"]


def output_of(*command, **how):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **how)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("packages")
    program = os.environ.get("SLCBEAM") or ROOT / "target/release/slcbeam"
    output_of(ROOT / "scripts/package", folder, "deb", "tarball", env=os.environ | {"SLCBEAM": str(program)})
    return folder


def test_the_deb_holds_the_program_and_names_its_libraries(packages, tmp_path):
    (deb,) = packages.glob("slcbeam_*.deb")
    depends = output_of("dpkg-deb", "--field", deb, "Depends")
    for library in ("libc6", "libgcc-s1", "libklu1", "libsundials-idas5", "libsundials-kinsol6", "libsundials-nvecserial6"):
        assert re.search(rf"{library} \(>=", depends), depends
    output_of("dpkg-deb", "--extract", deb, tmp_path)
    assert re.search(r"Version: \d", output_of("dpkg-deb", "--info", deb)) and (tmp_path / "usr/share/bash-completion/completions/slcbeam").stat().st_size > 1000
    documents = tmp_path / "usr/share/doc/slcbeam"
    output_of(tmp_path / "usr/bin/slcbeam", *CASE, tmp_path / "result", cwd=documents)
    output_of(tmp_path / "usr/bin/slcbeam", *FMU, tmp_path / "a.fmu", cwd=documents)
    assert (tmp_path / "result/summary.json").is_file() and "MIT" in (documents / "copyright").read_text()


def test_the_tarball_runs_where_no_library_is(packages, tmp_path):
    """In a root folder of its own, which has the C library, the program and nothing else."""
    (tarball,) = packages.glob("slcbeam-*.tar.gz")
    root = tmp_path / "root"
    (root / "slcbeam").mkdir(parents=True)
    output_of("tar", "--extract", "--file", tarball, "--directory", root / "slcbeam", "--strip-components", "1")
    program = root / "slcbeam/slcbeam"
    own = {path.name for path in (root / "slcbeam/lib").iterdir()}
    assert {"libklu.so.1", "libsundials_idas.so.5"} <= own
    assert {path.name for path in (root / "slcbeam/licences").iterdir()} >= {"libklu1", "libsundials-idas5"}
    for library in re.findall(r"(?:=> )?(/\S+) \(0x", output_of("ldd", program)):
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
        output_of(*inside, *CASE, "/tmp/result")
        output_of(*inside, *FMU, "/tmp/a.fmu")
    else:  # a machine that gives no process a root folder of its own: at least none but its own libraries are taken
        taken = dict(re.findall(r"(\S+) => (/\S+) \(0x", output_of("ldd", program)))
        assert all(Path(taken[name]).is_relative_to(root / "slcbeam/lib") for name in own & taken.keys()) and own & taken.keys()
        output_of(program, *CASE, root / "tmp/result", cwd=root / "slcbeam", env={})
        output_of(program, *FMU, root / "tmp/a.fmu", cwd=root / "slcbeam", env={})
    assert (root / "tmp/result/summary.json").is_file()
    with zipfile.ZipFile(root / "tmp/a.fmu") as archive:
        archived = {Path(name).name for name in archive.namelist()}
    assert {"libklu.so.1", "libamd.so.2", "tour_actuator.so"} <= archived, archived


def test_versions_agree():
    version = re.search(r'^version = "(.*)"', (ROOT / "Cargo.toml").read_text(), re.M)[1]
    manifests = [ROOT / "python/Cargo.toml", *(ROOT / "crates").glob("*/Cargo.toml")]
    assert {re.search(r'^version = "(.*)"', path.read_text(), re.M)[1] for path in manifests} == {version}
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    heading = re.search(rf"^## \[{re.escape(version)}\] - (20\d\d-\d\d-\d\d|Unreleased)$", (ROOT / "CHANGELOG.md").read_text(), re.M)
    assert heading and (heading[1] == "Unreleased" or f"\ndate-released: {heading[1]}\n" in (ROOT / "CITATION.cff").read_text())
    named = set(re.findall(r"slcbeam[-_](\d+\.\d+\.\d+)", (ROOT / "docs/install.md").read_text()))
    assert named == {version}


def test_sources_are_packaged_with_all_that_a_build_reads(tmp_path):
    """The crates as for crates.io, and the source package of Python."""
    output_of("cargo", "package", "--workspace", "--no-verify", "--allow-dirty", "--target-dir", tmp_path, cwd=ROOT)
    crates = {path.name.rsplit("-", 1)[0]: path for path in (tmp_path / "package").glob("*.crate")}
    assert {"slcbeam", "slcbeam-dense", "slcbeam-section"} <= set(crates)
    assert crates["slcbeam"].stat().st_size < 10e6, "crates.io accepts 10 MB"
    output_of(ROOT / "scripts/package", tmp_path, "sdist")
    (sdist,) = tmp_path.glob("slcbeam-*.tar.gz")
    for package in (sdist, crates["slcbeam"]):
        held = {name.split("/", 1)[1] for name in output_of("tar", "--list", "--file", package).split()}
        # files that the sources include, and that the build copies
        assert {"build.rs", "cases/schema.json", "cases/wiring-2.json", "Cargo.lock"} <= held, package
