/* drawn_image.h: an image of names, units and numbers alone, drawn: for what writes them. Nothing steps it. */
#ifndef TESTS_HOST_DRAWN_IMAGE_H
#define TESTS_HOST_DRAWN_IMAGE_H

#include "command.h"
#include "host/image/image.h"

enum { DRAWN_UNKNOWNS = 4, DRAWN_INPUTS = 3, DRAWN_STATES = 2 * DRAWN_UNKNOWNS };

typedef struct drawn_image {
    image im;
    image_unknown unknown[DRAWN_UNKNOWNS];
    image_unit unit[DRAWN_UNKNOWNS][3];
    component angle[DRAWN_STATES];
    component real[DRAWN_STATES];
    image_quantity input[DRAWN_INPUTS];
    double entry[DRAWN_STATES * (DRAWN_STATES + DRAWN_INPUTS + 1)];
} drawn_image;

/* Of second order: so many unknowns, some of them angles; each has a rate. A step of `matrix`, if it is one, in which the
 * last column is zero in half of the cases. The texts stay the program's own. */
void drawn_image_draw(drawn_image *d, dice *die, image_matrix_of matrix);

/* "theta'" of a component, "M" of an input behind them; in text[40]. */
const char *drawn_image_name(const drawn_image *d, int column, char *text);
/* The SI unit of the same. */
const char *drawn_image_unit(const drawn_image *d, int column);

#endif
