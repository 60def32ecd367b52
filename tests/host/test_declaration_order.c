/* test_declaration_order.c: the output of `whirl run` (summary, warnings, hints) must not depend on the sequence of
 * declarations. There are random scenes for every kind of warning, with coordinates of very different size; they run
 * in all sequences. Words must be equal, and numbers, too, except for sums that are rounded in another sequence. */
#include "command.h"
#include "host/cli/commands.h"

static dice die;

enum { DECLARED_MOST = 4, WORDS_MOST = 6, LINES_MOST = 80, TEXT_SIZE = 2000 };

/* A scene. In its texts, a number after @ is replaced by a random number within a tenth of it. */
typedef struct told_scene {
    const char *told; /* words that the output must have */
    const char *coordinates[DECLARED_MOST];
    const char *law;
    const char *contacts[DECLARED_MOST];
    const char *scene;
    const char *words[WORDS_MOST];
    int status;
    double apart; /* relative tolerance for sums that float rounds in another sequence */
} told_scene;

#define SPRUNG \
    "T = 1 [kg]*a'^2/2 + 2 [kg]*b'^2/2 + 3 [kg]*c'^2/2\n" \
    "V = @80 [N/m]*a^2/2 + @7 [N/m^3]*a^4 + @3 [N/m]*b^2/2 + @0.7 [N/m]*c^2/2\n"
#define SPRUNG_START "start a = @1 [m], b = @20 [m], c = @5 [m]; "
#define THREE \
    { "coordinate a [m]\n", "coordinate b [m]\n", "coordinate c [m]\n" }

