#include "drawn_image.h"

#include <math.h>

#define PI 3.14159265358979323846

static const char *const names[] = {"theta", "X", "phi_2", "longer_name"};
static const char *const input_names[] = {"M", "F", "u3"};

static void draw_unknown(drawn_image *d, dice *die, int i) {
    static const image_unit turned[] = {
        {"deg", "rad", PI, 180.0}, {"deg/s", "rad/s", PI, 180.0}, {"rad/s^2", "rad/s^2", 1.0, 1.0}};
    static const image_unit moved[] = {
        {"mm", "m", 1.0, 1000.0}, {"m/s", "m/s", 1.0, 1.0}, {"m/s^2", "m/s^2", 1.0, 1.0}};
    static const image_unit bare[] = {
        {"1", "1", 1.0, 1.0}, {"1/s", "1/s", 1.0, 1.0}, {"1/s^2", "1/s^2", 1.0, 1.0}};
    const bool is_angle = dice_one_of(die, 2) == 0;
    const image_unit *unit = is_angle ? turned : dice_one_of(die, 2) == 0 ? moved : bare;
    for (int k = 0; k < 3; k++) {
        d->unit[i][k] = unit[k];
    }
    d->unknown[i] = (image_unknown){
        .name = names[i], .text = "", .is_angle = is_angle, .order = 2, .unit = d->unit[i]};
    component *value = is_angle ? &d->angle[d->im.angles++] : &d->real[d->im.reals++];
    *value = (component){i, 0};
}

static double drawn_entry(dice *die) {
    switch (dice_one_of(die, 4)) {
    case 0: return 0.0;
    case 1: return 1.0;
    case 2: return dice_between(die, -2.0, 2.0);
    default: return dice_between(die, -2.0, 2.0) * pow(10.0, dice_between(die, -20.0, 20.0));
    }
}

void drawn_image_draw(drawn_image *d, dice *die, image_matrix_of matrix) {
    *d = (drawn_image){.im = {.name = "drawn",
                              .title = dice_one_of(die, 2) == 0 ? "" : "of no mechanism",
                              .settings = IMAGE_SETTINGS_DEFAULT,
                              .count = 1 + (int)dice_one_of(die, DRAWN_UNKNOWNS),
                              .inputs = (int)dice_one_of(die, DRAWN_INPUTS + 1)}};
    image *im = &d->im;
    im->step = (whole_ratio){1 + dice_one_of(die, 9), 1000};
    im->step_s = (double)im->step.numerator / 1000.0;
    im->steps = 1 + dice_one_of(die, 100000);
    im->settings.matrix = matrix;
    im->settings.compensated = dice_one_of(die, 2) == 0;
    im->unknown = d->unknown;
    im->angle = d->angle;
    im->real = d->real;
    im->input = d->input;
    for (int i = 0; i < im->count; i++) {
        draw_unknown(d, die, i);
    }
    for (int i = 0; i < im->count; i++) {
        d->real[im->reals++] = (component){i, 1};
    }
    for (int i = 0; i < im->inputs; i++) {
        d->input[i] = (image_quantity){.name = input_names[i],
                                       .text = "",
                                       .unit = {"N", i == 0 ? "N*m" : "N", 1.0, 1.0},
                                       .value = drawn_entry(die)};
    }
    const int states = im->angles + im->reals;
    im->matrix =
        (image_matrix){.states = states, .columns = states + im->inputs + 1, .entry = d->entry};
    im->start_rad = d->entry;
    im->start_real = d->entry + im->angles;
    const bool has_offset = dice_one_of(die, 2) == 0;
    for (int i = 0; i < states * im->matrix.columns; i++) {
        const bool is_offset = i % im->matrix.columns == im->matrix.columns - 1;
        d->entry[i] = is_offset && !has_offset ? 0.0 : drawn_entry(die);
    }
}

static component component_of(const drawn_image *d, int column) {
    return column < d->im.angles ? d->angle[column] : d->real[column - d->im.angles];
}

const char *drawn_image_name(const drawn_image *d, int column, char *text) {
    const int states = d->im.angles + d->im.reals;
    if (column >= states) {
        snprintf(text, 40, "%s",
                 column < states + d->im.inputs ? input_names[column - states] : "");
    } else {
        const component c = component_of(d, column);
        snprintf(text, 40, "%s%s", names[c.unknown], c.primes == 0 ? "" : "'");
    }
    return text;
}

const char *drawn_image_unit(const drawn_image *d, int column) {
    const int states = d->im.angles + d->im.reals;
    if (column >= states) {
        return d->input[column - states].unit.si;
    }
    const component c = component_of(d, column);
    return d->unit[c.unknown][c.primes].si;
}
