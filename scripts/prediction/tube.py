"""A channel along a soft beam as an inflated tube: closed forms of rubber elasticity, for channels that no periodic cell has.

The tube (inner radius A, outer B, at the height c) is incompressible: r^2 = a^2 + (R^2 - A^2)/l, with l = 1 + e + kappa c (Rivlin 1949).
The rest of the section is bars of stretch 1 + e + kappa x. Per length and over the shear modulus, the energy is

    Omega = integral of w(1 + e + kappa x) over the section + W_tube(a, l) - pi B^2 w(l) - p pi (a^2 l - A^2)

and stationary by a, e and kappa (free) or by a and e (kappa = 0, blocked).
"""
import math

# Gauss-Legendre points and weights of five points on [-1, 1]
GAUSS = ((0.0, 0.5688888888888889), (-0.5384693101056831, 0.4786286704993665), (0.5384693101056831, 0.4786286704993665),
         (-0.9061798459386640, 0.2369268850561891), (0.9061798459386640, 0.2369268850561891))
# growth of the bore from one state to the next, and the largest bore over that at rest
STEP, LARGEST = 1.05, 8.0


def points(low, high, parts):
    """Points and weights of composite Gauss quadrature."""
    size = (high - low) / parts
    return [(low + (k + 0.5 + 0.5 * x) * size, 0.5 * w * size) for k in range(parts) for x, w in GAUSS]


class Tube:
    """Section with a pressurised channel; law is (a, b) of Yeoh's w = (I + a I^2 + b I^3)/2."""

    def __init__(self, inner, outer, center, layers, width, law):
        self.inner, self.outer, self.center, self.law = inner, outer, center, law
        self.rings = points(inner, outer, 4)
        # (height, width times weight times modulus over that of the tube)
        self.fibres = [(x, width * weight * ratio) for low, high, ratio in layers for x, weight in points(low, high, 1)]

    def slope(self, invariant):
        """dw/dI."""
        second, third = self.law
        return 0.5 * (1 + 2 * second * invariant + 3 * third * invariant**2)

    def stress(self, stretch):
        """Nominal stress of a bar."""
        return self.slope(stretch**2 + 2 / stretch - 3) * (2 * stretch - 2 / stretch**2)

    def bore(self, a, stretch):
        """Pressure, and axial force of the tube with its end thrust beyond that of a solid bar."""
        by_bore = by_stretch = 0.0
        for big, weight in self.rings:
            rest = big * big - self.inner**2
            r = math.sqrt(a * a + rest / stretch)
            around, across = r / big, big / (r * stretch)
            w = 2 * math.pi * big * weight * self.slope(around**2 + across**2 + stretch**2 - 3)
            by_radius = 2 * around / big - 2 * across**2 / r
            by_bore += w * by_radius * a / r
            by_stretch += w * (2 * stretch - 2 * across**2 / stretch - by_radius * rest / (2 * r * stretch**2))
        pressure = by_bore / (2 * math.pi * a * stretch)
        return pressure, by_stretch - pressure * math.pi * a * a - math.pi * self.outer**2 * self.stress(stretch)

    def forces(self, a, e, kappa):
        """Axial force and moment about mid-height of the whole section."""
        _, tube = self.bore(a, 1 + e + kappa * self.center)
        force, moment = tube, tube * self.center
        for x, size in self.fibres:
            part = size * self.stress(1 + e + kappa * x)
            force += part
            moment += part * x
        return force, moment

    def state(self, a, e, kappa, blocked):
        """Strain and curvature in equilibrium for a bore, from a guess; None without."""
        de, dk = 1e-6, 1e-6 / self.center
        for _ in range(30):
            n, m = self.forces(a, e, kappa)
            ne, me = ((x - y) / de for x, y in zip(self.forces(a, e + de, kappa), (n, m)))
            if blocked:
                change, bend = -n / ne, 0.0
            else:
                nk, mk = ((x - y) / dk for x, y in zip(self.forces(a, e, kappa + dk), (n, m)))
                det = ne * mk - nk * me
                change, bend = (nk * m - mk * n) / det, (me * n - ne * m) / det
            limit = min(1.0, 0.2 / max(abs(change), abs(bend * self.center), 1e-30))
            e, kappa = e + limit * change, kappa + limit * bend
            if 1 + e < 0.3 or 1 + e + kappa * self.center < 0.3:
                return None
            if abs(change) + abs(bend) * self.center < 1e-9:
                return e, kappa
        return None

    def path(self, blocked):
        """(pressure over modulus mu, curvature or reaction over mu, volume per length) by rising bore."""
        found, a, e, kappa = [(0.0, 0.0, 0.0)], self.inner, 0.0, 0.0
        while a < LARGEST * self.inner:
            a *= STEP
            at = self.state(a, e, kappa, blocked)
            if at is None:
                break
            e, kappa = at
            stretch = 1 + e + kappa * self.center
            pressure, _ = self.bore(a, stretch)
            held = -self.forces(a, e, kappa)[1]
            found.append((pressure, held if blocked else kappa, math.pi * (a * a * stretch - self.inner**2)))
        return found


def reached(path, pressure):
    """First state of a path at a pressure, beyond a snap where there is one: (value, volume); None if it is never reached."""
    for (p0, x0, v0), (p1, x1, v1) in zip(path, path[1:]):
        if p0 <= pressure <= p1:
            share = (pressure - p0) / (p1 - p0)
            return x0 + share * (x1 - x0), v0 + share * (v1 - v0)
    return None
