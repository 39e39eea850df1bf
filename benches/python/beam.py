"""The semi-discrete equations of docs/model.md, section 7, for a beam clamped at the root and free at the tip, finite rotations, no
rotary inertia, in numba. Tags in brackets are those of the equations there.

Unknowns are scaled as in slcbeam, so that a tolerance has the same meaning in all programs.
"""

import math
from typing import NamedTuple

import numba
import numpy as np
import scipy.sparse
from scipy.optimize._numdiff import group_columns


class Numbers(NamedTuple):
    """A scene; SI units."""

    nodes: int  # free ones, 1 .. cells
    per_segment: int
    h: float
    mass: float
    axial: float
    bending: float
    gravity: float
    published: bool
    amplitude: float
    omega: float
    ramp: float  # duration of the smooth start
    wet: bool
    segments: int
    per_bladder: int
    ds: float
    inside: float  # conductance between cells of a bladder
    a_p: float
    am: float
    dm: float
    an: float
    dn: float
    width_m: float
    width_n: float
    stretch: float  # λ_p per pressure
    curvature: float  # α_p per pressure
    area: np.ndarray  # place of each cell's area among the unknowns; -1 where the bladder keeps its own, [E23]
    kept: np.ndarray
    links: np.ndarray  # from cell, to cell; -1: ambient pressure
    conductances: np.ndarray
    scales: np.ndarray
    rows: np.ndarray


def numbers(scene):
    """Builds the scene from the output of `peers export`."""
    case, section, mesh = scene["case"], scene["section"], scene["mesh"]
    beam, bladders = case["beam"], case.get("bladders")
    segments, k = mesh["segments"], mesh["cells_per_segment"]
    h = beam["length_m"] / (segments * k)
    drive = case["ends"]["root"]["clamped"] if isinstance(case["ends"]["root"], dict) else {}
    sine = drive.get("u3_m", {})
    sine = sine.get("sine", {}) if isinstance(sine, dict) else {}
    f = sine.get("frequency_hz", 1.0)
    gravity = sum(load["gravity"].get("x_m_s2", 0.0) for load in case.get("loads", []) if "gravity" in load)
    ea, ei = section["axial_stiffness"], section["bending_stiffness"]
    wet = bladders is not None
    given = dict(
        nodes=segments * k, per_segment=k, h=h, mass=section["mass_per_length"], axial=ea, bending=ei, gravity=gravity,
        published=case["formulation"] == "published", amplitude=sine.get("amplitude", 0.0), omega=2 * math.pi * f,
        ramp=sine.get("ramp_cycles", 0.0) / f, wet=wet, segments=segments, per_bladder=mesh["cells_per_bladder"],
        scales=np.array(scene["scales"]), rows=np.array(scene["row_scales"]),
    )
    nothing = dict.fromkeys(["ds", "inside", "a_p", "am", "dm", "an", "dn", "width_m", "width_n", "stretch", "curvature"], 0.0)
    if not wet:
        none = np.zeros(0, np.int64)
        return Numbers(**given, **nothing, area=none, kept=np.zeros(0), links=np.zeros((0, 2), np.int64), conductances=np.zeros(0))
    per_bladder, fluid, tubes, network = mesh["cells_per_bladder"], case["fluid"], case["tubes"], case["network"]
    m, n = bladders["area_per_moment_m2_per_n_m"], bladders["area_per_force_m2_per_n"]
    factor, mu = network["permeability_factor"], fluid["viscosity_pa_s"]
    ds = bladders["length_m"] / per_bladder
    inside = factor * bladders["permeability_m4"] / (mu * ds)
    half = 0.5 / inside
    tube = mu * tubes["length_m"] / (factor * tubes["permeability_m4"])
    per_row = bladders["per_row"]
    number = lambda b: b - 1 if b > 0 else per_row - b - 1
    first = lambda b: number(b) * per_bladder
    last = lambda b: first(b) + per_bladder - 1
    links, conductances = [], []
    for chain in network["chains"]:
        row = chain["bladders"]
        for a, b in zip(row, row[1:]):
            links.append((last(a), first(b)))
            conductances.append(1 / (2 * half + tube))
        for end, cell in zip(chain["ends"], (first(row[0]), last(row[-1]))):
            if isinstance(end, dict):  # [E6], at ambient pressure in these scenes
                assert end == {"pressure_pa": 0.0}, end
                links.append((cell, -1))
                conductances.append(1 / half)
    area, kept = np.full(2 * per_row * per_bladder, -1), np.zeros(2 * per_row * per_bladder)
    at = scene["layout"]["area"][0]
    for bladder in range(2 * per_row):
        own = slice(bladder * per_bladder, (bladder + 1) * per_bladder)
        if bladder in scene["layout"]["flowing"]:
            area[own] = np.arange(at, at + per_bladder)
            at += per_bladder
        else:
            kept[own] = scene["layout"]["kept_area"][own]
    coupling = bladders["coupling"]["published"]
    per_pressure = per_row / beam["length_m"] / beam["young_modulus_pa"]
    return Numbers(
        **given, ds=ds, inside=inside, a_p=bladders["area_per_pressure_m2_per_pa"],
        am=(m["closing"] + m["opening"]) / 2, dm=(m["closing"] - m["opening"]) / 2,
        an=(n["compression"] + n["tension"]) / 2, dn=(n["compression"] - n["tension"]) / 2,
        width_m=bladders["kink_width"] * ei / beam["length_m"], width_n=bladders["kink_width"] * ea,
        stretch=per_pressure * coupling["length_per_pressure_m"], curvature=per_pressure * coupling["slope_per_pressure_rad"],
        area=area, kept=kept, links=np.array(links, np.int64).reshape(-1, 2), conductances=np.array(conductances),
    )


