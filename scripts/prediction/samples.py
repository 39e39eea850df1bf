"""Uncertain inputs: their table, a Halton sequence, and intervals."""
import csv
import math
import pathlib
from collections import namedtuple
from statistics import NormalDist

ROOT = pathlib.Path(__file__).resolve().parents[2]
# 95 % quantile of a normal distribution: a lognormal "factor" is that of the 90 % interval
NINETY = NormalDist().inv_cdf(0.95)
PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43)

Row = namedtuple("Row", "experiment specimen quantity unit pressure_kpa low median high")


def table():
    """Distributions by (specimen, quantity)."""
    with open(ROOT / "cases/blind/inputs.csv") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {(row["specimen"], row["quantity"]): row["distribution"] for row in rows}


INPUTS = table()


def draw(specimen, quantity, share=0.5):
    """Quantile of an input: that of a share from 0 to 1."""
    kind, *numbers = INPUTS[specimen, quantity].split(":")
    numbers = [float(number) for number in numbers]
    if kind == "value":
        return numbers[0]
    low, high = numbers
    if kind == "uniform":
        return low + share * (high - low)
    if kind == "log":
        return low * (high / low) ** share
    return low * high ** (NormalDist().inv_cdf(share) / NINETY)


def halton(count, size, skip=20):
    """Points of a Halton sequence in the unit cube."""
    def radical(index, base):
        value, step = 0.0, 1.0
        while index:
            step /= base
            value += step * (index % base)
            index //= base
        return value
    return [[radical(skip + k, base) for base in PRIMES[:size]] for k in range(count)]


def interval(values):
    """Quantiles of 5, 50 and 95 %."""
    ordered = sorted(values)
    def quantile(share):
        place = share * (len(ordered) - 1)
        below = int(place)
        above = min(below + 1, len(ordered) - 1)
        return ordered[below] + (place - below) * (ordered[above] - ordered[below])
    return [quantile(share) for share in (0.05, 0.5, 0.95)]


def between(points, x):
    """Linear interpolation in (x, y) points of rising x; None beyond the last."""
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x <= x1:
            return y0 + (x - x0) / (x1 - x0) * (y1 - y0)
    return None


def significant(value, digits=3):
    """A number with so many significant digits, without an exponent."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{decimals}f}"
