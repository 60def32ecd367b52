/* show_break.c: line breaks in LaTeX, at the signs of a sum, with amsmath's aligned. A sum inside parentheses or below
 * a root is broken in place. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "host/base/alloc.h"
#include "host/show/show_equations.h"

/* Widths in points of 10 pt type. A line of LaTeX's article is 345 pt wide, including 25 for the equation's number.
 * NARROWEST: of a broken sum. */
enum { LINE_WIDTH = 320, NARROWEST = 100, LEFT_WIDTH = 150, EQUALS = 14, SIGN = 13, QUAD = 10 };

/* A part of a text. */
typedef struct span {
    const char *from;
    const char *end;
} span;

static bool begins(span s, const char *word) {
    const size_t length = strlen(word);
    return *s.from == *word && (size_t)(s.end - s.from) >= length &&
           strncmp(s.from, word, length) == 0;
}

/* Depth of brackets: +1 for an opening one, -1 for a closing one. */
static int opens(span s) {
    return *s.from == '{' || begins(s, "\\left") || begins(s, "\\begin")  ? 1
           : *s.from == '}' || begins(s, "\\right") || begins(s, "\\end") ? -1
                                                                          : 0;
}

/* The end of the group that opens at s.from. */
static const char *behind_group(span s) {
    int depth = 0;
    do {
        depth += opens(s);
        s.from++;
    } while (depth > 0 && s.from < s.end);
    return s.from;
}

static int larger(int a, int b) { return a > b ? a : b; }

static int width_of(span s);

/* The widest row of an aligned. */
static int width_of_rows(span s) {
    int widest = 0;
    int depth = 0;
    const char *row = s.from;
    for (; s.from < s.end; s.from++) {
        depth += opens(s);
        if (depth == 0 && begins(s, "\\\\")) {
            widest = larger(widest, width_of((span){row, s.from}));
            s.from++;
            row = s.from + 1;
        }
    }
    return larger(widest, width_of((span){row, s.end}));
}

/* A command and its arguments; *s advances past them. */
static int width_of_command(span *s) {
    static const char aligned[] = "\\begin{aligned}";
    static const char behind[] = "\\end{aligned}";
    if (begins(*s, aligned)) {
        const span all = {s->from, behind_group(*s)};
        int depth = 0;
        do { /* to the \end of this one */
            depth += begins(*s, "\\begin") ? 1 : begins(*s, "\\end") ? -1 : 0;
            s->from++;
        } while (depth > 0 && s->from < s->end);
        const char *end = s->from - 1;
        s->from = end + strlen(behind);
        const char *inside = all.from + strlen(aligned);
        inside += strncmp(inside, "[t]", 3) == 0 ? 3 : 0;
        return width_of_rows((span){inside, end});
    }
    const char *name = s->from + 1;
    size_t length = 0;
    while (name + length < s->end && isalpha((unsigned char)name[length])) {
        length++;
    }
    const span of = {name, name + length};
    if (length == 0) { /* a thin space, an underscore */
        const int width = *name == ',' ? 2 : 5;
        s->from = name + 1;
        return width;
    }
    s->from = name + length;
    if (begins(of, "frac")) {
        const char *middle = behind_group(*s);
        const char *end = behind_group((span){middle, s->end});
        const int width =
            3 + larger(width_of((span){s->from, middle}), width_of((span){middle, end}));
        s->from = end;
        return width;
    }
    static const char *const named[] = {"sin", "cos", "tan", "exp", "min", "max"};
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++) {
        if (begins(of, named[i])) {
            return 6 * (int)length + 2;
        }
    }
    if (begins(of, "quad")) {
        return QUAD;
    }
    static const char *const empty[] = {"left", "right", "mathrm", "operatorname", "dot", "ddot"};
    for (size_t i = 0; i < sizeof empty / sizeof empty[0]; i++) {
        if (length == strlen(empty[i]) && begins(of, empty[i])) {
            return 0;
        }
    }
    return begins(of, "sqrt") ? 9 : begins(of, "times") ? SIGN : 7;
}

/* Rounded up; scripts count as wide as their base. */
static int width_of_character(char c) {
    return strchr("+-", c) != NULL         ? SIGN
           : c == '='                      ? EQUALS
           : strchr(" {}&\n^_", c) != NULL ? 0
           : strchr("mMwW", c) != NULL     ? 10
           : isupper((unsigned char)c)     ? 9
           : isdigit((unsigned char)c)     ? 5
                                           : 6;
}

static int width_of(span s) {
    int width = 0;
    while (s.from < s.end) {
        if (*s.from == '\\') {
            width += width_of_command(&s);
        } else {
            width += width_of_character(*s.from);
            s.from++;
        }
    }
    return width;
}

/* The beginning of the next term at depth 0: its sign, or with `factors` the end of the sign between two factors; s.end
 * if there is none. */
static const char *next_break(span s, bool factors) {
    int depth = 0;
    for (span at = {s.from, s.end}; at.from < s.end; at.from++) {
        depth += opens(at);
        if (depth == 0 && at.from > s.from &&
            (factors ? begins(at, " \\, ") : begins(at, " + ") || begins(at, " - "))) {
            return at.from;
        }
    }
    return s.end;
}

