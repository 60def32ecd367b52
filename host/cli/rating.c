#include "rating.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/check/findings.h"
#include "host/engine/start.h"
#include "host/fixed/engine_fixed.h"
#include "host/number/functions.h"
#include "host/study/price_table.h"
#include "pricing.h"

/* --- the rows --------------------------------------------------------------------------------------*/

/* Prints why there are no rows, and the `command` that shows them (NULL: none). */
static void say_none(FILE *out, const rating_request *w, const char *why, const char *command) {
    fprintf(out, "accuracy and cost  not shown: %s", why);
    if (command != NULL) {
        char *target = pricing_quoted(w->target);
        overrides asked = *w->changes;
        asked.step = NULL; /* `whirl price` tries steps of its own */
        char *changes = pricing_words(&asked, false);
        fprintf(out, "; this command %sshows them: whirl %s %s%s%s%s",
                strcmp(command, "price") != 0 ? "in Whirl's source tree " : "", command, target,
                changes, w->board_word != NULL ? " --board " : "",
                w->board_word != NULL ? w->board_word : "");
        free(target);
        free(changes);
    }
    fputc('\n', out);
}

/* RECORDS_MOST: most records of the run. SPACING: a record's interval is a multiple of this many steps. */
enum { ROWS = 3, RECORDS_MOST = 20000, SPACING = 2 };
/* Steps of all rows, and of the two references, as multiples of the run's steps. */
#define ROWS_STEPS (0.5 + 1.0 + 2.0)
#define REFERENCE_STEPS (4.0 + 2.0)

static double operations_of(const rating_request *w, const setting *s, double steps) {
    const double runs = setting_is_fixed(s) ? 2.0 : 1.0; /* a first run measures the ranges */
    const double each = ROWS_STEPS * runs * wh_methods[s->image.method].stages +
                        REFERENCE_STEPS * wh_methods[step_doubling_method(w->image)].stages;
    return steps * each * (double)engine_evaluation(w->image);
}

enum { NUMBER = 24 };
static const char *bytes_text(const cost_figure *f, char text[NUMBER]) {
    snprintf(text, NUMBER, f->basis == COST_NOT_KNOWN ? "-" : "%.0f", f->value);
    return text;
}

static void print_row(FILE *out, const trials *t, const table_row *row) {
    char error[NUMBER];
    char price[NUMBER];
    char flash[NUMBER];
    char ram[NUMBER];
    char stack[NUMBER];
    char name[TRIAL_NAME];
    const trial_result *r = &row->result;
    const cost *c = &row->cost;
    snprintf(error, sizeof error, "%s%.2e", r->bound ? "<" : "", r->error);
    snprintf(price, sizeof price, row->price.basis != COST_NOT_KNOWN ? "%.3g" : "-",
             row->price.value);
    fprintf(out, "  %-10.6g %9s  %10s  %8s  %6s  %8s   %s\n",
            ratio_times(1, trial_step(t, row->pace)),
            !r->ran      ? "-"
            : !r->usable ? "above 1"
                         : error,
            price, bytes_text(&c->flash_bytes, flash), bytes_text(&c->ram_bytes, ram),
            bytes_text(&c->stack_bytes, stack),
            r->ran ? trial_column(t, r->column, name) : "no such step");
}

