#!/usr/bin/env python3
"""Reference end states of the scenes in core/models, independent of Whirl: writes trajectory.txt.

The accelerations come from the hand transcriptions of dissertation.py; the integrator is
Gragg-Bulirsch-Stoer extrapolation (Hairer, Norsett & Wanner, Solving Ordinary Differential
Equations I, section II.9) of order 24 in 42-digit numbers with fixed steps. The step is halved
until two runs agree to 18 digits of the largest state; the finer one is written. Two further checks
need no integrator: the two-mass cases are repeated as exp(St), the particle's flight as a parabola.

Needs python3-sympy and python3-gmpy2.
From the project's root: python3 tests/reference/trajectory.py
"""
import pathlib
import sys

import gmpy2
import mpmath as mp
import sympy as sp
from sympy import Rational as R, pi

sys.dont_write_bytecode = True  # leave no __pycache__ among the sources
import dissertation as d
from derive import Case
from units import INCH

HERE = pathlib.Path(__file__).parent
AGREE = mp.mpf(10) ** -18
BITS = 140
COLUMNS = 12  # of the extrapolation table, which gives order 24
FAST = {"mpf": gmpy2.mpfr, "sin": gmpy2.sin, "cos": gmpy2.cos}


class System:
    """y = (coordinates, rates) and its right-hand side in gmpy2 numbers."""

    def __init__(self, names, build):
        self.names = names.split()
        n = len(self.names)
        x, equations = Case("", {name: 2 for name in self.names}, build).equations({})
        a = [s[2] for s in x.values()]
        known = [s[0] for s in x.values()] + [s[1] for s in x.values()]
        entries = [sp.diff(e, h) for e in equations for h in a]
        entries += [-e.subs({h: 0 for h in a}) for e in equations]
        self.n = n
        self.entries = sp.lambdify(known, entries, [FAST, "mpmath"], cse=True)

    def slope(self, y):
        n = self.n
        e = [gmpy2.mpfr(v) for v in self.entries(*y)]
        rows = [e[i * n:(i + 1) * n] + [e[n * n + i]] for i in range(n)]
        for i in range(n):  # Gauss: mass matrices need no pivoting
            for k in range(i + 1, n):
                factor = rows[k][i] / rows[i][i]
                rows[k] = [b - factor * c for b, c in zip(rows[k], rows[i])]
        a = [gmpy2.mpfr(0)] * n
        for i in reversed(range(n)):
            rest = rows[i][n] - sum(rows[i][j] * a[j] for j in range(i + 1, n))
            a[i] = rest / rows[i][i]
        return list(y[n:]) + a

    def midpoint(self, y, slope, span, parts):
        """Gragg's modified midpoint rule."""
        h = span / parts
        before, now = y, [b + h * s for b, s in zip(y, slope)]
        for _ in range(parts - 1):
            before, now = now, [b + 2 * h * s for b, s in zip(before, self.slope(now))]
        return [(b + c + h * s) / 2 for b, c, s in zip(before, now, self.slope(now))]

    def step(self, y, span):
        slope = self.slope(y)
        table = []
        for k in range(COLUMNS):
            row = [self.midpoint(y, slope, span, 2 * (k + 1))]
            for j in range(1, k + 1):
                ratio = gmpy2.mpfr(k + 1) ** 2 / (k + 1 - j) ** 2 - 1
                row.append([b + (b - c) / ratio for b, c in zip(row[j - 1], table[-1][j - 1])])
            table.append(row)
        return table[-1][-1]

    def run(self, y, times, span):
        """The states at `times`, which must be multiples of `span`."""
        states, done = [], 0
        for time in times:
            for _ in range(int(round(time / span)) - done):
                y = self.step(y, quotient(span))
                done += 1
            states.append(y)
        return states

    def refined(self, y, times, span):
        """The states after the step was halved until they no longer change, and the last change of each."""
        states = self.run(y, times, span)
        while True:
            span = span / 2
            finer = self.run(y, times, span)
            changes = [apart(b, a) for a, b in zip(states, finer)]
            if max(changes) < AGREE:
                return [precise(state) for state in finer], changes
            states = finer


