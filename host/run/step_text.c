/* step_text.c: see step_text.h. */
#include "step_text.h"

#include <stdio.h>
#include <stdlib.h>

double step_nice_s(double most_s) {
    static const double steps[] = {5.0, 2.0, 1.0};
    double decade = 1e3;
    for (int i = 0; i < 16; i++) {
        for (int k = 0; k < 3; k++) {
            if (steps[k] * decade <= most_s * (1.0 + 1e-9)) {
                return steps[k] * decade;
            }
        }
        decade /= 10.0;
    }
    return 0.0;
}

const char *step_text(double step_s, char text[STEP_WORD]) {
    static const struct {
        double s;
        const char *unit;
    } units[] = {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}};
    int i = 0;
    while (i < 3 && step_s < 0.9999 * units[i].s) {
        i++;
    }
    for (int digits = 3; digits <= 17; digits++) { /* 200us, not 2e+02us */
        snprintf(text, STEP_WORD, "%.*g%s", digits, step_s / units[i].s, units[i].unit);
        const double off = strtod(text, NULL) * units[i].s / step_s - 1.0;
        if (off < 1e-14 && off > -1e-14) {
            break;
        }
    }
    return text;
}
