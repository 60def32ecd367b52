/* about.c: see about.h. */
#include "about.h"

#include <inttypes.h>
#include <stdlib.h>

#include "core/version.h"
#include "host/base/room.h"
#include "host/number/decimal.h"
#include "host/plot/plot_run.h"

char *about_facts(const image *im, const engine_kind *kind, const void *run) {
    char *stepper = room_words("%s%s", image_stepper(im), image_sums(im));
    char *method = plot_run_quoted(stepper);
    char *made = room_words(
        "whirl = \"" WH_VERSION "\"\n"
        "scene = \"%s\"\nmechanism = \"%s\"\nmethod = %s\nnumber = \"%s\"\n"
        "step_s = %.17g\nsteps = %" PRIu64 "\nstate_hash = \"0x%016" PRIx64 "\"\n",
        im->name, im->mechanism, method, kind->name, im->step_s, kind->steps(run), kind->hash(run));
    free(stepper);
    free(method);
    return made;
}

static void write_values(FILE *to, const char *table, const image_quantity *list, int count) {
    fprintf(to, "\n[%s] # SI\n", table);
    for (int i = 0; i < count; i++) {
        char text[40];
        snprintf(text, sizeof text, "%.15g", list[i].value);
        const bool whole = decimal_read(text, NULL) == list[i].value;
        fprintf(to, "\"%s\" = %.*g\n", list[i].name, whole ? 15 : 17, list[i].value);
    }
}

char *about_tables(const image *im) {
    char *made = NULL;
    size_t length = 0;
    FILE *to = room_text(&made, &length);
    write_values(to, "parameters", im->parameter, im->parameters);
    write_values(to, "inputs", im->input, im->inputs);
    room_text_end(to);
    return made;
}
