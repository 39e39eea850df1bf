"""The description of the program: set from the documents on four pages."""

import subprocess
from pathlib import Path

import typst

ROOT = Path(__file__).resolve().parents[2]


def test_the_description_has_four_pages(tmp_path):
    pages = typst.compile(ROOT / "docs/description/description.typ", root=ROOT, format="png", ppi=30)
    assert len(pages) == 4


def test_a_script_writes_the_description(tmp_path):
    file = tmp_path / "description.pdf"
    subprocess.run([ROOT / "scripts/description", file], check=True, capture_output=True)
    assert file.read_bytes().startswith(b"%PDF-")
