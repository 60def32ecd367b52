#include "slow.h"

bool slow_angle(const engine_kind *kind, const void *run, int i) {
    double span_rad;
    const double off_rad = kind->angle_off(run, i, &span_rad);
    return off_rad > SLOW_SHARE * span_rad && off_rad > SLOW_LEAST_RAD;
}

int slow_count(const engine_kind *kind, const image *im, const void *run) {
    int count = 0;
    for (int i = 0; i < im->angles; i++) {
        count += slow_angle(kind, run, i);
    }
    return count;
}

void slow_say(FILE *out, const image *im, const engine_kind *kind, const void *run) {
    for (int i = 0; i < im->angles; i++) {
        double span_rad;
        const double off_rad = kind->angle_off(run, i, &span_rad);
        if (slow_angle(kind, run, i)) {
            fprintf(
                out,
                "whirl run: note: '%s' turns so slowly that rounding its steps to 1.5e-9 rad, as float "
                "does, put it off by up to %.2g rad, %.2g %% of the %.2g rad that it should cover\n",
                im->unknown[im->angle[i].unknown].name, off_rad, 100.0 * off_rad / span_rad,
                span_rad);
        }
    }
    if (slow_count(kind, im, run) > 0) {
        fputs("hint: --compensated carries what is rounded; a larger --step rounds less\n", out);
    }
}
