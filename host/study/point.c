/* point.c: running one point. */
#include "host/study/point.h"

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/check/energy_residual.h"
#include "host/check/nonfinite.h"
#include "host/check/run_checks.h"
#include "host/check/step_doubling.h"
#include "host/derive/lagrange.h"
#include "host/engine/start.h"
#include "host/image/image_make.h"
#include "host/io/records.h"
#include "host/lang/expression.h"
#include "host/lang/parser.h"
#include "host/lang/value.h"
#include "host/number/functions.h"
#include "host/number/ratio.h"
#include "host/os/atomic_file.h"

/* === a measure, sample by sample ============================================================== */

gauge gauge_start(measure_kind kind) { return (gauge){.kind = kind}; }

void gauge_end(gauge *g) { free(g->kept); }

void gauge_enter(gauge *g, double value) {
    if (!isfinite(value)) {
        g->undefined = true;
        return;
    }
    if (g->kind == MEASURE_PERIOD) {
        if (g->samples == g->kept_room) {
            g->kept_room = g->kept_room == 0 ? 1024 : 2 * g->kept_room;
            g->kept = alloc_more(g->kept, (int64_t)g->kept_room, sizeof *g->kept);
        }
        g->kept[g->samples] = value;
    }
    if (g->samples == 0) {
        g->first = value;
        g->least = value;
        g->most = value;
    }
    g->least = value < g->least ? value : g->least;
    g->most = value > g->most ? value : g->most;
    g->sum += value;
    g->last = value;
    g->samples++;
}

static double mean_of(const gauge *g) {
    if (g->samples == 1) {
        return g->last;
    }
    return (g->sum - 0.5 * (g->first + g->last)) / (double)(g->samples - 1);
}

static double period_of(const gauge *g, double step_s, double epsilon) {
    const double level = mean_of(g);
    const double size = number_most(fabs(g->least), fabs(g->most));
    if (!isfinite(level) || !isfinite(g->most - g->least)) {
        return (double)INFINITY;
    }
    if (!(g->most - g->least > 64.0 * epsilon * size)) {
        return (double)NAN;
    }
    uint64_t crossings = 0;
    double first = 0.0; /* first upward crossing of the mean, in steps */
    double last = 0.0;
    for (uint64_t i = 1; i < g->samples; i++) {
        const double before = g->kept[i - 1];
        const double after = g->kept[i];
        if (before < level && after >= level) {
            last = (double)(i - 1) + (level - before) / (after - before);
            first = crossings == 0 ? last : first;
            crossings++;
        }
    }
    return crossings < 2 ? (double)NAN : (last - first) / (double)(crossings - 1) * step_s;
}

double gauge_result(const gauge *g, double step_s, double epsilon) {
    if (g->undefined || g->samples == 0) {
        return (double)NAN;
    }
    switch (g->kind) {
    case MEASURE_FINAL: return g->last;
    case MEASURE_MAX: return g->most;
    case MEASURE_MIN: return g->least;
    case MEASURE_AMPLITUDE: return 0.5 * (g->most - g->least);
    case MEASURE_MEAN: return mean_of(g);
    case MEASURE_PERIOD: return period_of(g, step_s, epsilon);
    }
    return (double)NAN;
}

/* === measures of a sweep ====================================================================== */

static const char *const kind_names[] = {[MEASURE_FINAL] = "",    [MEASURE_MAX] = "max",
                                         [MEASURE_MIN] = "min",   [MEASURE_AMPLITUDE] = "amplitude",
                                         [MEASURE_MEAN] = "mean", [MEASURE_PERIOD] = "period"};

const symbol *measure_symbol(const measure *m) {
    return m->kind != MEASURE_PERIOD && m->of->op == EXPR_SYMBOL ? m->of->symbol : NULL;
}

static size_t blanks(const char *text) { return strspn(text, " \t"); }

/* The length of "(...)" at the start of the text, with balanced parentheses; 0 if it is not closed.
 * Sets *has_comma if there is a comma outside inner parentheses. */
static size_t parenthesized(const char *text, bool *has_comma) {
    int depth = 0;
    *has_comma = false;
    for (size_t i = 0; text[i] != '\0'; i++) {
        depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
        if (depth == 0) {
            return i + 1;
        }
        *has_comma = *has_comma || (text[i] == ',' && depth == 1);
    }
    return 0;
}

/* The kind of a measure. For "amplitude(x)" it is MEASURE_AMPLITUDE, and inner[length] is x. Plain expressions, such as
 * "max(x, y)" and "2*max(x, y)", are MEASURE_FINAL. */