static const told_scene scenes[] = {
    {.told = "the energy balance fails",
     .coordinates = THREE,
     .law = SPRUNG,
     .scene = SPRUNG_START "step 0.09 [s]; until 9 [s]"},
    {.told = "the energy balance fails",
     .coordinates = THREE,
     .law = SPRUNG,
     .scene = SPRUNG_START "step 0.04 [s]; until 4 [s]",
     .words = {"--method", "heun", "--number", "float"}},
    {.told = "the energy balance fails",
     .coordinates = THREE,
     .law = SPRUNG,
     .scene = SPRUNG_START "step 0.1 [s]; until 9 [s]",
     .words = {"--method", "leapfrog"}},
    {.told = "grew without bound",
     .coordinates = THREE,
     .law = SPRUNG,
     .scene = SPRUNG_START "step 0.36 [s]; until 50 [s]",
     .status = 1},
    {.told = "[accuracy]",
     .coordinates = {"state p\n", "state q\n", "state r\n", "state s\n"},
     .law = "equation p' = @8 [1/s]*q*(1 + q^2/200)\nequation q' = -@5 [1/s]*p - @2 [1/s]*r\n"
            "equation r' = -@0.5 [1/s]*r + @9 [1/s]*q\n"
            "equation s' = @0.1 [1/s]*r\n",
     .scene = "start p = @3, r = @1, s = @7; step 0.08 [s]; until 8 [s]"},
    {.told = "[accuracy]",
     .coordinates = {"coordinate r [m]\n", "coordinate b [m]\n", "coordinate phi [rad]\n",
                     "coordinate psi [rad]\n"},
     .law = "T = 1 [kg]*(r'^2 + (1 [m] - r)^2*phi'^2)/2 + 2 [kg]*b'^2/2 + @5 [kg*m^2]*psi'^2/2\n"
            "V = @3 [N/m]*b^2/2\n",
     .scene = "start r = 0 [m], r' = @1 [m/s], phi' = @0.018 [rad/s], b = @0.3 [m], psi' = @0.6 "
              "[rad/s]; step 0.02 [s]; until 2 [s]"},
    {.told = "[accuracy]",
     .coordinates = THREE,
     .law = "T = 1 [kg]*a'^2/2 + 2 [kg]*b'^2/2 + 3 [kg]*c'^2/2\n"
            "V = @9 [N/m]*a^2/2 + @25 [N/m]*b^2/2\n",
     .scene = "start a = 1 [m], b = @1 [m], c = @5e5 [m], c' = @0.1 [m/s]; step 0.01 [s]; until 3 "
              "[s]",
     .words = {"--number", "float"}},
    {.told = "[accuracy]",
     .coordinates = THREE,
     .law =
         "T = 1 [kg]*a'^2/2 + 2 [kg]*b'^2/2 + 3 [kg]*c'^2/2\n"
         "V = @9 [N/m]*a^2/2 + @25 [N/m]*b^2/2 + @4 [N/m]*(sqrt((c - 8e3 [m])^2 + 1 [m^2]) - 0.5 "
         "[m])^2/2\n",
     .scene = "start a = 1 [m], b = @1 [m], c = 8001 [m]; step 0.01 [s]; until 5 [s]",
     .words = {"--number", "float"},
     .apart = 0.3},
    {.told = "'b' turns so slowly that rounding",
     .coordinates = {"coordinate a [rad]\n", "coordinate b [rad]\n", "coordinate c [rad]\n",
                     "coordinate x [m]\n"},
     .law = "T = 1 [kg*m^2]*a'^2/2 + 2 [kg*m^2]*b'^2/2 + 3 [kg*m^2]*c'^2/2 + 1 [kg]*x'^2/2\n",
     .scene = "start a' = @1 [rad/s], b' = @3.3e-7 [rad/s], c' = @0.01 [rad/s], x' = @3 [m/s]; "
              "step 0.01 [s]; until 4 [s]",
     .words = {"--number", "float"}},
    {.told = "[accuracy]",
     .coordinates = {"state u\n", "state v [m]\n", "state w [kg]\n"},
     .law = "input p = 1e-20 [m/s]\ninput q = @7e-25\ninput c = 1e38\nequation v' = p*q*c\n"
            "equation u' = @1 [1/s]\nequation w' = @70 [kg/s]\n",
     .scene = "step 10 [ms]; until 1 [s]",
     .words = {"--number", "float"}},
    {.told = "moments with events, most of them from 'hold b while",
     .coordinates = THREE,
     .law = "T = 1 [kg]*a'^2/2 + 2 [kg]*b'^2/2 + 3 [kg]*c'^2/2\nQ(a) = @1 [N]\nQ(b) = @30 [N]\n"
            "Q(c) = @20 [N]\n",
     .contacts = {"hold a while a' > 5 [m/s]\n", "hold b while b' > 0.023 [m/s]\n",
                  "hold c while c' > 0.041 [m/s]\n"},
     .scene = "step 0.01 [s]; until 0.5 [s]"},
    {.told = "saturated",
     .coordinates = THREE,
     .law = "T = 1 [kg]*a'^2/2 + 2 [kg]*b'^2/2 + 3 [kg]*c'^2/2\n"
            "V = @3 [N/m]*a^2/2 + @5 [N/m]*b^2/2\n",
     .scene = "range a = -2 .. 2 [m], b = -3 .. 3 [m], c = -0.7 .. 0.7 [m], a' = -8 .. 8 [m/s], "
              "b' = -9 .. 9 [m/s], c' = -1 .. 1 [m/s]; start a = 1 [m], b = @0.5 [m], c' = @0.5 "
              "[m/s]; step 10 [ms]; until 2 [s]",
     .words = {"--number", "fixed"}},
    {.told = "'c' moves so slowly",
     .coordinates = THREE,
     .law = "T = 1 [kg]*a'^2/2 + 2 [kg]*b'^2/2 + 3 [kg]*c'^2/2\n"
            "V = @3 [N/m]*a^2/2 + @5 [N/m]*b^2/2\n",
     .scene = "range a = -2 .. 2 [m], b = -3 .. 3 [m], c = -1 .. 1 [m], a' = -8 .. 8 [m/s], "
              "b' = -9 .. 9 [m/s], c' = -1 .. 1 [m/s]; start a = 1 [m], b = @0.5 [m], c' = @3.3e-6 "
              "[m/s]; step 1 [ms]; until 0.5 [s]",
     .words = {"--number", "fixed"}},
    {.told = "momentum balance of a [kg*m/s]",
     .coordinates = THREE,
     .law = "T = 1 [kg]*a'^2/2 + 2 [kg]*b'^2/2 + 3 [kg]*c'^2/2 + @0.4 [kg]*a'*c'\n"
            "V = @5 [N/m]*b^2/2\nF = @0.7 [N*s/m]*b'^2/2\n",
     .scene = "start a' = @1 [m/s], b = @0.5 [m], c' = -@3 [m/s]; step 10 [ms]; until 2 [s]",
     .words = {"--with", "ledger"}},
};

enum { SCENES = (int)(sizeof scenes / sizeof scenes[0]) };

static size_t add(char *text, size_t at, const char *more) {
    const size_t size = strlen(more);
    TEST_ASSERT_TRUE(at + size < TEXT_SIZE);
    memcpy(text + at, more, size + 1);
    return at + size;
}

/* Computes permutation number k, in the factorial number system. */
static void order_of(unsigned k, unsigned count, unsigned *place) {
    for (unsigned i = 0; i < count; i++) {
        place[i] = i;
    }
    for (unsigned left = count; left > 1; left--) {
        const unsigned other = k % left;
        const unsigned kept = place[left - 1];
        place[left - 1] = place[other];
        place[other] = kept;
        k /= left;
    }
}

