/* linear.c: random linear mechanisms, and the matrices of their steps by scaling and squaring with 113 bits. */
#include "linear.h"
#include "derived.h"

quad quad_size(quad x) { return x < 0 ? -x : x; }

/* Draws a multiple of 1/8 up to 8, multiplied by a random power of two from 1 to 2^more. */
static double eighths(uint64_t *seed, int more) {
    const double size = (double)(1 + random_bits(seed) % 64) / 8.0;
    return size * (double)(UINT64_C(1) << (random_bits(seed) % (uint64_t)(more + 1)));
}

typedef struct drawing {
    FILE *out;
    linear *made;
    quad mass[LINEAR_STATES][LINEAR_STATES];
    /* force on each coordinate, per column of `linear` */
    quad force[LINEAR_STATES][LINEAR_COLUMNS];
    /* mass of body i, which gravity may pull, kg */
    double weight[LINEAR_STATES];
} drawing;

/* Adds a spring (or a damper if `rates`) with the constant k between coordinates i and j. If j < 0, the other end is
 * fixed to the ground. */
static void tie(drawing *d, int i, int j, double k, bool rates) {
    const int n = d->made->coordinates;
    const char *prime = rates ? "'" : "";
    const char *unit = rates ? "N*s/m" : "N/m";
    const int at = rates ? n : 0;
    if (j < 0) {
        fprintf(d->out, " + %.17g [%s]*q%d%s^2/2", k, unit, i, prime);
    } else {
        fprintf(d->out, " + %.17g [%s]*(q%d%s - q%d%s)^2/2", k, unit, i, prime, j, prime);
        d->force[i][at + j] += (quad)k;
        d->force[j][at + i] += (quad)k;
        d->force[j][at + j] -= (quad)k;
    }
    d->force[i][at + i] -= (quad)k;
}

static void draw_masses(drawing *d, uint64_t *seed, bool coupled) {
    const int n = d->made->coordinates;
    fputs("T = 0 [J]", d->out);
    for (int i = 0; i < n; i++) {
        const double m = coupled ? eighths(seed, 0) : 0.25 * (double)(1U << random_bits(seed) % 5);
        const bool rides = coupled && i > 0 && random_bits(seed) % 2 != 0;
        fprintf(d->out, rides ? " + %.17g [kg]*(q%d' + q%d')^2/2" : " + %.17g [kg]*q%d'^2/2", m, i,
                i - 1);
        d->weight[i] = m;
        d->mass[i][i] += (quad)m;
        if (rides) {
            d->mass[i - 1][i - 1] += (quad)m;
            d->mass[i][i - 1] += (quad)m;
            d->mass[i - 1][i] += (quad)m;
        }
    }
    fputc('\n', d->out);
}

static void draw_ties(drawing *d, uint64_t *seed, int stiff, bool rates) {
    const int n = d->made->coordinates;
    fputs(rates ? "F = 0 [W]" : "V = 0 [J]", d->out);
    for (int i = 0; i < n; i++) {
        if (random_bits(seed) % 3 != 0) {
            tie(d, i, (int)(random_bits(seed) % (uint64_t)(i + 1)) - 1, eighths(seed, stiff),
                rates);
        }
        /* every digit of 9.75 N/kg is exact in binary */
        if (!rates && random_bits(seed) % 4 == 0) {
            fprintf(d->out, " + %.17g [N]*q%d", 9.75 * d->weight[i], i);
            d->force[i][d->made->columns - 1] -= (quad)(9.75 * d->weight[i]);
        }
    }
    fputc('\n', d->out);
}

static void draw_inputs(drawing *d, uint64_t *seed) {
    const linear *made = d->made;
    for (int k = 0; k < made->inputs; k++) {
        d->force[random_bits(seed) % (uint64_t)made->coordinates][made->states + k] +=
            (quad)eighths(seed, 0);
    }
    for (int i = 0; i < made->coordinates; i++) {
        const quad *by = d->force[i] + made->states;
        if (made->inputs > 0 && (by[0] != 0 || by[1] != 0)) {
            fprintf(d->out, "Q(q%d) = %.17g*u0", i, (double)by[0]);
            if (made->inputs > 1) {
                fprintf(d->out, " + %.17g*u1", (double)by[1]);
            }
            fputc('\n', d->out);
        }
    }
}

