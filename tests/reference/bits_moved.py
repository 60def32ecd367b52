#!/usr/bin/env python3
"""Two programs whose bits differ: are the errors of the one worse than the other's beyond luck?

One run says nothing: a rounding falls this way or that. So each scene runs from 40 starts, near its own, with both programs in float, and in double for the reference: the second program at a quarter of the step,
where the method's error is far below float's rounding. The error of a run is the mean over its records of the
largest difference of any position or rate, divided by the largest value of its kind: at one moment alone an
error may be small by chance in all 40.

The driven rig forgets its start: it runs with 40 motors instead.

    python3 tests/reference/bits_moved.py OLD/whirl NEW/whirl [SCENES...]

Prints the median and the worst error of both programs, float and double, and the ratio of the medians.
Exit status 1 when a median rose by more than half: 40 errors of one distribution do that about never.
"""
import statistics
import subprocess
import sys

RUNS = 40
RECORDS = 25
# scene, what is set to 40 values, the first less one step, the step, end of the run [s]
SCENES = [
    ("epicyclic_from_rest", "--start", "theta", 0, 0.02, 5),
    ("epicyclic_conserved", "--start", "theta", 0, 0.02, 5),
    ("thomson_a", "--start", "theta1", 0, 0.02, 2),
    ("thomson_a_conserved", "--start", "theta1", 0, 0.02, 2),
    ("thomson_b_spin", "--start", "theta1", 0, 0.02, 1),
    ("thomson_plane_a", "--start", "theta1", 0, 0.02, 1),
    ("driven_hinge_from_rest", "--start", "theta1", 0, 0.02, 2),
    ("rig_fixed", "--set", "stall", 1.3, 0.013, 5),
    ("carriage_free", "--start", "theta", 0, 0.02, 2),
    ("cuff_equal", "--start", "theta", 0, 0.02, 1),
    ("laskowitz_shifted", "--start", "theta", 0, 0.02, 1),
    ("halvorson_smooth", "--start", "theta", 0, 0.02, 1),
    ("spherical_flight", "--start", "phi", 0, 0.02, 1),
    ("two_mass_relative", "--start", "X", 0, 0.001, 2),
]


def records(program, scene, setting, until, more):
    command = [program, "run", scene, "--quiet"] + setting + ["--until", f"{until} s",
               "--csv", "-", "--every", f"{until / RECORDS} s"] + more
    lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    names = lines[0].split(",")
    state = [i for i, name in enumerate(names) if name.startswith("der(") or f"der({name})" in names]
    rows = [[float(x) for x in line.split(",")] for line in lines[2:]]
    return [{names[i]: row[i] for i in state} for row in rows]


def error(run, exact):
    size = {rate: max(abs(v) for at in exact for n, v in at.items() if n.startswith("der(") == rate)
            for rate in (False, True)}
    return statistics.mean(max(abs(a[n] - b[n]) / (size[n.startswith("der(")] or 1.0) for n in b)
                           for a, b in zip(run, exact))


def step_of(program, scene):
    text = subprocess.run([program, "derive", scene, "--as", "c"], capture_output=True, text=True,
                          check=True).stdout
    return float.fromhex(text.split(".step_s = WH_R(")[1].split(")")[0])


def main():
    old, new = sys.argv[1:3]
    worse = 0
    print(f"{'scene, ' + str(RUNS) + ' starts':26} {'number':7} {'old: median':>12} {'worst':>9}"
          f" {'new: median':>12} {'worst':>9} {'ratio':>6}")
    for scene, option, name, first, step, until in SCENES:
        if sys.argv[3:] and scene not in sys.argv[3:]:
            continue
        h = step_of(new, scene)
        starts = [[option, f"{name}={first + step * (k + 1):.6g}"] for k in range(RUNS)]
        exact = [records(new, scene, s, until, ["--step", f"{h / 4!r} s"]) for s in starts]
        for number in ("float", "double"):
            errors = [[error(records(program, scene, s, until, ["--number", number]), e)
                       for s, e in zip(starts, exact)] for program in (old, new)]
            middle = [statistics.median(e) for e in errors]
            ratio = middle[1] / middle[0] if middle[0] > 0 else 1.0
            worse += ratio > 1.5 and middle[1] > 1e-15
            print(f"{scene:26} {number:7} {middle[0]:12.2g} {max(errors[0]):9.2g}"
                  f" {middle[1]:12.2g} {max(errors[1]):9.2g} {ratio:6.2f}", flush=True)
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