/* Prints three rows: for 2, 1 and 1/2 times the run's step. `steps`: length of the comparison, at least 2. */
static void print_rows(FILE *out, const rating_request *w, const pricing_scene *p, const setting *s,
                       const image_settings *plain, uint64_t steps) {
    const uint64_t pairs = steps / SPACING;
    const uint64_t many = 1 + (pairs - 1) / RECORDS_MOST;
    const trial_request request = {.source = &p->source,
                                   .board = w->board,
                                   .spacing = ratio_of(ratio_times(SPACING * many, w->image->step)),
                                   .records = (int)(pairs / many),
                                   .by = {.steps = 8 * many,
                                          .method = step_doubling_method(w->image),
                                          .order = step_doubling_order(w->image),
                                          .limit = HORIZON_TOLERANCE},
                                   .plain = plain};
    trials t;
    table_row row[ROWS];
    const bool good = trial_begin(&t, &request) && t.reliable;
    for (int i = 0; i < ROWS && good && !t.stopped; i++) {
        bool own;
        row[i] = (table_row){.setting = *s, .pace = {many << i, 1}};
        row[i].cost = trial_cost(&t, s, row[i].pace, &own);
        row[i].price = table_price_of(&row[i].cost, ratio_times(1, trial_step(&t, row[i].pace)));
        row[i].result = trial_run(&t, s, row[i].pace);
    }
    if (t.stopped) {
        say_none(out, w, "interrupted", "price");
    } else if (!good) {
        say_none(out, w, "no reference is accurate enough", NULL);
    } else {
        const table_price *price = &row[0].price;
        fprintf(out, "accuracy and cost  in %s on %s (%s), until t = %.6g s; costs are %s\n",
                s->number->name, w->board->name, w->board->core, trial_horizon_s(&t),
                cost_basis_words[price->basis]);
        fprintf(out, "  %-10s %9s  %10s  %8s  %6s  %8s   worst\n", "step, s", "error",
                table_heads[price->unit], "flash, B", "RAM, B", "stack, B");
        for (int i = 0; i < ROWS; i++) {
            print_row(out, &t, &row[i]);
        }
    }
    trial_end(&t);
}

/* Returns the reason why the rows cannot be shown, or NULL. *command becomes a command that shows the rows, or NULL. */
static const char *why_none(const rating_request *w, const setting *s,
                            const simulation_trust *trust, double steps, const char **command) {
    const bool on_board = strcmp(w->board->name, "host") != 0;
    *command = NULL;
    if (trust->still) {
        return "nothing moves";
    }
    if (w->image->contacts > 0) {
        *command = on_board ? "choose --error 1e-3" : "price";
        return "events make the cost of a step depend on the motion";
    }
    diags *unsaid = diags_new();
    const bool held = s->number == &engine_double || start_angles_are_held(w->image, unsaid);
    diags_free(unsaid);
    if (w->settings->stabilized || !held) {
        return w->settings->stabilized ? "the cost of --stabilized is not known"
                                       : "a start angle has more turns than float can represent";
    }
    *command = "price";
    return trust->over_budget     ? "the rows take more than a second"
           : trust->until_s < 0.0 ? "the trusted time of the run is unknown"
           : steps < 2.0          ? "the run is trusted for fewer than two steps"
           : operations_of(w, s, steps) > 0.5 * trust->left ? "the rows take more than a second"
                                                            : NULL;
}

void rating_say(FILE *out, const rating_request *w, const simulation_trust *trust) {
    const bool pc = strcmp(w->board->name, "host") == 0;
    const engine_kind *programs = pc ? &engine_double : &engine_float;
    const setting s = {*w->settings, w->number != NULL ? w->number : programs};
    const double trusted = number_floor(trust->until_s / w->image->step_s * (1.0 + 1e-12));
    const double steps = number_least(trusted, (double)w->image->steps);
    const char *command;
    const char *why = why_none(w, &s, trust, steps, &command);
    if (w->image->steps == 0) {
        return;
    }
    if (why != NULL) {
        say_none(out, w, why, command);
        return;
    }
    const grid none = {0};
    pricing_scene *p = pricing_scene_new(w->of, w->in, w->changes, &none, w->errors);
    image_settings finer;
    image_settings_finer(w->settings, &finer);
    pricing_scene_lend(p, w->settings, w->image);
    pricing_scene_lend(p, &finer, w->image->finer);
    print_rows(out, w, p, &s, &finer, (uint64_t)steps);
    pricing_scene_free(p);
}

/* --- the step of --error -----------------------------------------------------------------------------*/

