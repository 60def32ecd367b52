/* faint.c: see faint.h. */
#include "faint.h"

#include <math.h>
#include <string.h>

#include "host/number/functions.h"

/* The least numbers there are: what a sum of such is rounded to. */
#define FLOAT_UNIT 0x1p-149
#define DOUBLE_UNIT 0x1p-1074
/* Less than this part is not told. */
#define PART_TOLD 1e-3

/* What the steps' roundings come to, of the furthest that component c ever is: they go either way, and their root counts.
 * What starts at something and is nothing is lost whole. */
static double part_lost(const image *im, const watch *w, int c, double unit) {
    const double furthest = number_most(fabs(w->low[c]), fabs(w->high[c]));
    const double size = number_most(furthest, w->range[c]);
    if (size > 0.0) { /* a quotient of such numbers first: their product would be none */
        return 0.5 * (unit / size) * number_root((double)w->steps);
    }
    return im->start_real[c - im->angles] != 0.0 ? 1.0 : 0.0;
}

void faint_say(FILE *out, const image *im, const engine_kind *kind, const watch *w) {
    const bool is_float = kind == &engine_float;
    if (w->steps == 0 || (!is_float && kind != &engine_double)) {
        return;
    }
    const double unit = is_float ? FLOAT_UNIT : DOUBLE_UNIT;
    int worst = -1;
    double most = PART_TOLD;
    for (int c = im->angles; c < w->field->n; c++) {
        const double part = part_lost(im, w, c, unit);
        if (part > most) {
            most = part;
            worst = c;
        }
    }
    if (worst < 0) {
        return;
    }
    const component c = image_component(im, worst);
    fprintf(out,
            "whirl run: warning: '%s%.*s' is so small that %s has no digits for it: steps round to "
            "%.2g, up to %.2g %% of its size over the run\n"
            "hint: smaller units make larger numbers%s\n",
            im->unknown[c.unknown].name, c.primes, "''''''''''", is_float ? "float" : "double",
            unit, 100.0 * number_least(most, 1.0), is_float ? "; or --number double" : "");
}
