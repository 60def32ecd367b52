/* shown.c: see shown.h. */
#include "shown.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/room.h"

const char *dimension_unit(dimension dim, bool is_angle, char *text, size_t size) {
    static const struct {
        signed char m, kg, s, A;
        const char *name;
    } named[] = {{1, 0, 0, 0, "m"},     {1, 0, -1, 0, "m/s"}, {1, 0, -2, 0, "m/s^2"},
                 {0, 1, 0, 0, "kg"},    {0, 0, 1, 0, "s"},    {0, 0, -1, 0, "1/s"},
                 {1, 1, -2, 0, "N"},    {2, 1, -2, 0, "N*m"}, {2, 1, -3, 0, "W"},
                 {0, 0, 0, 1, "A"},     {2, 1, -3, -1, "V"},  {1, 1, -1, 0, "kg*m/s"},
                 {2, 1, -1, 0, "N*m*s"}};
    bool none = true;
    for (int i = 0; i < DIM_BASES; i++) {
        none = none && dim.twelfths[i] == 0;
    }
    if (none || dim.any) {
        snprintf(text, size, "%s", is_angle ? "rad" : "1");
        return text;
    }
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++) {
        if (dim.twelfths[DIM_LENGTH] == 12 * named[i].m &&
            dim.twelfths[DIM_MASS] == 12 * named[i].kg &&
            dim.twelfths[DIM_TIME] == 12 * named[i].s &&
            dim.twelfths[DIM_CURRENT] == 12 * named[i].A && dim.twelfths[DIM_TEMPERATURE] == 0) {
            snprintf(text, size, "%s", named[i].name);
            return text;
        }
    }
    return dim_symbols(dim, text, size);
}

struct unit shown_unit(const symbol *s, int primes) {
    const struct unit si = {1.0, 1.0, s->dim};
    (void)primes; /* a derivative is one per second: the same number */
    return s->unit[0] == '\0' || unit_is_si(s->declared) ? si : s->declared;
}

static char *copy_of(const char *text) { return room_copy(text, strlen(text)); }

char *shown_si_name(const symbol *s, int primes) {
    char text[DIM_TEXT_SIZE];
    dimension dim = s->dim;
    const bool is_angle = s->is_angle || unit_is_angle(s->unit, strlen(s->unit));
    if (is_angle && primes > 0) {
        snprintf(text, sizeof text, primes > 1 ? "rad/s^%d" : "rad/s", primes);
        return copy_of(text);
    }
    dim.twelfths[DIM_TIME] = (short)(dim.twelfths[DIM_TIME] - DIM_DENOMINATOR * primes);
    dim.any = dim.any && primes == 0;
    return copy_of(dimension_unit(dim, is_angle, text, sizeof text));
}

char *shown_unit_name(const symbol *s, int primes) {
    if (s->unit[0] == '\0' || (primes > 0 && unit_is_si(s->declared))) {
        return shown_si_name(s, primes);
    }
    char per[16] = "";
    if (primes > 0) {
        snprintf(per, sizeof per, primes > 1 ? "/s^%d" : "/s", primes);
    }
    return room_words("%s%s", s->unit, per);
}

void shown_note_bare(const char *typed, const symbol *s, int primes) {
    char *name = shown_unit_name(s, primes);
    char *si = shown_si_name(s, primes);
    fprintf(stderr,
            "note: %s has no unit and counts as %s: '%s' is declared in [%s]\n"
            "hint: write the unit behind the number: [%s] or [%s]\n",
            typed, si, s->name, s->unit, name, si);
    free(si);
    free(name);
}
