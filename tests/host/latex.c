#include "latex.h"
#include "test.h"

/* TeX allows 255 nested groups; the page around the formula needs some of them. */
enum { DEPTH_MAX = 240 };

typedef struct reader {
    const char *at;
    const char *problem;
    int depth;
    int width; /* width of the present row up to here, in hundredths of a point */
} reader;

static void list(reader *r, char until);

static void fail(reader *r, const char *problem) {
    if (r->problem == NULL) {
        r->problem = problem;
    }
}

static void skip(reader *r) {
    while (*r->at == ' ' || *r->at == '\n') {
        r->at++;
    }
}

static void argument(reader *r) {
    skip(r);
    if (*r->at != '{') {
        fail(r, "an argument without braces");
        return;
    }
    r->at++;
    list(r, '}');
    if (r->problem == NULL) {
        r->at++;
    }
}

/* Width of a character in Computer Modern at 10 pt, in hundredths of a point: letters of the font cmmi10, digits,
 * and signs with their spaces. */
static int width_of(char c) {
    static const int small[] = {529, 429, 433, 520, 466, 490, 477, 576, 345, 412, 521, 298, 878,
                                600, 485, 503, 446, 451, 469, 361, 572, 485, 716, 572, 490, 465};
    static const int large[] = {750, 759, 715, 828, 738, 643, 786, 831, 440, 555, 849, 681, 970,
                                803, 763, 642, 791, 759, 613, 584, 683, 583, 944, 828, 581, 683};
    return c >= 'a' && c <= 'z'   ? small[c - 'a']
           : c >= 'A' && c <= 'Z' ? large[c - 'A']
           : c == '+' || c == '-' ? 1222
           : c == '='             ? 1333
           : c == '(' || c == ')' ? 389
                                  : 500;
}

/* Reads the arguments of a command. `name` is the command's name without its backslash, which has been read already. */
static void command(reader *r, const char *name, size_t length) {
    static const struct {
        const char *name;
        int arguments;
    } known[] = {{"frac", 2},         {"sqrt", 1},    {"dot", 1},   {"ddot", 1}, {"mathrm", 1},
                 {"operatorname", 1}, {"sin", 0},     {"cos", 0},   {"tan", 0},  {"exp", 0},
                 {"sinh", 0},         {"cosh", 0},    {"tanh", 0},  {"min", 0},  {"max", 0},
                 {"cdot", 0},         {"partial", 0}, {"times", 0}, {"quad", 0}, {"varepsilon", 0},
                 {"text", 1}};
    static const char wide[] = " sin cos tan exp sinh cosh tanh min max ";
    const bool is_quad = length == 4 && strncmp(name, "quad", 4) == 0;
    static const char greek[] =
        " alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi rho sigma tau phi chi "
        "psi omega Gamma Delta Theta Lambda Xi Sigma Phi Psi Omega ";
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (strlen(known[i].name) == length && memcmp(known[i].name, name, length) == 0) {
            const int before = r->width;
            int widest = 0;
            for (int k = 0; k < known[i].arguments && r->problem == NULL; k++) {
                r->width = before;
                argument(r);
                widest = r->width - before > widest ? r->width - before : widest;
            }
            const char *at = strstr(wide, known[i].name);
            /* the arguments stand one above the other; a function's name, a fraction's line or a root's sign adds
             * width */
            r->width = before + widest;
            for (size_t k = 0; at != NULL && k < length; k++) {
                r->width += width_of(name[k]);
            }
            r->width += at != NULL                            ? 167
                        : is_quad                             ? 1000
                        : strcmp(known[i].name, "times") == 0 ? 1222
                        : name[0] == 'f'                      ? 240
                        : name[0] == 's'                      ? 833
                        : known[i].arguments == 0             ? 531
                                                              : 0;
            return;
        }
    }
    for (const char *at = greek; at != NULL; at = strchr(at + 1, ' ')) {
        if (strncmp(at + 1, name, length) == 0 && at[1 + length] == ' ') {
            r->width += isupper((unsigned char)at[1]) ? 780 : 570;
            return;
        }
    }
    fail(r, "an unknown command");
}

/* Reads a base, that is, the part before an exponent or an index. */
static void nucleus(reader *r) {
    const char c = *r->at;
    if (c == '{') {
        argument(r);
    } else if (c == '\\' && isalpha((unsigned char)r->at[1])) {
        const char *name = r->at + 1;
        size_t length = 0;
        while (isalpha((unsigned char)name[length])) {
            length++;
        }
        r->at = name + length;
        if (length == 4 && memcmp(name, "left", 4) == 0) {
            if (*r->at++ != '(') {
                fail(r, "\\left without a parenthesis");
            }
            list(r, ')');
            r->at += r->problem == NULL ? strlen("\\right)") : 0;
            r->width += 2 * 597;
        } else if (strncmp(name, "begin{aligned}", 14) == 0) {
            r->at = name + 14;
            list(r, 'e');
            r->at += r->problem == NULL ? strlen("\\end{aligned}") : 0;
        } else {
            command(r, name, length);
        }
    } else if (c == '\\' && (r->at[1] == '_' || r->at[1] == ',')) {
        r->width += r->at[1] == '_' ? 500 : 167;
        r->at += 2;
    } else if (isalnum((unsigned char)c) || (c != '\0' && strchr("+-=/.,:>()", c) != NULL)) {
        r->width += width_of(c);
        r->at++;
    } else {
        fail(r, "a character that means something else here");
    }
}

