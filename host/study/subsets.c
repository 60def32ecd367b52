#include "subsets.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/check/nonfinite.h"
#include "host/derive/lagrange.h"
#include "host/engine/loop.h"
#include "host/engine/start.h"
#include "host/engine/vector_field.h"
#include "host/image/core_rows.h"
#include "host/image/image_make.h"

static const image_settings settings = IMAGE_SETTINGS_DEFAULT;
static const engine_kind *const engine = &engine_double;

static uint64_t bit(int k) { return (uint64_t)1 << (unsigned)k; }

/* --- images ----------------------------------------------------------------------------------------*/

/* The scene without the effects in `out`. Their parameters stay in the instance, so that `set` and --set stay valid. */
static image *image_without(const subsets *s, uint64_t out, diags *errors) {
    instance *inst = instance_make(s->of, s->in, s->changes, errors);
    for (int k = 0; inst != NULL && k < s->effects; k++) {
        inst->with[s->effect[k]] = (out & bit(k)) == 0;
    }
    equations *e = inst == NULL ? NULL : equations_derive(inst, errors);
    image *im = e == NULL ? NULL : image_make(e, inst->conserve, &settings, IMAGE_TO_RUN, errors);
    equations_free(e);
    instance_free(inst);
    const bool starts = im != NULL && start_is_possible(im, engine, errors);
    if (!starts) {
        image_free(im);
    }
    return starts ? im : NULL;
}

static double value_of(const cost_figure *f) {
    return f->basis == COST_NOT_KNOWN ? (double)NAN : f->value;
}

static void take_price(const subsets *s, const image *im, subset *to) {
    image smooth = *im;
    smooth.contacts = 0;
    const cost c = cost_of(&smooth, s->board, COST_FLOAT);
    to->contacts = im->contacts;
    to->figure[SUBSET_STEP] =
        value_of(s->board->cycles == COST_RANGE ? &c.instructions : &c.cycles);
    to->figure[SUBSET_WORST] = core_evaluations(im);
    to->figure[SUBSET_FLASH] = value_of(&c.flash_bytes);
    to->figure[SUBSET_RAM] = value_of(&c.ram_bytes);
}

static subset *add(subsets *s, uint64_t out) {
    subset *made = alloc(1, sizeof *made);
    *made = (subset){.out = out, .same = true, .moved = alloc(s->columns->columns, sizeof(double))};
    for (int i = 0; i < SUBSET_FIGURES; i++) {
        made->figure[i] = (double)NAN;
    }
    s->list = alloc_more(s->list, s->count + 1, sizeof(subset *));
    s->list[s->count++] = made;
    return made;
}

bool subsets_open(subsets *s, diags *errors) {
    s->image = image_without(s, 0, errors);
    for (int i = 0; s->image != NULL && i < s->image->effects; i++) {
        if (s->image->effect[i].with && s->effects == SUBSETS_EFFECTS_MAX) {
            diag_error(errors, s->of->effects[i].at, "leave some out with --without EFFECT",
                       "more than %d effects are selected", SUBSETS_EFFECTS_MAX);
            return false;
        }
        if (s->image->effect[i].with) {
            s->effect[s->effects++] = i;
        }
    }
    if (s->image == NULL) {
        return false;
    }
    s->columns = records_open(NULL, s->image, engine);
    s->range = alloc(s->columns->columns, sizeof *s->range);
    s->limit = alloc(s->columns->columns, sizeof *s->limit);
    add(s, 0);
    return true;
}

void subsets_close(subsets *s) {
    for (int i = 0; i < s->count; i++) {
        free(s->list[i]->moved);
        free(s->list[i]);
    }
    free(s->list);
    free(s->range);
    free(s->limit);
    records_close(s->columns);
    image_free(s->image);
}

/* --- runs side by side -------------------------------------------------------------------------------*/

/* One of the runs that step side by side. Lane 0 is the full scene. */
typedef struct lane {
    subset *subset;
    image *image;
    records *records;
    vector_field *field;
    void *run; /* NULL: the run has ended */
} lane;

static lane lane_open(const subsets *s, subset *of) {
    diags *unsaid = diags_new();
    lane l = {.subset = of, .image = image_without(s, of->out, unsaid)};
    if (l.image != NULL) {
        l.records = records_open(NULL, l.image, engine);
        l.field = vector_field_open(l.image, engine);
        l.run = engine->start(l.image);
        take_price(s, l.image, of);
    }
    of->failed = l.image == NULL ? "needed: no run can start without it" : NULL;
    diags_free(unsaid);
    return l;
}

