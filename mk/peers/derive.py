"""derive.py WHIRL SYSTEM SCENE: the equations of motion by SymPy, to C, beside `whirl derive SCENE --as c`.

Prints how many times as long SymPy takes: the median of ROUNDS, each in turns with Whirl's. SymPy's time is from the
energies to the text of the C code, without its start; Whirl's that of the whole program. Before that both must give the
same accelerations at one state.
"""
import os
import re
import statistics
import subprocess
import sys
import time

import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

ROUNDS = int(os.environ.get("DERIVATIONS", "5"))
T = dynamicsymbols._t
MASS, RADIUS = sp.Integer(2), sp.Rational(3, 10)
INERTIA = MASS * RADIUS**2 / 2


def squared(point):
    return sum(sp.diff(x, T) ** 2 for x in point)


def epicyclic():
    theta, x = q = dynamicsymbols("theta X")
    gear = (x + 2 * RADIUS * sp.cos(theta), 2 * RADIUS * sp.sin(theta))
    energy = MASS * (squared((x,)) + squared(gear)) / 2 + INERTIA * (2 * theta.diff(T)) ** 2 / 2
    return q, energy, [2, 0]


def thomson():
    theta1, theta2, x = q = dynamicsymbols("theta1 theta2 X")
    disc = (x + 2 * RADIUS * sp.cos(theta1), 2 * RADIUS * sp.sin(theta1))
    last = (
        disc[0] + RADIUS * sp.cos(2 * theta1) + RADIUS * sp.cos(theta2),
        disc[1] + RADIUS * sp.sin(2 * theta1) + RADIUS * sp.sin(theta2),
    )
    energy = MASS * (squared((x,)) + squared(disc) + squared(last)) / 2
    return q, energy + INERTIA * (2 * theta1.diff(T)) ** 2 / 2, [-2, 0, 0]


def derive(system):
    """The accelerations as common subexpressions and results, and their C code."""
    q, energy, force = system()
    lagrange = LagrangesMethod(energy, q)
    lagrange.form_lagranges_equations()
    accelerations = lagrange.mass_matrix.LUsolve(lagrange.forcing + sp.Matrix(force))
    names = {}
    for i, coordinate in enumerate(q):
        names[coordinate.diff(T)] = sp.Symbol(f"v{i}")
    for i, coordinate in enumerate(q):
        names[coordinate] = sp.Symbol(f"q{i}")
    shared, results = sp.cse(accelerations.subs(names), list=True)
    lines = [f"const double {name} = {sp.ccode(value)};" for name, value in shared]
    lines += [f"a[{i}] = {sp.ccode(value)};" for i, value in enumerate(results[0])]
    return q, shared, results[0], "\n".join(lines)


def same_accelerations(whirl, scene, q, shared, results):
    state, words = {}, []
    for i, coordinate in enumerate(q):
        place, rate = 0.3 + 0.4 * i, 1.2 - 1.6 * i
        state[sp.Symbol(f"q{i}")], state[sp.Symbol(f"v{i}")] = place, rate
        words += [f"{coordinate.func.__name__}={place!r}", f"{coordinate.func.__name__}'={rate!r}"]
    for name, value in shared:
        state[name] = float(value.subs(state))
    told = subprocess.run([whirl, "accel", scene, *words], capture_output=True, text=True, check=True)
    ours = [float(value) for value in re.findall(r"= (\S+)", told.stdout)]
    theirs = [float(value.subs(state)) for value in results]
    return len(ours) == len(theirs) and all(
        abs(a - b) <= 1e-12 * (1 + abs(b)) for a, b in zip(ours, theirs)
    )


def main():
    whirl, name, scene = sys.argv[1:4]
    system = {"epicyclic": epicyclic, "thomson": thomson}[name]
    ratios = []
    for _ in range(ROUNDS):
        sp.core.cache.clear_cache()
        begin = time.perf_counter()
        q, shared, results, _ = derive(system)
        theirs = time.perf_counter() - begin
        begin = time.perf_counter()
        subprocess.run([whirl, "derive", scene, "--as", "c"], stdout=subprocess.DEVNULL, check=True)
        ratios.append(theirs / (time.perf_counter() - begin))
    if not same_accelerations(whirl, scene, q, shared, results):
        sys.exit(f"derive.py: SymPy and Whirl differ in the accelerations of {scene}")
    print(f"{statistics.median(ratios):.3g}")


main()
