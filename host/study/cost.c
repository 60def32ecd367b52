#include "host/study/cost.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/engine/start.h"
#include "host/fixed/fixed_plan.h"
#include "host/image/core_rows.h"
#include "host/image/image.h"
#include "host/number/decimal.h"

#include "host/study/cost_rows.inc"

/* === boards and number types ================================================================== */

#define COST_BASIS_WORD(id, word, says) word,
const char *const cost_basis_words[COST_BASES] = {COST_BASIS_ROWS(COST_BASIS_WORD)};
const char *const cost_number_words[COST_NUMBERS] = {"float", "double", "fixed"};

/* The two numbers after COST_RANGE are assumed limits of the cycles per instruction. */
const cost_board cost_boards[] = {
    {"atmega328p", "AVR", false, COST_SIMULATED, 0, 0, 16e6, 32768, 2048},
    {"atmega2560", "AVR", false, COST_SIMULATED, 0, 0, 16e6, 262144, 8192},
    {"mps2-an385-m0", "Cortex-M0", false, COST_ESTIMATED, 0, 0, 0, 0, 0},
    {"mps2-an385", "Cortex-M3", false, COST_ESTIMATED, 0, 0, 0, 0, 0},
    {"mps2-an386", "Cortex-M4F", true, COST_ESTIMATED, 0, 0, 0, 0, 0},
    {"mps2-an500", "Cortex-M7", true, COST_RANGE, 0.5, 3.0, 0, 0, 0},
    {"mps2-an505", "Cortex-M33", true, COST_RANGE, 0.8, 3.0, 0, 0, 0},
    {"rv32imac", "RV32IMAC", false, COST_RANGE, 1.0, 4.0, 0, 0, 0},
    {"rv32imafc", "RV32IMAFC", true, COST_RANGE, 1.0, 5.0, 0, 0, 0},
    {"host", "x86-64", true, COST_RANGE, 0.2, 3.0, 0, 0, 0},
};
const int cost_board_count = sizeof cost_boards / sizeof cost_boards[0];

const cost_board *cost_board_named(const char *name) {
    for (int i = 0; i < cost_board_count; i++) {
        if (strcmp(cost_boards[i].name, name) == 0) {
            return &cost_boards[i];
        }
    }
    return NULL;
}

/* === the operations of a step, by class ======================================================= */

/* Lists of at most this many operations are inlined (host/emit/c_list.c, host/fixed/c_fixed.c). */
enum { INLINED_MOST = 150, INLINED_FIXED = 80 };
enum { REGISTERS = 16 };   /* number of state and stage values that FPU registers hold */
enum { SUMS_CARRIED = 9 }; /* extra additions for each of im->reals in a compensated matrix step */

static void add(cost_counts *c, cost_class class, double run, double code) {
    c->run[class] += run;
    c->code[class] += code;
}

/* --- the lists ---------------------------------------------------------------------------------------*/

/* The class of each operation; operations without an entry (0) are of COST_CLASS_MOVE. */
static const cost_class classes[OPS] = {
    [OP_ADD] = COST_CLASS_SUM,       [OP_SUB] = COST_CLASS_SUM,
    [OP_MUL] = COST_CLASS_PRODUCT,   [OP_DIV] = COST_CLASS_QUOTIENT,
    [OP_SQRT] = COST_CLASS_ROOT,     [OP_PHASE] = COST_CLASS_LOOKED_UP,
    [OP_CALL] = COST_CLASS_FUNCTION, [OP_POW] = COST_CLASS_POWER,
    [OP_CELL] = COST_CLASS_CELL,     [OP_LINE] = COST_CLASS_LINE,
    [OP_CUBIC] = COST_CLASS_CUBIC};

static cost_class class_of(const op *o) {
    return classes[o->code] != 0 ? classes[o->code] : COST_CLASS_MOVE;
}

static bool is_turned(const op *o) { return o->code == OP_PHASE && o->b < 0; }

typedef struct times {
    double stages; /* evaluations per step of an operation with depth_of() 2 */
    double places; /* evaluations per step of an operation with depth_of() 1 */
    double once;   /* evaluations per step of an operation with depth_of() 0 */
} times;