static measure_kind kind_of(const char *text, const char **inner, size_t *length) {
    *inner = text;
    *length = strlen(text);
    for (measure_kind kind = MEASURE_MAX; kind <= MEASURE_PERIOD; kind++) {
        const size_t name = strlen(kind_names[kind]);
        if (strncmp(text, kind_names[kind], name) != 0) {
            continue;
        }
        const char *open = text + name + blanks(text + name);
        bool has_comma;
        const size_t closed = *open == '(' ? parenthesized(open, &has_comma) : 0;
        if (closed == 0 || open[closed + blanks(open + closed)] != '\0' ||
            (has_comma && kind <= MEASURE_MIN)) {
            continue;
        }
        *inner = open + 1;
        *length = closed - 2;
        return kind;
    }
    return MEASURE_FINAL;
}

/* Reports a name with more primes than the order of its equation. Each let is walked only once. */
static bool check_orders(parser *in, const expr *tree, bool *let_seen) {
    if (tree == NULL) {
        return true;
    }
    const symbol *found = tree->op == EXPR_SYMBOL ? tree->symbol : NULL;
    if (found != NULL && found->kind == SYM_STATE && tree->primes > found->order) {
        diag_error(in->diags, tree->at, NULL, "'%s' can have at most %d prime%s", found->name,
                   found->order, found->order == 1 ? "" : "s");
        return false;
    }
    if (found != NULL && found->kind == SYM_LET && !let_seen[found->index]) {
        let_seen[found->index] = true;
        return check_orders(in, found->value, let_seen);
    }
    return check_orders(in, tree->left, let_seen) && check_orders(in, tree->right, let_seen);
}

/* Reports a measure inside a larger expression, "amplitude(x)/2", and returns true: measures are no functions. */
static bool has_measure_inside(const source *typed, diags *errors) {
    for (measure_kind kind = MEASURE_AMPLITUDE; kind <= MEASURE_PERIOD; kind++) {
        const size_t length = strlen(kind_names[kind]);
        const char *at = typed->text;
        while ((at = strstr(at, kind_names[kind])) != NULL) {
            const bool begins =
                at == typed->text || (!isalnum((unsigned char)at[-1]) && at[-1] != '_');
            if (begins && at[length + blanks(at + length)] == '(') {
                const size_t offset = (size_t)(at - typed->text);
                diag_error(errors, (place){typed, 1, (int)offset + 1, offset},
                           "use this measure alone, and compute with its column afterwards",
                           "%s() must stand around the whole expression of a measure",
                           kind_names[kind]);
                return true;
            }
            at += length;
        }
    }
    return false;
}

/* Replaces each noisy output in the expression by its record, which has the noise. */
static const expr *as_recorded(measures *m, const mechanism *of, const expr *tree) {
    if (tree == NULL) {
        return NULL;
    }
    expr made = *tree;
    for (int k = 0; k < of->noise_count && tree->op == EXPR_SYMBOL; k++) {
        if (of->noises[k].output == tree->symbol) {
            made.symbol = of->noises[k].record;
        }
    }
    made.left = as_recorded(m, of, tree->left);
    made.right = as_recorded(m, of, tree->right);
    if (made.symbol == tree->symbol && made.left == tree->left && made.right == tree->right) {
        return tree;
    }
    expr *kept = arena_alloc(m->arena, sizeof *kept);
    *kept = made;
    return kept;
}

/* Reports a comma outside all parentheses, and returns true: each option takes one measure, not a list. */
static bool is_list(const source *typed, diags *errors) {
    int depth = 0;
    for (const char *at = typed->text; *at != '\0'; at++) {
        depth += *at == '(' ? 1 : *at == ')' ? -1 : 0;
        if (*at == ',' && depth <= 0) {
            const size_t offset = (size_t)(at - typed->text);
            diag_error(errors, (place){typed, 1, (int)offset + 1, offset},
                       "--measure max(X) --measure max(Y)", "one measure at a time");
            return true;
        }
    }
    return false;
}

