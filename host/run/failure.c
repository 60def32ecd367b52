/* failure.c: see failure.h. */
#include "failure.h"

#include <math.h>

#include "core/contact.h"
#include "core/refuse.h"
#include "findings.h"
#include "host/base/diag.h"
#include "host/base/statement.h"
#include "host/run/undefined.h"

static bool starts_beyond(const image *im) {
    bool found = false;
    for (int i = 0; i < im->reals; i++) {
        found = found || !(fabs(im->start_real[i]) < (double)WH_ABSURD);
    }
    return found;
}

/* The first contact that pushes more than one coordinate; -1: none. */
static int pushing(const image *im) {
    const int n = im->coordinates;
    for (int k = 0; k < im->forced; k++) {
        const tape *t = im->list[IMAGE_FORCES];
        int entries = 0;
        for (int i = 0; i < n; i++) {
            const op *o = &t->ops[t->result[k * (WH_LAW_ROWS + 2 * n) + WH_LAW_ROWS + i]];
            entries += o->code != OP_CONSTANT || o->value != 0.0;
        }
        if (entries > 1) {
            return k;
        }
    }
    return -1;
}

void failure_say(FILE *out, const engine_kind *kind, const void *run, wh_status status,
                 const verdict *about, const image *plain, const volatile sig_atomic_t *stop) {
    const image *im = about->image;
    diags *errors = diags_new();
    const bool known = undefined_step(im, kind, run, status, errors);
    diags_flush(errors, out);
    diags_free(errors);
    if (known) {
        /* Where a linkage lies flat, a step that misses the place knows no more of how it goes on. */
        if (status != WH_E_SINGULAR) {
            findings_say_failed(out, about, plain, stop);
        }
        return;
    }
    const int fault = kind->fault(run);
    const component c = image_component(im, fault < 0 ? 0 : fault);
    const double time_s = ratio_times(kind->steps(run), im->step);
    fprintf(out, "whirl run: error: the run diverged in the step after t = %.9g s: %s", time_s,
            im->unknown[c.unknown].name);
    for (int k = 0; k < c.primes; k++) {
        fputc('\'', out);
    }
    fputs(" left all bounds\n", out);
    if (kind->steps(run) == 0 && starts_beyond(im)) {
        fprintf(
            out,
            "hint: it starts beyond them: numbers of a run stay below %g in SI's units; take an "
            "origin, or units, nearer to it\n",
            (double)WH_ABSURD);
        return;
    }
    const int k = pushing(im);
    if (k >= 0) {
        char statement[STATEMENT_SIZE];
        statement_text(im->contact[k].at, statement, sizeof statement);
        fprintf(
            out,
            "hint: '%s' pushes all that it names: a clock there needs far more inertia than what "
            "it meets, or is an input with a rate\n",
            statement);
    }
    fputs("hint: a smaller --step may carry it further; if it fails at the same time, look for a "
          "singular position there\n",
          out);
    findings_say_failed(out, about, plain, stop);
}