/* 0: operation i has the same value at all stages. 1: it depends on positions. 2: it depends on rates, or is a call. */
static int depth_of(const op_list *t, int i, const int *depth) {
    const op *o = &t->ops[i];
    int operand[2];
    int most = o->code == OP_CONSTANT || o->code == OP_INPUT                   ? 0
               : o->code == OP_RATE || o->code == OP_CALL || o->code == OP_POW ? 2
               : op_rows[o->code].kind == OP_IS_LEAF || o->code == OP_CELL || o->code == OP_PHASE
                   ? 1
                   : 0;
    for (int k = op_list_operands(o, operand); k > 0; k--) {
        most = depth[operand[k - 1]] > most ? depth[operand[k - 1]] : most;
    }
    return most;
}

/* If `turned`, omits the sine-cosine pairs that are rotated, because add_stages() counts them. */
static void add_list(cost_counts *c, const op_list *t, bool turned, times run, double code) {
    int *depth = t != NULL ? alloc(t->count, sizeof *depth) : NULL;
    for (int i = 0; t != NULL && i < t->count; i++) {
        const op *o = &t->ops[i];
        depth[i] = depth_of(t, i, depth);
        /* sine and cosine of an angle are counted as one operation, OP_PHASE */
        if (o->code != OP_SIN && o->code != OP_COS && !(turned && is_turned(o))) {
            add(c, class_of(o),
                depth[i] == 0   ? run.once
                : depth[i] == 1 ? run.places
                                : run.stages,
                code);
        }
    }
    if (t != NULL) {
        add(c, COST_CLASS_MOVE, run.stages * (op_list_carried(t) + t->results), code * t->results);
    }
    free(depth);
}

/* Counts each used library function once, because its code exists once. */
static void add_libraries(cost_counts *c, const image *im) {
    bool has[COST_CLASSES] = {false};
    bool calls[FUNCTIONS] = {false};
    const op_list *lists[] = {im->list[IMAGE_STEP], im->list[IMAGE_OBSERVE]};
    for (int k = 0; k < 2; k++) {
        for (int i = 0; lists[k] != NULL && i < lists[k]->count; i++) {
            const op *o = &lists[k]->ops[i];
            has[class_of(o)] = true;
            if (o->code == OP_CALL) {
                calls[o->function] = true;
            }
        }
    }
    static const cost_class shared[] = {COST_CLASS_QUOTIENT, COST_CLASS_ROOT, COST_CLASS_LOOKED_UP,
                                        COST_CLASS_FUNCTION, COST_CLASS_POWER};
    int count = 0;
    for (size_t i = 0; i < sizeof shared / sizeof shared[0]; i++) {
        count += has[shared[i]];
    }
    for (int i = 0; i < FUNCTIONS; i++) {
        count += calls[i];
    }
    add(c, COST_CLASS_LIBRARY, 0, count);
}

/* --- the method --------------------------------------------------------------------------------------*/

typedef struct work {
    int stages;
    int places; /* distinct positions of the stages */
    int shares; /* nonzero weights of the method's tableau, for stages and for the step's end */
    int turns;  /* rotations of a sine-cosine pair in a step */
} work;

/* Has an earlier stage the same positions as stage s? */
static bool stands_again(const wh_tableau *by, unsigned s) {
    const wh_places *at = by->places;
    for (unsigned e = 0; e < s; e++) {
        bool same = at->node[e] == at->node[s] && at->reach[e].parts == at->reach[s].parts;
        for (unsigned j = 0; j < by->stages; j++) {
            same = same && at->reach[e].share[j] == at->reach[s].share[j];
        }
        if (same) {
            return true;
        }
    }
    return false;
}

static work work_of(const wh_tableau *by, bool reaches) {
    work w = {.stages = (int)by->stages};
    for (unsigned s = 0; s < by->stages; s++) {
        bool shears = false;
        for (unsigned j = 0; j < s; j++) {
            w.shares += by->stage[s].share[j] != 0;
            w.shares += reaches && by->places->reach[s].share[j] != 0;
            shears = shears || (j > 0 && by->stage[s].share[j] != 0);
        }
        w.shares += by->rates[s] != 0;
        w.shares += by->positions[s] != 0 && by->positions[s] != by->rates[s];
        w.turns += shears;
        w.places += !(reaches && stands_again(by, s));
    }
    int most = 0;
    for (unsigned s = 0; s < by->stages; s++) {
        most = by->turns[s] > most ? by->turns[s] : most;
    }
    w.turns += most;
    return w;
}