static void lane_close(lane *l, int columns) {
    for (int i = 0; l->subset->failed != NULL && i < columns; i++) {
        l->subset->moved[i] = (double)INFINITY;
        l->subset->same = false;
    }
    if (l->run != NULL) {
        engine->stop(l->run);
    }
    records_close(l->records);
    vector_field_close(l->field);
    image_free(l->image);
}

/* Updates each column's largest difference from the full run. */
static void lane_compare(lane *l, const records *full) {
    records_read(l->records, l->run, full->row[0]);
    for (int i = 1; i < full->columns; i++) {
        const double a = full->row[i];
        const double b = l->records->row[i];
        const bool same = a == b || (isnan(a) && isnan(b));
        const double off = same ? 0.0 : fabs(a - b);
        l->subset->same = l->subset->same && same;
        if (!(off <= l->subset->moved[i])) {
            l->subset->moved[i] = isnan(off) ? (double)INFINITY : off;
        }
    }
}

/* Do the terms that `less` lacks change a slope of the full run by more than round-off? */
static bool terms_act(const lane *all, vector_field *less) {
    enum { MOST = 3 * IMAGE_COMPONENTS_MAX };
    vector_field *full = all->field;
    double x[2][MOST];
    double slope[2][MOST];
    double off[2][MOST];
    int at[MOST] = {0};
    bool act = full->n != less->n;
    engine->state(all->run, x[0], x[0] + all->image->angles);
    for (int i = 0; i < less->n; i++) {
        const component c = image_component(less->list.image, i);
        at[i] = image_find_component(full->list.image, c.unknown, c.primes);
        act = act || at[i] < 0;
        x[1][i] = act ? 0.0 : x[0][at[i]];
    }
    vector_field_slope(full, x[0], slope[0]);
    vector_field_slope(less, x[1], slope[1]);
    vector_field_rounding(full, x[0], off[0]);
    vector_field_rounding(less, x[1], off[1]);
    for (int i = 0; i < less->n && !act; i++) {
        act = fabs(slope[0][at[i]] - slope[1][i]) > off[0][at[i]] + off[1][i];
    }
    return act;
}

static void contact_acts(subsets *s, int contact) {
    for (int i = 0; i < s->of->contact_count; i++) {
        const contact_statement *c = &s->of->contacts[i];
        for (int k = 0; c->at.offset == s->image->contact[contact].at.offset && k < s->effects;
             k++) {
            s->acted[k] = s->acted[k] || c->effect == s->effect[k];
        }
    }
}

static void contacts_act(subsets *s, void *run) {
    engine_event event[WH_EVENT_LOG];
    int mode[WH_CONTACTS_LIMIT];
    for (int i = engine->happened(run, event); i > 0; i--) {
        contact_acts(s, event[i - 1].contact);
    }
    engine->modes(run, mode);
    for (int i = 0; i < s->image->contacts; i++) {
        const int kind = s->image->contact[i].kind;
        if (kind == WH_FRICTION || (kind != WH_WHEN && mode[i] == WH_ACTIVE)) {
            contact_acts(s, i);
        }
    }
}

/* Marks the effects that act at this step of the full run. Lane k + 1 is without effect k. */
static void note_acting(subsets *s, const lane *lanes) {
    if (s->image->contacts > 0) {
        contacts_act(s, lanes[0].run);
    }
    for (int k = 0; k < s->effects; k++) {
        const lane *less = &lanes[k + 1];
        s->acted[k] = s->acted[k] || less->run == NULL || terms_act(&lanes[0], less->field);
    }
}

static void note_range(subsets *s, double *least, double *most, bool first) {
    const double *row = s->columns->row;
    for (int i = 1; i < s->columns->columns; i++) {
        least[i] = first || row[i] < least[i] ? row[i] : least[i];
        most[i] = first || row[i] > most[i] ? row[i] : most[i];
        s->range[i] = most[i] - least[i];
    }
}

bool subsets_keeps(const subsets *s, const subset *of) {
    bool keeps = of->failed == NULL;
    for (int i = 1; i < s->columns->columns; i++) {
        keeps = keeps && of->moved[i] <= s->limit[i];
    }
    return keeps;
}

static void lane_stop(lane *l, const char *why) {
    l->subset->failed = why;
    engine->stop(l->run);
    l->run = NULL;
}

