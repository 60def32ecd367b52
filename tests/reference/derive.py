#!/usr/bin/env python3
"""Reference accelerations, independent of Whirl: writes accel.txt.

The mechanisms are transcribed by hand in dissertation.py, mechanics.py and systems.py (not parsed
from the .whirl files). SymPy differentiates, mpmath evaluates at 50 digits and solves the linear
system for the highest derivatives; 25 digits are printed. Every state value is a multiple of 1/64,
so it is exact in binary and in print.

Needs python3-sympy. From the project's root: python3 tests/reference/derive.py
Only needed to make the references anew; the tests read accel.txt.
"""
import inspect
import pathlib
import random
import sys

import mpmath as mp
import sympy as sp

sys.dont_write_bytecode = True  # leave no __pycache__ among the sources
DIGITS = 25
STATES = 6  # of each mechanism
HERE = pathlib.Path(__file__).parent


# The SI units of parameters that their files declare in other units.
UNITS = {
    "two_mass": {"m1": "[kg]", "A": "[kg/s]", "K2": "[kg/s^2]"},
    "simple_pendulum": {"k": "[N*m]"},
}


class Case:
    """One mechanism. `order` maps each unknown to its order (2 for a coordinate); `where` is the
    argument for `whirl accel`; `build` is called with the symbols and the parameters."""

    def __init__(self, where, order, build, ranges=None, vary=None, outright=False):
        self.where = where
        self.order = order
        self.build = build
        self.ranges = ranges or {}  # name -> (low, high); default -2..2
        self.vary = vary or {}  # parameters and inputs changed in every second state
        self.outright = outright

    def symbols(self):
        """x[name] = [x, x', ...] up to and with the highest derivative."""
        return {
            name: [sp.Symbol(name + "'" * k, real=True) for k in range(order + 1)]
            for name, order in self.order.items()
        }

    def equations(self, changed):
        """Expressions that must be zero. They are linear in the highest derivatives."""
        x = self.symbols()
        if self.outright:
            return x, self.build(x, **changed)
        q = [s[0] for s in x.values()]
        v = [s[1] for s in x.values()]
        a = [s[2] for s in x.values()]
        energies = self.build(x, **changed)
        T, V, F = (sp.sympify(energies.get(key, 0)) for key in "TVF")
        Q = energies.get("Q", {})
        L = T - V
        equations = []
        for i, name in enumerate(self.order):
            momentum = sp.diff(L, v[i])
            rate = sum(
                sp.diff(momentum, v[j]) * a[j] + sp.diff(momentum, q[j]) * v[j]
                for j in range(len(q))
            )
            equations.append(rate - sp.diff(L, q[i]) + sp.diff(F, v[i]) - Q.get(name, 0))
        return x, equations

    def accelerations(self, state, changed):
        """The highest derivatives at a state, as {name: value}. state: {symbol name: Rational}."""
        x, equations = self.equations(changed)
        highest = [s[-1] for s in x.values()]
        known = [k for s in x.values() for k in s[:-1]]
        values = [mp.mpf(state[k.name].p) / state[k.name].q for k in known]
        n = len(highest)
        matrix = mp.matrix(n, n)
        right = mp.matrix(n, 1)
        zeros = {h: 0 for h in highest}
        for i, equation in enumerate(equations):
            row = [sp.diff(equation, h) for h in highest] + [-equation.subs(zeros)]
            for j, entry in enumerate(row):
                value = mp.mpf(sp.lambdify(known, entry, "mpmath")(*values))
                if j < n:
                    matrix[i, j] = value
                else:
                    right[i] = value
        solved = mp.lu_solve(matrix, right)
        return {h.name: solved[i] for i, h in enumerate(highest)}

    def random_state(self, rng):
        state = {}
        for name, symbols in self.symbols().items():
            for symbol in symbols[:-1]:
                low, high = self.ranges.get(symbol.name, (-2, 2))
                state[symbol.name] = sp.Rational(rng.randint(int(low * 64), int(high * 64)), 64)
        return state

    def lines(self):
        rng = random.Random(self.where)  # repeatable, and independent of the other mechanisms
        for number in range(STATES):
            state = self.random_state(rng)
            changed = {}
            if number % 2 == 1:
                for name, (low, high) in self.vary.items():
                    changed[name] = sp.Rational(rng.randint(int(low * 64), int(high * 64)), 64)
            result = self.accelerations(state, changed)
            units = UNITS.get(self.where.split("/")[-1].split(".")[0], {})
            given = [f"{k}={exact(v)}{units.get(k, '')}" for k, v in {**changed, **state}.items()]
            wanted = [f"{k}={number_text(v)}" for k, v in result.items()]
            yield f"{self.where} | {' '.join(given)} | {' '.join(wanted)}"


def exact(value):
    """The text of a multiple of 1/64, with all its digits."""
    text = repr(float(value))
    assert sp.Rational(text) == value
    return text


def number_text(value):
    return "0" if abs(value) < mp.mpf(10) ** -40 else mp.nstr(value, DIGITS, strip_zeros=False)


def all_cases():
    import dissertation
    import mechanics
    import systems

    cases = []
    for module in (dissertation, mechanics, systems):
        cases += module.cases()
    for case in cases:  # a misspelt name in `vary` would otherwise pass unnoticed
        assert set(case.vary) <= set(inspect.signature(case.build).parameters), case.where
    return cases


def main():
    mp.mp.dps = 50
    lines = [
        "# Reference accelerations, made by derive.py. Do not edit.",
        "# FILE[:MECHANISM or SCENE] | state, inputs and parameters | highest derivatives, 25 digits; SI",
    ]
    for case in all_cases():
        lines += case.lines()
    (HERE / "accel.txt").write_text("\n".join(lines) + "\n")
    print(f"{len(lines) - 2} states of {len(all_cases())} mechanisms")


if __name__ == "__main__":
    main()