@numba.njit(cache=True)
def drive(t, p):
    """Axial motion of the root: value, rate, acceleration."""
    s, c = math.sin(p.omega * t), math.cos(p.omega * t)
    r = r1 = r2 = 0.0
    x = t / p.ramp if p.ramp > 0.0 else 1.0
    if x < 1.0:
        r = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
        r1 = 30.0 * x * x * (1.0 - x) ** 2 / p.ramp
        r2 = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / (p.ramp * p.ramp)
    else:
        r = 1.0
    a, w = p.amplitude, p.omega
    return a * r * s, a * (r1 * s + r * w * c), a * (r2 * s + 2.0 * r1 * w * c - r * w * w * s)


@numba.njit(cache=True)
def kink(x, d):
    return math.sqrt(x * x + d * d) - d


@numba.njit(cache=True)
def shape(u1, u3, p, w):
    """[E11] Strain, stretch, tangents and curvatures into the rows of w."""
    n, h = p.nodes, p.h
    for c in range(n):
        ex = (u1[c + 1] - u1[c]) / h
        ez = (u3[c + 1] - u3[c]) / h
        lam = math.sqrt(ex * ex + (1.0 + ez) ** 2)
        w[0, c], w[1, c] = (ex * ex + ez * (ez + 2.0)) / (lam + 1.0), lam
        w[2, c], w[3, c] = ex / lam, (1.0 + ez) / lam
    w[4, 0] = -math.atan2(w[2, 0], w[3, 0]) * 2.0 / h
    for i in range(1, n):
        cross = w[2, i] * w[3, i - 1] - w[3, i] * w[2, i - 1]
        dot = w[2, i] * w[2, i - 1] + w[3, i] * w[3, i - 1]
        w[4, i] = -math.atan2(cross, dot) / h
    for i in range(n):
        # α
        stretch = 1.0
        if p.published:
            stretch = w[1, 0] if i == 0 else 0.5 * (w[1, i - 1] + w[1, i])
        w[5, i] = w[4, i] * stretch


