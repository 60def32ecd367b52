"""Mechanisms of Almesallmy (2006), chapters II and III, transcribed by hand."""
from sympy import Rational as R, cos, sin

from derive import Case
from units import INCH, LB, LBF, RPM


def spherical_particle(x, m=1, g=R("9.81")):
    (r, vr, _), (th, vth, _), (_, vph, _) = x["r"], x["theta"], x["phi"]
    return {
        "T": R(1, 2) * m * (vr**2 + r**2 * vth**2 + r**2 * sin(th) ** 2 * vph**2),
        "V": m * g * r * cos(th),
    }


M1, M2 = R("0.72") * LBF / INCH, R("1.36") * LBF / INCH  # lbf s^2/in, as the listings have them
K = 50 * LBF / INCH
C = LBF / INCH  # 1 lbf s/in


def masses_absolute(x, m1=M1, m2=M2, K1=K, K2=K, A=C, B=C):
    (X, vX, _), (Y, vY, _) = x["X"], x["Y"]
    L1, L2 = R("2.35") * INCH, 2 * INCH
    return {
        "T": m1 * vX**2 / 2 + m2 * vY**2 / 2,
        "V": K1 * (X - L1) ** 2 / 2 + K2 * ((Y - X) - L2) ** 2 / 2,
        "F": B * (vY - vX) ** 2 / 2 + A * vY**2 / 2,
    }


def masses_relative(x, m1=M1, m2=M2, K1=K, K2=K, A=C, B=C):
    (X, vX, _), (Y, vY, _) = x["X"], x["Y"]
    return {
        "T": m1 * vX**2 / 2 + m2 * (vY + vX) ** 2 / 2,
        "V": K1 * X**2 / 2 + K2 * Y**2 / 2,
        "F": B * vY**2 / 2 + A * (vY + vX) ** 2 / 2,
    }


def physical(build):
    """The same with real pounds of mass."""
    return lambda x: build(x, m1=R("0.72") * LB, m2=R("1.36") * LB)


def epicyclic(x, m=2, r=R("0.3"), M=2):
    (th, w, _), (_, vX, _) = x["theta"], x["X"]
    inertia = m * r**2 / 2
    return {
        "T": m * vX**2 / 2
        + m * ((vX - 2 * r * w * sin(th)) ** 2 + (2 * r * w * cos(th)) ** 2) / 2
        + inertia * (2 * w) ** 2 / 2,
        "Q": {"theta": M},
    }


def epicyclic_rail_drag(x, m=2, r=R("0.3"), M=2, b=R("0.5")):
    return {**epicyclic(x, m, r, M), "F": b * x["X"][1] ** 2 / 2}


def driven_hinge(x, m=2, r=R("0.3"), M=-2):
    (a, wa, _), (b, wb, _) = x["theta1"], x["theta2"]
    inertia = m * r**2 / 2
    return {
        "T": m * r**2 * wa**2 / 2
        + (inertia + m * r**2) * wb**2 / 2
        + m * r**2 * wa * wb * cos(b - a),
        "Q": {"theta1": M},
    }


def thomson(x, m=2, r=R("0.3"), M=-2):
    (a, wa, _), (b, wb, _), (_, vX, _) = x["theta1"], x["theta2"], x["X"]
    inertia = m * r**2 / 2
    disc26 = (vX - 2 * r * wa * sin(a)) ** 2 + (2 * r * wa * cos(a)) ** 2
    disc33 = (2 * wa * r * (cos(a) + cos(2 * a)) + r * wb * cos(b)) ** 2 + (
        vX - 2 * wa * r * (sin(a) + sin(2 * a)) - r * wb * sin(b)
    ) ** 2
    return {
        "T": m * vX**2 / 2 + m * disc26 / 2 + 2 * inertia * wa**2 + m * disc33 / 2,
        "Q": {"theta1": M},
    }


def thomson_spin(x, m=2, r=R("0.3"), M=-2):
    energies = thomson(x, m, r, M)
    energies["T"] += m * r**2 / 2 * x["theta2"][1] ** 2 / 2
    return energies


