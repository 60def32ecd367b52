/* test_trajectory.c: `whirl run` in double, compared with independent end states of 18 digits
 * (tests/reference/trajectory.txt, made by trajectory.py).
 *
 * The method has an error, so the test checks its order: half the step must divide the error by about 2^4 (RK4's order)
 * until round-off dominates. The error is the largest difference of a state, relative to the largest entry of the
 * reference state.
 *
 * - The measured order log2(e(h)/e(h/2)) is at least 3.7, or e(h/2) is below 1e-11 (round-off). There is no upper
 *   bound: in fast swings RK4's amplitude error, of order 5, exceeds its phase error, and orders of 5 to 6 occur.
 * - e(h/2) is below 1e-5, because a wrong trajectory may converge too.
 *
 * The step resolves the fastest swing of each mechanism. Thomson's set B is chaotic before 5 s, so only the error at a
 * fine step is checked.
 *
 * The program is build/whirl or $WHIRL. Run from the root. */
#include "test.h"

#define REFERENCE "tests/reference/trajectory.txt"
#define ORDER_LEAST 3.7
#define ROUNDING 1e-11
#define WORST 1e-5
#define VALUES_MAX 16
#define TEXT_MAX 4096

/* Reads the header and the last row of a run's CSV. Returns false if the run failed or had no row. */
static bool last_row(const char *scene, const char *until, double step_ms, char header[TEXT_MAX],
                     char row[TEXT_MAX]) {
    const char *whirl = getenv("WHIRL");
    char command[TEXT_MAX];
    char line[TEXT_MAX];
    snprintf(command, sizeof command, "%s run \"%s\" --until %ss --step %gms --csv - --quiet",
             whirl != NULL ? whirl : "build/whirl", scene, until, step_ms);
    FILE *pipe = popen(command, "r");
    TEST_ASSERT_NOT_NULL(pipe);
    header[0] = '\0';
    row[0] = '\0';
    while (fgets(line, (int)sizeof line, pipe) != NULL) {
        strcpy(header[0] == '\0' ? header : row, line);
    }
    const int status = pclose(pipe);
    if (status != 0 || row[0] == '\0') {
        printf("  %s\n    status %d\n", command, status);
        return false;
    }
    return true;
}

/* The value of a column. The fields have no quotes. */
static double column(const char *header, const char *row, const char *name) {
    const size_t length = strlen(name);
    for (;;) {
        const char *next = strpbrk(header, ",\r\n");
        const size_t width = next != NULL ? (size_t)(next - header) : strlen(header);
        if (width == length && strncmp(header, name, length) == 0) {
            return strtod(row, NULL);
        }
        const char *comma = strchr(row, ',');
        if (next == NULL || *next != ',' || comma == NULL) {
            printf("  no column %s\n", name);
            return (double)NAN;
        }
        header = next + 1;
        row = comma + 1;
    }
}

/* The error of a run, compared with `wanted` ("theta=1 theta'=2"). NaN if the run failed. */
static double run_error(const char *scene, const char *until, double step_ms, const char *wanted) {
    char header[TEXT_MAX];
    char row[TEXT_MAX];
    if (!last_row(scene, until, step_ms, header, row)) {
        return (double)NAN;
    }
    const double late = fabs(column(header, row, "time") - strtod(until, NULL));
    double largest = late <= 1e-12 ? 0.0 : (double)NAN;
    double scale = 0.0;
    char text[TEXT_MAX];
    snprintf(text, sizeof text, "%s", wanted);
    char *rest = NULL;
    for (char *word = strtok_r(text, " \n", &rest); word != NULL;
         word = strtok_r(NULL, " \n", &rest)) {
        char *equals = strchr(word, '=');
        TEST_ASSERT_NOT_NULL(equals);
        *equals = '\0';
        char name[80];
        char *prime = strchr(word, '\'');
        if (prime != NULL) {
            *prime = '\0';
        }
        snprintf(name, sizeof name, prime != NULL ? "der(%.60s)" : "%.60s", word);
        const double want = strtod(equals + 1, NULL);
        const double error = fabs(column(header, row, name) - want);
        largest = error > largest || isnan(error) ? error : largest;
        scale = fmax(scale, fabs(want));
    }
    return largest / scale;
}

