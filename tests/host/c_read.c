#include "c_read.h"
#include "test.h"

static char *without_comments(const char *text) {
    const size_t length = strlen(text);
    char *copy = malloc(length + 1);
    TEST_ASSERT_NOT_NULL(copy);
    memcpy(copy, text, length + 1);
    for (char *at = copy; (at = strstr(at, "/*")) != NULL;) {
        char *end = strstr(at, "*/");
        TEST_ASSERT_NOT_NULL_MESSAGE(end, "a comment that does not end");
        memset(at, ' ', (size_t)(end + 2 - at));
    }
    return copy;
}

static int word_length(const char *at) {
    static const char *const pairs[] = {"->", "==", "!=", "||", "&&", "++", "<=", ">="};
    int length = 1;
    if (*at == '"') {
        while (at[length] != '"' && at[length] != '\0') {
            length++;
        }
        return length + 1;
    }
    if (isalpha((unsigned char)*at) || *at == '_') {
        while (isalnum((unsigned char)at[length]) || at[length] == '_') {
            length++;
        }
        return length;
    }
    if (isdigit((unsigned char)*at)) {
        while (isalnum((unsigned char)at[length]) || at[length] == '.' ||
               (strchr("+-", at[length]) != NULL && strchr("pe", at[length - 1]) != NULL)) {
            length++;
        }
        return length;
    }
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        length = strncmp(at, pairs[i], 2) == 0 ? 2 : length;
    }
    return length;
}

c_file c_file_of(const char *text) {
    c_file f = {.text = without_comments(text)};
    f.word = calloc(strlen(text) + 1, sizeof *f.word);
    TEST_ASSERT_NOT_NULL(f.word);
    for (const char *at = f.text; *at != '\0';) {
        at += strspn(at, " \n");
        if (*at == '#') {
            at += strcspn(at, "\n");
        } else if (*at != '\0') {
            f.word[f.words] = (c_word){at, word_length(at)};
            at += f.word[f.words++].length;
        }
    }
    return f;
}

void c_file_free(c_file *f) {
    free(f->text);
    free(f->word);
}

bool c_is(const c_file *f, int i, const char *word) {
    return i >= 0 && i < f->words && (int)strlen(word) == f->word[i].length &&
           strncmp(f->word[i].at, word, strlen(word)) == 0;
}

static bool stand_at(const c_file *f, int i, const char *words, int *behind) {
    char word[80];
    for (const char *at = words; *at != '\0'; i++) {
        const size_t length = strcspn(at, " ");
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        if (!c_is(f, i, word)) {
            return false;
        }
        at += length;
        at += *at == ' ';
    }
    *behind = i;
    return true;
}

int c_behind(const c_file *f, int from, const char *words) {
    int behind;
    for (int i = from; i < f->words; i++) {
        if (stand_at(f, i, words, &behind)) {
            return behind;
        }
    }
    return -1;
}

int c_need(const c_file *f, int from, const char *words) {
    const int behind = c_behind(f, from, words);
    if (behind < 0) {
        printf("%s\n", f->text);
    }
    TEST_ASSERT_TRUE_MESSAGE(behind >= 0, words);
    return behind;
}

void c_text(const c_file *f, int i, int end, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int k = i; k < end && used < size; k++) {
        used += (size_t)snprintf(text + used, size - used, "%s%.*s", k > i ? " " : "",
                                 f->word[k].length, f->word[k].at);
    }
}

int c_closing(const c_file *f, int i) {
    int depth = 0;
    for (int k = i; k < f->words; k++) {
        depth += c_is(f, k, "(") || c_is(f, k, "{") || c_is(f, k, "[");
        depth -= c_is(f, k, ")") || c_is(f, k, "}") || c_is(f, k, "]");
        if (depth == 0) {
            return k;
        }
    }
    TEST_FAIL_MESSAGE("a bracket that nothing closes");
    return -1;
}

double c_number(const c_file *f, int *i) {
    int open = 0;
    double sign = 1.0;
    for (bool more = true; more; *i += more) {
        const bool opens = c_is(f, *i, "(");
        open += opens;
        sign = c_is(f, *i, "-") ? -sign : sign;
        more = opens || c_is(f, *i, "-") || c_is(f, *i, "WH_R");
    }
    char *end;
    const double number = strtod(f->word[*i].at, &end);
    TEST_ASSERT_TRUE_MESSAGE(end != f->word[*i].at, f->word[*i].at);
    ++*i;
    for (; open > 0; open--, ++*i) {
        TEST_ASSERT_TRUE_MESSAGE(c_is(f, *i, ")"), f->word[*i].at);
    }
    return sign * number;
}

enum { NAMES = 2000 };

typedef struct name_list {
    c_word name[NAMES];
    int used[NAMES];    /* uses elsewhere */
    int ignored[NAMES]; /* uses as (void)NAME */
    bool is_parameter[NAMES];
    int count;
} name_list;

static bool same(c_word a, c_word b) {
    return a.length == b.length && strncmp(a.at, b.at, (size_t)a.length) == 0;
}

static int find(const name_list *l, c_word w) {
    for (int i = l->count - 1; i >= 0; i--) {
        if (same(l->name[i], w)) {
            return i;
        }
    }
    return -1;
}

