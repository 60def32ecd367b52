/* measures.c: reading measures. */
#include "host/study/measures.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/arena.h"
#include "host/lang/cursor.h"
#include "host/lang/expression.h"
#include "host/number/functions.h"

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
    double first = 0.0; /* in steps */
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

/* "amplitude(x)" is a measure of the series of x; "max(x, y)" and "2*max(x, y)" are expressions. */
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

/* A name may have any number of primes, but the equations define it only up to its order. Each let
 * is walked once. */
static bool check_orders(parser *in, const expr *tree, bool *let_seen) {
    if (tree == NULL) {
        return true;
    }
    const symbol *found = tree->op == EXPR_SYMBOL ? tree->symbol : NULL;
    if (found != NULL && found->kind == SYM_STATE && tree->primes > found->order) {
        diag_error(in->diags, tree->at, NULL, "the equations give '%s' no more than %d prime%s",
                   found->name, found->order, found->order == 1 ? "" : "s");
        return false;
    }
    if (found != NULL && found->kind == SYM_LET && !let_seen[found->index]) {
        let_seen[found->index] = true;
        return check_orders(in, found->value, let_seen);
    }
    return check_orders(in, tree->left, let_seen) && check_orders(in, tree->right, let_seen);
}

/* "amplitude(x)/2": measures are no functions of the language. Reports and returns true when there
 * is one inside the text. */
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
                           "take it as it is, and reckon with the column afterwards",
                           "%s() must stand around the whole measure", kind_names[kind]);
                return true;
            }
            at += length;
        }
    }
    return false;
}

/* The expression with noisy outputs as they are recorded. Noise does not enter other outputs that
 * use them, as in the records. */
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

/* Measures come one by one: a comma outside all parentheses is a list's. */
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
        char words[80];
        parser_fail(&in, "max, min, amplitude, mean and period stand around a whole expression",
                    "unexpected %s", token_words(&in.token, words, sizeof words));
    }
    bool *let_seen = arena_alloc(m->arena, (size_t)of->let_count * sizeof *let_seen);
    const bool good = made != NULL && diags_calls(errors) == before;
    return good && check_orders(&in, made, let_seen) ? as_recorded(m, of, made) : NULL;
}

static void add(measures *m, measure_kind kind, const char *name, const expr *of) {
    measure *longer = arena_room(m->arena, m->list, m->count, sizeof *longer);
    m->list = longer;
    m->list[m->count++] = (measure){kind, name, of};
}

static void add_symbol(measures *m, const mechanism *of, const symbol *s, int primes) {
    const size_t length = strlen(s->name);
    const size_t depth = (size_t)primes;
    char *name = arena_alloc(m->arena, length + 5 * depth + 1);
    for (size_t k = 0; k < depth; k++) {
        snprintf(name + 4 * k, 5, "der(");
    }
    snprintf(name + 4 * depth, length + 1, "%s", s->name);
    memset(name + 4 * depth + length, ')', depth);
    expr *made = arena_alloc(m->arena, sizeof *made);
    *made = (expr){.op = EXPR_SYMBOL, .symbol = s, .primes = primes, .dim = s->dim, .height = 1};
    for (int k = 0; k < primes; k++) {
        (void)dim_divide(made->dim, dim_of(0, 0, 1, 0, 0), &made->dim);
    }
    add(m, MEASURE_FINAL, name, as_recorded(m, of, made));
}

/* The columns of `whirl run --csv`, without the time. */
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