static const expr *read_expression(measures *m, const mechanism *of, const char *text,
                                   size_t length, diags *errors) {
    const size_t before = diags_calls(errors);
    source *typed = arena_alloc(m->arena, sizeof *typed);
    *typed = (source){"<measure>", arena_copy(m->arena, text, length), length};
    if (is_list(typed, errors) || has_measure_inside(typed, errors)) {
        return NULL;
    }
    parser in = {.diags = errors, .arena = m->arena, .effect = -1, .all_effects = true};
    in.names = of->names;
    in.lexer = lexer_start(typed, errors);
    parser_next(&in);
    const expr *made = parse_expression(&in, CONTEXT_OUTPUT);
    if (made != NULL && in.token.kind != TOKEN_END) {
        parser_fail(&in, "write max, min, amplitude, mean and period around the whole expression",
                    "unexpected %s", token_words(&in, &in.token));
    }
    bool *let_seen = arena_alloc(m->arena, (size_t)of->let_count * sizeof *let_seen);
    const bool good = made != NULL && diags_calls(errors) == before;
    return good && check_orders(&in, made, let_seen) ? as_recorded(m, of, made) : NULL;
}

static void add(measures *m, measure_kind kind, const char *name, const expr *of) {
    const measure made = {kind, name, of};
    m->list = arena_push(m->arena, m->list, &m->count, &made, sizeof made);
}

static void add_symbol(measures *m, const mechanism *of, const symbol *s, int primes) {
    char *name = records_name(&(record_column){.name = s->name, .primes = primes});
    expr *made = arena_alloc(m->arena, sizeof *made);
    *made = (expr){.op = EXPR_SYMBOL, .symbol = s, .primes = primes, .dim = s->dim, .height = 1};
    for (int k = 0; k < primes; k++) {
        (void)dim_divide(made->dim, dim_of(0, 0, 1, 0, 0), &made->dim);
    }
    add(m, MEASURE_FINAL, arena_copy(m->arena, name, strlen(name)), as_recorded(m, of, made));
    free(name);
}

/* Adds the columns of `whirl run --csv`, without the time. */
static void add_all(measures *m, const mechanism *of) {
    int highest = 0;
    for (int i = 0; i < of->coordinate_count; i++) {
        highest = of->coordinates[i]->order > highest ? of->coordinates[i]->order : highest;
    }
    for (int primes = 0; primes < highest; primes++) {
        for (int i = 0; i < of->coordinate_count; i++) {
            if (primes < of->coordinates[i]->order) {
                add_symbol(m, of, of->coordinates[i], primes);
            }
        }
    }
    for (int i = 0; i < of->output_count; i++) {
        add_symbol(m, of, of->outputs[i], 0);
    }
}

static void make_outputs(measures *m, const mechanism *of) {
    const symbol **outputs = arena_alloc(m->arena, (size_t)m->count * sizeof(const symbol *));
    for (int i = 0; i < m->count; i++) {
        symbol *each = arena_alloc(m->arena, sizeof *each);
        *each = (symbol){.kind = SYM_OUTPUT,
                         .name = m->list[i].name,
                         .text = "",
                         .unit = "",
                         .dim = m->list[i].of->dim,
                         .value = m->list[i].of,
                         .at = of->at,
                         .index = i,
                         .effect = -1};
        outputs[i] = each;
    }
    m->mechanism = *of;
    m->mechanism.outputs = outputs;
    m->mechanism.output_count = m->count;
}

measures *measures_new(const mechanism *of, const char *const *texts, int count, diags *errors) {
    struct arena *arena = arena_new();
    measures *m = arena_alloc(arena, sizeof *m);
    m->arena = arena;
    bool good = true;
    for (int i = 0; i < count; i++) {
        const char *text = texts[i] + blanks(texts[i]);
        const char *inner;
        size_t length;
        const measure_kind kind = kind_of(text, &inner, &length);
        const expr *made = read_expression(m, of, inner, length, errors);
        good = good && made != NULL;
        if (good) {
            add(m, kind, arena_copy(arena, text, strlen(text)), made);
        }
    }
    if (!good) {
        arena_free(arena);
        return NULL;
    }
    if (count == 0) {
        add_all(m, of);
    }
    make_outputs(m, of);
    return m;
}

void measures_free(measures *m) {
    if (m != NULL) {
        arena_free(m->arena);
    }
}

/* === a run of a sweep ========================================================================= */

typedef struct meter {
    const sweep *sweep;
    const image *image;
    void *run;
    run_checks *verdict;
    gauge *gauges;  /* [measures] */
    int *component; /* [measures] index in the state; -1: measure i takes output[i] */
    double *output;
    bool series;            /* a measure takes a sample each step */
    bool series_of_outputs; /* a measure takes a sample of an output each step */
    bool periods;           /* a measure keeps all samples */
    uint64_t from;          /* first step of the series */
    diags *errors;
    FILE *reason;
    bool good;
} meter;