/* Replaces force[] by M^-1 force. */
static void solve(drawing *d) {
    const int n = d->made->coordinates;
    for (int p = 0; p < n; p++) {
        for (int i = 0; i < n; i++) {
            const quad factor = i == p ? 0 : d->mass[i][p] / d->mass[p][p];
            for (int k = 0; k < n; k++) {
                d->mass[i][k] -= factor * d->mass[p][k];
            }
            for (int k = 0; k < d->made->columns; k++) {
                d->force[i][k] -= factor * d->force[p][k];
            }
        }
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < d->made->columns; k++) {
            d->made->rate[n + i][k] = d->force[i][k] / d->mass[i][i];
        }
        d->made->rate[i][n + i] = 1;
    }
}

void linear_draw(uint64_t *seed, int coordinates, linear_kind kind, char *text, size_t size,
                 linear *made) {
    static const int steps_us[] = {100, 1000, 10000};
    drawing d = {.made = made};
    *made = (linear){.coordinates = coordinates,
                     .states = 2 * coordinates,
                     .inputs = (int)(random_bits(seed) % (LINEAR_INPUTS + 1))};
    made->columns = made->states + made->inputs + 1;
    d.out = fmemopen(text, size, "w");
    TEST_ASSERT_NOT_NULL(d.out);
    fputs("mechanism m\n", d.out);
    for (int i = 0; i < coordinates; i++) {
        fprintf(d.out, "coordinate q%d [m]\n", i);
    }
    for (int k = 0; k < made->inputs; k++) {
        fprintf(d.out, "input u%d = 0.5 [N]\n", k);
    }
    draw_masses(&d, seed, kind.coupled);
    draw_ties(&d, seed, kind.stiff, false);
    draw_ties(&d, seed, kind.stiff, true);
    draw_inputs(&d, seed);
    solve(&d);
    const int us = steps_us[random_bits(seed) % 3];
    made->h = (quad)us / 1000000;
    fputs("scene s {\n", d.out);
    for (int i = 0; i < made->states; i++) {
        made->start[i] = (random_bits(seed) % 2 != 0 ? 1.0 : -1.0) * eighths(seed, 0) / 8.0;
        fprintf(d.out, "start q%d%s = %.17g [%s]\n", i % coordinates, i < coordinates ? "" : "'",
                made->start[i], i < coordinates ? "m" : "m/s");
    }
    fprintf(d.out, "step %d [us]; until 10 [s] }\n", us);
    TEST_ASSERT_EQUAL_INT(0, fclose(d.out));
}

typedef quad square[LINEAR_COLUMNS][LINEAR_COLUMNS];

static void multiply(int n, square a, square b, square to) {
    static square product;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++) {
            quad sum = 0;
            for (int j = 0; j < n; j++) {
                sum += a[i][j] * b[j][k];
            }
            product[i][k] = sum;
        }
    }
    memcpy(to, product, sizeof product);
}

void linear_step(const linear *of, int order, quad step[LINEAR_STATES][LINEAR_COLUMNS]) {
    static square a;
    static square power;
    static square sum;
    const int n = of->columns;
    int halvings = 0;
    quad size = 0;
    memset(a, 0, sizeof a);
    for (int i = 0; i < of->states; i++) {
        for (int k = 0; k < n; k++) {
            a[i][k] = of->rate[i][k] * of->h;
            size += quad_size(a[i][k]);
        }
    }
    for (; order == 0 && size > (quad)0.125; halvings++) {
        size /= 2;
        for (int i = 0; i < of->states; i++) {
            for (int k = 0; k < n; k++) {
                a[i][k] /= 2;
            }
        }
    }
    memset(power, 0, sizeof power);
    for (int i = 0; i < n; i++) {
        power[i][i] = 1;
    }
    memcpy(sum, power, sizeof sum);
    for (int k = 1; k <= (order > 0 ? order : 30); k++) {
        multiply(n, a, power, power);
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                power[i][j] /= k;
                sum[i][j] += power[i][j];
            }
        }
    }
    for (; halvings > 0; halvings--) {
        multiply(n, sum, sum, sum);
    }
    for (int i = 0; i < of->states; i++) {
        memcpy(step[i], sum[i], sizeof sum[i]);
    }
}

void linear_move(const linear *of, quad step[LINEAR_STATES][LINEAR_COLUMNS], const double *input,
                 quad *x) {
    quad moved[LINEAR_STATES];
    for (int i = 0; i < of->states; i++) {
        moved[i] = step[i][of->columns - 1];
        for (int k = 0; k < of->states; k++) {
            moved[i] += step[i][k] * x[k];
        }
        for (int k = 0; k < of->inputs; k++) {
            moved[i] += step[i][of->states + k] * (quad)input[k];
        }
    }
    memcpy(x, moved, (size_t)of->states * sizeof *x);
}
