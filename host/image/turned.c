/* turned.c: the choice of the form of a scene's step. */
#include "turned.h"

#include "core/step/stage_turn.h"
#include "core/step/table.h"

#define IMAGE_ANGLES_WORD(id, word) word,
const char *const image_angles_words[IMAGE_ANGLES] = {IMAGE_ANGLES_ROWS(IMAGE_ANGLES_WORD)};

#define IMAGE_MATRIX_WORD(id, word) word,
const char *const image_matrix_words[IMAGE_MATRICES] = {IMAGE_MATRIX_ROWS(IMAGE_MATRIX_WORD)};

#define IMAGE_TABLES_WORD(id, word) word,
const char *const image_tables_words[IMAGE_TABLES_FORMS] = {IMAGE_TABLES_ROWS(IMAGE_TABLES_WORD)};

_Static_assert(IMAGE_CELLS_LEAST == 1U << WH_TABLE_BITS_LEAST &&
                   IMAGE_CELLS_MOST == 1U << WH_TABLE_BITS_MOST,
               "the core's tables are what an image may have");

_Static_assert(TURNED_WAVES_MAX == WH_WAVES, "the core's room is what an image may have");

bool image_turns(const image *im) {
    const op_list *t = im->list[IMAGE_STEP];
    return im->settings.angles == ANGLES_TURNED && im->settings.matrix == MATRIX_NONE &&
           im->contacts == 0 && im->angles > 0 && im->settings.tables == TABLES_NONE &&
           wh_method_turns(im->settings.method) && op_list_takes_waves(t) &&
           op_list_waves(t) <= TURNED_WAVES_MAX;
}
