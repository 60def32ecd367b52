# multistep.awk: Adams-Bashforth-Moulton of four steps in PEC form, one evaluation a step, on mk/price/separable.whirl, written by
# hand: is it worth a history in a scene's state? Prints how far the whole state is off after 2 s, worst of four times, beside
# the classic Runge-Kutta method written here, too (which tests/tools/precision measures of the program's own). With
# -v hold=2e-3 it starts again every 2 ms, as it must when inputs jump. `awk -f mk/price/multistep.awk`
function accelerations(a, b) {
    fa = (-0.8 * sin(a) - 0.5 * sin(a - b)) / 0.02
    fb = (-0.8 * sin(b) + 0.5 * sin(a - b)) / 0.02
}

function begin() {
    pi = atan2(0, -1)
    a = 80 * pi / 180; b = -30 * pi / 180; u = 0; v = 0
}

function runge_kutta(h,    i, da, db, du, dv, ca, cb, cu, cv, w, part) {
    ca = a; cb = b; cu = u; cv = v
    da = db = du = dv = 0
    for (i = 0; i < 4; i++) {
        w = i == 1 || i == 2 ? 2 : 1
        accelerations(ca, cb)
        da += w * cu; db += w * cv; du += w * fa; dv += w * fb
        part = i == 2 ? h : h / 2
        ca = a + part * cu; cb = b + part * cv
        cu = u + part * fa; cv = v + part * fb
    }
    a += h / 6 * da; b += h / 6 * db; u += h / 6 * du; v += h / 6 * dv
}

function remember(i) {
    for (i = 3; i > 0; i--) { pa[i] = pa[i - 1]; pb[i] = pb[i - 1]; pu[i] = pu[i - 1]; pv[i] = pv[i - 1] }
    pa[0] = fa; pb[0] = fb; pu[0] = u; pv[0] = v
}

function predicted(x) { return 55 * x[0] - 59 * x[1] + 37 * x[2] - 9 * x[3] }
function corrected(now, x) { return 9 * now + 19 * x[0] - 5 * x[1] + x[2] }

function adams(h) {
    accelerations(a + h / 24 * predicted(pu), b + h / 24 * predicted(pv))
    u += h / 24 * corrected(fa, pa); v += h / 24 * corrected(fb, pb)
    a += h / 24 * corrected(u, pu); b += h / 24 * corrected(v, pv)
}

# The states at four times; returns evaluations.
function run(steps, multi, at,    i, known, evaluations, held) {
    begin()
    known = evaluations = 0
    held = hold ? int(hold * steps / 2 + 0.5) : steps
    for (i = 0; i < steps; i++) {
        if (i % held == 0) { known = 0 }
        if (!multi) { runge_kutta(2 / steps); evaluations += 4 }
        else if (known < 3) {
            accelerations(a, b); remember(); runge_kutta(2 / steps); evaluations += 4
            if (++known == 3) { accelerations(a, b); remember(); evaluations++ }
        } else { adams(2 / steps); remember(); evaluations++ }
        if ((i + 1) % (steps / 4) == 0) {
            at[(i + 1) / (steps / 4), 1] = a; at[(i + 1) / (steps / 4), 2] = b
            at[(i + 1) / (steps / 4), 3] = u; at[(i + 1) / (steps / 4), 4] = v
        }
    }
    return evaluations
}

function distance(x, y,    t, c, sum, worst) {
    worst = 0
    for (t = 1; t <= 4; t++) {
        sum = 0
        for (c = 1; c <= 4; c++) { sum += (x[t, c] - y[t, c]) ^ 2 }
        if (sqrt(sum) > worst) { worst = sqrt(sum) }
    }
    return worst
}

BEGIN {
    run(32000, 0, exact)
    print "step_us rk4 evaluations_s abm4 evaluations_s"
    for (n = hold ? 1000 : 248; n <= 16000; n *= 2) {
        if (hold && hold * n / 2 < 1) { continue }
        r = run(n, 0, at); er = distance(at, exact)
        m = run(n, 1, at); em = distance(at, exact)
        printf "%g %.3g %d %.3g %d\n", 2e6 / n, er, r / 2, em, m / 2
    }
}