static char *broken(span s, int limit);

/* The widest group of s; names do not count. */
static span widest_group(span s) {
    span widest = {s.from, s.from};
    int most = 0;
    for (span at = s; at.from < s.end;) {
        if (begins(at, "\\mathrm") || begins(at, "\\operatorname") || begins(at, "\\dot") ||
            begins(at, "\\ddot") || begins(at, "_{") || begins(at, "\\begin")) {
            at.from = strchr(at.from, begins(at, "\\begin") ? '\n' : '{');
            at.from = *at.from == '{' ? behind_group(at) : at.from;
        } else if (opens(at) > 0) {
            const char *end = behind_group(at);
            const bool brace = *at.from == '{';
            const span inside = {at.from + (brace ? 1 : strlen("\\left(")), end - 1};
            const int width = width_of(inside);
            if (width > most && !begins(inside, "\\begin")) {
                most = width;
                widest = inside;
            }
            at.from = end;
        } else {
            at.from++;
        }
    }
    return widest;
}

/* s with its widest groups broken, until it has that width or no group is wide enough. */
static char *narrowed(span s, int limit) {
    char *text = alloc_copy(s.from, (size_t)(s.end - s.from));
    for (;;) {
        const span all = {text, text + strlen(text)};
        const int excess = width_of(all) - limit;
        const span group = widest_group(all);
        const int width = width_of(group);
        if (excess <= 0 || width <= NARROWEST) {
            return text;
        }
        char *inside = broken(group, larger(width - excess, NARROWEST));
        if (width_of((span){inside, inside + strlen(inside)}) >= width) {
            free(inside);
            return text;
        }
        char *longer = alloc_words("%.*s%s%s", (int)(group.from - text), text, inside, group.end);
        free(inside);
        free(text);
        text = longer;
    }
}

/* The rows of s, "first \\ &\quad + next". */
static char *rows_of(span s, int limit, bool factors) {
    char *text;
    size_t length;
    FILE *out = alloc_text(&text, &length);
    const int indent = factors ? QUAD + SIGN : QUAD; /* of the rows after the first */
    int width = 0;
    for (const char *at = s.from; at < s.end;) {
        const char *next = next_break((span){at, s.end}, factors);
        char *part = broken((span){at, next}, limit - indent);
        const int more = width_of((span){part, part + strlen(part)});
        if (width > 0 && width + more > limit) {
            fputs(factors ? " \\\\\n    &\\quad \\times" : " \\\\\n    &\\quad", out);
            width = indent;
            fputs(part + (factors ? strlen(" \\,") : 0), out);
        } else {
            fputs(part, out);
        }
        width += more;
        free(part);
        at = next;
    }
    alloc_text_end(out);
    return text;
}

/* s within that width: one line, or rows of an aligned. */
static char *broken(span s, int limit) {
    if (width_of(s) <= limit) {
        return alloc_copy(s.from, (size_t)(s.end - s.from));
    }
    bool factors = next_break(s, false) == s.end;
    char *rows = NULL;
    if (factors) {
        char *line = narrowed(s, limit);
        if (width_of((span){line, line + strlen(line)}) <= limit || next_break(s, true) == s.end) {
            return line;
        }
        free(line);
    }
    rows = rows_of(s, limit, factors);
    char *all = alloc_words("\\begin{aligned}\n    & %s\n  \\end{aligned}", rows);
    free(rows);
    return all;
}

static void put_row(FILE *out, const char *row) {
    const char *sign = strstr(row, " &= ");
    const span left = {row, sign};
    const span right = {sign + strlen(" &= "), row + strlen(row)};
    if (width_of(left) + width_of(right) + EQUALS <= LINE_WIDTH) {
        fputs(row, out);
        return;
    }
    if (width_of(left) <= LEFT_WIDTH) {
        char *lines = broken(right, LINE_WIDTH - width_of(left) - EQUALS);
        fprintf(out, "%.*s &= %s", (int)(sign - row), row, lines);
        free(lines);
        return;
    }
    const bool sums[2] = {next_break(left, false) == left.end,
                          next_break(right, false) == right.end};
    char *lines[2] = {rows_of(left, LINE_WIDTH - EQUALS, sums[0]),
                      rows_of(right, LINE_WIDTH - EQUALS, sums[1])};
    const char *first = lines[0] + strspn(lines[0], " ");
    fprintf(out, "  &\\begin{aligned}\n    & %s \\\\\n    &= %s\n  \\end{aligned}", first,
            lines[1]);
    free(lines[0]);
    free(lines[1]);
}

show *show_row_begin(show_row *row, const show *s) {
    row->out = s->out;
    row->inner = *s;
    if (s->style == SHOW_LATEX) {
        row->inner.out = alloc_text(&row->text, &row->length);
    }
    return &row->inner;
}

void show_row_end(show_row *row) {
    if (row->inner.style == SHOW_LATEX) {
        alloc_text_end(row->inner.out);
        put_row(row->out, row->text);
        free(row->text);
    }
}
