"""Systems of tests/mechanisms that are given by equations outright, transcribed by hand."""
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
    ]