static void enter(name_list *l, c_word w, bool is_parameter) {
    TEST_ASSERT_TRUE(l->count < NAMES);
    TEST_ASSERT_TRUE_MESSAGE(find(l, w) < 0, w.at); /* names are unique */
    l->name[l->count] = w;
    l->used[l->count] = l->ignored[l->count] = 0;
    l->is_parameter[l->count++] = is_parameter;
}

static bool is_name(c_word w) { return isalpha((unsigned char)*w.at) || *w.at == '_'; }

static bool is_known(c_word w) {
    static const char *const words[] = {
        "const", "static", "inline",  "void",     "bool", "int",    "for",     "return",
        "true",  "false",  "uint8_t", "uint32_t", "NULL", "extern", "INT64_C", "UINT64_C"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if ((int)strlen(words[i]) == w.length && strncmp(words[i], w.at, strlen(words[i])) == 0) {
            return true;
        }
    }
    return strncmp(w.at, "wh_", 3) == 0 || strncmp(w.at, "WH_", 3) == 0;
}

/* Is a name declared at word i? A declared name follows a type or its asterisk. */
static bool is_declared(const c_file *f, int i) {
    const int type = c_is(f, i - 1, "*") ? i - 2 : i - 1;
    const bool types = type >= 0 && is_name(f->word[type]) &&
                       (strncmp(f->word[type].at, "wh_", 3) == 0 || c_is(f, type, "void") ||
                        c_is(f, type, "bool") || c_is(f, type, "int") || c_is(f, type, "uint8_t") ||
                        c_is(f, type, "uint32_t"));
    return is_name(f->word[i]) && !is_known(f->word[i]) && types && !c_is(f, type + 1, ")");
}

static void look_up(const c_file *f, int i, name_list *own, name_list *all, const char *what) {
    if (!is_name(f->word[i]) || is_known(f->word[i]) || c_is(f, i - 1, ".") ||
        c_is(f, i - 1, "->")) {
        return;
    }
    name_list *in = own;
    int found = find(own, f->word[i]);
    if (found < 0) {
        in = all;
        found = find(all, f->word[i]);
    }
    if (found < 0) {
        printf("  %s: used before it is there: %.60s\n%s", what, f->word[i].at, f->text);
    }
    TEST_ASSERT_TRUE_MESSAGE(found >= 0, what);
    const bool ignored = c_is(f, i - 1, ")") && c_is(f, i - 2, "void") && c_is(f, i - 3, "(");
    in->ignored[found] += ignored;
    in->used[found] += !ignored;
}

/* Every parameter is used or cast to void; every sine and cosine is used. */
static void expect_used(const name_list *own, const char *what) {
    for (int i = 0; i < own->count; i++) {
        const bool pair =
            strchr("sc", own->name[i].at[0]) != NULL && isdigit((unsigned char)own->name[i].at[1]);
        const bool is_model = own->name[i].length == 5 && strncmp(own->name[i].at, "model", 5) == 0;
        if (!own->is_parameter[i] && !pair) {
            continue;
        }
        const bool good = is_model ? own->used[i] == 0 && own->ignored[i] == 1
                          : pair   ? own->used[i] > 0
                                   : (own->used[i] > 0) != (own->ignored[i] > 0) ||
                                       strncmp(own->name[i].at, "scene", 5) == 0;
        if (!good) {
            printf("  %s: used %d times, ignored %d times: %.70s\n", what, own->used[i],
                   own->ignored[i], own->name[i].at);
        }
        TEST_ASSERT_TRUE_MESSAGE(good, what);
    }
}

/* Reads from the parenthesis at word i to the closing brace and returns its place. */
static int in_function(const c_file *f, int i, name_list *all, const char *what) {
    static name_list own;
    own.count = 0;
    const int parameters = c_closing(f, i);
    for (int k = i; k < parameters; k++) {
        if (is_declared(f, k)) {
            enter(&own, f->word[k], true);
        }
    }
    const int end = c_closing(f, parameters + 1);
    for (int k = parameters + 1; k < end; k++) {
        if (is_declared(f, k)) {
            /* a loop counter may be declared again */
            if (!(c_is(f, k, "i") && find(&own, f->word[k]) >= 0)) {
                enter(&own, f->word[k], false);
            }
        } else {
            look_up(f, k, &own, all, what);
        }
    }
    expect_used(&own, what);
    return end;
}

void c_expect_whole(const c_file *f, const char *what) {
    static name_list all;
    static name_list none;
    all.count = none.count = 0;
    for (int i = 0; i < f->words; i++) {
        if (c_is(f, i, "{")) { /* of an object */
            const int end = c_closing(f, i);
            for (int k = i; k < end; k++) {
                look_up(f, k, &none, &all, what);
            }
            i = end;
        } else if (is_declared(f, i)) {
            const int found = find(&all, f->word[i]);
            if (found < 0) {
                enter(&all, f->word[i], false);
            }
            if (c_is(f, i + 1, "(")) {
                i = in_function(f, i + 1, &all, what);
            }
        }
    }
    for (int i = 0; i < all.count - 1; i++) {
        if (all.used[i] == 0) {
            printf("  %s: there, and not used: %.60s\n", what, all.name[i].at);
        }
        TEST_ASSERT_TRUE_MESSAGE(all.used[i] > 0, what);
    }
}
