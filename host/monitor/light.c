#include "light.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "core/frame.h"

const char *const light_names[LIGHT_FIELDS] = {WH_LIGHT_FIELDS};

enum { BEGIN = sizeof WH_LIGHT_BEGIN - 1, END = sizeof WH_LIGHT_END - 1, DIGITS = 8 };

bool light_is_none(const char *value) { return strcmp(value, WH_LIGHT_NONE) == 0; }

static const char *find(const char *from, const char *end, const char *word, size_t length) {
    for (; (size_t)(end - from) >= length; from++) {
        if (memcmp(from, word, length) == 0) {
            return from;
        }
    }
    return NULL;
}

const char *light_begin(const char *bytes, size_t count) {
    const char *last = NULL;
    const char *at = bytes;
    while ((at = find(at, bytes + count, WH_LIGHT_BEGIN, BEGIN)) != NULL) {
        last = at;
        at += BEGIN;
    }
    return last;
}

const char *light_end(const char *from, const char *end) {
    const char *at = find(from, end, "\n" WH_LIGHT_END, END + 1U);
    at = at != NULL ? memchr(at + 1, '\n', (size_t)(end - at - 1)) : NULL;
    return at != NULL ? at + 1 : NULL;
}

/* Copies the text without carriage returns. Returns false if it is too long. */
static bool keep_text(light *l, const char *from, const char *end) {
    l->length = 0;
    for (; from < end; from++) {
        if (l->length == LIGHT_ROOM - 1) {
            return false;
        }
        l->text[l->length] = *from;
        l->length += *from != '\r';
    }
    l->text[l->length] = '\0';
    return true;
}

/* Finds the fields' values. Returns false if a field is missing, is out of order or has unprintable characters. */
static bool split(light *l, size_t body) {
    memcpy(l->lines, l->text, l->length + 1);
    char *at = l->lines + BEGIN + 1;
    for (int i = 0; i < LIGHT_FIELDS; i++) {
        const size_t name = strlen(light_names[i]);
        char *ends = memchr(at, '\n', (size_t)(l->lines + body - at));
        if (ends == NULL || (size_t)(ends - at) < name + 2U ||
            memcmp(at, light_names[i], name) != 0 || at[name] != ' ') {
            return false;
        }
        *ends = '\0';
        l->value[i] = at + name + 1;
        for (const char *c = l->value[i]; c < ends; c++) {
            if (*c < ' ' || *c > '~') {
                return false;
            }
        }
        at = ends + 1;
    }
    return at == l->lines + body;
}

const char *light_read(light *l, const char *bytes, size_t count, const char **hint) {
    static const char again[] =
        "press Enter at the board's console: the board prints the record again";
    const char *end = bytes + count;
    const char *from = find(bytes, end, WH_LIGHT_BEGIN, BEGIN);
    *hint = again;
    if (from == NULL) {
        *hint = "run the program firstlight, which prints a record: make firstlight BOARD=...";
        return "there is no record: no line '" WH_LIGHT_BEGIN "'";
    }
    if (light_begin(bytes, count) != from) {
        *hint = "keep one complete record in the file; a reset of the board cuts a record off";
        return "the file contains the beginning of more than one record";
    }
    if (!keep_text(l, from, end)) {
        return "the record has no end: it is longer than any record of firstlight";
    }
    const size_t last = END + DIGITS + 1;
    const char *behind = light_end(l->text, l->text + l->length);
    if (behind == NULL) {
        return "the record is incomplete: it has no line '" WH_LIGHT_END "...'";
    }
    if (*behind != '\0' || behind != l->text + l->length) {
        *hint = "delete the text after the record";
        return "there is more text after the record";
    }
    char said[DIGITS + 1] = "";
    const size_t body = l->length < last ? 0 : l->length - last;
    l->crc = wh_frame_crc(0, (const uint8_t *)l->text, (unsigned)body);
    (void)snprintf(said, sizeof said, "%08" PRIx32, l->crc);
    if (memcmp(l->text + body, WH_LIGHT_END, END) != 0 ||
        memcmp(l->text + body + END, said, DIGITS) != 0 || l->text[BEGIN] != '\n') {
        return "the record is garbled: its CRC is not that of its lines";
    }
    if (!split(l, body)) {
        *hint = "build the image and whirl from one version of the sources";
        return "the fields of the record differ from those of this version of whirl";
    }
    return NULL;
}
