/* fitted.c: see fitted.h. Least squares of the relative error, no figure below zero. */
#include "fitted.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SWEEPS = 1500, ROUNDS = 6 };
/* Beyond this a row counts less. */
#define FAR_OFF 0.04
/* Of the smallest figure that is fitted: what a compiler makes of the smallest steps is half chance. */
#define SLACK 0.25
/* How much a row's information counts of the figures of a board that is alike. */
#define LIKENESS 0.03

bool takes_part(const counted *r, int board, cost_number number, cost_quantity q) {
    return r->board == board && r->number == number && r->value[q] > 0.0;
}

/* Least squares of weight (sum - value) / value, no figure below zero: the normal equations A figure = b, minimised
 * along one axis after the other. */
static void solve(double (*a)[COST_FEATURES], const double *b, double *figure) {
    int used[COST_FEATURES];
    int count = 0;
    for (int i = 0; i < COST_FEATURES; i++) {
        if (a[i][i] > 0.0) {
            used[count++] = i;
        }
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        for (int n = 0; n < count; n++) {
            const int i = used[n];
            double rest = b[i] + a[i][i] * figure[i];
            for (int k = 0; k < count; k++) {
                rest -= a[i][used[k]] * figure[used[k]];
            }
            figure[i] = rest > 0.0 ? rest / a[i][i] : 0.0;
        }
    }
}

static bool is_taken(int feature, cost_quantity q) {
    return (cost_feature_taken[feature] >> q & 1U) != 0;
}

/* A row of the system: its features over its value, with this weight. */
static void add_equation(const counted *r, cost_quantity q, double weight,
                         double (*a)[COST_FEATURES], double *b) {
    double x[COST_FEATURES];
    for (int i = 0; i < COST_FEATURES; i++) {
        x[i] = is_taken(i, q) ? r->feature[i] / r->value[q] : 0.0;
    }
    for (int i = 0; i < COST_FEATURES; i++) {
        b[i] += weight * x[i];
        for (int k = 0; k < COST_FEATURES && x[i] != 0.0; k++) {
            a[i][k] += weight * x[i] * x[k];
        }
    }
}

double sum_of(const cost_fit *f, const counted *r, cost_quantity q) {
    double feature[COST_FEATURES];
    int unseen;
    for (int i = 0; i < COST_FEATURES; i++) {
        feature[i] = is_taken(i, q) ? r->feature[i] : 0.0;
    }
    return cost_fit_at(f, feature, &unseen);
}

/* The figures of a board that is alike, times what makes the middle one of our rows right. */
static void scale_prior(const cost_fit *of, int board, cost_number number, cost_quantity q,
                        double *prior) {
    static double ratio[ROWS_MAX];
    int count = 0;
    for (int r = 0; r < row_count; r++) {
        if (takes_part(&rows[r], board, number, q) && rows[r].fitted) {
            const double sum = sum_of(of, &rows[r], q);
            if (sum > 0.0) {
                ratio[count++] = rows[r].value[q] / sum;
            }
        }
    }
    qsort(ratio, (size_t)count, sizeof ratio[0], by_size);
    for (int i = 0; i < COST_FEATURES; i++) {
        prior[i] = count > 0 && of->figure[i] > 0.0 ? ratio[count / 2] * of->figure[i] : 0.0;
    }
}

/* What a row that is told as `ratio` of its value weighs in the next round. Less, where it was far off (Cauchy's
 * weights): a few scenes of which a compiler makes something else must not bend the figures of all others. Of events all
 * are far off: there the logarithms' squares are to be least, or most would be told too little. */
static double weight_of(double ratio, cost_quantity q) {
    const double off = ratio - 1.0;
    if (q != COST_OF_CONTACT_MEAN && q != COST_OF_CONTACT_WORST) {
        return 1.0 / (1.0 + off * off / (FAR_OFF * FAR_OFF));
    }
    const double share = fabs(off) < 1e-6 || ratio <= 0.0 ? 1.0 : log(ratio) / off;
    return share * share;
}

/* The most that each feature is of a fitted row: asked of time. */
static void add_parts(cost_fit *f, int board, cost_number number, cost_quantity q) {
    f->is_parted = q == COST_OF_INSTRUCTIONS || q == COST_OF_CYCLES;
    for (int r = 0; r < row_count; r++) {
        const bool fitted = takes_part(&rows[r], board, number, q) && rows[r].fitted;
        const double sum = fitted && f->is_parted ? sum_of(f, &rows[r], q) : 0.0;
        for (int i = 0; i < COST_FEATURES && sum > 0.0; i++) {
            const double part = is_taken(i, q) && f->figure[i] > 0.0
                                    ? f->figure[i] * rows[r].feature[i] / sum
                                    : 0.0;
            f->part[i] = part > f->part[i] ? part : f->part[i];
        }
    }
}

cost_fit fit(int board, cost_number number, cost_quantity q, const cost_fit *like) {
    static double a[COST_FEATURES][COST_FEATURES];
    static double b[COST_FEATURES];
    cost_fit f = {.cases = 0};
    const bool events = q == COST_OF_CONTACT_MEAN || q == COST_OF_CONTACT_WORST;
    double smallest = 0.0;
    double prior[COST_FEATURES] = {0.0};
    if (like != NULL) {
        scale_prior(like, board, number, q, prior);
    }
    for (int round = 0; round < ROUNDS; round++) {
        memset(a, 0, sizeof a);
        memset(b, 0, sizeof b);
        f.cases = 0;
        for (int r = 0; r < row_count; r++) {
            if (takes_part(&rows[r], board, number, q) && rows[r].fitted) {
                const double ratio = round == 0 ? 1.0 : sum_of(&f, &rows[r], q) / rows[r].value[q];
                add_equation(&rows[r], q, weight_of(ratio, q), a, b);
                f.cases++;
                smallest =
                    smallest == 0.0 || rows[r].value[q] < smallest ? rows[r].value[q] : smallest;
                f.largest = rows[r].value[q] > f.largest ? rows[r].value[q] : f.largest;
            }
        }
        for (int i = 0; i < COST_FEATURES && like != NULL; i++) {
            b[i] += LIKENESS * a[i][i] * prior[i];
            a[i][i] *= 1.0 + LIKENESS;
        }
        solve(a, b, f.figure);
    }
    f.slack = events || q == COST_OF_FLASH || q == COST_OF_RAM || q == COST_OF_STACK
                  ? 0.0
                  : SLACK * smallest;
    for (int i = 0; i < COST_FEATURES; i++) {
        if (is_taken(i, q) && a[i][i] <= 0.0) {
            f.figure[i] = COST_UNSEEN;
        }
    }
    add_parts(&f, board, number, q);
    return f;
}
