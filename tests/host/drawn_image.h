/* drawn_image.h: a random image of names, units and numbers, without operations, for tests of writers. No test steps
 * it. */
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

/* Draws an image of second order: unknowns, some of which are angles, with their rates. In half of the cases, the
 * last column of a `matrix` step is zero. The start values are the first entries of the matrix. The texts are string
 * literals: do not free them. */
void drawn_image_draw(drawn_image *d, dice *die, image_matrix_of matrix);

/* Writes the name of a column to text[40], such as "theta'" for a component. The inputs follow the components. */
const char *drawn_image_name(const drawn_image *d, int column, char *text);
const char *drawn_image_unit(const drawn_image *d, int column);

#endif