/* A pace is a tried step size. The first PACES_LONG paces are multiples of the interval between records. The others are
 * this interval divided by 1, 2, 4, 5, 8, 10, 20, ... */
enum { PACES = 32, PACES_LONG = 10 };

/* Limit on the operations of all tries: about half a second. */
#define TRIES_OPERATIONS (BUDGET_LEAST / 2.0)

static deviation_pace pace_at(int i) {
    static const uint64_t spacings[PACES_LONG] = {50, 40, 25, 20, 16, 10, 8, 5, 4, 2};
    static const uint64_t parts[] = {1, 2, 4, 5, 8};
    if (i < PACES_LONG) {
        return (deviation_pace){1, spacings[i]};
    }
    uint64_t steps = parts[(i - PACES_LONG) % 5];
    for (int k = (i - PACES_LONG) / 5; k > 0; k--) {
        steps *= 10;
    }
    return (deviation_pace){steps, 1};
}

/* `slow`: NULL, or the first pace that was not tried because of TRIES_OPERATIONS. */
static void say_no_pace(const trials *t, const setting *s, double least, bool rounds,
                        const deviation_pace *slow, double operations) {
    char text[NUMBER_SIZE];
    char smallest[60] = "all failed";
    char why[160] = "";
    if (least < (double)INFINITY) {
        snprintf(smallest, sizeof smallest, "the smallest is %.2e %s", least, trial_unit(t));
    }
    if (rounds) {
        snprintf(why, sizeof why,
                 ", and shorter steps do not reduce the error, because of round-off");
    } else if (slow != NULL) {
        snprintf(
            why, sizeof why,
            "; with steps of %s s or less, all tries together need %.1e operations or more, and the limit "
            "is %.1e",
            trial_step_text(t, *slow, text), operations, TRIES_OPERATIONS);
    }
    fprintf(stderr,
            "whirl run: error: no tried step stays within --error: %s%s\n"
            "hint: %s%s; `whirl choose` tries every setting\n",
            smallest, why, rounds ? "a larger --error" : "a --method of higher order",
            s->number == &engine_float ? ", or --number double" : "");
}

/* Tries paces from long to short. Returns the index of the first that satisfies --error, or -1 (reported).
 * *longest is false if a longer pace failed. */
static int find_pace(trials *t, const setting *s, deviation_pace *pace, trial_result *r,
                     bool *longest) {
    double least = (double)INFINITY;
    double operations = 0.0; /* of all tries */
    bool slow = false;
    int falls = 0; /* tries with an error below 0.7 * least */
    int stuck = 0; /* tries since the last fall */
    *longest = true;
    for (int i = 0; i < PACES && !t->stopped && !(falls >= 3 && stuck >= 2); i++) {
        *pace = pace_at(i);
        if (pace->records > (uint64_t)t->records) {
            continue;
        }
        operations += trial_operations(t, s, *pace);
        slow = operations > TRIES_OPERATIONS;
        if (slow) {
            break;
        }
        *r = trial_run(t, s, *pace);
        const bool usable = r->ran && r->usable;
        if (usable && r->error <= t->tolerated) {
            return i;
        }
        const bool fell = usable && r->error < 0.7 * least;
        falls += fell ? 1 : 0;
        stuck = fell ? 0 : stuck + 1;
        least = usable ? number_least(least, r->error) : least;
        *longest = false;
    }
    if (t->stopped) {
        fputs("whirl run: interrupted\n", stderr);
    } else {
        say_no_pace(t, s, least, falls >= 3 && stuck >= 2, slow ? pace : NULL, operations);
    }
    return -1;
}

