/* drawn_scene.h: a random image with everything that writers write: names, units, starts, contacts, accounts, tables
 * and lists of operations. For tests of writers and descriptions. Its numbers have no meaning, and no test steps it. */
#ifndef TESTS_HOST_DRAWN_SCENE_H
#define TESTS_HOST_DRAWN_SCENE_H

#include "command.h"
#include "host/image/image.h"

enum {
    SCENE_UNKNOWNS = 4,
    SCENE_STATES = 12,
    SCENE_FEW = 3, /* largest number of inputs, outputs, parameters, effects or tables */
    SCENE_CONTACTS = 5,
    SCENE_SETS = 4,
    SCENE_ROWS = 6, /* rows of the energy balance that change continuously */
    SCENE_OPS = 260,
    SCENE_RESULTS = 64,
    SCENE_TERMS = 4,
    SCENE_BITS = 5,
    SCENE_LINES = 9
};

typedef struct scene_list {
    op ops[SCENE_OPS];
    int turns[SCENE_OPS][SCENE_UNKNOWNS];
    double parts[SCENE_OPS][SCENE_UNKNOWNS];
    int result[SCENE_RESULTS];
    op_list list;
} scene_list;

typedef struct drawn_scene {
    image im;
    image_effect effect[SCENE_FEW];
    image_unknown unknown[SCENE_UNKNOWNS];
    image_unit unit[SCENE_UNKNOWNS][4];
    component angle[SCENE_UNKNOWNS];
    component real[SCENE_STATES];
    int place[SCENE_UNKNOWNS];
    int from_momentum[SCENE_UNKNOWNS];
    image_quantity input[SCENE_FEW];
    image_quantity output[SCENE_FEW];
    image_quantity parameter[SCENE_FEW];
    double start_rad[SCENE_UNKNOWNS];
    int64_t start_turns[SCENE_UNKNOWNS];
    double start_real[SCENE_STATES];
    image_range range[SCENE_STATES + SCENE_FEW];
    image_contact contact[SCENE_CONTACTS];
    int target[SCENE_SETS];
    image_entry entry[SCENE_ROWS];
    int account_of[1 + SCENE_UNKNOWNS];
    int booked[SCENE_FEW];
    /* entries of im.matrix: the columns of Phi, Gamma and g of a step */
    double entries[SCENE_STATES * (SCENE_STATES + SCENE_FEW + 1)];
    double number[SCENE_FEW * SCENE_TERMS << SCENE_BITS];
    double size[SCENE_FEW];
    double off[SCENE_FEW];
    bool odd[SCENE_FEW];
    scene_list list[IMAGE_ROLES];
} drawn_scene;

/* Bits that allow kinds of operations in a list. */
enum {
    TAKES_RATES = 1,   /* allows rates; set for every list of second order */
    TAKES_RECORDS = 2, /* allows angles together with their turns */
    TAKES_STATE = 4,   /* allows time and noise */
    TAKES_ACCEL = 8,
    TAKES_TABLES = 16,
    TAKES_SUMS = 32 /* allows only sums of states and inputs */
};

/* Draws the operation list of `role`, with `results` results and the operations that `takes` allows. In one case of
 * six the length is near a limit above which the writer changes the form of the code. */
void drawn_scene_list(drawn_scene *d, dice *die, image_role role, int results, unsigned takes);

/* Draws a scene of any kind: first or second order, with or without contacts, energy balance, tables and matrix. */
void drawn_scene_draw(drawn_scene *d, dice *die);

/* Statement number `line` (from 1), without indentation and comment, of the file to which the scene's source places
 * refer. */
const char *drawn_scene_statement(int line);

/* Writes the name of a component, such as "theta''", to text[40]. */
const char *drawn_scene_name(const drawn_scene *d, component c, char *text);

extern const char *const drawn_scene_roles[IMAGE_ROLES];

/* Number of real numbers in the memory of the scene's state: states, carries, inputs, contacts and accounts, but no
 * angles. */
int drawn_scene_numbers(const image *im);
/* Bytes of the state's memory without contacts. A number has `number` bytes, an angle eight. */
size_t drawn_scene_bytes(const image *im, size_t number);
/* drawn_scene_evaluations(): the largest number of evaluations of accelerations or slopes in a step.
 * drawn_scene_signals(): the largest number of evaluations of contact signals. */
int drawn_scene_evaluations(const image *im);
int drawn_scene_signals(const image *im);

#endif