static meter meter_open(const sweep *sw, const image *im, void *run, diags *errors, FILE *reason) {
    const int count = sw->measures->count;
    meter m = {
        .sweep = sw, .image = im, .run = run, .errors = errors, .reason = reason, .good = true};
    m.verdict = run_checks_open(im, sw->kind, run, NULL);
    m.gauges = alloc(count, sizeof *m.gauges);
    m.component = alloc(count, sizeof *m.component);
    m.output = alloc(im->outputs, sizeof *m.output);
    for (int i = 0; i < count; i++) {
        const measure *each = &sw->measures->list[i];
        const symbol *of = each->of->op == EXPR_SYMBOL ? each->of->symbol : NULL;
        const bool moves = of != NULL && of->order > 0;
        const bool series = each->kind != MEASURE_FINAL;
        m.gauges[i] = gauge_start(each->kind);
        m.component[i] = moves ? image_find_component(im, of->index, each->of->primes) : -1;
        m.series = m.series || series;
        m.series_of_outputs = m.series_of_outputs || (series && m.component[i] < 0);
        m.periods = m.periods || each->kind == MEASURE_PERIOD;
    }
    return m;
}

static void meter_close(meter *m) {
    for (int i = 0; i < m->sweep->measures->count; i++) {
        gauge_end(&m->gauges[i]);
    }
    run_checks_close(m->verdict);
    free(m->gauges);
    free(m->component);
    free(m->output);
}

/* Samples the state: for the MEASURE_FINAL measures if `final`, else for all others. */
static void meter_enter(meter *m, bool final) {
    double state[3 * IMAGE_COMPONENTS_MAX];
    const engine_kind *kind = m->sweep->kind;
    kind->state(m->run, state, state + m->image->angles);
    if (final || m->series_of_outputs) {
        kind->outputs(m->run, m->output);
    }
    for (int i = 0; i < m->sweep->measures->count; i++) {
        const int c = m->component[i];
        if ((m->gauges[i].kind == MEASURE_FINAL) == final) {
            gauge_enter(&m->gauges[i], c >= 0 ? state[c] : m->output[i]);
        }
    }
}

/* Enters a step into the checks and the series. Returns false, with a message, if an energy is not a finite number. */
static bool see(void *of, uint64_t step) {
    meter *m = of;
    const books *b = m->verdict->books;
    run_checks_enter(m->verdict);
    m->good = b == NULL || !b->undefined;
    if (!m->good &&
        !nonfinite_energies(m->image, m->sweep->kind, b->state, b->undefined_s, m->errors)) {
        fprintf(m->reason, "the energies are not finite numbers at t = %.9g s", b->undefined_s);
    }
    if (m->good && m->series && step >= m->from) {
        meter_enter(m, false);
    }
    return m->good;
}

/* Steps to the end. Returns false if the run failed, with a message on m->reason or in m->errors. */
static bool run_through(meter *m) {
    const engine_kind *kind = m->sweep->kind;
    const image *im = m->image;
    const bool counted = ratio_count_from(m->sweep->from_s, im->step, &m->from);
    if (m->series && (!counted || m->from > im->steps)) {
        fprintf(m->reason, "--from %.9g s is after the last step", m->sweep->from_s);
        return false;
    }
    if (m->periods && im->steps >= m->from && im->steps - m->from >= PERIOD_SAMPLES_MAX) {
        fprintf(m->reason,
                "period() takes at most %.0e samples: use a later --from or a larger step",
                (double)PERIOD_SAMPLES_MAX);
        return false;
    }
    const loop l = {.kind = kind,
                    .run = m->run,
                    .steps = im->steps,
                    .own = &m->verdict->own,
                    .see = see,
                    .of = m};
    wh_status status;
    if (loop_run(&l, &status) == LOOP_FAILED &&
        !nonfinite_step(im, kind, m->run, status, m->errors)) {
        fprintf(m->reason, "diverged in the step after t = %.9g s",
                ratio_times(kind->steps(m->run), im->step));
    }
    if (status != WH_OK || !m->good) {
        return false;
    }
    meter_enter(m, true);
    return true;
}

