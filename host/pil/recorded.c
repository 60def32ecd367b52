/* recorded.c: records of the plant of a run in the loop as comma-separated values. */
#include "recorded.h"

#include "host/base/atomic_file.h"

#define EVERY_S 1e-3

bool recorded_open(recorded *r, const char *name, const image *im, double every_s) {
    *r = (recorded){.name = name, .every = 1};
    if (name == NULL) {
        return true;
    }
    if (!ratio_count_each(every_s >= 0.0 ? every_s : EVERY_S, im->step, &r->every) &&
        every_s >= 0.0) {
        fprintf(stderr,
                "whirl pil: error: --every %.9g s is not a whole number of steps, one or more\n"
                "hint: the plant's --step is %.9g s\n",
                every_s, im->step_s);
        return false;
    }
    r->file = atomic_file_open(name);
    if (r->file == NULL) {
        return false;
    }
    r->rows = records_open(r->file, im, &engine_double);
    records_header(r->rows);
    return true;
}

void recorded_enter(recorded *r, void *run, uint64_t steps) {
    if (r->rows != NULL && steps % r->every == 0) {
        records_read(r->rows, run, ratio_times(steps, r->rows->image->step));
        (void)records_write(r->rows);
    }
}

bool recorded_close(recorded *r) {
    records_close(r->rows);
    return atomic_file_close(r->file, r->name, true);
}
