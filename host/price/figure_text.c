/* figure_text.c: see figure_text.h. */
#include "figure_text.h"

#include <string.h>

#include "host/number/functions.h"

char figure_letter(cost_basis basis) {
    switch (basis) {
    case COST_NOT_KNOWN: return '-';
    case COST_EXACT: return 'x';
    case COST_PREDICTED: return 'p';
    case COST_MEASURED: return 'm';
    case COST_ESTIMATED: return 'e';
    case COST_SIMULATED: return 's';
    case COST_RANGE: return 'r';
    }
    return '-';
}

const char *figure_text(const cost_figure *f, char text[FIGURE_TEXT]) {
    if (f->basis == COST_NOT_KNOWN) {
        snprintf(text, FIGURE_TEXT, "-");
    } else if (f->basis == COST_RANGE) {
        snprintf(text, FIGURE_TEXT, "%.3g to %.3g r", f->least, f->most);
    } else {
        snprintf(text, FIGURE_TEXT, "%.0f %c", f->value, figure_letter(f->basis));
    }
    return text;
}

const char *figure_words(const cost_figure *f, char text[FIGURE_WORDS]) {
    const char *word = cost_basis_words[f->basis];
    if (f->basis == COST_PREDICTED && f->least > 0.0) {
        snprintf(text, FIGURE_WORDS, "%s: in nine of ten counted cases within %.0f %%", word,
                 100.0 * (number_root(f->most / f->least) - 1.0));
    } else {
        snprintf(text, FIGURE_WORDS, "%s", word);
    }
    return text;
}

void figure_legend(FILE *out, const cost *c) {
    static const char *const says[COST_BASES] = {
#define COST_BASIS_SAYS(id, word, says) says,
        COST_BASIS_ROWS(COST_BASIS_SAYS)
#undef COST_BASIS_SAYS
    };
    const cost_figure *const figures[] = {&c->instructions, &c->instructions_worst, &c->cycles,
                                          &c->cycles_worst, &c->flash_bytes,        &c->ram_bytes,
                                          &c->stack_bytes,  &c->state_bytes};
    for (int basis = COST_EXACT; basis < COST_BASES; basis++) {
        bool there = false;
        for (size_t i = 0; i < sizeof figures / sizeof figures[0]; i++) {
            there = there || (int)figures[i]->basis == basis;
        }
        if (there) {
            fprintf(out, "  %c  %s: %s\n", figure_letter((cost_basis)basis),
                    cost_basis_words[basis], says[basis]);
        }
    }
}

/* Does a column count at any place? */
static bool counts(const trials *t, int column) {
    for (int p = 0; p < t->points; p++) {
        if (t->reference[p]->column[column].counts) {
            return true;
        }
    }
    return false;
}

static void say_missing(FILE *out, const trials *t) {
    const reference *r = t->reference[t->worst];
    bool first = true;
    for (int k = 1; k < r->columns; k++) {
        char name[TRIAL_NAME];
        if (r->shape->column[k].unknown >= 0 && !counts(t, k)) {
            fprintf(out, "%s%s", first ? "  left out    stays at zero but for rounding: " : ", ",
                    trial_column(t, k, name));
            first = false;
        }
    }
    fputs(first ? "" : "\n", out);
}

void figure_reference(FILE *out, const trials *t) {
    const reference *r = t->reference[t->worst];
    fprintf(out, "  reference   %s\n", r->how);
    if (r->kind == REFERENCE_NONE) {
        const char *where = trial_place(t, t->worst);
        fprintf(out, "              none that could be trusted%s%s: %s\n",
                where[0] != '\0' ? ", with" : "", where, r->why);
        return;
    }
    fprintf(out, "              the two agree within %.1e of each component's largest value\n",
            reference_agreement(r));
    fprintf(out, "  horizon     %.9g s", trial_horizon_s(t));
    if (t->records < t->wish.records) {
        fprintf(out, " of %.9g s: %s\n", ratio_times((uint64_t)t->wish.records, t->wish.spacing),
                r->why != NULL ? r->why : "the reference ends");
    } else {
        fprintf(out, ", %d records\n", t->records);
    }
    if (t->what.column < 0) {
        say_missing(out, t);
    }
    if (t->still != NULL) {
        fprintf(out, "  left out    nothing moves with%.*s\n", (int)strlen(t->still) - 1, t->still);
    }
}

void figure_field(FILE *out, const char *text) {
    if (strpbrk(text, ",\"\r\n") == NULL) {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (; *text != '\0'; text++) {
        fputs(*text == '"' ? "\"\"" : (char[]){*text, '\0'}, out);
    }
    fputc('"', out);
}