/* Runs list[0], and all subsets from list[first] on. If `first` > 1, a subset stops when its error exceeds a limit. */
static bool run_from(subsets *s, int first, diags *errors) {
    const int count = 1 + s->count - first;
    const int columns = s->columns->columns;
    lane *lanes = alloc(count, sizeof *lanes);
    double *ends = alloc(2 * (int64_t)columns, sizeof *ends);
    wh_status status = WH_OK;
    for (int i = 0; i < count; i++) {
        lanes[i] = lane_open(s, s->list[i == 0 ? 0 : first + i - 1]);
    }
    for (uint64_t step = 0; lanes[0].run != NULL && status == WH_OK; step++) {
        const double time_s = ratio_times(step, s->image->step);
        records_read(s->columns, lanes[0].run, time_s);
        for (int i = 1; i < count; i++) {
            if (lanes[i].run != NULL) {
                lane_compare(&lanes[i], s->columns);
            }
            if (lanes[i].run != NULL && first > 1 && !subsets_keeps(s, lanes[i].subset)) {
                lane_stop(&lanes[i], "the error is too large");
            }
        }
        note_range(s, ends, ends + columns, step == 0);
        if (first == 1) {
            note_acting(s, lanes);
        }
        if (step == s->image->steps) {
            break;
        }
        for (int i = 1; i < count; i++) {
            if (lanes[i].run != NULL && loop_steps(engine, lanes[i].run, 1) != WH_OK) {
                lane_stop(&lanes[i], "needed: the run diverges without it");
            }
        }
        status = loop_steps(engine, lanes[0].run, 1);
        if (status != WH_OK && !nonfinite_step(s->image, engine, lanes[0].run, status, errors)) {
            diag_error(errors, s->image->at, "a smaller --step, or an earlier --until",
                       "with all effects the run diverges in the step after t = %.9g s", time_s);
        }
    }
    for (int i = 0; i < count; i++) {
        lane_close(&lanes[i], columns);
    }
    free(ends);
    free(lanes);
    return status == WH_OK;
}

bool subsets_run(subsets *s, diags *errors) {
    for (int k = 0; k < s->effects; k++) {
        for (int i = 0; i < s->of->noise_count; i++) {
            s->acted[k] = s->acted[k] || s->of->noises[i].effect == s->effect[k];
        }
        add(s, bit(k));
    }
    const bool good = run_from(s, 1, errors);
    for (int k = 0; k < s->effects; k++) {
        s->acted[k] = s->acted[k] && !s->list[k + 1]->same;
    }
    return good;
}

/* --- the smallest set ----------------------------------------------------------------------------------*/

static int effects_of(uint64_t mask) { return __builtin_popcountll(mask); }

static bool is_better(const subset *a, const subset *b) {
    const int fewer = effects_of(a->out) - effects_of(b->out);
    const double longer = a->figure[SUBSET_WORST] - b->figure[SUBSET_WORST];
    return fewer != 0    ? fewer > 0
           : longer != 0 ? longer < 0
                         : a->figure[SUBSET_STEP] < b->figure[SUBSET_STEP];
}

/* The best subset within the limits. Effects that did not act stay: their removal only changes round-off. */
static const subset *best_of(const subsets *s, uint64_t acting) {
    const subset *best = s->list[0];
    for (int i = 1; i < s->count; i++) {
        const bool may = (s->list[i]->out & ~acting) == 0 && subsets_keeps(s, s->list[i]);
        best = may && is_better(s->list[i], best) ? s->list[i] : best;
    }
    return best;
}

const subset *subsets_smallest(subsets *s, bool *greedy) {
    diags *unsaid = diags_new();
    uint64_t acting = 0;
    for (int k = 0; k < s->effects; k++) {
        acting |= s->acted[k] ? bit(k) : 0;
    }
    *greedy = effects_of(acting) > SUBSETS_ALL_MOST;
    const subset *best = best_of(s, acting);
    for (bool more = best->out != 0 || !*greedy; more;) {
        const int first = s->count;
        for (uint64_t out = acting; out != 0 && !*greedy; out = (out - 1) & acting) {
            if (effects_of(out) > 1) {
                add(s, out);
            }
        }
        for (int k = 0; k < s->effects && *greedy; k++) {
            if ((acting & bit(k) & ~best->out) != 0) {
                add(s, best->out | bit(k));
            }
        }
        run_from(s, first, unsaid);
        const subset *before = best;
        best = best_of(s, acting);
        more = *greedy && best != before;
    }
    diags_free(unsaid);
    return best;
}