def runs():
    """The scenes: (file:scene, names, energies, start, times, step)."""
    models = "core/models/"
    masses = models + "two_mass.whirl:two_mass_"
    stretched = [0, INCH / 2, 0, 0]
    apart = [R("2.35") * INCH, R("4.85") * INCH, 0, 0]
    for kind, names, build, start in (
        ("absolute", "X Y", d.masses_absolute, apart),
        ("relative", "X Y", d.masses_relative, stretched),
    ):
        yield masses + kind, names, build, start, [R(1, 2), 2, 5], R(1, 20)
        yield masses + kind + "_physical", names, d.physical(build), start, [R(1, 10)], R(1, 400)
    yield (models + "spherical_particle.whirl:spherical_flight", "r theta phi",
           d.spherical_particle, [5, R(5, 4), R(1, 2), 8, -R(3, 4), R(1, 2)], [1, 2], R(1, 20))
    yield (models + "spherical_particle.whirl:spherical_near_pole", "r theta phi",
           d.spherical_particle, [4, R(1, 2), 0, 6, -R(3, 2), R(1, 16)], [1], R(1, 200))
    yield (models + "epicyclic.whirl:epicyclic_from_rest", "theta X", d.epicyclic,
           [0] * 4, [5, 9], R(1, 40))
    yield (models + "epicyclic.whirl:epicyclic_rail_drag", "theta X", d.epicyclic_rail_drag,
           [0] * 4, [5, 9], R(1, 40))
    yield (models + "driven_hinge.whirl:driven_hinge_from_rest", "theta1 theta2", d.driven_hinge,
           [0] * 4, [5, 10], R(1, 40))
    names = "theta1 theta2 X"
    set_b = [0, -pi / 2, 0, R("-8.5"), 0, 0]
    thomson = models + "thomson.whirl:thomson_"
    yield thomson + "a", names, d.thomson, [0] * 6, [5, 8], R(1, 20)
    yield thomson + "b", names, d.thomson, set_b, [2, 5], R(1, 80)
    yield thomson + "a_spin", names, d.thomson_spin, [0] * 6, [5], R(1, 20)
    yield thomson + "b_spin", names, d.thomson_spin, set_b, [2], R(1, 80)


def quotient(value):
    return gmpy2.mpfr(int(value.p)) / int(value.q)


def number(value):
    value = sp.sympify(value)
    return quotient(value) if value.is_Rational else -gmpy2.const_pi() / 2


def precise(state):
    """The same numbers for mpmath."""
    return [mp.mpf(str(v)) for v in state]


def linear_solution(system, start, time):
    """The solution of y' = S y + c, from exp of the augmented matrix. S is found by exact differences."""
    size = 2 * system.n
    zero = precise(system.slope([gmpy2.mpfr(0)] * size))
    augmented = mp.zeros(size + 1, size + 1)
    for j in range(size):
        unit = [gmpy2.mpfr(int(i == j)) for i in range(size)]
        for i, value in enumerate(precise(system.slope(unit))):
            augmented[i, j] = value - zero[i]
    for i in range(size):
        augmented[i, size] = zero[i]
    moved = mp.expm(augmented * mp.mpf(time.p) / time.q, method="taylor")
    return [moved[i, size] + sum(moved[i, j] * start[j] for j in range(size)) for i in range(size)]


def parabola(start, time):
    """The end of a flight, computed in Cartesian coordinates, in spherical ones (phi within half a turn)."""
    r, th, ph, vr, vth, vph = start
    s, c, sp_, cp = mp.sin(th), mp.cos(th), mp.sin(ph), mp.cos(ph)
    t = mp.mpf(time.p) / time.q
    x = r * s * cp + t * (vr * s * cp + r * vth * c * cp - r * vph * s * sp_)
    y = r * s * sp_ + t * (vr * s * sp_ + r * vth * c * sp_ + r * vph * s * cp)
    z = r * c + t * (vr * c - r * vth * s) - mp.mpf("9.81") * t**2 / 2
    distance = mp.sqrt(x**2 + y**2 + z**2)
    return [distance, mp.acos(z / distance), mp.atan2(y, x)]


def apart(a, b):
    """Largest difference of two states, relative to the largest entry."""
    a, b = precise(a), precise(b)
    return max(abs(p - q) for p, q in zip(a, b)) / max(abs(p) for p in a)


def main():
    mp.mp.dps = 42
    gmpy2.get_context().precision = BITS
    lines = [
        "# Reference end states, made by trajectory.py. Do not edit.",
        "# FILE:SCENE | time | coordinates and rates, 18 digits; SI",
    ]
    for where, names, build, start, times, span in runs():
        system = System(names, build)
        times = [sp.Rational(t) for t in times]
        y = [number(v) for v in start]
        for time, state, change in zip(times, *system.refined(y, times, span)):
            notes = f"halving the step changes {mp.nstr(change, 2)}"
            if "two_mass" in where:
                exact = linear_solution(system, precise(y), time)
                assert apart(exact, state) < AGREE, (where, time)
                notes += f", exp(St) to {mp.nstr(apart(exact, state), 2)}"
            if "spherical" in where:
                exact = parabola(precise(y), time)
                assert apart(exact, state[:3]) < AGREE, (where, time, exact, state)
                notes += f", parabola to {mp.nstr(apart(exact, state[:3]), 2)}"
            print(f"{where} t={time}: {notes}", flush=True)
            keys = system.names + [name + "'" for name in system.names]
            values = " ".join(f"{k}={mp.nstr(v, 18, strip_zeros=False)}"
                              for k, v in zip(keys, state))
            lines.append(f"{where} | {float(time)} | {values}")
    (HERE / "trajectory.txt").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
