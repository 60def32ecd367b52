#!/usr/bin/env python3
"""References for the scenes with stops, friction, holds and crossings: writes contacts.txt.

The mechanisms are written here by hand, as point masses with Jacobians and not as energies; events.py
integrates them. Every scene runs twice, with stretches of two lengths, and what the two differ by is
printed: at most 5e-10 in any number.

Needs nothing but Python 3. From the project's root: python3 tests/reference/contacts.py [PART OF A NAME]
"""
import math
import pathlib
import sys

sys.dont_write_bytecode = True  # leave no __pycache__ among the sources
from events import STUCK, Crossing, Friction, Hold, Run, Stop

HERE = pathlib.Path(__file__).parent

# --- mechanisms -----------------------------------------------------------------------------------


def diagonal(*masses):
    rows = [[m if i == j else 0.0 for j in range(len(masses))] for i, m in enumerate(masses)]
    return lambda q: rows


def points(parts, extra=()):
    """Mass matrix and centrifugal force of point masses. parts(q, v): [(mass, jacobian rows,
    velocity-dependent acceleration)] a direction in space each; extra: inertias on the diagonal."""

    def mass(q):
        n = len(q)
        m = [[extra[i] if extra and i == j else 0.0 for j in range(n)] for i in range(n)]
        for kg, row, _ in parts(q, [0.0] * n):
            for i in range(n):
                for j in range(n):
                    m[i][j] += kg * row[i] * row[j]
        return m

    def inertia_force(q, v):
        f = [0.0] * len(q)
        for kg, row, left in parts(q, v):
            f = [a - kg * r * left for a, r in zip(f, row)]
        return f

    return mass, inertia_force


G = 9.81
TURN = 2 * math.pi


def hopper(span):
    f = lambda q, v: [0.0, -G + 0.003 * v[0] ** 2 * math.sin(q[0])]
    stop = Stop(0.0, lambda q: q[1], [0.0, 1.0])
    return Run(diagonal(1.0, 1.0), f, [stop], [0.0, 0.0], [10 * TURN, 0.0], span), "phi z"


def shaken_block(A, B):
    def make(span):
        f = lambda q, v: [0.0, v[0] ** 2 * (A * math.sin(q[0]) + 4 * B * math.cos(2 * q[0]))]
        rough = Friction([0.0, 1.0], 0.4, 0.3, lambda q, v: G)
        return Run(diagonal(1.0, 1.0), f, [rough], [0.0, 0.0], [2 * TURN, 0.0], span), "phi s"
    return make


def belt(k_3):
    def make(span):
        def f(q, v):
            pull = q[0] + q[1]
            return [0.0, -100.0 * pull - k_3 * pull ** 3]
        rough = Friction([0.0, 1.0], 0.4, 0.3, lambda q, v: G)
        return Run(diagonal(1.0, 1.0), f, [rough], [0.0, 0.0], [0.1, 0.0], span), "b s"
    return make


def plank(span):
    parts = lambda q, v: [(1.0, [1.0, 0.0, 0.0], 0.0), (2.0, [1.0, 1.0, 0.0], 0.0)]

    def f(q, v):
        block = 9.0 * math.sin(1.7 * q[2])
        return [12.0 * math.sin(q[2]) + block, block - 200.0 * q[1], 0.0]
    rough = [Friction([1.0, 0.0, 0.0], 0.2, 0.05, lambda q, v: 3.0 * G),
             Friction([0.0, 1.0, 0.0], 0.25, 0.2, lambda q, v: 2.0 * G)]
    mass, _ = points(parts, (0.0, 0.0, 1.0))
    return Run(mass, f, rough, [0.0, 0.0, 0.0], [0.0, 0.0, 7.0], span), "x u p"


def crash(both):
    def make(span):
        l, m, M = 0.5, 1.0, 2.0

        def parts(q, v):
            s, c, w = math.sin(q[1]), math.cos(q[1]), v[1]
            return [(M, [1.0, 0.0], 0.0), (m, [1.0, l * c], -l * s * w * w),
                    (m, [0.0, l * s], l * c * w * w)]

        mass, inertia = points(parts)
        f = lambda q, v: [inertia(q, v)[0], inertia(q, v)[1] - m * G * l * math.sin(q[1])]
        stops = [Stop(0.6, lambda q: 1.0 - q[0], [-1.0, 0.0])]
        if both:
            stops.append(Stop(0.6, lambda q: 1.2 - q[0] - l * math.sin(q[1]),
                              lambda q: [-1.0, -l * math.cos(q[1])],
                              lambda q, v: l * math.sin(q[1]) * v[1] ** 2))
        return Run(mass, f, stops, [0.0, 0.0], [2.0, 0.0], span), "X theta"
    return make