static void add_stages(cost_counts *c, const image *im, bool called, bool fpu) {
    const wh_tableau *by = wh_tableau_of(im->settings.method);
    const bool second = im->form == WH_SECOND_ORDER;
    const bool turned = image_turns(im);
    const work w = work_of(by, second && by->places != NULL);
    const op_list *list = im->list[IMAGE_STEP];
    int pairs = 0;
    for (int i = 0; i < list->count; i++) {
        pairs += is_turned(&list->ops[i]);
    }
    const int components = second ? im->coordinates : im->angles + im->reals;
    const double copies = called ? 1 : w.stages;
    const times each = {w.stages, called ? w.stages : w.places, called ? w.stages : 1};
    const times all = {w.stages, w.stages, w.stages};
    add(c, COST_CLASS_STAGE, (second ? 2 : 1) * components * w.stages, components * w.stages);
    add(c, COST_CLASS_ANGLE, turned ? im->angles : w.stages * im->angles, im->angles);
    const int more = (second ? 4 : 2) * components - REGISTERS;
    const int spilled = fpu && more > 0 ? more : 0;
    add(c, COST_CLASS_SPILL, w.stages * spilled, spilled);
    add(c, COST_CLASS_SHARE, w.shares * components, w.shares * components);
    add(c, COST_CLASS_CALL, called ? w.stages : 0, called);
    add_list(c, list, turned, each, copies);
    if (turned) {
        add(c, COST_CLASS_LOOKED_UP, pairs, pairs);
        add(c, COST_CLASS_TURNED, w.turns * pairs, w.turns * pairs);
    }
    if (im->ledger.kept) {
        add_list(c, im->list[IMAGE_POWERS], false, all, 1);
        add(c, COST_CLASS_BOOK, w.stages * im->ledger.entries, im->ledger.entries);
    }
    if (im->settings.compensated) {
        const double carried = im->reals + im->angles;
        add(c, COST_CLASS_CARRY, carried + (turned ? w.turns * pairs : 0), carried);
    }
}

static void add_firmware(cost_counts *c, const image *im) {
    const op_list_tables *of = &im->list[IMAGE_STEP]->tables;
    const double cells = of->count > 0 ? (double)(1U << (unsigned)of->bits) : 0.0;
    add_list(c, im->list[IMAGE_OBSERVE], false, (times){0, 0, 0}, 1);
    add_libraries(c, im);
    add(c, COST_CLASS_TABLE, 0, (of->folds ? cells / 2 + 1 : cells) * of->count * of->terms);
}

/* --- fixed point -------------------------------------------------------------------------------------*/

static const cost_class fixed_classes[FIXED_MOST + 1] = {[FIXED_PHASE] = COST_CLASS_LOOKED_UP,
                                                         [FIXED_SUM] = COST_CLASS_SUM,
                                                         [FIXED_DIFFERENCE] = COST_CLASS_SUM,
                                                         [FIXED_PRODUCT] = COST_CLASS_PRODUCT,
                                                         [FIXED_QUOTIENT] = COST_CLASS_QUOTIENT};

static cost_class class_of_fixed(fixed_code code) {
    return fixed_classes[code] != 0 ? fixed_classes[code] : COST_CLASS_MOVE;
}

static bool is_shifted(const fixed_list *l, fixed_operand from) {
    return l->op[from.op].code != FIXED_CONSTANT && from.shift != 0;
}

