#!/bin/sh
# swing.sh WHIRL cycles|law: the swing of disc 33 about the line BC of the driven hinge, cycle by cycle.
#
# phi = theta2 - theta1 is the only coordinate besides the cyclic theta1. So the total angular momentum is L = M t, and
# phi swings under a Hamiltonian that changes with L alone. If L changes slowly, the action is constant: the integral of
# p dphi over a cycle. With a = m r^2 and b = I + m r^2:
#   p = (b + a cos phi) theta1' + b phi',   L = (a + b + 2 a cos phi) theta1' + (b + a cos phi) phi'
# `cycles` runs the scene. For each cycle it prints the middle time, amplitude [rad], action [J s] and mean energy of
# the swing [J]: the kinetic energy minus that of a rigid rotation with the same L.
# `law` runs nothing. It prints `time,amplitude` for a constant action of 7 J s. At amplitude A the action is 4 L times
# the integral from 0 to A of
#   sqrt((b - B^2/C) (1/C(A) - 1/C(phi))),   B = b + a cos phi,   C(phi) = a + b + 2 a cos phi
set -eu
if [ "${2:?usage: swing.sh WHIRL cycles|law}" = law ]; then
    awk 'function C(phi) { return a + b + 2 * a * cos(phi) }
    BEGIN {
        a = 2 * 0.3 * 0.3; b = 1.5 * a; n = 2000
        print "time,amplitude"
        for (A = 1.04; A < 2.0; A += 0.02) {
            sum = 0
            for (i = 0; i < n; i++) { # with phi = A sin u, the root vanishes at the end of the swing
                u = (i + 0.5) / n * 1.5707963267948966
                phi = A * sin(u)
                B = b + a * cos(phi)
                sum += sqrt((b - B * B / C(phi)) * (1 / C(A) - 1 / C(phi))) * A * cos(u)
            }
            printf "%.6f,%.2f\n", 7 / (2 * 4 * sum * 1.5707963267948966 / n), A
        }
    }'
    exit
fi
"$1" run driven_hinge_from_rest --quiet --columns - | awk '
    BEGIN { a = 2 * 0.3 * 0.3; b = 1.5 * a; print "time,amplitude,action,swing_energy" }
    /^%/ { next }
    {
        w = $4; rate = $5 - $4; phi = $3 - $2
        p = (b + a * cos(phi)) * w + b * rate
        L = (a + b + 2 * a * cos(phi)) * w + (b + a * cos(phi)) * rate
        # a cycle is from one upward passage of phi = 0 to the next
        ends = n++ > 0 && before < 0 && phi >= 0
        part = ends ? -before / (phi - before) : 1
        area += (p_before + p) / 2 * part * (phi - before)
        if (ends) {
            crossed = $1 - (1 - part) * 0.001
            if (since != "") printf "%.6f,%.6f,%.8f,%.8f\n", (since + crossed) / 2, (high - low) / 2, area, sum / points
            since = crossed
            area = (p_before + p) / 2 * (1 - part) * (phi - before)
            high = low = sum = points = 0
        }
        if (phi > high) high = phi
        if (phi < low) low = phi
        sum += (a * w * w + b * $5 * $5) / 2 + a * w * $5 * cos(phi) - L * L / (2 * (3 * a + b))
        points++
        before = phi; p_before = p
    }'
