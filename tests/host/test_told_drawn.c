/* test_told_drawn.c: the whole output of `whirl describe` for drawn scenes. */
#include "derived.h"
#include "drawn_scene.h"
#include "host/emit/description.h"
#include "host/image/image.h"

static dice die;
static drawn_scene drawn;

/* "  angle [0]  theta [rad]     " */
static const char *said_name(const char *at, const char *kind, int index, const char *name,
                             const char *si) {
    char words[200];
    const int length = snprintf(words, sizeof words, "  %s[%d]  %s [%s]", kind, index, name, si);
    at = said_exactly(at, words);
    for (int i = length - (int)strlen(kind) - 7; i < 24; i++) {
        at = said_exactly(at, " ");
    }
    return at;
}

static const char *said_value(const char *at, double value) {
    char words[60];
    snprintf(words, sizeof words, " %-12.9g", value);
    return said_exactly(at, words);
}

static const char *said_quantities(const char *at, const char *title, const char *kind,
                                   const image_quantity *q, int count, bool valued) {
    if (count > 0) {
        at = said_exactly(at, "\n");
        at = said_exactly(at, title);
        at = said_exactly(at, "\n");
    }
    for (int i = 0; i < count; i++) {
        at = said_name(at, kind, i, q[i].name, q[i].unit.si);
        at = valued ? said_value(at, q[i].value) : at;
        at = said_exactly(at, " ");
        at = said_exactly(at, q[i].text);
        at = said_exactly(at, "\n");
    }
    return at;
}

static const char *said_state(const char *at, const image *im) {
    char name[40];
    at = said_exactly(at, "\nstate, SI, as it starts (turn angles first)\n");
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = i < im->angles ? im->angle[i] : im->real[i - im->angles];
        const bool turns = i < im->angles;
        at = said_name(at, turns ? "angle " : "real  ", turns ? i : i - im->angles,
                       drawn_scene_name(&drawn, c, name), im->unknown[c.unknown].unit[c.primes].si);
        at = said_value(at, turns ? im->start_rad[i] : im->start_real[i - im->angles]);
        at = said_exactly(at, " ");
        at = said_exactly(at, c.primes == 0 ? im->unknown[c.unknown].text : "");
        at = said_exactly(at, "\n");
    }
    return at;
}

static const char *said_top(const char *at, const image *im) {
    char words[400];
    static const char *const matrices[] = {"", "one exact matrix a step",
                                           "Runge-Kutta 4 as one matrix a step"};
    snprintf(words, sizeof words,
             "%s%s%s\n  mechanism %s of x.whirl, model hash 0x%016" PRIx64 "\n", im->name,
             im->title[0] != '\0' ? ": " : "", im->title, im->mechanism, im->hash);
    at = said_exactly(at, words);
    for (int i = 0; i < im->effects; i++) {
        if (im->effect[i].with) {
            snprintf(words, sizeof words, "  with %s: %s\n", im->effect[i].name,
                     im->effect[i].text);
            at = said_exactly(at, words);
        }
    }
    snprintf(words, sizeof words,
             "  %s order, %s%s, step %.9g s, %" PRIu64 " steps to t = %.9g s\n",
             im->form == WH_SECOND_ORDER ? "second" : "first",
             im->settings.matrix != MATRIX_NONE ? matrices[im->settings.matrix]
                                                : wh_methods[im->settings.method].title,
             im->settings.compensated ? " compensated" : "", im->step_s, im->steps, im->until_s);
    return said_exactly(at, words);
}

static const char *said_ranges(const char *at, const image *im) {
    bool any = false;
    char words[200];
    for (int i = 0; i < im->reals + im->inputs; i++) {
        const image_range *r = &im->range[i];
        if (r->declared) {
            at = said_exactly(at, any ? "" : "\nranges, SI, for fixed point\n");
            snprintf(words, sizeof words, "  %-26s %.9g .. %.9g\n", r->name, r->low, r->high);
            at = said_exactly(at, words);
            any = true;
        }
    }
    return at;
}

static const char *said_contacts(const char *at, const image *im) {
    char words[200];
    if (im->contacts > 0) {
        at = said_exactly(at, "\ncontacts, in the order in which those of one moment are taken\n");
    }
    for (int k = 0; k < im->contacts; k++) {
        const image_contact *c = &im->contact[k];
        snprintf(words, sizeof words, "  %2d %-9s line %-5d %s\n", k, c->word, c->at.line,
                 drawn_scene_statement(c->at.line));
        at = said_exactly(at, words);
    }
    return at;
}

