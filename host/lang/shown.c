#include "shown.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"

const char *dimension_unit(dimension dim, bool is_angle, char *text, size_t size) {
    bool none = true;
    for (int i = 0; i < DIM_BASES; i++) {
        none = none && dim.twelfths[i] == 0;
    }
    if (none || dim.any) {
        snprintf(text, size, "%s", is_angle ? "rad" : "1");
        return text;
    }
    return dim_recorded_unit(dim, text, size);
}

unit_scale shown_unit(const symbol *s, int primes) {
    const unit_scale si = {1.0, 1.0, s->dim, enclosure_of(1.0)};
    (void)primes; /* a derivative is per second: the same number */
    return s->unit[0] == '\0' || unit_is_si(s->declared) ? si : s->declared;
}

static char *copy_of(const char *text) { return alloc_copy(text, strlen(text)); }

char *shown_si_name(const symbol *s, int primes) {
    char text[DIM_TEXT_SIZE];
    dimension dim = s->dim;
    const bool is_angle =
        s->is_angle || unit_is_angle(s->unit, strlen(s->unit)) || strcmp(s->unit, "mrad") == 0;
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
    return alloc_words("%s%s", s->unit, per);
}

char *shown_written(const expr *given) {
    const expr *leaf = given;
    while (leaf != NULL && leaf->left != NULL) {
        leaf = leaf->left;
    }
    if (leaf == NULL || leaf->at.source == NULL || leaf->at.source->text == NULL) {
        return NULL;
    }
    const char *text = leaf->at.source->text;
    size_t at = leaf->at.offset;
    while (at > 0 &&
           strchr("=\n", text[at - 1]) == NULL) { /* before it: signs, parentheses, a function */
        at--;
    }
    at += strspn(text + at, " \t");
    char *copy = alloc((int64_t)strlen(text + at) + 1, 1);
    size_t length = 0;
    int depth = 0;
    for (; text[at] != '\0'; at++) {
        const bool blank = strchr(" \t\r\n", text[at]) != NULL;
        depth += (text[at] == '(') - (text[at] == ')');
        if (depth <= 0 && strchr("\n#\",;}", text[at]) != NULL) {
            break;
        }
        if (text[at] == '#') { /* a comment inside parentheses */
            at += strcspn(text + at, "\n") - 1;
        } else if (!blank || (length > 0 && copy[length - 1] != ' ')) {
            copy[length++] = blank ? ' ' : text[at];
        }
    }
    length -= length > 0 && copy[length - 1] == ' ';
    copy[length] = '\0';
    return copy;
}

char *shown_formula(const expr *given) {
    const expr *number = given != NULL && given->op == EXPR_NEG ? given->left : given;
    return number == NULL || number->op == EXPR_NUMBER ? NULL : shown_written(given);
}

char *shown_assignment(const symbol *s, int primes, const char *number) {
    char *si = shown_si_name(s, primes);
    char *made = unit_is_si(s->declared)
                     ? alloc_words("%s%.*s=%s", s->name, primes, "'''''''''", number)
                     : alloc_words("%s%.*s=%s [%s]", s->name, primes, "'''''''''", number, si);
    free(si);
    return made;
}