ARM, ARM_LENGTH = R("0.152") * LB, R("7.25") * INCH
DISC, DISC_RADIUS = R("0.15") * LB, R("6.5") * INCH


def eccentric(x, duty=0, carriage=3 * 2 * (ARM + DISC)):
    """Two arms as slender rods, two sets of discs as points, on a carriage; ratio 1/3."""
    th, w, _ = x["theta"]
    vX = x["X"][1] if "X" in x else 0

    def speed2(radius):  # of a point at `radius` on the turning line
        return (vX - radius * w * sin(th)) ** 2 + (radius * w * cos(th)) ** 2

    spin = 2 * ARM * ARM_LENGTH**2 / 12 + R("0.0005")
    return {
        "T": carriage * vX**2 / 2 + ARM * speed2(ARM_LENGTH / 2) + DISC * speed2(DISC_RADIUS)
        + spin * w**2 / 2,
        "F": R("0.001") * w**2 / 2,
        "Q": {"theta": R("1.5") * (duty - w / (600 * RPM))},
    }


def cases():
    spin = {"theta1'": (-12, 12), "theta2'": (-12, 12)}
    return [
        Case("core/models/spherical_particle.whirl", {"r": 2, "theta": 2, "phi": 2},
             spherical_particle, {"r": (0.5, 5), "theta": (0.25, 2.75)}, {"g": (1, 12)}),
        Case("core/models/two_mass.whirl:masses_absolute", {"X": 2, "Y": 2}, masses_absolute,
             {"X": (0, 0.25), "Y": (0.125, 0.5)}, {"m1": (50, 200), "A": (50, 250)}),
        Case("core/models/two_mass.whirl:masses_relative", {"X": 2, "Y": 2}, masses_relative,
             {"X": (-0.25, 0.25), "Y": (-0.25, 0.25)}, {"m1": (50, 200), "K2": (5000, 9000)}),
        Case("core/models/epicyclic.whirl", {"theta": 2, "X": 2}, epicyclic,
             {"theta": (-9, 9), "theta'": (-20, 20)},
             {"M": (-4, 4), "m": (1, 3), "r": (0.25, 0.5)}),
        Case("core/models/driven_hinge.whirl", {"theta1": 2, "theta2": 2}, driven_hinge,
             {"theta1": (-9, 9), "theta2": (-9, 9), **spin}, {"M": (-4, 4), "m": (1, 3)}),
        Case("core/models/thomson.whirl", {"theta1": 2, "theta2": 2, "X": 2}, thomson,
             {"theta1": (-9, 9), "theta2": (-9, 9), **spin},
             {"M": (-4, 4), "m": (1, 3), "r": (0.25, 0.5)}),
        # scenes, for their effects and changed parameters
        Case("core/models/two_mass.whirl:two_mass_relative_physical", {"X": 2, "Y": 2},
             physical(masses_relative), {"X": (-0.25, 0.25), "Y": (-0.25, 0.25)}),
        Case("core/models/epicyclic.whirl:epicyclic_rail_drag", {"theta": 2, "X": 2},
             epicyclic_rail_drag, {"theta": (-9, 9), "theta'": (-20, 20)}, {"b": (0.25, 2)}),
        Case("core/models/thomson.whirl:thomson_a_spin", {"theta1": 2, "theta2": 2, "X": 2},
             thomson_spin, {"theta1": (-9, 9), "theta2": (-9, 9), **spin}, {"r": (0.25, 0.5)}),
        Case("core/models/eccentric.whirl:eccentric_fixed", {"theta": 2}, eccentric,
             {"theta": (-9, 9), "theta'": (-50, 50)}, {"duty": (0, 1)}),
        Case("core/models/eccentric.whirl:eccentric", {"theta": 2, "X": 2}, eccentric,
             {"theta": (-9, 9), "theta'": (-50, 50)}, {"duty": (0, 1)}),
    ]
