"""Exact SI values of the units that the transcriptions need."""
from sympy import Rational as R, pi

INCH = R("0.0254")
FOOT = 12 * INCH
LB = R("0.45359237")
LBF = LB * R("9.80665")
SLUG = LBF / FOOT  # times 1 s^2
DEG = pi / 180
RPM = 2 * pi / 60
