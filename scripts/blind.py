"""Blind predictions of published experiments: scripts/blind [NAME..., --write]. Without --write the table is compared with the committed one."""
import argparse
import csv
import functools
import io
import sys
from concurrent.futures import ThreadPoolExecutor

from prediction import epfl, lines, marchese
from prediction.samples import ROOT, Row, significant

TABLE = ROOT / "cases/blind/predictions.csv"
DATE = "2026-11-30"
TASKS = {
    "ribbed": functools.partial(marchese.rows, "ribbed"),
    "epfl": epfl.rows,
    "pleated": functools.partial(marchese.rows, "pleated"),
    "cylindrical": functools.partial(marchese.rows, "cylindrical"),
    "lines": lines.rows,
}
# largest difference of a quantile from the committed one, over its interval: solvers and machines round differently
TOLERANCE = 0.02
NUMBERS = ("low", "median", "high")


def text(rows):
    """The table as CSV."""
    file = io.StringIO()
    file.write(f"# Predictions of {DATE}, before any comparison: 90 % intervals for uncertain material, geometry and model (docs/blind.md).\n")
    file.write("# Recomputed by scripts/blind; inputs with sources: inputs.csv.\n")
    out = csv.writer(file, lineterminator="\n")
    out.writerow(Row._fields)
    for row in rows:
        out.writerow([*row[:5], *(significant(value, 4) for value in row[5:])])
    return file.getvalue()


def committed():
    """Rows of the committed table by their first five fields."""
    with open(TABLE) as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {tuple(row[name] for name in Row._fields[:5]): [float(row[name]) for name in NUMBERS] for row in rows}


def differences(rows):
    """Rows that differ from the committed ones."""
    known, found = committed(), []
    for row in rows:
        key = tuple(map(str, row[:5]))
        if key not in known:
            found.append(f"{', '.join(key)}: not in the committed table")
            continue
        allowed = TOLERANCE * (known[key][2] - known[key][0]) + 5e-4 * abs(known[key][1])
        for name, old, new in zip(NUMBERS, known[key], row[5:]):
            if abs(new - old) > allowed:
                found.append(f"{', '.join(key)}: {name} {new:.4g}, committed {old:.4g}")
    return found


def main():
    asked = argparse.ArgumentParser(prog="scripts/blind", description=__doc__)
    asked.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(TASKS)}; all without")
    asked.add_argument("--write", action="store_true", help="write cases/blind/predictions.csv; needs all")
    asked = asked.parse_args()
    unknown = [name for name in asked.names if name not in TASKS]
    if unknown:
        sys.exit(f"no prediction {', '.join(unknown)}; there are {', '.join(TASKS)}")
    if asked.write and asked.names:
        sys.exit("--write needs all predictions: give no names")
    names = asked.names or list(TASKS)
    with ThreadPoolExecutor(2) as pool:
        running = {name: pool.submit(TASKS[name]) for name in names}
        answers = {name: job.result() for name, job in running.items()}
    rows = [row for name in TASKS if name in answers for row in answers[name][0]]
    print(text(rows), end="")
    for _, left_out in answers.values():
        for (specimen, how), share in left_out.items():
            print(f"# {specimen}, {how}: {100 * share:.0f} % of the samples have no state at the largest published pressure and are left out")
    if asked.write:
        TABLE.write_text(text(rows))
        return
    changed = differences(rows)
    if changed:
        sys.exit("\n".join(changed))
    print(f"# {len(rows)} rows agree with cases/blind/predictions.csv within {100 * TOLERANCE:.0f} % of their intervals")


main()