/* value[]: the measures, then the energy residual or NAN. Returns false, with a message, if a measure is not finite. */
static bool read_measures(const meter *m, double *value, point_notes *notes) {
    const measures *all = m->sweep->measures;
    const double epsilon = m->sweep->kind == &engine_float ? (double)FLT_EPSILON : DBL_EPSILON;
    for (int i = 0; i < all->count; i++) {
        if (m->gauges[i].undefined) {
            fprintf(m->reason,
                    "the expression of the measure '%s' is not a finite number at every step",
                    all->list[i].name);
            return false;
        }
        value[i] = gauge_result(&m->gauges[i], m->image->step_s, epsilon);
        const bool no_period = isnan(value[i]) && m->gauges[i].kind == MEASURE_PERIOD;
        if (!isfinite(value[i]) && !no_period) {
            fprintf(
                m->reason,
                "the measure '%s' is not a finite number: the values of its expression are too large",
                all->list[i].name);
            return false;
        }
    }
    run_checks_end(m->verdict, WH_OK);
    value[all->count] = m->verdict->balance.known ? m->verdict->balance.ratio : (double)NAN;
    for (int id = 0; id < FINDINGS; id++) {
        notes->found |= m->verdict->found[id].reported ? FINDING_BIT(id) : 0U;
    }
    notes->warned = m->verdict->warned;
    notes->fails = run_checks_fails(m->verdict, m->sweep->strict);
    notes->unlooked = run_checks_unlooked(m->verdict);
    return true;
}

bool sweep_measure(const sweep *s, const image *im, double *value, diags *errors, FILE *reason,
                   point_notes *notes) {
    void *run = s->kind->start(im);
    notes->end_s = ratio_times(im->steps, im->step);
    meter m = meter_open(s, im, run, errors, reason);
    const bool good = run_through(&m) && read_measures(&m, value, notes);
    meter_close(&m);
    s->kind->stop(run);
    return good;
}

/* === a point ================================================================================== */

#define ENDS_ALIKE 1e-9 /* tolerance of the end of a run, relative to until_s */

static bool has_balance(const sweep *s) { return !s->mechanism->is_system; }

int sweep_columns(const sweep *s) {
    return s->measures->count + (has_balance(s) ? 1 : 0) + (grid_step_axis(s->grid) >= 0 ? 1 : 0);
}

bool sweep_ends_are_alike(const sweep *s, double until_s) {
    const int at = grid_step_axis(s->grid);
    bool needed = false;
    for (int i = 0; i < s->measures->count; i++) {
        needed = needed || s->measures->list[i].kind == MEASURE_FINAL;
    }
    if (at < 0 || !needed) {
        return true;
    }
    double *value = alloc(s->grid->count, sizeof *value);
    double off_s = 0.0; /* the step of the run that ends furthest from the requested end */
    double most_s = ENDS_ALIKE * until_s;
    uint64_t steps_off = 0;
    for (uint64_t point = 0; point < s->grid->points; point++) {
        uint64_t steps;
        grid_values(s->grid, point, value);
        if (value[at] >= RATIO_LEAST &&
            ratio_count(ratio_of(until_s), ratio_of(value[at]), &steps) &&
            fabs(value[at] * (double)steps - until_s) > most_s) {
            most_s = fabs(value[at] * (double)steps - until_s);
            off_s = value[at];
            steps_off = steps;
        }
    }
    free(value);
    if (off_s > 0.0) {
        const double down = number_most(number_floor(until_s / off_s), 1.0);
        fprintf(stderr,
                "whirl sweep: error: the runs end at different times, so a measure at the end "
                "would compare different moments: with the step %.9g s the run ends at %.9g s, "
                "not at %.9g s\nhint: the nearest steps that divide"
                " %.9g s are %.9g s and %.9g s; or measure over "
                "the run, such as max(EXPR)\n",
                off_s, off_s * (double)steps_off, until_s, until_s, until_s / (down + 1.0),
                until_s / down);
    }
    return off_s == 0.0;
}

bool sweep_can_share(const grid *g, const image *im) {
    image_settings finer;
    return !grid_varies_parameters(g) && im->recovered == 0 &&
           !image_settings_finer(&im->settings, &finer);
}

/* --- the point in numbers ----------------------------------------------------------------------*/

/* Prints the first message, without its place, source line and hint. */
static void tell_first(diags *errors, FILE *reason) {
    char *text = NULL;
    FILE *memory = alloc_text(&text, NULL);
    diags_flush(errors, memory);
    alloc_text_end(memory);
    const char *start = strstr(text, "error: ");
    start = start == NULL ? text : start + strlen("error: ");
    fprintf(reason, "%.*s", (int)strcspn(start, "\n"), start);
    free(text);
}

