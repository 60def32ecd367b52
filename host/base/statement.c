/* statement.c: the text of a statement of a model file. */
#include "statement.h"

#include <stdio.h>
#include <string.h>

void statement_text(place at, char *text, size_t size) {
    const source *from = at.source;
    text[0] = '\0';
    if (from == NULL || from->text == NULL) {
        return;
    }
    size_t start = at.offset < from->length ? at.offset : from->length;
    while (start > 0 && from->text[start - 1] != '\n' && from->text[start - 1] != '{') {
        start--;
    }
    size_t end = start;
    int open = 0; /* depth of its own braces */
    while (end < from->length && strchr("\n#", from->text[end]) == NULL &&
           (from->text[end] != '}' || open > 0)) {
        open += from->text[end] == '{' ? 1 : 0;
        open -= from->text[end] == '}' ? 1 : 0;
        end++;
    }
    while (start < end && (from->text[start] == ' ' || from->text[start] == '\t')) {
        start++;
    }
    while (end > start && strchr(" \t\r", from->text[end - 1]) != NULL) {
        end--;
    }
    snprintf(text, size, "%.*s", (int)(end - start), from->text + start);
    if (end - start >= size) {
        memcpy(text + size - 4, "...", 3);
    }
}