@numba.njit(cache=True)
def pressed(area, mm, nn, p, pressure, f):
    """[E8], [E3] Pressures of cells, and stretch and curvature of each segment by pressure, into the rows of f."""
    k = p.per_bladder
    for j in range(p.segments):
        common = p.an * nn[j] - p.dn * kink(nn[j], p.width_n) - p.dm * kink(mm[j], p.width_m)
        means = np.zeros(2)
        for row in range(2):
            sign = 1.0 - 2.0 * row
            first = (row * p.segments + j) * k
            for c in range(first, first + k):
                pressure[c] = (area[c] - common - sign * p.am * mm[j]) / p.a_p
                means[row] += pressure[c] / k
        f[0, j] = p.stretch * (means[0] + means[1])
        f[1, j] = p.curvature * (means[0] - means[1])


@numba.njit(cache=True)
def forces(p, w, f, fx, fz):
    """[E12], [E13], [E14], [E15] Normal forces, moments, shears into w; forces on nodes."""
    n, h, k = p.nodes, p.h, p.per_segment
    for c in range(n):
        w[6, c] = p.axial * (w[0, c] - f[0, c // k])
    for i in range(n):
        right = i // k
        left = (i - 1) // k if i > 0 else 0
        w[7, i] = p.bending * (w[5, i] - 0.5 * (f[1, left] + f[1, right]))
    w[7, n] = 0.0
    stretch = w[1, n - 1] if p.published else 1.0
    w[4, n] = f[1, p.segments - 1] / stretch
    for c in range(n):
        w[8, c] = (w[7, c] - w[7, c + 1]) / (h * w[1, c])
    for i in range(1, n + 1):
        a, b = i - 1, min(i, n - 1)
        own = h if i < n else 0.5 * h
        x = p.mass * p.gravity * own - (w[6, a] * w[2, a] - w[8, a] * w[3, a])
        z = -(w[6, a] * w[3, a] + w[8, a] * w[2, a])
        if i < n:
            x += w[6, i] * w[2, i] - w[8, i] * w[3, i]
            z += w[6, i] * w[3, i] + w[8, i] * w[2, i]
        if p.published:
            tx, tz = w[2, a] + w[2, b], w[3, a] + w[3, b]
            size = math.sqrt(tx * tx + tz * tz)
            tx, tz = tx / size, tz / size
            normal, shear = 0.5 * (w[6, a] + w[6, b]), 0.5 * (w[8, a] + w[8, b])
            excess = (w[4, i] - w[7, i] / p.bending) * own
            x += excess * (shear * tx + normal * tz)
            z += excess * (shear * tz - normal * tx)
        fx[i], fz[i] = x, z


@numba.njit(cache=True)
def mean_moment(w, j, p):
    k = p.per_segment
    mean = 0.0
    for i in range(k + 1):
        mean += w[7, j * k + i] * (0.5 if i == 0 or i == k else 1.0) / k
    return mean


@numba.njit(cache=True)
def inflow(pressure, p, q):
    """[E9] Net inflow of cells."""
    q[:] = 0.0
    for b in range(2 * p.segments):
        for c in range(b * p.per_bladder, (b + 1) * p.per_bladder - 1):
            flow = p.inside * (pressure[c] - pressure[c + 1])
            q[c] -= flow
            q[c + 1] += flow
    for l in range(p.links.shape[0]):
        a, b = p.links[l, 0], p.links[l, 1]
        flow = p.conductances[l] * (pressure[a] - (pressure[b] if b >= 0 else 0.0))
        q[a] -= flow
        if b >= 0:
            q[b] += flow


@numba.njit(cache=True)
def evaluate(t, y, p, mm, nn, work):
    """All quantities up to forces and flows; y is scaled, means are in SI units."""
    n, s = p.nodes, p.scales
    u, w, fn, cells = work
    f, q, pressure = fn, cells[0], cells[1]
    root = drive(t, p)[0]
    u[0, 0], u[1, 0] = 0.0, root
    for i in range(1, n + 1):
        u[0, i] = y[i - 1] * s[i - 1]
        u[1, i] = root + y[n + i - 1] * s[n + i - 1]
    shape(u[0], u[1], p, w)
    if p.wet:
        for c in range(cells.shape[1]):
            k = p.area[c]
            cells[2, c] = y[k] * s[k] if k >= 0 else p.kept[c]
        pressed(cells[2], mm, nn, p, pressure, f)
        inflow(pressure, p, q)
    forces(p, w, f, u[2], u[3])


def room(p):
    """Workspace of `evaluate`."""
    n = p.nodes
    cells = 2 * p.segments * p.per_bladder if p.wet else 0
    return np.zeros((4, n + 1)), np.zeros((9, n + 1)), np.zeros((2, p.segments)), np.zeros((3, cells))


@numba.njit(cache=True)
def residual(t, y, yp, out, p, work):
    """F(t, y, y') = 0, all scaled."""
    n, s, rows, g = p.nodes, p.scales, p.rows, p.segments
    mm, nn = np.zeros(g), np.zeros(g)
    if p.wet:
        for j in range(g):
            mm[j] = y[4 * n + j] * s[4 * n + j]
            nn[j] = y[4 * n + g + j] * s[4 * n + g + j]
    evaluate(t, y, p, mm, nn, work)
    u, w, _, cells = work
    acceleration = drive(t, p)[2]
    for i in range(1, n + 1):
        for axis in range(2):
            k = axis * n + i - 1
            v = 2 * n + k
            out[k] = (yp[k] * s[k] - y[v] * s[v]) / rows[k]
            own = p.mass * (p.h if i < n else 0.5 * p.h)
            out[v] = (own * (yp[v] * s[v] + axis * acceleration) - u[2 + axis, i]) / rows[v]
    if p.wet:
        k = p.per_segment
        for j in range(g):
            force = 0.0
            for c in range(j * k, (j + 1) * k):
                force += w[6, c] / k
            out[4 * n + j] = (mm[j] - mean_moment(w, j, p)) / rows[4 * n + j]
            out[4 * n + g + j] = (nn[j] - force) / rows[4 * n + g + j]
        for c in range(cells.shape[1]):
            k = p.area[c]
            if k >= 0:
                out[k] = (yp[k] * s[k] * p.ds - cells[0, c]) / rows[k]


@numba.njit(cache=True)
def means(t, y, p, mm, nn, work):
    """Mbar and Nbar as functions of the other unknowns, [E16]: Mbar from a tridiagonal system, Nbar by Newton's iteration. Only for the
    published coupling, where α_p is linear in Mbar, and λ_p in pressures."""
    g, k = p.segments, p.per_segment
    zero = np.zeros(g)
    evaluate(t, y, p, zero, zero, work)
    u, w, f, cells = work
    # with Mbar = Nbar = 0: moments, pressures. Then α_p = f - x Mbar, x = curvature 2 am/a_p
    x = p.bending * p.curvature * 2.0 * p.am / p.a_p
    lower, diagonal, upper = np.zeros(g), np.zeros(g), np.zeros(g)
    for j in range(g):
        mm[j] = mean_moment(w, j, p)
        edge = 0.5 / k
        inner = (k - 1.0) / k
        own = inner + edge * (1.0 if j == 0 else 0.5) + (0.5 * edge if j + 1 < g else 0.0)
        diagonal[j] = 1.0 - x * own
        if j > 0:
            lower[j] = -x * 0.5 * edge
        if j + 1 < g:
            upper[j] = -x * 0.5 * edge
    for j in range(1, g):
        factor = lower[j] / diagonal[j - 1]
        diagonal[j] -= factor * upper[j - 1]
        mm[j] -= factor * mm[j - 1]
    mm[g - 1] /= diagonal[g - 1]
    for j in range(g - 2, -1, -1):
        mm[j] = (mm[j] - upper[j] * mm[j + 1]) / diagonal[j]
    for j in range(g):
        force = 0.0
        for c in range(j * k, (j + 1) * k):
            force += w[6, c] / k
        c = 2.0 * p.axial * p.stretch / p.a_p
        given = force - c * p.dm * kink(mm[j], p.width_m)
        v = nn[j]
        for _ in range(20):
            wide = math.sqrt(v * v + p.width_n * p.width_n)
            change = (v - c * (p.an * v - p.dn * (wide - p.width_n)) - given) / (1.0 - c * (p.an - p.dn * v / wide))
            v -= change
            if abs(change) < 1e-13 * (abs(v) + p.width_n):
                break
        nn[j] = v


@numba.njit(cache=True)
def rates(t, z, out, p, work, y, mm, nn):
    """z' of the differential unknowns z; y is workspace for all unknowns, mm and nn are the last means."""
    n, s, g = p.nodes, p.scales, p.segments
    y[: 4 * n] = z[: 4 * n]
    if p.wet:
        y[4 * n + 2 * g :] = z[4 * n :]
        means(t, y, p, mm, nn, work)
    evaluate(t, y, p, mm, nn, work)
    u, cells = work[0], work[3]
    acceleration = drive(t, p)[2]
    for i in range(1, n + 1):
        for axis in range(2):
            k = axis * n + i - 1
            v = 2 * n + k
            own = p.mass * (p.h if i < n else 0.5 * p.h)
            out[k] = z[v] * s[v] / s[k]
            out[v] = (u[2 + axis, i] / own - axis * acceleration) / s[v]
    for c in range(cells.shape[1]):
        k = p.area[c]
        if k >= 0:
            out[k - 2 * g] = cells[0, c] / (p.ds * s[k])


@numba.njit(cache=True)
def differences(t, y, yp, cj, p, work, groups, count, starts, rows, values):
    """Entries of ∂F/∂y + cj ∂F/∂y'; structurally orthogonal columns are evaluated together."""
    n = y.shape[0]
    at, moved, y2, yp2 = np.zeros(n), np.zeros(n), y.copy(), yp.copy()
    residual(t, y, yp, at, p, work)
    eps = 1e-7
    for g in range(count):
        for j in range(n):
            if groups[j] == g:
                y2[j] = y[j] + eps
                yp2[j] = yp[j] + cj * eps
        residual(t, y2, yp2, moved, p, work)
        for j in range(n):
            if groups[j] == g:
                y2[j], yp2[j] = y[j], yp[j]
                for k in range(starts[j], starts[j + 1]):
                    values[k] = (moved[rows[k]] - at[rows[k]]) / eps


@numba.njit(cache=True)
def rate_differences(t, z, p, work, y, mm, nn, groups, count, starts, rows, values):
    """Entries of ∂z'/∂z."""
    n = z.shape[0]
    at, moved, z2 = np.zeros(n), np.zeros(n), z.copy()
    rates(t, z, at, p, work, y, mm, nn)
    eps = 1e-7
    for g in range(count):
        for j in range(n):
            if groups[j] == g:
                z2[j] = z[j] + eps
        rates(t, z2, moved, p, work, y, mm, nn)
        for j in range(n):
            if groups[j] == g:
                z2[j] = z[j]
                for k in range(starts[j], starts[j + 1]):
                    values[k] = (moved[rows[k]] - at[rows[k]]) / eps


class Beam:
    """A scene: equations, pattern, groups of columns, start."""

    def __init__(self, scene):
        self.p = numbers(scene)
        self.work = room(self.p)
        self.y0, self.yp0 = np.array(scene["start"]["y"]), np.array(scene["start"]["yp"])
        self.n = len(self.y0)
        self.times = np.array(scene["times"])
        self.algebraic = [k for k, d in enumerate(scene["differential"]) if not d]
        self.differential = np.array([k for k, d in enumerate(scene["differential"]) if d])
        starts, rows = np.array(scene["pattern"]["starts"]), np.array(scene["pattern"]["rows"])
        ones = np.ones(len(rows))
        self.pattern = scipy.sparse.csc_matrix((ones, rows, starts), shape=(self.n, self.n))
        self.pattern.sort_indices()
        self.groups, self.count = self.grouped(self.pattern)
        g = self.p.segments
        self.y, self.mm, self.nn = self.y0.copy(), np.zeros(g), np.zeros(g)
        self.reduced = self.reduced_pattern()
        self.reduced_groups, self.reduced_count = self.grouped(self.reduced)

    @staticmethod
    def grouped(pattern):
        groups = group_columns(pattern).astype(np.int64)
        return groups, int(groups.max()) + 1

    def reduced_pattern(self):
        """Sparsity pattern of z'. Mbar couples two segments on each side; beyond them its influence is below a hundredth."""
        d, a = self.differential, np.array(self.algebraic, dtype=int)
        full = self.pattern.tocsr()
        own = full[d][:, d]
        if len(a):
            g = self.p.segments
            band = scipy.sparse.diags([1.0] * 5, [-2, -1, 0, 1, 2], shape=(g, g))
            means = scipy.sparse.bmat([[band, None], [band, band]]).tocsr()
            own = own + full[d][:, a] @ means @ full[a][:, d]
        own = (own + scipy.sparse.identity(len(d))).tocsc()
        own.data[:] = 1.0
        own.sort_indices()
        return own

    def readings(self, y):
        """Tip deflection [m] and pressure at the tip end of the upper row [Pa], from all unknowns."""
        p, n, g = self.p, self.p.nodes, self.p.segments
        si = y * p.scales
        if not p.wet:
            return si[n - 1], 0.0
        area, mm, nn = si[p.area[g * p.per_bladder - 1]], si[4 * n + g - 1], si[4 * n + 2 * g - 1]
        imposed = p.an * nn - p.dn * kink(nn, p.width_n) + p.am * mm - p.dm * kink(mm, p.width_m)
        return si[n - 1], (area - imposed) / p.a_p

    def complete(self, t, z):
        """All unknowns, from the differential ones."""
        y = self.y0.copy()
        y[self.differential] = z
        if self.p.wet:
            n, g = self.p.nodes, self.p.segments
            means(t, y, self.p, self.mm, self.nn, self.work)
            y[4 * n : 4 * n + g] = self.mm / self.p.scales[4 * n : 4 * n + g]
            y[4 * n + g : 4 * n + 2 * g] = self.nn / self.p.scales[4 * n + g : 4 * n + 2 * g]
        return y

    def residual(self, t, y, yp, out):
        residual(t, y, yp, out, self.p, self.work)

    def rates(self, t, z):
        out = np.empty(len(z))
        rates(t, z, out, self.p, self.work, self.y, self.mm, self.nn)
        return out

    def jacobian(self, t, y, yp, res, cj, values):
        differences(
            t, y, yp, cj, self.p, self.work, self.groups, self.count, self.pattern.indptr, self.pattern.indices, values
        )

    def rate_jacobian(self, t, z):
        values = np.empty(self.reduced.nnz)
        rate_differences(
            t, z, self.p, self.work, self.y, self.mm, self.nn, self.reduced_groups, self.reduced_count,
            self.reduced.indptr, self.reduced.indices, values,
        )
        return scipy.sparse.csc_matrix((values, self.reduced.indices, self.reduced.indptr), shape=self.reduced.shape)

    def warm_up(self):
        """Compiles all functions by calling them."""
        out, values = np.zeros(self.n), np.zeros(self.pattern.nnz)
        self.residual(0.0, self.y0, self.yp0, out)
        self.jacobian(0.0, self.y0, self.yp0, out, 1.0, values)
        z = self.y0[self.differential]
        self.rates(0.0, z)
        self.rate_jacobian(0.0, z)