/* Reads up to `}`, `\right)` or `\end{aligned}`, or up to the end if `until` is 0. Does not read the closing part
 * itself. */
static void list(reader *r, char until) {
    const int from = r->width;
    int widest = 0;
    const bool has_rows = until == '\0' || until == 'e';
    if (++r->depth > DEPTH_MAX) {
        fail(r, "nested too deep for TeX");
    }
    bool bare = false; /* true after a function whose argument has no parentheses */
    bool opens = false;
    for (skip(r); r->problem == NULL; skip(r)) {
        const bool closes = strncmp(r->at, "\\right)", 7) == 0;
        const bool ends = strncmp(r->at, "\\end{aligned}", 13) == 0;
        if (closes || ends || *r->at == '}' || *r->at == '\0') {
            if (until != (closes ? ')' : ends ? 'e' : *r->at)) {
                fail(r, "something is not closed, or closed twice");
            }
            break;
        }
        if (has_rows && (*r->at == '&' || strncmp(r->at, "\\\\", 2) == 0)) {
            if (*r->at == '\\') {
                widest = r->width > widest ? r->width : widest;
                r->width = from;
                bare = false;
            }
            r->at += *r->at == '&' ? 1 : 2;
            continue;
        }
        static const char functions[] = " sin cos tan sinh cosh tanh operatorname exp min max ";
        const size_t length = *r->at == '\\' ? strspn(r->at + 1, "acdefghimnoprstx") : 0;
        const char *found = functions;
        while (length >= 3 && found != NULL &&
               (strncmp(found + 1, r->at + 1, length) != 0 || found[1 + length] != ' ')) {
            found = strstr(found + 1, " ");
        }
        const bool is_function = length >= 3 && found != NULL;
        if (bare && !opens && strncmp(r->at, "\\left(", 6) == 0) {
            fail(r, "a parenthesis behind a function without one");
            break;
        }
        bare = bare && strchr("+-=,", *r->at) == NULL;
        nucleus(r);
        bool has[2] = {false, false};
        for (skip(r); r->problem == NULL && (*r->at == '^' || *r->at == '_'); skip(r)) {
            bool *mine = &has[*r->at == '^'];
            if (*mine) {
                fail(r, *r->at == '^' ? "a double superscript" : "a double subscript");
                break;
            }
            *mine = true;
            r->at++;
            const int before = r->width;
            argument(r);
            /* exponents and indices are in the smaller font cmmi7 */
            r->width = before + (r->width - before) * 76 / 100;
        }
        opens = is_function && strncmp(r->at, "\\left(", 6) == 0;
        bare = is_function ? bare || !opens : bare;
    }
    r->depth--;
    r->width = widest > r->width ? widest : r->width;
}

const char *latex_problem(const char *text, const char **at) {
    reader r = {text, NULL, 0, 0};
    list(&r, '\0');
    *at = r.at;
    return r.problem;
}

int latex_width(const char *text) {
    reader r = {text, NULL, 0, 0};
    list(&r, '\0');
    return (r.width + 99) / 100;
}

char *latex_joined(const char *text) {
    static const struct {
        const char *mark;
        const char *joined;
        int deeper;
        bool inside; /* true within an `aligned` environment */
    } marks[] = {{" \\\\\n    &\\quad \\times", " \\,", 0, true},
                 {" \\\\\n    &\\quad", "", 0, true},
                 {" \\\\\n    &= ", " &= ", 0, true},
                 {"&\\begin{aligned}\n    & ", "", 1, false},
                 {"\\begin{aligned}\n    & ", "", 1, false},
                 {"\n  \\end{aligned}", "", -1, true}};
    char *made = malloc(strlen(text) + 1);
    size_t length = 0;
    int depth = 0;
    while (made != NULL && *text != '\0') {
        size_t i = 0;
        const size_t all = sizeof marks / sizeof marks[0];
        while (i < all && (strncmp(text, marks[i].mark, strlen(marks[i].mark)) != 0 ||
                           (marks[i].inside && depth == 0))) {
            i++;
        }
        if (i == all) {
            made[length++] = *text++;
        } else {
            length += (size_t)sprintf(made + length, "%s", marks[i].joined);
            depth += marks[i].deeper;
            text += strlen(marks[i].mark);
        }
    }
    if (made != NULL) {
        made[length] = '\0';
    }
    return made;
}
