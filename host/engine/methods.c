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
        if (wh_method_takes((wh_method)i, form) && wh_methods[i].takes != WH_NO_RATES) {
            if (waiting != NULL) {
                put(text, text[0] != '\0' ? ", " : "", waiting);
            }
            waiting = wh_methods[i].word;
        }
    }
    put(text, text[0] != '\0' ? " or " : "", waiting != NULL ? waiting : "");
    return text;
}

/* The rows that take these systems and no others. */
static void put_only(char text[METHODS_TEXT_SIZE], uint8_t takes, const char *what) {
    const char *before = "; ";
    for (int i = 0; i < WH_METHODS; i++) {
        if (wh_methods[i].takes == takes) {
            put(text, before, wh_methods[i].word);
            before = ", ";
        }
    }
    put(text, before[0] == ',' ? what : "", "");
}

const char *methods_in_help(char text[METHODS_TEXT_SIZE]) {
    text[0] = '\0';
    put(text, wh_methods[WH_METHOD_DEFAULT].word, " (default)");
    for (int i = WH_METHODS - 1; i >= 0; i--) {
        if (i != WH_METHOD_DEFAULT && wh_method_takes((wh_method)i, WH_FIRST_ORDER)) {
            put(text, ", ", wh_methods[i].word);
        }
    }
    put_only(text, WH_SECOND_ORDER_ONLY, ", for second order only");
    put_only(text, WH_NO_RATES, ", where accelerations take no rates");
    return text;
}