def shuttle(clamped):
    def make(span):
        f = lambda q, v: [0.0, 8.0 * math.sin(q[0])]
        contacts = [Stop(0.5, lambda q: q[1] + 0.1, [0.0, 1.0]),
                    Stop(0.0, lambda q: 0.15 - q[1], [0.0, -1.0])]
        if clamped:
            contacts.append(Hold([0.0, 1.0], lambda q: math.cos(q[0]) - math.sqrt(0.5)))
        contacts.append(Friction([0.0, 1.0], 0.3, 0.2, lambda q, v: G))
        return Run(diagonal(1.0, 1.0), f, contacts, [0.0, 0.0], [TURN, 0.0], span), "phi x"
    return make


def escapement(span):
    f = lambda q, v: [-0.01 * q[0] - 2e-5 * v[0]]
    kick = Crossing(lambda q: q[0], lambda q, v: [v[0] + 0.5])
    return Run(diagonal(1e-4), f, [kick], [0.0], [1.0], span), "theta"


LB, INCH, GRAVITY = 0.45359237, 0.0254, 9.80665
ARM, DISC = 0.152 * LB, 0.15 * LB
ECCENTRIC = 2 * (ARM + DISC)
FIRST_MOMENT = 2 * (ARM * 7.25 * INCH / 2 + DISC * 6.5 * INCH)
SECOND_MOMENT = 2 * (ARM * (7.25 * INCH) ** 2 / 3 + DISC * (6.5 * INCH) ** 2)


def carriage(flywheel, q, v, rough):
    def make(span):
        S, I, all_kg = FIRST_MOMENT, SECOND_MOMENT + flywheel, 4 * ECCENTRIC

        def mass(q):
            side = -S * math.sin(q[0])
            return [[I, side], [side, all_kg]]

        def f(q, v):
            motor = 1.5 * (0.573 - v[0] / (600 * TURN / 60)) - 0.001 * v[0]
            return [motor, S * v[0] ** 2 * math.cos(q[0])]

        contacts = [Stop(0.5, lambda q: q[1], [0.0, 1.0])]
        if rough:
            contacts.append(Friction([0.0, 1.0], 0.06, 0.05, lambda q, v: all_kg * GRAVITY))
        return Run(mass, f, contacts, q, v, span), "theta X"
    return make


def thomson_magnet(span):
    """One unit with the spin of disc 33; theta1, theta2, X."""
    m, r = 2.0, 0.3
    I = m * r * r / 2

    def parts(q, v):
        a, b = q[0], q[1]
        s1, c1, s2, c2 = math.sin(a), math.cos(a), math.sin(2 * a), math.cos(2 * a)
        sb, cb = math.sin(b), math.cos(b)
        w, u = v[0] ** 2, v[1] ** 2
        disc26 = [(m, [-2 * r * s1, 0.0, 1.0], -2 * r * c1 * w),
                  (m, [2 * r * c1, 0.0, 0.0], -2 * r * s1 * w)]
        disc33 = [(m, [-2 * r * (s1 + s2), -r * sb, 1.0],
                   -2 * r * (c1 + 2 * c2) * w - r * cb * u),
                  (m, [2 * r * (c1 + c2), r * cb, 0.0],
                   -2 * r * (s1 + 2 * s2) * w - r * sb * u)]
        return [(m, [0.0, 0.0, 1.0], 0.0)] + disc26 + disc33

    mass, inertia = points(parts, (4 * I, I, 0.0))

    def f(q, v):
        f = inertia(q, v)
        return [f[0] - 2.0, f[1], f[2]]

    held = Hold([0.0, 1.0, 0.0], lambda q: min(math.sin(2 * q[0]), math.cos(2 * q[0])))
    return Run(mass, f, [held], [0.0] * 3, [0.0] * 3, span), "theta1 theta2 X"