static void add_fixed(cost_counts *c, const image *im) {
    const fixed_list *l = im->fixed->list;
    int operations = 0;
    for (int i = 0; i < l->count; i++) {
        operations += l->op[i].used && class_of_fixed(l->op[i].code) != COST_CLASS_MOVE;
    }
    const bool called = operations > INLINED_FIXED;
    const double stages = wh_methods[WH_RK4].stages;
    const double copies = called ? 1 : stages;
    for (int i = 0; i < l->count; i++) {
        const fixed_op *o = &l->op[i];
        const bool is_none = !o->used || o->code == FIXED_CONSTANT || o->code == FIXED_SINE ||
                             o->code == FIXED_COSINE;
        const cost_class class = class_of_fixed(o->code);
        if (is_none) {
            continue;
        }
        add(c, class, stages, copies);
        const bool two = class == COST_CLASS_SUM || class == COST_CLASS_PRODUCT;
        const double shifts = two ? is_shifted(l, o->a) + is_shifted(l, o->b) : 0;
        add(c, COST_CLASS_SHIFT, stages * shifts, copies * shifts);
        if (class == COST_CLASS_LOOKED_UP) {
            c->code[COST_CLASS_LIBRARY] = 1;
        }
    }
    const int each = im->fixed->second ? 2 : 1;
    add(c, COST_CLASS_STAGE, stages * each * im->fixed->coordinates,
        stages * each * im->fixed->coordinates);
    add(c, COST_CLASS_ANGLE, stages * im->angles, im->angles);
    add(c, COST_CLASS_CALL, called ? stages : 0, called);
}

cost_counts cost_count(const image *im, const cost_board *board, cost_number number) {
    cost_counts c = {.run = {0}};
    add(&c, COST_CLASS_STEP, 1, 1);
    add(&c, COST_CLASS_WORD, 0,
        2 * im->angles + 2 * im->reals + im->inputs + core_ledger_words(im) + im->outputs);
    if (number == COST_FIXED) {
        add_fixed(&c, im);
    } else if (im->settings.matrix != MATRIX_NONE) {
        add_firmware(&c, im);
        add_list(&c, im->list[IMAGE_MATRIX], false, (times){1, 1, 1}, 1);
        add(&c, COST_CLASS_MATRIX, im->reals, im->reals);
        add(&c, COST_CLASS_ANGLE, im->angles, im->angles);
        if (im->settings.compensated) {
            add(&c, COST_CLASS_SUM, SUMS_CARRIED * im->reals, SUMS_CARRIED * im->reals);
        }
    } else {
        const bool called = op_list_operations(im->list[IMAGE_STEP]) > INLINED_MOST ||
                            im->contacts > 0 || !board->fpu;
        add_firmware(&c, im);
        add_stages(&c, im, called, board->fpu);
    }
    return c;
}

/* === the price of a step ====================================================================== */

/* --- predicting -----------------------------------------------------------------------------------*/

cost_figure cost_known(double value, cost_basis basis) {
    return (cost_figure){basis, value, value, value};
}

static cost_figure ranged(const cost_board *board, const cost_figure *instructions) {
    return instructions->basis == COST_NOT_KNOWN
               ? (cost_figure){0}
               : (cost_figure){COST_RANGE, 0.0, instructions->least * board->cycles_least,
                               instructions->most * board->cycles_most};
}

bool cost_has_cycles(const cost *c) {
    return c->cycles.basis != COST_RANGE && c->cycles.basis != COST_NOT_KNOWN;
}

/* On a board without counted cycles (COST_RANGE), sets the ranges of cycles and returns true. */
static bool take_ranges(const cost_board *board, cost *c) {
    if (board->cycles == COST_RANGE) {
        c->cycles = ranged(board, &c->instructions);
        c->cycles_worst = ranged(board, &c->instructions_worst);
    }
    return board->cycles == COST_RANGE;
}

const double *cost_counted(const cost_counts *c, cost_quantity quantity) {
    return quantity == COST_OF_INSTRUCTIONS || quantity == COST_OF_CYCLES ? c->run : c->code;
}

static const cost_row *row_of(const cost_board *board, cost_number number, cost_quantity quantity) {
    for (size_t i = 0; i < sizeof cost_rows / sizeof cost_rows[0]; i++) {
        const cost_row *row = &cost_rows[i];
        if (strcmp(row->board, board->name) == 0 && row->number == number &&
            row->quantity == quantity) {
            return row;
        }
    }
    return NULL;
}

