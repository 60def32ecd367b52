#include "too_far.h"

#include <math.h>

void too_far_say(FILE *out, const image *im, const engine_kind *kind, const void *run) {
    double angle_rad[IMAGE_COMPONENTS_MAX];
    double real[2 * IMAGE_COMPONENTS_MAX];
    const int fault = kind->fault(run);
    const char *name = im->unknown[im->angle[fault].unknown].name;
    const double time_s = ratio_times(kind->steps(run), im->step);
    kind->state(run, angle_rad, real);
    fprintf(out, "'%s' turns too far for sines that are turned in the step after t = %.9g s", name,
            time_s);
    if (im->form == WH_SECOND_ORDER) { /* else its rate is no part of the state */
        const double rate = real[im->coordinates - im->angles + fault];
        fprintf(out, ": by %.3g rad", fabs(rate * im->step_s));
    }
}
