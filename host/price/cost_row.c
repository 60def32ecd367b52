/* cost_row.c: see cost_row.h. */
#include "cost_row.h"

#include "cost_figure.h"

double cost_fit_at(const cost_fit *fit, const double feature[static COST_FEATURES], int *unseen) {
    double sum = 0.0;
    for (int f = 0; f < COST_FEATURES; f++) {
        if (feature[f] != 0.0 && fit->figure[f] < 0.0) {
            *unseen = f;
            return -1.0;
        }
        sum += feature[f] * fit->figure[f];
    }
    return sum;
}

/* Of a sum's parts, so much may be more than any fitted row had of them. */
#define FAR_LEAST 0.05

static double beyond(const cost_fit *fit, const double feature[static COST_FEATURES], double sum) {
    double all = 0.0;
    for (int f = 0; f < COST_FEATURES; f++) {
        const double part = fit->figure[f] > 0.0 ? feature[f] * fit->figure[f] / sum : 0.0;
        all += part > fit->part[f] ? part - fit->part[f] : 0.0;
    }
    return all;
}

static cost_class class_of(const double feature[static COST_FEATURES]) {
    return feature[COST_F_BOOKS] != 0.0        ? COST_BOOKING
           : feature[COST_F_CODE_CALLS] != 0.0 ? COST_CALLING
           : feature[COST_F_MATRIX] != 0.0     ? COST_AS_MATRIX
           : feature[COST_F_CELLS] != 0.0      ? COST_TABLED
                                               : COST_PLAIN;
}

cost_class cost_class_at(const cost_fit *fit, const double feature[static COST_FEATURES],
                         double sum) {
    const bool is_far = fit->is_parted && sum > 0.0 && beyond(fit, feature, sum) > FAR_LEAST;
    return is_far ? COST_FAR : class_of(feature);
}

double cost_bound_at(const cost_fit *fit, const double feature[static COST_FEATURES], double sum) {
    const double far = fit->bound[cost_class_at(fit, feature, sum)];
    const double own = fit->bound[class_of(feature)];
    return cost_bound_of(sum, fit->largest, far > own ? far : own);
}

double cost_least(const cost_fit *fit, double sum, double bound) {
    return sum > fit->slack ? (sum - fit->slack) / bound : 0.0;
}

double cost_most(const cost_fit *fit, double sum, double bound) { return sum * bound + fit->slack; }
