"""Textbook mechanisms of tests/mechanisms, given by their energies, transcribed by hand."""
from sympy import (Abs, Piecewise, Rational as R, acos, asin, atan, atan2, cos, exp, log, sign,
                   sin, sqrt, tan)

from derive import Case
from units import DEG, FOOT, INCH, LB, LBF, RPM, SLUG

G = R("9.81")
HALF = R(1, 2)


def simple_pendulum(x, k=3 * LBF * INCH):
    th, w, _ = x["theta"]
    m, l, g = R("2.5") * LB, R("1.5") * FOOT, R("9.80665")
    return {"T": HALF * m * l**2 * w**2, "V": -m * g * l * cos(th) + k * (1 - cos(th - 30 * DEG)),
            "F": R("0.125") * LBF * INCH * w**2 / 2}


def double_pendulum(x, m1=R("1.5")):
    (a, va, _), (b, vb, _) = x["a"], x["b"]
    m2, l1, l2 = R("0.7"), R("0.8"), R("0.5")
    return {
        "T": HALF * (m1 + m2) * l1**2 * va**2 + HALF * m2 * l2**2 * vb**2
        + m2 * l1 * l2 * va * vb * cos(a - b),
        "V": -(m1 + m2) * G * l1 * cos(a) - m2 * G * l2 * cos(b),
    }


def triple_pendulum(x, m3=R("0.5"), c=R("0.01")):
    q = [x[f"q{i}"][0] for i in (1, 2, 3)]
    v = [x[f"q{i}"][1] for i in (1, 2, 3)]
    m, l = [1, R("0.75"), m3], [R("0.5"), R("0.4"), R("0.3")]
    T = V = vx = vy = depth = 0
    for i in range(3):
        cx, cy = vx + l[i] / 2 * v[i] * cos(q[i]), vy + l[i] / 2 * v[i] * sin(q[i])
        T += HALF * m[i] * (cx**2 + cy**2) + HALF * m[i] * l[i] ** 2 / 12 * v[i] ** 2
        V -= m[i] * G * (depth + l[i] / 2 * cos(q[i]))
        vx, vy = vx + l[i] * v[i] * cos(q[i]), vy + l[i] * v[i] * sin(q[i])
        depth += l[i] * cos(q[i])
    F = c / 2 * (v[0] ** 2 + (v[1] - v[0]) ** 2 + (v[2] - v[1]) ** 2)
    return {"T": T, "V": V, "F": F}


def cart_pole(x, u=R("1.5"), l=R("0.6")):
    (X, v, _), (th, w, _) = x["x"], x["theta"]
    M, m = 3, R("0.4")
    J = m * (2 * l) ** 2 / 12
    return {
        "T": HALF * (M + m) * v**2 + m * l * v * w * cos(th) + HALF * (m * l**2 + J) * w**2,
        "V": HALF * 15 * X**2 + m * G * l * cos(th),
        "F": HALF * R("0.7") * v**2 + HALF * R("0.02") * w**2,
        "Q": {"x": u},
    }


def elastic_pendulum(x, k=120):
    (X, vx, _), (Y, vy, _) = x["x"], x["y"]
    m = R("0.3") * SLUG
    return {"T": HALF * m * (vx**2 + vy**2),
            "V": HALF * k * (sqrt(X**2 + Y**2) - R("0.7")) ** 2 + m * G * Y}


def spherical_pendulum(x):
    (th, w, _), (_, p, _) = x["theta"], x["phi"]
    m, l = R("1.2"), R("0.9")
    return {"T": HALF * m * l**2 * (w**2 + sin(th) ** 2 * p**2), "V": -m * G * l * cos(th),
            "Q": {"phi": R("0.05")}}


def bead_on_hoop(x):
    th, w, _ = x["theta"]
    m, r, turn = R("0.05"), R("0.12"), 120 * RPM
    return {"T": HALF * m * r**2 * (w**2 + turn**2 * sin(th) ** 2), "V": -m * G * r * cos(th),
            "F": HALF * R("0.0001") * w**2}


def bead_on_wire(x, h=R("1.5")):
    X, v, _ = x["x"]
    m, a = R("0.2"), R("0.8")
    y = h * exp(-X / a)
    path = 1 + y.diff(X) ** 2
    return {"T": HALF * m * v**2 * path, "V": m * G * y, "F": HALF * R("0.1") * v**2 * path}