static const char *said_ledger(const char *at, const image *im) {
    static const char *const kinds[] = {"work", "loss", "energies", "drive", "damping"};
    const image_ledger *l = &im->ledger;
    char words[300];
    if (!l->asked) {
        return at;
    }
    snprintf(words, sizeof words, "\nledger: %d accounts, %d entries\n", l->accounts, l->entries);
    at = said_exactly(at, words);
    for (int i = 0; i < l->smooth; i++) {
        const image_entry *e = &l->entry[i];
        snprintf(words, sizeof words, "  %2d %-9s of %-12s %s\n", i, kinds[e->kind],
                 e->account > 0 ? im->unknown[l->unknown[e->account]].name : "the energy",
                 drawn_scene_statement(e->at.line));
        at = said_exactly(at, words);
    }
    return at;
}

static const char *said_lists(const char *at, const image *im) {
    char words[200];
    at = said_exactly(at, "\nlist       results   + - *     /  roots  waves  calls\n");
    for (int role = 0; role < IMAGE_ROLES; role++) {
        if (im->list[role] != NULL) {
            const op_list_cost cost = op_list_count(im->list[role]);
            snprintf(words, sizeof words, "  %-9s %6d  %6d %5d %6d %6d %6d\n",
                     drawn_scene_roles[role], im->list[role]->results, cost.arithmetic,
                     cost.divisions, cost.roots, cost.waves, cost.calls);
            at = said_exactly(at, words);
        }
    }
    return at;
}

static const char *said_step(const char *at, const image *im) {
    const op_list_tables *of = &im->list[IMAGE_STEP]->tables;
    const bool matrix = im->settings.matrix != MATRIX_NONE;
    const bool tables = im->settings.tables != TABLES_NONE;
    char words[200];
    if (matrix) {
        at = said_exactly(at, "\na step is one product with a matrix");
    } else {
        snprintf(words, sizeof words, "\na step evaluates the %s at most %d times",
                 im->form == WH_SECOND_ORDER ? "accelerations" : "slopes",
                 drawn_scene_evaluations(im));
        at = said_exactly(at, words);
    }
    if (im->contacts > 0) {
        snprintf(words, sizeof words, ", the contacts' signals %d times", drawn_scene_signals(im));
        at = said_exactly(at, words);
    }
    if (tables) {
        snprintf(words, sizeof words, "\n%d tables of %d cells, %s%s:", of->count,
                 im->settings.cells, im->settings.tables == TABLES_LINEAR ? "linear" : "cubic",
                 of->folds ? ", even or odd" : "");
        at = said_exactly(at, words);
    }
    for (int k = 0; k < of->count; k++) {
        snprintf(words, sizeof words, "\n  %2d up to %.4g in size, off by %.2g at most", k,
                 of->size[k], of->off[k]);
        at = said_exactly(at, words);
    }
    if (im->angles > 0 && !matrix && !tables) {
        at = said_exactly(at, "\nsines of turn angles: looked up ");
        at = said_exactly(at, image_turns(im) ? "once a step, and turned" : "at each stage");
    }
    return at;
}

static const char *said_memory(const char *at, const image *im) {
    double bytes[2];
    at = said_number(said_exactly(at, "\nmemory: "), &bytes[0]);
    at = said_number(said_exactly(at, " bytes in float, "), &bytes[1]);
    for (int i = 0; i < 2 && im->contacts == 0; i++) {
        TEST_ASSERT_TRUE(bytes[i] == (double)drawn_scene_bytes(im, i == 0 ? 4 : 8));
    }
    TEST_ASSERT_TRUE(bytes[0] < bytes[1] || im->reals + im->inputs == 0);
    return said_exactly(at, " in double\n");
}

TEST(told_drawn, readers_are_told_everything) {
    for (unsigned c = 0; c < dice_cases(usual_or(200, 50)); c++) {
        drawn_scene_draw(&drawn, &die);
        const image *im = &drawn.im;
        char name[40];
        char *text = derived_written(describe_text, im);
        const char *at = said_top(text, im);
        at = said_state(at, im);
        at = said_quantities(at, "inputs", "input ", im->input, im->inputs, true);
        at = said_quantities(at, "outputs", "output", im->output, im->own_outputs, false);
        for (int k = 0; k < 2 * im->recovered; k++) {
            const component of = {im->from_momentum[k / 2], k % 2};
            at = said_name(at, "output", im->own_outputs + k, drawn_scene_name(&drawn, of, name),
                           im->unknown[of.unknown].unit[of.primes].si);
            at = said_exactly(at, " from its momentum\n");
        }
        at = said_quantities(at, "parameters", "param ", im->parameter, im->parameters, true);
        at = said_ranges(at, im);
        at = said_contacts(at, im);
        at = said_ledger(at, im);
        at = said_lists(at, im);
        at = said_step(at, im);
        at = said_memory(at, im);
        TEST_ASSERT_EQUAL_STRING("", at);
        free(text);
    }
}

SUITE(told_drawn) { die = dice_of("told_drawn", 4150); }
