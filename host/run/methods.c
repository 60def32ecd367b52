/* methods.c: the rows of core/method.h as words for users. */
#include "methods.h"

#include <stdio.h>
#include <string.h>

static void put(char text[METHODS_TEXT_SIZE], const char *before, const char *word) {
    const size_t length = strlen(text);
    snprintf(text + length, METHODS_TEXT_SIZE - length, "%s%s", before, word);
}

const char *methods_of_form(wh_form form, char text[METHODS_TEXT_SIZE]) {
    const char *waiting = NULL; /* "or" stands before the last one */
    text[0] = '\0';
    for (int i = 0; i < WH_METHODS; i++) {
        if (wh_method_takes((wh_method)i, form)) {
            if (waiting != NULL) {
                put(text, text[0] != '\0' ? ", " : "", waiting);
            }
            waiting = wh_methods[i].word;
        }
    }
    put(text, text[0] != '\0' ? " or " : "", waiting != NULL ? waiting : "");
    return text;
}

const char *methods_in_help(char text[METHODS_TEXT_SIZE]) {
    const char *before = "; ";
    text[0] = '\0';
    put(text, wh_methods[WH_METHOD_DEFAULT].word, " (default)");
    for (int i = WH_METHODS - 1; i >= 0; i--) {
        if (i != WH_METHOD_DEFAULT && wh_method_takes((wh_method)i, WH_FIRST_ORDER)) {
            put(text, ", ", wh_methods[i].word);
        }
    }
    for (int i = 0; i < WH_METHODS; i++) {
        if (!wh_method_takes((wh_method)i, WH_FIRST_ORDER)) {
            put(text, before, wh_methods[i].word);
            before = ", ";
        }
    }
    put(text, before[0] == ',' ? ", for second order only" : "", "");
    return text;
}
