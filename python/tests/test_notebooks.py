"""The notebooks of the tours: executed as `jupyter nbconvert --execute` does, and true to the tours on the command line."""

from pathlib import Path

import nbclient
import nbformat
import pytest

ROOT = Path(__file__).resolve().parents[2]

#: What a notebook prints and its tour on the command line says.
FIGURES = {
    "actuator": ["2.57 mm", "4.56 mm", "1.14 mm", "3.44 mm", "-0.64 mm", "5.5 s", "1.3 s", "1.05 N"],
    "harvester": ["15.8 %", "35.9 %", "35.1 to 35.6 %", "3.59 to 4.22 mW", "6.58 to 7.38 kPa", "stable"],
    "metamaterial": ["48.3 mm", "45.2 mm", "38.5 mm", "12.60 Hz", "3.7 %", "12.49 Hz", "5.6 %", "6.2 %", "17.7 mm", "34.7 mm", "52.8 mm", "32.5 mm", "22.9 mm"],
    "sensor": ["0.71", "0.69", "12.6 Hz"],
}


def test_every_tour_has_a_notebook():
    assert {path.stem for path in (ROOT / "python/notebooks").glob("*.ipynb")} == set(FIGURES)
    assert {path.stem for path in (ROOT / "docs").glob("tour-*.md")} == {f"tour-{name}" for name in FIGURES}


@pytest.mark.parametrize("name", FIGURES)
def test_a_notebook_runs_and_says_what_the_tour_says(name, tmp_path):
    book = nbformat.read(ROOT / f"python/notebooks/{name}.ipynb", as_version=4)
    nbformat.validate(book)
    codes = [cell for cell in book.cells if cell.cell_type == "code"]
    assert all(not cell.outputs and cell.execution_count is None for cell in codes), "outputs are not kept in the repository"
    nbclient.NotebookClient(book, timeout=120, kernel_name="python3", resources={"metadata": {"path": tmp_path}}).execute()
    outputs = [output for cell in codes for output in cell.outputs]
    printed = "".join(output.text for output in outputs if output.output_type == "stream")
    pictures = [output for output in outputs if "image/png" in output.get("data", {})]
    assert len(pictures) >= 2
    tour = (ROOT / f"docs/tour-{name}.md").read_text(encoding="utf-8")
    for figure in FIGURES[name]:
        assert figure in printed and figure in tour, figure