/* Checks the reference lines that contain `part`. There must be `lines_wanted` such lines. */
static void check_lines(const char *part, double step_ms, int lines_wanted) {
    FILE *file = fopen(REFERENCE, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, REFERENCE " cannot be read: run from the project's root");
    char line[TEXT_MAX];
    int lines = 0;
    int failures = 0;
    while (fgets(line, (int)sizeof line, file) != NULL) {
        if (strncmp(line, "core/models/", 12) != 0 || strstr(line, part) == NULL) {
            continue;
        }
        char *rest = NULL;
        char scene[256];
        char until[32];
        TEST_ASSERT_EQUAL_INT(1, sscanf(strtok_r(line, "|", &rest), "%255s", scene));
        TEST_ASSERT_EQUAL_INT(1, sscanf(strtok_r(NULL, "|", &rest), "%31s", until));
        const char *wanted = strtok_r(NULL, "|", &rest);
        /* real pounds are stiff: their fastest part decays at 884 per second */
        const double h_ms = strstr(scene, "_physical") != NULL ? step_ms / 10.0 : step_ms;
        const double coarse = run_error(scene, until, h_ms, wanted);
        const double fine = run_error(scene, until, h_ms / 2.0, wanted);
        const double order = log2(coarse / fine);
        const bool falls = order >= ORDER_LEAST || fine <= ROUNDING;
        printf("  %s at %s s: error %.2g at %g ms, %.2g at %g ms, order %.2f\n", scene, until,
               coarse, h_ms, fine, h_ms / 2.0, order);
        lines++;
        if (!(falls && fine <= WORST)) {
            printf("    FAILED\n");
            failures++;
        }
    }
    fclose(file);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, failures, "a trajectory does not converge to the reference");
    TEST_ASSERT_EQUAL_INT_MESSAGE(lines_wanted, lines, "reference lines");
}

TEST(trajectory, particle_follows_its_parabola) {
    check_lines("/spherical_particle.whirl", 1.0, 3);
}

TEST(trajectory, two_masses_follow_the_matrix_exponential) {
    check_lines("/two_mass.whirl", 1.0, 8);
}

TEST(trajectory, epicyclic_gear_follows_the_reference) { check_lines("/epicyclic.whirl", 1.0, 4); }

TEST(trajectory, driven_hinge_follows_the_reference) {
    check_lines("/driven_hinge.whirl", 0.25, 2);
}

TEST(trajectory, thomson_device_follows_the_reference) {
    check_lines(":thomson_a | ", 0.25, 2);
    check_lines(":thomson_b | 2.0 ", 0.25, 1);
    check_lines(":thomson_a_spin | ", 0.25, 1);
    check_lines(":thomson_b_spin | ", 0.25, 1);
}

TEST(trajectory, thomson_set_b_for_five_seconds) {
    const char *part = ":thomson_b | 5.0 | ";
    FILE *file = fopen(REFERENCE, "r");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, REFERENCE " cannot be read: run from the project's root");
    char line[TEXT_MAX];
    bool found = false;
    while (!found && fgets(line, (int)sizeof line, file) != NULL) {
        found = strstr(line, part) != NULL;
    }
    fclose(file);
    TEST_ASSERT_TRUE_MESSAGE(found, "the reference line is missing");
    const char *wanted = strrchr(line, '|') + 2;
    const double error = run_error("core/models/thomson.whirl:thomson_b", "5.0", 0.0625, wanted);
    printf("  thomson_b at 5 s: error %.2g at 0.0625 ms\n", error);
    TEST_ASSERT_TRUE(error <= WORST);
}
