"""The systems of tests/mechanisms that are given by equations, transcribed by hand."""
from sympy import Rational as R, cos, exp, log, sin

from derive import Case


def lorenz(s, rho=28):
    (x, dx), (y, dy), (z, dz) = s["x"], s["y"], s["z"]
    return [dx - 10 * (y - x), dy - (x * (rho - z) - y), dz - (x * y - R(8, 3) * z)]


def van_der_pol(s, mu=R("1.5"), e=R("0.3")):
    x, dx, ddx = s["x"]
    return [ddx / 4 - mu * (1 - (x / R("0.8")) ** 2) * dx / 2 + x - e]


def jerk(s, a=R("2.017")):
    x, dx, ddx, dddx = s["x"]
    return [dddx + a * ddx - dx**2 + x + x**3 / 5]


def implicit_pair(s, u=R("0.75")):
    (x, _, ax), (p, w, ap) = s["x"], s["phi"]
    e = R("0.3")
    return [2 * ax + e * ap * cos(p) - e * w**2 * sin(p) + 30 * x,
            R("0.5") * ap + e * ax * cos(p) + R("0.05") * w - u - exp(-(x**2))]


def mixed_order(s):
    (x, dx, ddx, dddx), (y, dy, ddy), (z, dz) = s["x"], s["y"], s["z"]
    return [2 * dddx + ddy + x - sin(y),
            ddy - dddx * (1 + y**2) / 4 + dz / 2 + dy * ddx - cos(x),
            dz + z + ddy / 3 - dx - log(2 + z**2)]


def dc_motor(s, volts=12):
    (th, w, a), (i, di) = s["theta"], s["current"]
    k = R("0.05")
    return [R("0.0002") * a + R("0.0001") * w + R("0.04") * sin(th) - k * i,
            R("0.0012") * di + R("0.6") * i + k * w - volts]


def dc_motor_pendulum(s, volts=6):
    (th, w, a), (ph, wp, ap), (i, di) = s["theta"], s["phi"], s["current"]
    twist = 12 * (ph - th) + R("0.01") * (wp - w)
    return [R("0.25") * R("0.4") ** 2 * a + R("0.25") * R("9.80665") * R("0.4") * sin(th) - twist,
            R("0.0005") * ap + R("0.002") * wp + twist - R("0.08") * i,
            R("0.004") * di + R("0.75") * i + R("0.08") * wp - volts]


def beam(s, load=0, P=40):
    w, _, ddw, _, ddddw = s["w"]
    return [250 * ddddw + P * ddw + 1000 * w + 5000 * w**3 - load]


def coupled_ten(s, k3=150):
    def at(i, order):
        return s[f"x{i}"][order] if 0 <= i < 10 else 0

    return [R(1, 2) * (4 * at(i, 2) + at(i - 1, 2) + at(i + 1, 2))
            + 400 * (2 * at(i, 0) - at(i - 1, 0) - at(i + 1, 0)) + k3 * at(i, 0) ** 3
            for i in range(10)]


def cases():
    def case(build, order, ranges=None, vary=None):
        return Case(f"tests/mechanisms/{build.__name__}.whirl", order, build, ranges, vary, True)

    return [
        case(lorenz, {"x": 1, "y": 1, "z": 1}, {"x": (-20, 20), "y": (-20, 20), "z": (0, 40)},
             {"rho": (10, 40)}),
        case(van_der_pol, {"x": 2}, {}, {"mu": (0.25, 4), "e": (-1, 1)}),
        case(jerk, {"x": 3}, {}, {"a": (1, 3)}),
        case(implicit_pair, {"x": 2, "phi": 2}, {}, {"u": (-3, 3)}),
        case(mixed_order, {"x": 3, "y": 2, "z": 1}),
        case(dc_motor, {"theta": 2, "current": 1}, {"theta'": (-99, 99), "current": (-9, 9)},
             {"volts": (-12, 12)}),
        case(dc_motor_pendulum, {"theta": 2, "phi": 2, "current": 1}, {"current": (-9, 9)},
             {"volts": (-12, 12)}),
        case(beam, {"w": 4}, {}, {"load": (-9, 9), "P": (-90, 90)}),
        case(coupled_ten, {f"x{i}": 2 for i in range(10)}, {}, {"k3": (0, 200)}),
    ]
