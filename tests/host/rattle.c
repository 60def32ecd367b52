#include "rattle.h"
#include "test.h"

rattle rattle_drawn(dice *d, rattle_kind kind) {
    rattle r = {.kind = kind, .step_s = pow(10.0, dice_between(d, -4.0, -2.0))};
    double *n = r.number;
    r.steps = 40 + (int)dice_one_of(d, 160);
    if (kind == BALL) {
        n[0] = pow(10.0, dice_between(d, -3.5, -1.7));
        n[1] = dice_one_of(d, 2) == 0 ? 0.0 : 9.81;
        n[2] = dice_one_of(d, 2) == 0 ? 1.0 : dice_between(d, 0.6, 1.0);
        n[3] = dice_one_of(d, 2) == 0 ? 1.0 : dice_between(d, 0.6, 1.0);
        r.place_m = n[0] * dice_between(d, 0.2, 0.8);
        r.speed_mps = n[0] / r.step_s * pow(10.0, dice_between(d, -0.5, 2.0));
    } else if (kind == HOLD) {
        n[1] = dice_between(d, 1.0, 20.0);
        n[0] = n[1] * r.step_s * pow(10.0, dice_between(d, -2.0, 1.0));
    } else {
        n[0] = pow(10.0, dice_between(d, -1.5, 0.3)) / r.step_s;
        n[0] *= n[0];
        n[2] = 0.4;
        n[3] = dice_between(d, 0.2, 0.35);
        n[1] = (n[2] - n[3]) * 9.81 / sqrt(n[0]) * dice_between(d, 0.5, 3.0);
    }
    return r;
}

void rattle_write(const rattle *r, char text[static LINKAGE_TEXT]) {
    const double *n = r->number;
    char more[600];
    if (r->kind == BALL) {
        snprintf(more, sizeof more,
                 "coordinate x [m]\nT = 1 [kg]*x'^2/2\nV = %.17g [N]*x\n"
                 "stop x >= 0 [m] restitution %.17g\nstop x <= %.17g [m] restitution %.17g\n"
                 "scene s { start x = %.17g [m], x' = %.17g [m/s]\n",
                 n[1], n[2], n[0], n[3], r->place_m, r->speed_mps);
    } else if (r->kind == HOLD) {
        snprintf(more, sizeof more,
                 "coordinate x [m]\nT = 1 [kg]*x'^2/2\nV = 0 [J]\nQ(x) = %.17g [N]\n"
                 "hold x while x' > %.17g [m/s]\nscene s { start x = 0\n",
                 n[1], n[0]);
    } else {
        snprintf(more, sizeof more,
                 "coordinate b [m]\ncoordinate y [m]\nT = 1 [kg]*b'^2/2 + 1 [kg]*y'^2/2\n"
                 "V = 0 [J]\nQ(y) = -%.17g [N/m]*(y + b)\n"
                 "friction y static %.17g kinetic %.17g normal 9.81 [N]\n"
                 "scene s { start b' = %.17g [m/s]\n",
                 n[0], n[2], n[3], n[1]);
    }
    snprintf(text, LINKAGE_TEXT, "mechanism rattle\n%sstep %.17g [s]\nuntil %.17g [s] }\n", more,
             r->step_s, r->step_s * r->steps);
}

void rattle_write_beside(const rattle *r, bool damped, double rate_radps, double size_m,
                         char text[static LINKAGE_TEXT]) {
    char own[LINKAGE_TEXT];
    rattle_write(r, own);
    char *kinetic = strstr(own, "\nT = ") + strlen("\nT = ");
    char *stored = strstr(own, "\nV = ") + strlen("\nV = ");
    char *start = strstr(own, "start ") + strlen("start ");
    stored[-5] = '\0';
    start[-6] = '\0';
    char law[160];
    char from[80];
    if (damped) {
        snprintf(law, sizeof law, "F = %.17g [N*s/m]*z'^2\nV = ", rate_radps);
        snprintf(from, sizeof from, "z' = %.17g [m/s]", size_m * rate_radps);
    } else {
        snprintf(law, sizeof law, "V = %.17g [N/m]*z^2 + ", rate_radps * rate_radps);
        snprintf(from, sizeof from, "z = %.17g [m]", size_m);
    }
    snprintf(text, LINKAGE_TEXT,
             "mechanism rattle\ncoordinate z [m]\n%.*sT = 1 [kg]*z'^2 + %s\n%s%swith ledger\n"
             "start %s, %s",
             (int)(kinetic - 4 - (own + 17)), own + 17, kinetic, law, stored, from, start);
}

static double ball_m(rattle *r, double t) {
    const double gap = r->number[0];
    const double g = r->number[1];
    for (;;) {
        const double z = r->place_m;
        const double v = r->speed_mps;
        const double up = v * v - 2.0 * g * (gap - z);
        const bool rises = v > 0.0 && up >= 0.0;
        double next = (double)INFINITY;
        if (rises) {
            next = g > 0.0 ? 2.0 * (gap - z) / (v + sqrt(up)) : (gap - z) / v;
        } else if (g > 0.0) {
            next = (v + sqrt(v * v + 2.0 * g * z)) / g;
        } else if (v < 0.0) {
            next = z / -v;
        }
        if (r->at_s + next > t || (z == 0.0 && next < 1e-10)) {
            const double dt = z == 0.0 && next < 1e-10 ? 0.0 : t - r->at_s;
            return z + v * dt - g * dt * dt / 2.0;
        }
        r->at_s += next;
        r->place_m = rises ? gap : 0.0;
        r->speed_mps = -(v - g * next) * r->number[rises ? 3 : 2];
    }
}

static double hold_m(const rattle *r, double t) {
    const double period = r->number[0] / r->number[1];
    const double rest = fmod(t, period);
    return (t - rest) / period * r->number[0] * period / 2.0 + r->number[1] * rest * rest / 2.0;
}

/* Position of a body on a moving belt, relative to the belt. The body sticks until the spring pulls with the static
 * friction. Then it oscillates about the point where the spring pulls with the kinetic friction. It sticks again
 * when its speed is that of the belt. */
static double belt_m(const rattle *r, double t) {
    const double *n = r->number;
    const double w = sqrt(n[0]);
    const double breaks = n[2] * 9.81 / n[0];
    const double middle = n[3] * 9.81 / n[0];
    const double above = breaks - middle;
    const double slip = (3.14159265358979323846 + 2.0 * atan(n[1] / (w * above))) / w;
    if (t < breaks / n[1]) {
        return 0.0;
    }
    const double cycle = slip + 2.0 * above / n[1];
    const double in = fmod(t - breaks / n[1], cycle);
    const double x = in < slip ? middle + above * cos(w * in) + n[1] / w * sin(w * in)
                               : middle - above + n[1] * (in - slip);
    return x - n[1] * t;
}

double rattle_truth_m(rattle *r, double t) {
    return r->kind == BALL ? ball_m(r, t) : r->kind == HOLD ? hold_m(r, t) : belt_m(r, t);
}
