/* image.c: access to an image. */
#include "host/image/image.h"

#include "core/step/stage_turn.h"
#include "core/step/table.h"
#include "host/base/alloc.h"

/* === settings ================================================================================= */

const char *const image_angles_words[IMAGE_ANGLES] = {IMAGE_ANGLES_ROWS(IMAGE_ROW_WORD)};
const char *const image_matrix_words[IMAGE_MATRICES] = {IMAGE_MATRIX_ROWS(IMAGE_ROW_WORD)};
const char *const image_tables_words[IMAGE_TABLES_FORMS] = {IMAGE_TABLES_ROWS(IMAGE_ROW_WORD)};

_Static_assert(IMAGE_CELLS_LEAST == 1U << WH_TABLE_BITS_LEAST &&
                   IMAGE_CELLS_MOST == 1U << WH_TABLE_BITS_MOST,
               "the core's tables are what an image may have");

_Static_assert(TURNED_WAVES_MAX == WH_WAVES,
               "an image may have as many sines as the core reserves memory for");

bool image_turns(const image *im) {
    const op_list *t = im->list[IMAGE_STEP];
    return im->settings.angles == ANGLES_TURNED && im->settings.matrix == MATRIX_NONE &&
           im->contacts == 0 && im->angles > 0 && im->settings.tables == TABLES_NONE &&
           wh_method_turns(im->settings.method) && op_list_takes_waves(t) &&
           op_list_waves(t) <= TURNED_WAVES_MAX;
}

/* === access =================================================================================== */

void image_free(image *im) {
    if (im == NULL) {
        return;
    }
    for (int role = 0; role < IMAGE_ROLES; role++) {
        if (im->base == NULL || im->list[role] != im->base->list[role]) {
            op_list_free(im->list[role]);
        }
    }
    for (int k = 0; k < im->ways && im->base == NULL; k++) {
        image_free(im->refolded[k]);
    }
    image_free(im->finer);
    arena_free(im->memory);
}

bool image_settings_finer(const image_settings *of, image_settings *finer) {
    *finer = *of;
    finer->tables = TABLES_NONE;
    finer->cells = 0;
    finer->compensated = of->compensated || of->matrix == MATRIX_EXACT;
    return finer->tables != of->tables || finer->compensated != of->compensated;
}

component image_component(const image *im, int i) {
    return i < im->angles ? im->angle[i] : im->real[i - im->angles];
}

int image_find_component(const image *im, int unknown, int primes) {
    for (int i = 0; i < im->angles + im->reals; i++) {
        const component c = image_component(im, i);
        if (c.unknown == unknown && c.primes == primes) {
            return i;
        }
    }
    return -1;
}

const char *image_stepper(const image *im) {
    switch (im->settings.matrix) {
    case MATRIX_NONE: break;
    case MATRIX_EXACT: return "one exact matrix a step";
    case MATRIX_RK4: return "Runge-Kutta 4 as one matrix a step";
    }
    return wh_methods[im->settings.method].title;
}

const char *image_sums(const image *im) {
    static const char *const words[2][2] = {{"", " stabilized"},
                                            {" compensated", " compensated, stabilized"}};
    return words[im->settings.compensated][im->settings.stabilized];
}

bool image_shows_si(const image_unit *unit) { return unit->scale == unit->divisor; }

double image_shown(const image_unit *unit, double si) {
    return image_shows_si(unit) ? si : si * unit->divisor / unit->scale;
}

void image_inputs(const image *im, double *input) {
    for (int i = 0; i < im->inputs; i++) {
        input[i] = im->input[i].value;
    }
}

double image_start(const image *im, int i) {
    return i < im->angles ? im->start_rad[i] : im->start_real[i - im->angles];
}

bool image_calls(const image *im) {
    bool calls = false;
    for (int role = 0; role < IMAGE_ROLES; role++) {
        const op_list *t = im->list[role];
        /* generated code does not have IMAGE_BOOKS */
        calls = calls || (role != IMAGE_BOOKS && t != NULL && op_list_count(t).calls > 0);
    }
    return calls;
}

double image_out_of_float(const image *im) {
    const image_role step = im->list[IMAGE_MATRIX] != NULL ? IMAGE_MATRIX : IMAGE_STEP;
    const image_role moving[] = {step, IMAGE_SIGNALS, IMAGE_FORCES, IMAGE_SETS};
    double found = 0.0;
    for (size_t k = 0; k < sizeof moving / sizeof moving[0] && found == 0.0; k++) {
        const op_list *t = im->list[moving[k]];
        found = t != NULL ? op_list_out_of_float(t) : 0.0;
    }
    for (int i = 0; i < im->inputs && found == 0.0; i++) {
        found = fits_float(im->input[i].value) ? 0.0 : im->input[i].value;
    }
    return found;
}
