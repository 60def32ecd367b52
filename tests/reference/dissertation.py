"""Mechanisms of Almesallmy (2006), chapters II and III, transcribed by hand."""
from sympy import Rational as R, cos, diff, pi, sin, sqrt

from derive import Case
from units import INCH, LB, LBF, RPM


def spherical_particle(x, m=1, g=R("9.81")):
    (r, vr, _), (th, vth, _), (_, vph, _) = x["r"], x["theta"], x["phi"]
    return {
        "T": R(1, 2) * m * (vr**2 + r**2 * vth**2 + r**2 * sin(th) ** 2 * vph**2),
        "V": m * g * r * cos(th),
    }


def cartesian_particle(x, m=1, g=R("9.81")):
    (_, vx, _), (_, vy, _), (z, vz, _) = x["x"], x["y"], x["z"]
    return {"T": m * (vx**2 + vy**2 + vz**2) / 2, "V": m * g * z}


M1, M2 = R("0.72") * LBF / INCH, R("1.36") * LBF / INCH  # lbf s^2/in, as in the dissertation's listings
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
    """The mechanism `build` with masses in pounds instead of lbf s^2/in."""
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


def speed2(position, q, v):
    """Squared speed of a point whose position depends on the coordinates q."""
    return sum(sum(diff(c, a) * b for a, b in zip(q, v)) ** 2 for c in position)


def thomson_unit(carriage, a, b, r):
    """Positions of the sun gear, disc 26 and disc 33 of one unit."""
    X, Y = carriage
    disc26 = (X + 2 * r * cos(a), Y + 2 * r * sin(a))
    disc33 = (disc26[0] + r * cos(2 * a) + r * cos(b), disc26[1] + r * sin(2 * a) + r * sin(b))
    return carriage, disc26, disc33


def thomson_units(x, units, m, r, M, spin):
    """Units (arm, disc 33, +1 or -1 for the torque's sense) on one carriage, free in the plane."""
    q, v = [s[0] for s in x.values()], [s[1] for s in x.values()]
    inertia = m * r**2 / 2
    T, Q = 0, {}
    for arm, disc, sense in units:
        places = thomson_unit((x["X"][0], x["Y"][0]), x[arm][0], x[disc][0], r)
        T += sum(m * speed2(place, q, v) / 2 for place in places)
        T += inertia * (2 * x[arm][1]) ** 2 / 2
        T += inertia * x[disc][1] ** 2 / 2 if spin else 0
        Q[arm] = sense * M
    return {"T": T, "Q": Q}


def thomson_plane(x, m=2, r=R("0.3"), M=-2, spin=False):
    return thomson_units(x, [("theta1", "theta2", 1)], m, r, M, spin)


def thomson_plane_spin(x, m=2, r=R("0.3"), M=-2):
    return thomson_plane(x, m, r, M, True)


def thomson_pair(x, m=2, r=R("0.3"), M=-2, spin=False):
    units = [("theta1a", "theta2a", 1), ("theta1b", "theta2b", -1)]
    return thomson_units(x, units, m, r, M, spin)


def thomson_pair_spin(x, m=2, r=R("0.3"), M=-2):
    return thomson_pair(x, m, r, M, True)


def ringed_weights(x, masses, ring_radius, shift, rest):
    """Weights at equal angles, held by a ring whose centre is `shift` from the wheel's, on a carriage
    with wheel of the mass `rest`, free in the plane."""
    q, v = [s[0] for s in x.values()], [s[1] for s in x.values()]
    X, Y = x["X"][0], x["Y"][0]
    T = rest * (x["X"][1] ** 2 + x["Y"][1] ** 2) / 2
    for i, mass in enumerate(masses):
        p = x["theta"][0] + 2 * pi * i / len(masses)
        radius = shift * cos(p) + sqrt(ring_radius**2 - shift**2 * sin(p) ** 2)
        T += mass * speed2((X + radius * cos(p), Y + radius * sin(p)), q, v) / 2
    return T


def laskowitz(x, m=R("0.5"), m_1=None, ring=R("0.2"), e=R("0.05"), torque=R("0.5")):
    masses = [m if m_1 is None else m_1] + 5 * [m]
    T = ringed_weights(x, masses, ring, e, 6) + ring**2 / 2 * x["theta"][1] ** 2 / 2
    return {"T": T, "Q": {"theta": torque}}


def laskowitz_shifting(x, m=R("0.5"), k=4000, torque=0):
    e, ve, _ = x["e"]
    T = ringed_weights(x, 6 * [m], R("0.2"), e, 5)
    T += R("0.04") / 2 * x["theta"][1] ** 2 / 2
    T += ((x["X"][1] + ve) ** 2 + x["Y"][1] ** 2) / 2
    return {"T": T, "V": k * (e - R("0.05")) ** 2 / 2, "F": 200 * ve**2 / 2,
            "Q": {"theta": torque}}


def cuff(x, m=R("0.25"), m_a=None, e=R("0.06"), torque=R("0.3")):
    masses = [m if m_a is None else m_a] + 7 * [m]
    T = ringed_weights(x, masses, R("0.15"), e, 5) + R("0.0225") / 2 * x["theta"][1] ** 2 / 2
    return {"T": T, "Q": {"theta": torque}}


