#!/usr/bin/env python3
"""Compares the dissertation's printed equations with Lagrange's equations, which are derived here.

Each printed equation is transcribed as printed (left minus right side) and subtracted from the one
derived from the same energies; the difference must vanish identically. EQ3 of Thomson's device is
lost in the scanned text and therefore missing here.

Needs python3-sympy. From the project's root: python3 tests/reference/printed.py
"""
import sys

import sympy as sp
from sympy import cos, sin

sys.dont_write_bytecode = True  # leave no __pycache__ among the sources
import dissertation as d
from derive import Case

A, B, K1, K2, m1, m2, m, g, r, M = sp.symbols("A B K1 K2 m1 m2 m g r M", positive=True)


def derived(order, build, **parameters):
    x, equations = Case("", {name: 2 for name in order.split()}, build).equations(parameters)
    return x, equations


def differences():
    x, e = derived("r theta phi", d.spherical_particle, m=m, g=g)
    (q, v, a), (th, w, wd), (_, p, pd) = x["r"], x["theta"], x["phi"]
    yield "(3)", e[0], -m * q * w**2 + m * a - m * q * sin(th) ** 2 * p**2 + m * g * cos(th)
    yield "(4)", e[1], (2 * m * q * w * v + m * q**2 * wd - m * q**2 * sin(th) * p**2 * cos(th)
                        - m * g * q * sin(th))
    yield "(5)", e[2], (2 * m * q * sin(th) ** 2 * p * v + 2 * m * q**2 * sin(th) * p * cos(th) * w
                        + m * q**2 * sin(th) ** 2 * pd)

    x, e = derived("X Y", d.masses_relative, m1=m1, m2=m2, K1=K1, K2=K2, A=A, B=B)
    (X, vX, aX), (Y, vY, aY) = x["X"], x["Y"]
    yield "(6)", e[0], (m1 + m2) * aX + m2 * aY + K1 * X + A * (vY + vX)
    yield "(7)", e[1], aX * m2 + m2 * aY + K2 * Y + A * vY + A * vX + B * vY

    x, e = derived("theta X", d.epicyclic, m=m, r=r, M=M)
    (th, w, wd), (_, _, aX) = x["theta"], x["X"]
    inertia = m * r**2 / 2
    yield "(10)", e[1], 2 * m * aX - 2 * m * r * wd * sin(th) - 2 * m * r * w**2 * cos(th)
    yield "(11)", e[0], -2 * m * aX * r * sin(th) + (4 * m * r**2 + 4 * inertia) * wd - M

    x, e = derived("theta1 theta2", d.driven_hinge, m=m, r=r, M=M)
    (a, wa, aa), (b, wb, ab) = x["theta1"], x["theta2"]
    k = m * r**2
    yield "hinge EQ1", e[0], (-k * (-cos(b) * sin(a) + sin(b) * cos(a)) * wb**2
                              - k * (-cos(b) * cos(a) - sin(b) * sin(a)) * ab + k * aa - M)
    yield "hinge EQ2", e[1], ((inertia + k) * ab + (k * cos(b) * cos(a) + k * sin(b) * sin(a)) * aa
                              - k * cos(b) * sin(a) * wa**2 + k * sin(b) * cos(a) * wa**2)

    x, e = derived("theta1 theta2 X", d.thomson, m=m, r=r, M=M)
    (a, wa, aa), (b, wb, ab), (_, _, aX) = x["theta1"], x["theta2"], x["X"]
    yield "Thomson EQ1", e[0], (
        (-4 * m * r * sin(a) * cos(a) - 4 * m * r * sin(a)) * aX
        + (4 * k * sin(a) * cos(a) * sin(b) - 2 * k * cos(b) + 2 * k * sin(a) * sin(b)
           + 2 * k * cos(a) * cos(b) + 4 * k * cos(a) ** 2 * cos(b)) * ab
        + (8 * k * cos(a) + 4 * inertia + 12 * k) * aa - 4 * k * sin(a) * wa**2
        + (2 * k * sin(b) + 2 * k * sin(a) * cos(b) - 2 * k * cos(a) * sin(b)
           - 4 * k * cos(a) ** 2 * sin(b) + 4 * k * cos(a) * cos(b) * sin(a)) * wb**2 - M)
    yield "Thomson EQ2", e[1], (
        -m * r * sin(b) * aX + k * ab
        + m * r * (4 * r * cos(a) ** 2 * cos(b) + 2 * r * cos(a) * cos(b)
                   + 4 * r * sin(a) * cos(a) * sin(b) - 2 * r * cos(b)
                   + 2 * r * sin(a) * sin(b)) * aa
        + m * r * (-2 * r * sin(a) * wa**2 * cos(b) + 8 * r * cos(a) ** 2 * wa**2 * sin(b)
                   - 4 * r * wa**2 * sin(b) + 2 * r * cos(a) * wa**2 * sin(b)
                   - 8 * r * cos(a) * cos(b) * sin(a) * wa**2))


if __name__ == "__main__":
    wrong = 0
    for name, ours, printed in differences():
        rest = sp.simplify(sp.expand(sp.expand_trig(ours - printed)))
        wrong += rest != 0
        print(f"{name}: {'agrees' if rest == 0 else f'differs by {rest}'}")
    raise SystemExit(wrong != 0)
