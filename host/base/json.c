#include "json.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "host/base/spelling.h"

static void put_text(FILE *out, const char *text) {
    const size_t length = strlen(text);
    fputc('"', out);
    for (size_t i = 0; i < length;) {
        const unsigned char c = (unsigned char)text[i];
        const size_t bytes = utf8_length(text + i, length - i);
        if (c == '"' || c == '\\') {
            fprintf(out, "\\%c", c);
        } else if (c < 0x20 || c == 0x7f) {
            fprintf(out, "\\u%04x", c);
        } else if (bytes == 0) {
            fputs("\\ufffd", out);
        } else {
            fwrite(text + i, 1, bytes, out);
        }
        i += bytes > 0 ? bytes : 1;
    }
    fputc('"', out);
}

static void begin(json *j, const char *key) {
    if (j->depth > 0) {
        fprintf(j->out, "%s\n%*s", j->filled ? "," : "", 2 * j->depth, "");
    }
    if (key != NULL) {
        put_text(j->out, key);
        fputs(": ", j->out);
    }
    j->filled = true;
}

void json_open(json *j, const char *key, char bracket) {
    begin(j, key);
    fputc(bracket, j->out);
    j->depth++;
    j->filled = false;
}

void json_close(json *j, char bracket) {
    j->depth--;
    if (j->filled) {
        fprintf(j->out, "\n%*s", 2 * j->depth, "");
    }
    fputc(bracket, j->out);
    j->filled = true;
    if (j->depth == 0) {
        fputc('\n', j->out);
    }
}

void json_text(json *j, const char *key, const char *text) {
    begin(j, key);
    put_text(j->out, text);
}

void json_number(json *j, const char *key, double value) {
    begin(j, key);
    if (isfinite(value)) {
        fprintf(j->out, "%.17g", value);
    } else {
        fputs("null", j->out);
    }
}

void json_whole(json *j, const char *key, int64_t value) {
    begin(j, key);
    fprintf(j->out, "%" PRId64, value);
}

void json_count(json *j, const char *key, uint64_t value) {
    begin(j, key);
    fprintf(j->out, "%" PRIu64, value);
}

void json_bool(json *j, const char *key, bool value) {
    begin(j, key);
    fputs(value ? "true" : "false", j->out);
}

void json_null(json *j, const char *key) {
    begin(j, key);
    fputs("null", j->out);
}
