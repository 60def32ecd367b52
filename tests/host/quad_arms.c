#include "quad_arms.h"

enum { TERMS = 16 };

/* The Taylor series of sin(x) (`from` = 1) or cos(x) (`from` = 0) for |x| below an eighth turn. */
static quad series(quad x, int from) {
    quad sum = 1;
    for (int i = TERMS; i > 0; i--) {
        sum = 1 - x * x * sum / (quad)((from + 2 * i - 1) * (from + 2 * i));
    }
    return from == 1 ? x * sum : sum;
}

static quad wave(quad rad, int quarters) {
    const quad quarter =
        (quad)0x1.921fb54442d18p+0 + (quad)0x1.1a62633145c07p-54 + (quad)-0x1.f1976b7ed8fbcp-110;
    const quad turns = rad / quarter;
    const long whole = (long)(turns + (turns < 0 ? (quad)-0.5 : (quad)0.5));
    const quad rest = rad - (quad)whole * quarter;
    switch ((whole + quarters) & 3) {
    case 0: return series(rest, 1);
    case 1: return series(rest, 0);
    case 2: return -series(rest, 1);
    default: return -series(rest, 0);
    }
}

quad quad_sine(quad rad) { return wave(rad, 0); }
quad quad_cosine(quad rad) { return wave(rad, 1); }

/* x[j], y[j]: derivatives of a body's position by coordinate j. bend_x, bend_y: the body's acceleration if all
 * coordinates have constant rates. */
typedef struct moving {
    quad x[QUAD_COORDINATES];
    quad y[QUAD_COORDINATES];
    quad bend_x;
    quad bend_y;
} moving;

static moving body_moves(const quad_arms *of, const quad_body *b, const quad *state) {
    moving m = {.bend_x = 0, .bend_y = 0};
    for (int i = 0; i < of->coordinates; i++) {
        m.x[i] = i == of->carriage ? 1 : 0;
        m.y[i] = 0;
    }
    for (int a = 0; a < b->arms; a++) {
        const quad_arm *arm = &b->arm[a];
        const quad times = (quad)arm->multiple;
        const quad angle = times * state[2 * arm->coordinate];
        const quad rate = times * state[2 * arm->coordinate + 1];
        const quad x = arm->length_m * quad_cosine(angle);
        const quad y = arm->length_m * quad_sine(angle);
        m.x[arm->coordinate] -= times * y;
        m.y[arm->coordinate] += times * x;
        m.bend_x -= rate * rate * x;
        m.bend_y -= rate * rate * y;
    }
    return m;
}

static void eliminate(int n, quad m[QUAD_COORDINATES][QUAD_COORDINATES], quad *f) {
    for (int k = 0; k < n; k++) {
        for (int i = k + 1; i < n; i++) {
            const quad by = m[i][k] / m[k][k];
            for (int j = k; j < n; j++) {
                m[i][j] -= by * m[k][j];
            }
            f[i] -= by * f[k];
        }
    }
    for (int k = n; k-- > 0;) {
        for (int j = k + 1; j < n; j++) {
            f[k] -= m[k][j] * f[j];
        }
        f[k] /= m[k][k];
    }
}

void quad_arms_slopes(const void *which, const quad *state, quad *to) {
    const quad_arms *of = which;
    const int n = of->coordinates;
    quad mass[QUAD_COORDINATES][QUAD_COORDINATES] = {{0}};
    quad force[QUAD_COORDINATES] = {0};
    for (int i = 0; i < n; i++) {
        force[i] = of->load[i];
        for (int j = 0; j < n; j++) {
            mass[i][j] = i == j ? of->spin_kgm2[i] : 0;
        }
    }
    for (int b = 0; b < of->bodies; b++) {
        const quad_body *body = &of->body[b];
        const moving m = body_moves(of, body, state);
        for (int i = 0; i < n; i++) {
            force[i] +=
                body->mass_kg * (m.x[i] * (of->gravity_mps2 - m.bend_x) - m.y[i] * m.bend_y);
            for (int j = 0; j < n; j++) {
                mass[i][j] += body->mass_kg * (m.x[i] * m.x[j] + m.y[i] * m.y[j]);
            }
        }
    }
    eliminate(n, mass, force);
    for (int i = 0; i < n; i++) {
        to[2 * i] = state[2 * i + 1];
        to[2 * i + 1] = force[i];
    }
}

enum { COLUMNS_LEAST = 7, COLUMNS = 14 };
#define SPAN_MOST_S 0.0125

typedef struct following {
    quad_slopes *slopes;
    const void *of;
    int states;
} following;

/* Gragg's modified midpoint rule. Its error has only even powers of the substep, so extrapolation gains two orders
 * at a time. */
static void midpoint(const following *f, quad span_s, int substeps, const quad *from, quad *to) {
    const quad h = span_s / (quad)substeps;
    quad before[QUAD_STATES];
    quad rate[QUAD_STATES];
    f->slopes(f->of, from, rate);
    for (int i = 0; i < f->states; i++) {
        before[i] = from[i];
        to[i] = from[i] + h * rate[i];
    }
    for (int s = 1; s < substeps; s++) {
        f->slopes(f->of, to, rate);
        for (int i = 0; i < f->states; i++) {
            const quad next = before[i] + 2 * h * rate[i];
            before[i] = to[i];
            to[i] = next;
        }
    }
    f->slopes(f->of, to, rate);
    for (int i = 0; i < f->states; i++) {
        to[i] = (to[i] + before[i] + h * rate[i]) / 2;
    }
}

static void extrapolate(const following *f, quad span_s, quad *state) {
    quad row[COLUMNS][QUAD_STATES] = {{0}};
    const int columns =
        COLUMNS_LEAST + (int)((double)span_s / SPAN_MOST_S * (COLUMNS - COLUMNS_LEAST) + 0.5);
    for (int k = 0; k < columns; k++) {
        midpoint(f, span_s, 2 * (k + 1), state, row[k]);
        /* row[j] becomes the entry in column k - j of row k of the tableau */
        for (int j = k - 1; j >= 0; j--) {
            const quad ratio = (quad)(k + 1) / (quad)(j + 1);
            for (int i = 0; i < f->states; i++) {
                row[j][i] = row[j + 1][i] + (row[j + 1][i] - row[j][i]) / (ratio * ratio - 1);
            }
        }
    }
    for (int i = 0; i < f->states; i++) {
        state[i] = row[0][i];
    }
}

void quad_follow(quad_slopes *slopes, const void *of, int states, quad span_s, quad *state) {
    const following f = {slopes, of, states};
    int pieces = 1;
    while (span_s / (quad)pieces > (quad)SPAN_MOST_S) {
        pieces++;
    }
    for (int i = 0; i < pieces; i++) {
        extrapolate(&f, span_s / (quad)pieces, state);
    }
}
