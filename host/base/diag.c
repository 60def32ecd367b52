#include "host/base/diag.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/base/spelling.h"

void statement_text(place at, char *text, size_t size) {
    const source *from = at.source;
    text[0] = '\0';
    if (from == NULL || from->text == NULL) {
        return;
    }
    size_t start = at.offset < from->length ? at.offset : from->length;
    while (start > 0 && strchr("\n{;", from->text[start - 1]) == NULL) {
        start--;
    }
    size_t end = start;
    int open = 0;        /* depth of the statement's own braces */
    bool quoted = false; /* inside a quoted text, in which # { } ; have no meaning */
    while (end < from->length && from->text[end] != '\n' &&
           (quoted || (from->text[end] != '#' &&
                       (open > 0 || (from->text[end] != '}' && from->text[end] != ';'))))) {
        quoted ^= from->text[end] == '"';
        open += !quoted && from->text[end] == '{' ? 1 : 0;
        open -= !quoted && from->text[end] == '}' ? 1 : 0;
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

/* === messages ================================================================================= */

enum {
    LINE_WIDTH = 100, /* characters of a source line in a message; a longer line is cut */
    CARET_MOST = 70,  /* furthest column of the caret in a line that is cut */
    TEXT_SIZE = 400,
    FILE_SIZE = 256
};

typedef struct entry {
    /* only compared, never dereferenced: the caller may free the source after diag_error() */
    const source *source;
    int file_order;
    char file[FILE_SIZE];
    int line;
    int column;
    size_t offset;
    char message[TEXT_SIZE];
    char hint[TEXT_SIZE];
    char shown[4 * LINE_WIDTH + 8];
    int caret; /* characters before the caret, or -1 without a caret */
} entry;

struct diags {
    entry *entries;
    int held;
    int reported;
    size_t calls;
};

diags *diags_new(void) {
    diags *all = alloc(1, sizeof *all);
    all->entries = alloc(DIAG_MAX, sizeof *all->entries);
    return all;
}

void diags_free(diags *all) {
    if (all != NULL) {
        free(all->entries);
        free(all);
    }
}

int diags_count(const diags *all) { return all->reported; }

size_t diags_calls(const diags *all) { return all->calls; }

/* Copies the source line around the place, one column per character. A tab becomes a space; invalid bytes and other
 * control characters become "?". */
static void copy_line(entry *made, place at) {
    const char *text = at.source->text;
    const size_t length = at.source->length;
    size_t start = at.offset;
    int before = 0; /* characters between `start` and the place */
    while (start > 0 && text[start - 1] != '\n' && before < CARET_MOST) {
        start--;
        before += ((unsigned char)text[start] & 0xc0) != 0x80;
    }
    while (start > 0 && ((unsigned char)text[start] & 0xc0) == 0x80 && text[start - 1] != '\n') {
        start--; /* do not begin inside a character */
    }
    if (start == 0 && length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0) {
        start = 3;
        before -= before > 0;
    }
    size_t used = 0;
    size_t i = start;
    for (int columns = 0; i < length && text[i] != '\n' && columns < LINE_WIDTH; columns++) {
        const unsigned char c = (unsigned char)text[i];
        const size_t bytes = utf8_length(text + i, length - i);
        if (c == '\r' && (i + 1 == length || text[i + 1] == '\n')) {
            break;
        }
        if (bytes == 0 || c < 0x20 || c == 0x7f) {
            made->shown[used++] = c == '\t' ? ' ' : '?';
            i++;
            while (c >= 0x80 && i < length && ((unsigned char)text[i] & 0xc0) == 0x80) {
                i++; /* an invalid character is one column, even if it has several bytes */
            }
        } else {
            memcpy(made->shown + used, text + i, bytes);
            used += bytes;
            i += bytes;
        }
    }
    made->shown[used] = '\0';
    made->caret = before;
}

/* Equal addresses do not prove equal sources: a new source may have the address of a freed one. */
static bool is_repeat(const diags *all, const entry *made) {
    for (int i = 0; i < all->held; i++) {
        const entry *each = &all->entries[i];
        if (each->source == made->source && each->offset == made->offset &&
            strcmp(each->file, made->file) == 0 && strcmp(each->shown, made->shown) == 0) {
            return true;
        }
    }
    return false;
}

void diag_error(diags *all, place at, const char *hint, const char *format, ...) {
    entry made = {.source = at.source, .line = at.line, .column = at.column, .offset = at.offset};
    all->calls++;
    made.file_order = all->held;
    for (int i = all->held - 1; i >= 0; i--) {
        if (all->entries[i].source == at.source) {
            made.file_order = all->entries[i].file_order;
        }
    }
    made.caret = -1;
    if (at.source != NULL) {
        snprintf(made.file, sizeof made.file, "%s", at.source->file);
        if (at.source->text != NULL && at.offset <= at.source->length) {
            copy_line(&made, at);
        }
    }
    if (is_repeat(all, &made)) {
        return;
    }
    all->reported++;
    if (all->held == DIAG_MAX) {
        return;
    }
    if (hint != NULL) {
        snprintf(made.hint, sizeof made.hint, "%s", hint);
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(made.message, sizeof made.message, format, arguments);
    va_end(arguments);
    all->entries[all->held++] = made;
}

static bool comes_after(const entry *a, const entry *b) {
    return a->file_order != b->file_order ? a->file_order > b->file_order : a->offset > b->offset;
}

static void sort(entry *entries, int count) {
    for (int i = 1; i < count; i++) {
        const entry moving = entries[i];
        int j = i;
        for (; j > 0 && comes_after(&entries[j - 1], &moving); j--) {
            entries[j] = entries[j - 1];
        }
        entries[j] = moving;
    }
}

void diags_flush(diags *all, FILE *out) {
    sort(all->entries, all->held);
    for (int i = 0; i < all->held; i++) {
        const entry *each = &all->entries[i];
        if (each->file[0] != '\0') {
            fprintf(out, "%s:%d:%d: ", each->file, each->line, each->column);
        }
        fprintf(out, "error: %s\n", each->message);
        if (each->caret >= 0) {
            fprintf(out, "  %s\n  %*s^\n", each->shown, each->caret, "");
        }
        if (each->hint[0] != '\0') {
            fprintf(out, "hint: %s\n", each->hint);
        }
    }
    if (all->reported > all->held) {
        fprintf(out, "too many errors: only the first %d are shown\n", all->held);
    }
    all->held = 0;
    all->reported = 0;
}
