#include "trusting.h"

#include <stdarg.h>

#include "host/number/functions.h"
#include "host/os/system.h"
#include "options.h"

int trusting_plan(const char *command, image *im, bool progress, diags *errors, fixed_plan **plan) {
    interrupts_catch();
    *plan = fixed_plan_make(im, progress, errors);
    im->fixed = *plan;
    diags_flush(errors, stderr);
    if (*plan == NULL && interrupted) {
        fprintf(stderr,
                "whirl %s: interrupted in the first run, in double, which measures the ranges for "
                "fixed point\nhint: declare all ranges, then this run is not needed: range NAME = "
                "A .. B\n",
                command);
    }
    return *plan != NULL ? EXIT_DONE : interrupted ? EXIT_INTERRUPTED : EXIT_BAD_INPUT;
}

bool effort_suffices(const char *command, double effort, double operations, const char *hint,
                     const char *what, ...) {
    if (operations <= effort) {
        return true;
    }
    const double time_ms = 1e3 * operations / BUDGET_LEAST;
    const double unit_ms = time_ms < 1e3 ? 1.0 : time_ms < 6e4 ? 1e3 : 6e4;
    const char *unit = time_ms < 1e3 ? "ms" : time_ms < 6e4 ? "s" : "min";
    va_list arguments;
    va_start(arguments, what);
    fprintf(stderr, "whirl %s: error: this would take about %.0f %s: ", command,
            number_ceiling(time_ms / unit_ms), unit);
    vfprintf(stderr, what, arguments);
    va_end(arguments);
    fprintf(stderr, "\nhint: %s", hint);
    if (operations <= EFFORT_MOST) {
        fprintf(stderr, "; or --effort %.2g", 1.1 * operations);
    }
    fputc('\n', stderr);
    return false;
}