static size_t add_in_order(char *text, size_t at, const char *const *lines, unsigned k) {
    unsigned count = 0;
    unsigned place[DECLARED_MOST];
    while (count < DECLARED_MOST && lines[count] != NULL) {
        count++;
    }
    order_of(k, count, place);
    for (unsigned i = 0; i < count; i++) {
        at = add(text, at, lines[place[i]]);
    }
    return at;
}

static void draw_numbers(const char *from, dice drawn, char text[TEXT_SIZE]) {
    size_t at = 0;
    text[0] = '\0';
    while (*from != '\0') {
        char number[40] = {*from, '\0'};
        if (*from++ == '@') {
            char *end;
            const double middle = strtod(from, &end);
            snprintf(number, sizeof number, "%.12g", middle * dice_between(&drawn, 0.9, 1.1));
            from = end;
        }
        at = add(text, at, number);
    }
}

static void run(const told_scene *s, dice drawn, unsigned k, said *what) {
    char with[TEXT_SIZE];
    char text[TEXT_SIZE];
    size_t at = add(with, 0, "mechanism m\n");
    at = add_in_order(with, at, s->coordinates, k);
    at = add(with, at, s->law);
    at = add_in_order(with, at, s->contacts, k / 2U + k % 2U);
    at = add(with, at, "scene s { ");
    at = add(with, at, s->scene);
    (void)add(with, at, " }\n");
    draw_numbers(with, drawn, text);
    const char *words[WORDS_MOST + 2] = {model_keep(text)};
    memcpy(words + 1, s->words, sizeof s->words);
    command_say(command_run, words, what);
}

static int compare(const void *a, const void *b) {
    const char *const *left = a;
    const char *const *right = b;
    return strcmp(*left, *right);
}

/* The lines of the output, sorted, without lines that differ from run to run. */
static unsigned lines_of(char *text, const char *line[LINES_MOST]) {
    unsigned count = 0;
    char *rest = NULL;
    for (char *at = strtok_r(text, "\n", &rest); at != NULL; at = strtok_r(NULL, "\n", &rest)) {
        if (strncmp(at, "accuracy and cost", 17) == 0) {
            break; /* later lines depend on float's round-off and the file's name */
        }
        if (strncmp(at, "state hash", 10) != 0 && strncmp(at, "trusted", 7) != 0) {
            TEST_ASSERT_TRUE(count < LINES_MOST);
            line[count++] = at;
        }
    }
    qsort(line, count, sizeof *line, compare);
    return count;
}

static void expect_line(const char *wanted, const char *is, double apart) {
    char both[700];
    snprintf(both, sizeof both, "%.330s | %.330s", wanted, is);
    const char *first = wanted;
    const char *second = is;
    while (*first != '\0' || *second != '\0') {
        char *ends[2];
        const double a = strtod(first, &ends[0]);
        const double b = strtod(second, &ends[1]);
        const bool begins = first == wanted || !isalnum((unsigned char)first[-1]);
        if (begins && ends[0] != first && ends[1] != second) {
            TEST_ASSERT_TRUE_MESSAGE(a == b || fabs(a - b) <= (0.02 + apart) * fabs(a) + 1e-9,
                                     both);
            first = ends[0];
            second = ends[1];
        } else {
            TEST_ASSERT_TRUE_MESSAGE(*first++ == *second++, both);
        }
    }
}

static void expect_the_same(char *wanted, char *is, double apart) {
    const char *line[2][LINES_MOST];
    const unsigned count = lines_of(wanted, line[0]);
    const unsigned other = lines_of(is, line[1]);
    TEST_ASSERT_EQUAL_UINT(count, other);
    for (unsigned i = 0; i < count; i++) {
        expect_line(line[0][i], line[1][i], apart);
    }
}

TEST(declaration_order, orders) {
    for (int i = 0; i < SCENES; i++) {
        const told_scene *s = &scenes[i];
        (void)dice_one_of(&die, 2);
        const dice drawn = die;
        said first;
        run(s, drawn, 0, &first);
        const bool in_err = strstr(first.err, s->told) != NULL;
        TEST_ASSERT_TRUE_MESSAGE(in_err || strstr(first.out, s->told) != NULL, first.err);
        const int status = s->status != 0 ? s->status : said_owes(first.err);
        TEST_ASSERT_EQUAL_INT_MESSAGE(status, first.status, first.err);
        for (unsigned k = 1; k < few_or_all(5, 24); k++) {
            said wanted = first;
            said what;
            run(s, drawn, k, &what);
            TEST_ASSERT_EQUAL_INT_MESSAGE(status, what.status, what.err);
            expect_the_same(wanted.err, what.err, s->apart);
            expect_the_same(wanted.out, what.out, s->apart);
        }
    }
    model_drop();
}

SUITE(declaration_order) { die = dice_of("declaration_order", 91); }