ARM, ARM_LENGTH = R("0.152") * LB, R("7.25") * INCH
DISC, DISC_RADIUS = R("0.15") * LB, R("6.5") * INCH


def eccentric(x, duty=0, carriage=3 * 2 * (ARM + DISC)):
    """Two arms as slender rods, two sets of discs as points, on a carriage; ratio 1/3."""
    th, w, _ = x["theta"]
    vX = x["X"][1] if "X" in x else 0

    def speed2(radius):  # squared speed of a point at `radius` on an arm
        return (vX - radius * w * sin(th)) ** 2 + (radius * w * cos(th)) ** 2

    spin = 2 * ARM * ARM_LENGTH**2 / 12 + R("0.0005")
    return {
        "T": carriage * vX**2 / 2 + ARM * speed2(ARM_LENGTH / 2) + DISC * speed2(DISC_RADIUS)
        + spin * w**2 / 2,
        "F": R("0.001") * w**2 / 2,
        "Q": {"theta": R("1.5") * (duty - w / (600 * RPM))},
    }


def eccentric_ratio(x, duty=R("0.573"), ratio=R(1, 3)):
    """The same with a flywheel of 100 kg m^2 and the carriage's weight from the ratio; the carriage's
    equation times ratio/(its mass of weights), so that the ratio may be zero."""
    th, w, a = x["theta"]
    aX = x["X"][2]
    weights = 2 * (ARM + DISC)
    S = 2 * (ARM * ARM_LENGTH / 2 + DISC * DISC_RADIUS)
    axis = 2 * (ARM * ARM_LENGTH**2 / 3 + DISC * DISC_RADIUS**2) + 100
    force = S * (w**2 * cos(th) + a * sin(th)) - weights * aX  # pin force, moves the carriage
    return [axis * a - S * aX * sin(th) - R("1.5") * (duty - w / (600 * RPM)) + R("0.001") * w,
            aX - ratio / weights * force]


def cases():
    spin = {"theta1'": (-12, 12), "theta2'": (-12, 12)}
    turning = {name: (-9, 9) for name in ("theta1", "theta2", "theta1a", "theta2a", "theta1b",
                                          "theta2b")}
    turning |= {name + "'": (-12, 12) for name in turning}
    plane_only = {"X": 2, "Y": 2}
    plane = {"theta1": 2, "theta2": 2, **plane_only}
    pair = {"theta1a": 2, "theta2a": 2, "theta1b": 2, "theta2b": 2, **plane_only}
    wheel = {"theta": 2, **plane_only}
    wheeling = {"theta": (-9, 9), "theta'": (-25, 25)}
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
        Case("core/models/cartesian_particle.whirl", {"x": 2, "y": 2, "z": 2},
             cartesian_particle, {}, {"g": (1, 12)}),
        Case("core/models/thomson_plane.whirl:thomson_plane", plane, thomson_plane, turning,
             {"M": (-4, 4), "m": (1, 3), "r": (0.25, 0.5)}),
        Case("core/models/thomson_plane.whirl:thomson_pair", pair, thomson_pair, turning,
             {"M": (-4, 4), "r": (0.25, 0.5)}),
        Case("core/models/laskowitz.whirl:laskowitz", wheel, laskowitz, wheeling,
             {"m_1": (0.25, 1), "e": (0, 0.125), "torque": (-2, 2)}),
        Case("core/models/laskowitz.whirl:laskowitz_shifting", {"theta": 2, "e": 2, **plane_only},
             laskowitz_shifting, {**wheeling, "e": (-0.125, 0.125)}, {"m": (0.25, 1)}),
        Case("core/models/cuff.whirl", wheel, cuff, wheeling,
             {"m_a": (0.25, 1), "e": (0, 0.125), "torque": (-2, 2)}),
        Case("core/models/eccentric.whirl:eccentric_ratio", {"theta": 2, "X": 2}, eccentric_ratio,
             {"theta": (-9, 9), "theta'": (-50, 50)}, {"ratio": (0, 2)}, outright=True),
        # scenes, for their effects and changed parameters
        Case("core/models/two_mass.whirl:two_mass_relative_physical", {"X": 2, "Y": 2},
             physical(masses_relative), {"X": (-0.25, 0.25), "Y": (-0.25, 0.25)}),
        Case("core/models/epicyclic.whirl:epicyclic_rail_drag", {"theta": 2, "X": 2},
             epicyclic_rail_drag, {"theta": (-9, 9), "theta'": (-20, 20)}, {"b": (0.25, 2)}),
        Case("core/models/thomson.whirl:thomson_a_spin", {"theta1": 2, "theta2": 2, "X": 2},
             thomson_spin, {"theta1": (-9, 9), "theta2": (-9, 9), **spin}, {"r": (0.25, 0.5)}),
        Case("core/models/thomson_plane.whirl:thomson_plane_a", plane, thomson_plane_spin, turning),
        Case("core/models/thomson_plane.whirl:thomson_pair_a", pair, thomson_pair_spin, turning),
        Case("core/models/eccentric.whirl:eccentric_fixed", {"theta": 2}, eccentric,
             {"theta": (-9, 9), "theta'": (-50, 50)}, {"duty": (0, 1)}),
        Case("core/models/eccentric.whirl:eccentric", {"theta": 2, "X": 2}, eccentric,
             {"theta": (-9, 9), "theta'": (-50, 50)}, {"duty": (0, 1)}),
    ]