def tan_well(x, U=2):
    X, v, _ = x["x"]
    return {"T": HALF * v**2, "V": U * tan(X) ** 2 + HALF * atan(3 * X)}


def kepler(x, k=5):
    q, v = [x[n][0] for n in "xyz"], [x[n][1] for n in "xyz"]
    return {"T": sum(s**2 for s in v), "V": -k / sqrt(sum(s**2 for s in q))}


def vortex(x, E=R("0.8")):
    (X, vx, _), (Y, vy, _) = x["x"], x["y"]
    angle, rho = atan2(Y, X), sqrt(X**2 + Y**2)
    return {"T": R(1, 4) * (vx**2 + vy**2),
            "V": E * angle + E / 3 * sin(2 * angle) * rho ** R(3, 2)}


def charged_particle(x, qB=R("0.3"), drive=R("0.1")):
    (X, vx, _), (_, vy, _), (Z, vz, _) = x["x"], x["y"], x["z"]
    b = qB * (1 + X / 2)
    return {"T": HALF * R("0.01") * (vx**2 + vy**2 + vz**2), "V": -R("0.2") * Z,
            "Q": {"x": b * vy + drive, "y": -b * vx}}


def furuta(x, tau=R("0.05")):
    (_, wa, _), (b, wb, _) = x["alpha"], x["beta"]
    J0, m, r, l = R("0.01"), R("0.12"), R("0.2"), R("0.15")
    J1 = m * (2 * l) ** 2 / 12
    return {
        "T": HALF * (J0 + m * r**2 + (m * l**2 + J1) * sin(b) ** 2) * wa**2
        + m * r * l * wa * wb * cos(b) + HALF * (m * l**2 + J1) * wb**2,
        "V": -m * G * l * cos(b),
        "F": HALF * R("0.001") * wa**2 + HALF * R("0.0002") * wb**2,
        "Q": {"alpha": tau},
    }


def symmetric_top(x, m=R("0.5")):
    (_, vp, _), (th, vt, _), (_, vs, _) = x["phi"], x["theta"], x["psi"]
    A, C = R("0.0008"), R("0.0003")
    return {"T": HALF * A * (vt**2 + vp**2 * sin(th) ** 2) + HALF * C * (vs + vp * cos(th)) ** 2,
            "V": m * G * R("0.04") * cos(th), "F": HALF * R("0.00001") * vs**2}


def quadratic_drag(x, wind=5):
    (_, vx, _), (Z, vz, _) = x["x"], x["z"]
    m, c, g = R("0.145"), R("0.0013"), R("32.174") * FOOT
    return {"T": HALF * m * (vx**2 + vz**2), "V": m * g * Z,
            "Q": {"x": -c * Abs(vx - wind) * (vx - wind), "z": -c * Abs(vz) * vz}}


def morse(x, D=4):
    (a, va, _), (b, vb, _) = x["x1"], x["x2"]
    return {"T": HALF * va**2 + 3 * HALF * vb**2,
            "V": D * (1 - exp(-(b - a - 1) / R("1.5"))) ** 2 - R("0.4") * log(a + 4)}


def contact(x, E=900):
    X, v, _ = x["x"]
    V = Piecewise((E * X ** R(5, 2), X > 0), (HALF * 40 * X**2, True))
    return {"T": HALF * R("0.25") * v**2, "V": V, "Q": {"x": -R("0.6") * sign(v)}}


def planar_arm(x, u1=5, u2=-2, u3=HALF):
    m, J = [4, 3, R("1.5")], [R("0.08"), R("0.04"), R("0.01")]
    l, c = [R("0.45"), R("0.35"), 0], [R("0.225"), R("0.175"), R("0.1")]
    T = V = angle = rate = vx = vy = height = 0
    for i in range(3):
        angle, rate = angle + x[f"q{i + 1}"][0], rate + x[f"q{i + 1}"][1]
        cx, cy = vx - c[i] * rate * sin(angle), vy + c[i] * rate * cos(angle)
        T += HALF * m[i] * (cx**2 + cy**2) + HALF * J[i] * rate**2
        V += m[i] * G * (height + c[i] * sin(angle))
        vx, vy = vx - l[i] * rate * sin(angle), vy + l[i] * rate * cos(angle)
        height += l[i] * sin(angle)
    return {"T": T, "V": V, "Q": {"q1": u1, "q2": u2, "q3": u3}}