static image *image_at(const sweep *s, const instance *inst, diags *errors) {
    if (s->shared != NULL) {
        return image_again(s->shared, inst, errors);
    }
    equations *e = equations_derive(inst, errors);
    image *im =
        e == NULL ? NULL : image_make(e, inst->conserve, &s->engine, IMAGE_TO_CHECK, errors);
    equations_free(e);
    return im;
}

image *sweep_image(const sweep *s, uint64_t point, diags *errors) {
    overrides changes = changes_at(s->grid, s->changes, point);
    instance *inst = instance_make(s->mechanism, s->scene, &changes, errors);
    image *im = inst != NULL ? image_at(s, inst, errors) : NULL;
    instance_free(inst);
    changes_forget(s->changes, &changes);
    if (im != NULL && !(start_has_method(im, s->engine.method, errors) &&
                        start_is_possible(im, s->kind, errors))) {
        image_free(im);
        im = NULL;
    }
    return im;
}

/* --- rows --------------------------------------------------------------------------------------*/

char *sweep_unit(const symbol *of, int primes) {
    if (of == NULL || unit_is_si(of->declared)) {
        return alloc_words("%s", "");
    }
    char *name = shown_unit_name(of, primes);
    char *unit = alloc_words(" [%s]", name);
    free(name);
    return unit;
}

static double in_unit(const symbol *of, double si) {
    return of == NULL || unit_is_si(of->declared) ? si
                                                  : si * of->declared.divisor / of->declared.scale;
}

static void header_field(FILE *out, const char *name, const symbol *of, int primes) {
    char *unit = sweep_unit(of, primes);
    char *text = alloc_words("%s%s", name, unit);
    atomic_file_field(out, text);
    free(text);
    free(unit);
}

void sweep_header(const sweep *s, FILE *out) {
    for (int i = 0; i < s->grid->count; i++) {
        const axis *a = &s->grid->axes[i];
        header_field(out, a->column, a->symbol, a->primes);
        fputc(',', out);
    }
    for (int i = 0; i < s->measures->count; i++) {
        const measure *m = &s->measures->list[i];
        header_field(out, m->name, measure_symbol(m), m->of->primes);
        fputs(i + 1 < s->measures->count ? "," : "", out);
    }
    fputs(has_balance(s) ? "," ENERGY_RESIDUAL_COLUMN : "", out);
    fputs(grid_step_axis(s->grid) >= 0 ? ",end_s\r\n" : "\r\n", out);
}

char *sweep_swept_value(const axis *a, double si, char text[NUMBER_SIZE]) {
    const double shown = in_unit(a->symbol, si);
    if (shown == si) {
        return number_shortest(si, text);
    }
    snprintf(text, NUMBER_SIZE, "%.15g", number_shown(shown)); /* 17 digits would show round-off */
    return text;
}

void sweep_swept_fields(const sweep *s, uint64_t point, FILE *out) {
    double *value = alloc(s->grid->count, sizeof *value);
    char text[NUMBER_SIZE];
    grid_values(s->grid, point, value);
    for (int i = 0; i < s->grid->count; i++) {
        fprintf(out, "%s%s", i > 0 ? "," : "",
                sweep_swept_value(&s->grid->axes[i], value[i], text));
    }
    free(value);
}

bool sweep_point(const sweep *s, uint64_t point, FILE *row, FILE *reason, point_notes *notes) {
    double *value = alloc(s->measures->count + 1, sizeof *value);
    diags *errors = diags_new();
    image *im = sweep_image(s, point, errors);
    *notes = (point_notes){0};
    const bool good = im != NULL && sweep_measure(s, im, value, errors, reason, notes);
    if (diags_count(errors) > 0) {
        tell_first(errors, reason);
    }
    image_free(im);
    diags_free(errors);
    sweep_swept_fields(s, point, row);
    for (int i = 0; i < s->measures->count; i++) {
        fputc(',', row);
        if (good) {
            const symbol *of = measure_symbol(&s->measures->list[i]);
            fprintf(row, "%.*g", s->kind->digits, number_shown(in_unit(of, value[i])));
        }
    }
    if (has_balance(s)) {
        fputc(',', row);
        if (good && !isnan(value[s->measures->count])) {
            fprintf(row, "%.3e", value[s->measures->count]);
        }
    }
    if (grid_step_axis(s->grid) >= 0) {
        fputc(',', row);
        if (good) {
            fprintf(row, "%.15g", notes->end_s);
        }
    }
    fputs("\r\n", row);
    free(value);
    return good;
}
