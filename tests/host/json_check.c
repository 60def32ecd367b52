#include "json_check.h"
#include "test.h"

#include "host/base/spelling.h"

enum { WHY_SIZE = 100, VALUE_SIZE = 100, KEYS_MOST = 200, DEPTH_MOST = 20 };

typedef struct reader {
    const char *text;
    size_t at;
    const char *wrong; /* the first error; NULL if there is none */
    int depth;
} reader;

static bool fail(reader *r, const char *what) {
    r->wrong = r->wrong == NULL ? what : r->wrong;
    return false;
}

static void skip_blank(reader *r) { r->at += strspn(r->text + r->at, " \t\r\n"); }

static bool take(reader *r, const char *word) {
    const bool there = strncmp(r->text + r->at, word, strlen(word)) == 0;
    r->at += there ? strlen(word) : 0;
    return there;
}

static bool read_escape(reader *r) {
    const char c = r->text[r->at];
    if (c == 'u') {
        if (strspn(r->text + r->at + 1, "0123456789abcdefABCDEF") < 4) {
            return fail(r, "\\u without four digits");
        }
        r->at += 5;
        return true;
    }
    if (c == '\0' || strchr("\"\\/bfnrt", c) == NULL) {
        return fail(r, "unknown escape");
    }
    r->at++;
    return true;
}

static bool read_string(reader *r) {
    if (!take(r, "\"")) {
        return fail(r, "a string is missing");
    }
    while (r->text[r->at] != '"') {
        const unsigned char c = (unsigned char)r->text[r->at];
        const size_t bytes = utf8_length(r->text + r->at, strlen(r->text + r->at));
        if (c < 0x20) {
            return fail(r, "control character or end within a string");
        }
        if (bytes == 0) {
            return fail(r, "not UTF-8");
        }
        r->at += bytes;
        if (c == '\\' && !read_escape(r)) {
            return false;
        }
    }
    r->at++;
    return true;
}

static size_t digits(const reader *r) { return strspn(r->text + r->at, "0123456789"); }

static bool read_number(reader *r) {
    take(r, "-");
    if (digits(r) == 0 || (r->text[r->at] == '0' && digits(r) > 1)) {
        return fail(r, "no number, or one with a leading zero");
    }
    r->at += digits(r);
    if (take(r, ".")) {
        if (digits(r) == 0) {
            return fail(r, "no digit behind the point");
        }
        r->at += digits(r);
    }
    if (take(r, "e") || take(r, "E")) {
        if (!take(r, "+")) {
            take(r, "-");
        }
        if (digits(r) == 0) {
            return fail(r, "no digit in the exponent");
        }
        r->at += digits(r);
    }
    return true;
}

static bool read_value(reader *r);

/* Reads a key of an object. A key that occurs twice is an error. */
static bool read_key(reader *r, size_t *keys, int count) {
    const size_t at = r->at;
    if (!read_string(r)) {
        return false;
    }
    for (int i = 0; i < count; i++) {
        if (strncmp(r->text + keys[i], r->text + at, r->at - at) == 0) {
            return fail(r, "a key twice");
        }
    }
    if (count == KEYS_MOST) {
        return fail(r, "too many keys");
    }
    keys[count] = at;
    skip_blank(r);
    if (!take(r, ":")) {
        return fail(r, "a colon is missing");
    }
    skip_blank(r);
    return true;
}

static bool read_members(reader *r, const char *end, bool keyed) {
    size_t keys[KEYS_MOST] = {0};
    int count = 0;
    if (++r->depth > DEPTH_MOST) {
        return fail(r, "too deep");
    }
    skip_blank(r);
    if (!take(r, end)) {
        do {
            skip_blank(r);
            if ((keyed && !read_key(r, keys, count++)) || !read_value(r)) {
                return false;
            }
            skip_blank(r);
        } while (take(r, ","));
        if (!take(r, end)) {
            return fail(r, "not closed");
        }
    }
    r->depth--;
    return true;
}

static bool read_value(reader *r) {
    if (take(r, "{")) {
        return read_members(r, "}", true);
    }
    if (take(r, "[")) {
        return read_members(r, "]", false);
    }
    if (r->text[r->at] == '"') {
        return read_string(r);
    }
    return take(r, "true") || take(r, "false") || take(r, "null") || read_number(r);
}

bool json_is_valid(const char *text, char *why) {
    reader r = {.text = text};
    skip_blank(&r);
    const bool read = read_value(&r);
    skip_blank(&r);
    const bool whole = read && (text[r.at] == '\0' || fail(&r, "something behind the value"));
    snprintf(why, WHY_SIZE, "%s: %.30s", whole ? "valid" : r.wrong, text + r.at);
    return whole;
}

static bool step_to(reader *r, const char *name, size_t length) {
    const bool keyed = r->text[r->at] == '{';
    int left = keyed ? 0 : (int)strtol(name, NULL, 10);
    if (!keyed && r->text[r->at] != '[') {
        return false;
    }
    r->at++;
    skip_blank(r);
    while (r->text[r->at] != '}' && r->text[r->at] != ']') {
        bool here = !keyed && left-- == 0;
        if (keyed) {
            const size_t key = r->at + 1;
            read_string(r);
            here = r->at - 1 - key == length && strncmp(r->text + key, name, length) == 0;
            skip_blank(r);
            take(r, ":");
            skip_blank(r);
        }
        if (here) {
            return true;
        }
        read_value(r);
        skip_blank(r);
        take(r, ",");
        skip_blank(r);
    }
    return false;
}

static bool go_to(reader *r, const char *path) {
    skip_blank(r);
    while (*path != '\0') {
        const size_t length = strcspn(path, "/");
        if (!step_to(r, path, length)) {
            return false;
        }
        path += length + (path[length] == '/' ? 1 : 0);
    }
    return true;
}

const char *json_value(const char *text, const char *path, char *value) {
    reader r = {.text = text};
    if (!go_to(&r, path)) {
        return NULL;
    }
    const size_t quoted = text[r.at] == '"' ? 1 : 0;
    const size_t from = r.at;
    read_value(&r);
    snprintf(value, VALUE_SIZE, "%.*s", (int)(r.at - from - 2 * quoted), text + from + quoted);
    return value;
}

int json_length(const char *text, const char *path) {
    reader r = {.text = text};
    if (!go_to(&r, path) || text[r.at] != '[') {
        return -1;
    }
    int count = 0;
    char rest[VALUE_SIZE];
    for (;; count++) {
        char element[VALUE_SIZE];
        snprintf(element, sizeof element, "%s/%d", path, count);
        if (json_value(text, element, rest) == NULL) {
            return count;
        }
    }
}