def slider_crank(x, torque=2):
    th, w, _ = x["theta"]
    r, l = R("0.04"), R("0.15")
    piston = r * cos(th) + sqrt(l**2 - r**2 * sin(th) ** 2)
    return {"T": HALF * R("0.02") * w**2 + HALF * R("0.8") * (piston.diff(th) * w) ** 2,
            "V": HALF * 2000 * (piston - l) ** 2, "Q": {"theta": torque}}


def leaking_mass(x, mu=R("0.9")):
    (X, vx, _), (Y, vy, _) = x["x"], x["y"]
    m0 = R("0.3")
    return {"T": HALF * (m0 + mu * X) * vx**2 + HALF * (m0 + mu * X**2 / 2) * vy**2,
            "V": mu * G * X**2 / 2 + m0 * G * X + 3 * asin(Y / 2) ** 2 / 2 + 3 * acos(X / 2)}


def swinging_atwood(x, M=3):
    (r, v, _), (th, w, _) = x["r"], x["theta"]
    return {"T": HALF * (M + 1) * v**2 + HALF * r**2 * w**2, "V": M * G * r - G * r * cos(th)}


def mass_chain(x, push=1):
    q = [0] + [x[f"x{i}"][0] for i in range(1, 7)] + [0]
    v = [x[f"x{i}"][1] for i in range(1, 7)]
    stretch = [b - a for a, b in zip(q, q[1:])]
    return {"T": sum(R(1, 4) * (i + 1) * v[i] ** 2 for i in range(6)),
            "V": sum(50 * s**2 + 100 * s**4 for s in stretch),
            "F": sum(R("0.1") * (b - a) ** 2 for a, b in zip(v, v[1:])), "Q": {"x4": push}}


def cases():
    def case(build, names, ranges=None, vary=None):
        return Case(f"tests/mechanisms/{build.__name__}.whirl", {n: 2 for n in names.split()},
                    build, ranges, vary)

    return [
        case(simple_pendulum, "theta", {"theta": (-6, 6)}, {"k": (0.25, 2)}),
        case(double_pendulum, "a b", {"a": (-6, 6), "b": (-6, 6)}, {"m1": (0.5, 2)}),
        case(triple_pendulum, "q1 q2 q3", {}, {"m3": (0.25, 2), "c": (0.25, 1)}),
        case(cart_pole, "x theta", {}, {"u": (-9, 9), "l": (0.25, 1)}),
        case(elastic_pendulum, "x y", {"y": (-2, -0.25)}, {"k": (50, 200)}),
        case(spherical_pendulum, "theta phi", {"theta": (0.25, 2.75)}),
        case(bead_on_hoop, "theta", {"theta'": (-9, 9)}),
        case(bead_on_wire, "x", {"x": (-1, 2)}, {"h": (0.5, 2)}),
        case(tan_well, "x", {"x": (-1.25, 1.25)}, {"U": (0.5, 3)}),
        case(kepler, "x y z", {"x": (0.25, 2)}, {"k": (1, 9)}),
        case(vortex, "x y", {"y": (0.125, 2)}, {"E": (0.25, 2)}),
        case(charged_particle, "x y z", {}, {"qB": (0.125, 1), "drive": (-1, 1)}),
        case(furuta, "alpha beta", {"alpha'": (-9, 9), "beta'": (-9, 9)}, {"tau": (-1, 1)}),
        case(symmetric_top, "phi theta psi", {"theta": (0.25, 2.75), "psi'": (20, 90)},
             {"m": (0.25, 1)}),
        case(quadratic_drag, "x z", {"x'": (-40, 40), "z'": (-40, 40)}, {"wind": (-9, 9)}),
        case(morse, "x1 x2", {"x1": (-1, 1), "x2": (1.5, 4)}, {"D": (1, 9)}),
        case(contact, "x", {"x": (-0.5, 0.5)}, {"E": (100, 900)}),
        case(planar_arm, "q1 q2 q3", {}, {"u1": (-9, 9), "u2": (-9, 9), "u3": (-9, 9)}),
        case(slider_crank, "theta", {"theta": (-9, 9), "theta'": (-40, 40)}, {"torque": (-9, 9)}),
        case(leaking_mass, "x y", {"x": (0.25, 1.75), "y": (-1.75, 1.75)}, {"mu": (0.25, 2)}),
        case(swinging_atwood, "r theta", {"r": (0.25, 2)}, {"M": (1, 5)}),
        case(mass_chain, "x1 x2 x3 x4 x5 x6", {}, {"push": (-9, 9)}),
    ]