/* Predicts a cost: returns its mean over the steps, and sets *worst to that of the longest step. */
static cost_figure sum_of(const cost_row *row, const cost_counts *c, cost_figure *worst,
                          const char **why) {
    double sum = 0.0;
    for (int i = 0; row != NULL && i < COST_CLASSES; i++) {
        const double count = cost_counted(c, row->quantity)[i];
        if (count > 0.0 && row->figure[i] < 0.0) {
            *why = "the cost of one of this scene's operations is unknown on this board: use "
                   "--measure";
            row = NULL;
        } else {
            sum += count * row->figure[i];
        }
    }
    *worst = (cost_figure){0};
    if (row == NULL || !(sum > 0.0)) {
        return *worst;
    }
    *worst = (cost_figure){COST_PREDICTED, sum * row->longest, sum / row->within,
                           sum * row->longest * row->within};
    return (cost_figure){COST_PREDICTED, sum, sum / row->within, sum * row->within};
}

bool cost_takes_method(const image *im) {
    diags *unsaid = diags_new();
    const bool takes = start_has_method(im, im->settings.method, unsaid);
    diags_free(unsaid);
    return takes;
}

static double state_bytes(const image *im, cost_number number) {
    if (number == COST_FIXED) {
        const int words = ((int)WH_FIXED_BYTES(im->angles, im->reals + im->inputs) + 7) / 8;
        return 8.0 * words; /* the generated header reserves as much */
    }
    return 8.0 * im->angles + (number == COST_DOUBLE ? 8.0 : 4.0) * core_memory_reals(im);
}

cost cost_of(const image *im, const cost_board *board, cost_number number) {
    if (number != COST_FIXED && !cost_takes_method(im)) {
        return (cost){.why = "this method is not possible for this scene"};
    }
    if (im->contacts > 0) { /* state_bytes is unknown, too */
        return (cost){.why = "the cost of contacts depends on the motion, so whirl must count it "
                             "in a run"};
    }
    cost c = {.why = "", .state_bytes = cost_known(state_bytes(im, number), COST_EXACT)};
    if (row_of(board, number, COST_OF_INSTRUCTIONS) == NULL) {
        c.why = "Whirl has no instruction counts for this board with this number type";
        return c;
    }
    const cost_counts counts = cost_count(im, board, number);
    cost_figure none;
#define COST_SUM(of, worst) sum_of(row_of(board, number, COST_OF_##of), &counts, worst, &c.why)
    c.instructions = COST_SUM(INSTRUCTIONS, &c.instructions_worst);
    if (!take_ranges(board, &c)) {
        c.cycles = COST_SUM(CYCLES, &c.cycles_worst);
    }
    c.flash_bytes = COST_SUM(FLASH, &none);
    c.ram_bytes = COST_SUM(RAM, &none);
    c.stack_bytes = COST_SUM(STACK, &none);
#undef COST_SUM
    return c;
}

/* --- counted -----------------------------------------------------------------------------------------*/

bool cost_cut(char *row, char **column, int columns) {
    int count = 0;
    bool quoted = false;
    row[strcspn(row, "\r\n")] = '\0';
    column[count++] = row;
    for (char *at = row; *at != '\0' && count <= columns; at++) {
        quoted = quoted != (*at == '"');
        if (*at == ',' && !quoted) {
            *at = '\0';
            if (count < columns) {
                column[count] = at + 1;
            }
            count++;
        }
    }
    return count == columns;
}

const cost_layout cost_step_layout = {COST_COLUMNS, 3, 7, 8, 9, 10};

static void grow(cost_figure *f, cost_basis basis, const char *text) {
    const double value = decimal_read(text, NULL);
    if (text[0] != '\0' && (f->basis == COST_NOT_KNOWN || value > f->value)) {
        *f = cost_known(value, basis);
    }
}

bool cost_enter(char *row, const cost_layout *at, char **column, const cost_board *board, cost *c) {
    if (!cost_cut(row, column, at->columns) || strcmp(column[at->board], board->name) != 0) {
        return false;
    }
    grow(&c->instructions, COST_MEASURED, column[at->instructions]);
    grow(&c->instructions_worst, COST_MEASURED, column[at->instructions_most]);
    if (!take_ranges(board, c)) {
        grow(&c->cycles, board->cycles, column[at->cycles]);
        grow(&c->cycles_worst, board->cycles, column[at->cycles_most]);
    }
    grow(&c->flash_bytes, COST_MEASURED, column[at->columns - 3]);
    grow(&c->ram_bytes, COST_MEASURED, column[at->columns - 2]);
    grow(&c->stack_bytes, COST_MEASURED, column[at->columns - 1]);
    return c->instructions.basis == COST_MEASURED;
}
