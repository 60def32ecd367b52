/* gauge.c: taking measures. */
#include "gauge.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/number/functions.h"

gauge gauge_start(measure_kind kind) { return (gauge){.kind = kind}; }

void gauge_end(gauge *g) { free(g->kept); }

void gauge_enter(gauge *g, double value) {
    if (!isfinite(value)) {
        g->undefined = true;
        return;
    }
    if (g->kind == MEASURE_PERIOD) {
        if (g->samples == g->kept_room) {
            g->kept_room = g->kept_room == 0 ? 1024 : 2 * g->kept_room;
            g->kept = alloc_more(g->kept, (int64_t)g->kept_room, sizeof *g->kept);
        }
        g->kept[g->samples] = value;
    }
    if (g->samples == 0) {
        g->first = value;
        g->least = value;
        g->most = value;
    }
    g->least = value < g->least ? value : g->least;
    g->most = value > g->most ? value : g->most;
    g->sum += value;
    g->last = value;
    g->samples++;
}

static double mean_of(const gauge *g) {
    if (g->samples == 1) {
        return g->last;
    }
    return (g->sum - 0.5 * (g->first + g->last)) / (double)(g->samples - 1);
}

static double period_of(const gauge *g, double step_s, double epsilon) {
    const double level = mean_of(g);
    const double size = number_most(fabs(g->least), fabs(g->most));
    if (!isfinite(level) || !isfinite(g->most - g->least)) {
        return (double)INFINITY;
    }
    if (!(g->most - g->least > 64.0 * epsilon * size)) {
        return (double)NAN;
    }
    uint64_t crossings = 0;
    double first = 0.0; /* in steps */
    double last = 0.0;
    for (uint64_t i = 1; i < g->samples; i++) {
        const double before = g->kept[i - 1];
        const double after = g->kept[i];
        if (before < level && after >= level) {
            last = (double)(i - 1) + (level - before) / (after - before);
            first = crossings == 0 ? last : first;
            crossings++;
        }
    }
    return crossings < 2 ? (double)NAN : (last - first) / (double)(crossings - 1) * step_s;
}

double gauge_result(const gauge *g, double step_s, double epsilon) {
    if (g->undefined || g->samples == 0) {
        return (double)NAN;
    }
    switch (g->kind) {
    case MEASURE_FINAL: return g->last;
    case MEASURE_MAX: return g->most;
    case MEASURE_MIN: return g->least;
    case MEASURE_AMPLITUDE: return 0.5 * (g->most - g->least);
    case MEASURE_MEAN: return mean_of(g);
    case MEASURE_PERIOD: return period_of(g, step_s, epsilon);
    }
    return (double)NAN;
}