/* Does a run at this pace need a remedy? */
static bool is_warned_of(const trials *t, const setting *s, deviation_pace pace) {
    const trial_source *from = t->request.source;
    char text[NUMBER_SIZE];
    setting finer = *s;
    const bool other = image_settings_finer(&s->image, &finer.image);
    trial_step_text(t, pace, text);
    image *im = from->make(from->context, 0, s, text, NULL);
    if (im != NULL && other) {
        im->finer = from->make(from->context, 0, &finer, text, NULL);
    }
    const bool warned = im != NULL && !remedy_not_needed(im, s->number);
    image_free(im);
    return warned;
}

/* If *pace has warnings, tries shorter paces. Returns true if it replaced *pace by one without warnings. */
static bool find_unwarned(trials *t, const setting *s, int at, deviation_pace *pace,
                          trial_result *r) {
    enum { MORE = 6 };
    if (setting_is_fixed(s) || s->image.matrix != MATRIX_NONE || !is_warned_of(t, s, *pace)) {
        return false;
    }
    double operations = 0.0;
    for (int i = at + 1; i < PACES && i <= at + MORE && !t->stopped; i++) {
        const deviation_pace next = pace_at(i);
        operations += 4.0 * trial_operations(t, s, next);
        if (next.records <= (uint64_t)t->records && operations <= TRIES_OPERATIONS) {
            const trial_result one = trial_run(t, s, next);
            if (one.ran && one.usable && one.error <= t->tolerated && !is_warned_of(t, s, next)) {
                *pace = next;
                *r = one;
                return true;
            }
        }
    }
    return false;
}

static int choose(pricing *p, const setting *s, char **step, char **chosen) {
    char text[NUMBER_SIZE];
    int code = pricing_begin(p, pricing_spacing(p->until_s, PRICING_RECORDS));
    if (code != EXIT_DONE) {
        return code;
    }
    trials *t = &p->trial;
    if (!t->reliable && !t->stopped) {
        fprintf(stderr, "whirl run: error: --error: no reference is accurate enough: %s\n",
                t->reference[t->worst]->why);
        return EXIT_RUN_FAILED;
    }
    t->tolerated = p->error_si / trial_error_si(t, 1.0);
    deviation_pace pace;
    trial_result r;
    bool longest;
    const int at = find_pace(t, s, &pace, &r, &longest);
    if (at < 0) {
        return t->stopped ? EXIT_INTERRUPTED : EXIT_RUN_FAILED;
    }
    trial_step_text(t, pace, text);
    char *longer = find_unwarned(t, s, at, &pace, &r)
                       ? alloc_words("; a step of %s s would also stay within the error, "
                                     "but has warnings",
                                     text)
                       : alloc_words("%s", longest ? "; longer steps were not tried" : "");
    *step = alloc_words("%s", trial_step_text(t, pace, text));
    *chosen = alloc_words("chosen step        %s s: error of %s at most %.2e %s until t = %.6g s%s",
                          *step, p->quantity, r.error, trial_unit(t), trial_horizon_s(t), longer);
    free(longer);
    return EXIT_DONE;
}

int rating_choose(const common_options *common, const char *target, const char *error,
                  source_model *from, char **step, char **chosen) {
    const char *equals = strchr(error, '=');
    if (equals == NULL || equals == error || equals[1] == '\0' || common->changes.step != NULL) {
        fputs(equals != NULL && common->changes.step != NULL
                  ? "whirl run: error: --error chooses the step, so --step cannot set it\n"
                    "hint: leave one of them out\n"
                  : "whirl run: error: --error takes a coordinate and its allowed error\nhint: "
                    "write a value such as --error x=0.1mm\n",
              stderr);
        return EXIT_BAD_INPUT;
    }
    pricing p = pricing_defaults("run", 1);
    p.typed = target;
    p.common.changes = common->changes;
    p.balance = true; /* the verdict on the run needs the balance */
    p.value[PRICING_ERROR] = error;
    const setting s = {common->integration, common->number};
    int code = pricing_open(&p);
    code = code == EXIT_DONE ? choose(&p, &s, step, chosen) : code;
    *from = p.from;
    p.from = (source_model){0};
    pricing_close(&p);
    return code;
}