def halvorson(rough):
    """theta, u, w, X."""
    def make(span):
        M, m, e, r, I = 1.0, 0.3, 0.03, 0.003, 2e-4
        slope = math.radians(45)
        C, S = math.cos(slope), math.sin(slope)
        ka, ca, kb, cb = 13000.0, 13.0, 460.0, 10.0

        def parts(q, v):
            s, c = math.sin(q[0]), math.cos(q[0])
            w = v[0] ** 2
            return [(M, [0, 0, 0, 1], 0.0),
                    (m, [0, C, S, 1], 0.0), (m, [0, S, -C, 0], 0.0),
                    (e, [-r * s, C, S, 1], -r * c * w), (e, [r * c, S, -C, 0], -r * s * w)]

        mass, inertia = points(parts, (I, 0.0, 0.0, 0.0))

        def f(q, v):
            f = inertia(q, v)
            motor = 0.2 * (1 - v[0] / (1830 * TURN / 60))
            return [f[0] + motor - e * G * r * math.cos(q[0]),
                    f[1] - ka * q[1] - ca * v[1] - (m + e) * G * S,
                    f[2] - kb * q[2] - cb * v[2] + (m + e) * G * C, f[3]]

        def normal(q, v):
            return M * G - (ka * q[1] + ca * v[1]) * S + (kb * q[2] + cb * v[2]) * C

        contacts = [Friction([0.0, 0.0, 0.0, 1.0], 0.4, 0.3, normal)] if rough else []
        return Run(mass, f, contacts, [0.0, -0.176e-3, 4.976e-3, 0.0],
                   [60 * math.pi, 0.0, 0.0, 0.0], span), "theta u w X"
    return make


MODELS = "core/models/"
SCENES = [
    ("contacts.whirl:hopper_hops", hopper, [0.05, 1.0], 2e-3),
    ("contacts.whirl:table_slips", shaken_block(0.040, 0.0), [0.3, 5.0], 1e-2),
    ("contacts.whirl:table_drifts", shaken_block(0.020, 0.005), [0.3, 5.0, 10.0], 1e-2),
    ("contacts.whirl:belt_stick_slip", belt(0.0), [1.0, 5.0], 1e-2),
    ("contacts.whirl:belt_stiffening", belt(50000.0), [1.0, 5.0], 1e-2),
    ("contacts_together.whirl:plank_shaken", plank, [1.0, 5.0, 20.0], 5e-3),
    ("contacts.whirl:crash_cart", crash(False), [1.0, 3.0], 1e-2),
    ("contacts.whirl:crash_both", crash(True), [1.0, 3.0], 1e-2),
    ("contacts.whirl:shuttle_buffers", shuttle(False), [1.0, 5.0, 10.0], 1e-2),
    ("contacts.whirl:shuttle_clamped", shuttle(True), [1.0, 5.0, 10.0], 1e-2),
    ("contacts.whirl:escapement_ticks", escapement, [1.0, 10.0, 60.0], 2e-2),
    ("eccentric.whirl:carriage_stop",
     carriage(100.0, [0.5, 0.02], [11 * math.pi, 0.0], True), [1.0, 5.0, 60.0], 5e-3),
    ("eccentric.whirl:carriage_stop_smooth",
     carriage(100.0, [0.5, 0.02], [11 * math.pi, 0.0], False), [1.0, 5.0], 5e-3),
    ("eccentric.whirl:carriage_stop_start",
     carriage(0.05, [0.0, 0.0], [0.0, 0.0], True), [1.0, 5.0, 60.0], 5e-3),
    ("thomson.whirl:thomson_magnet", thomson_magnet, [2.0, 5.0], 5e-3),
    ("halvorson.whirl:halvorson_ground", halvorson(True), [1.0, 5.0, 10.0], 1e-3),
    ("halvorson.whirl:halvorson_smooth", halvorson(False), [1.0, 10.0], 1e-3),
]


def states(make, times, span):
    run, names = make(span)
    found = []
    for time in times:
        run.to(time)
        found.append(list(run.y))
    return found, names.split(), run


def main(wanted):
    lines = ["# Reference states, made by contacts.py. Do not edit.",
             "# FILE:SCENE | time | coordinates and rates, SI"]
    for where, make, times, span in SCENES:
        if wanted and not any(w in where for w in wanted):
            continue
        coarse, names, _ = states(make, times, span)
        fine, _, run = states(make, times, span * 0.61)
        keys = names + [name + "'" for name in names]
        for time, a, b in zip(times, coarse, fine):
            apart = max(abs(p - q) for p, q in zip(a, b))
            values = " ".join(f"{k}={x:.15g}" for k, x in zip(keys, b))
            print(f"{where} t={time}: apart {apart:.1e}, {len(run.log)} events", flush=True)
            lines.append(f"{MODELS}{where} | {time} | {values}")
        breaks = [t for t, c, mode in run.log if isinstance(c, Friction) and mode == STUCK]
        if "belt" in where:
            periods = [b - a for a, b in zip(breaks[1:], breaks[2:])]
            print(f"{where}: periods {min(periods)!r} to {max(periods)!r}")
            lines.append(f"{MODELS}{where} | period | T={periods[-1]:.15g}")
    if not wanted:
        (HERE / "contacts.txt").write_text("\n".join(lines) + "\n")
    else:
        print("\n".join(lines))


if __name__ == "__main__":
    main(sys.argv[1:])
