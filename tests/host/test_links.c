/* test_links.c: pendulums with one to twelve links. The accelerations derived from their energies are compared with
 * equations by hand, whose mass matrix has a closed form and is solved in long double. */
#include "derived.h"

enum { LINKS_MOST = 12, STATES = 40 };
#define GRAVITY 9.81

typedef struct links {
    int n;
    double mass[LINKS_MOST];   /* mass at the end of each rod, kg */
    double length[LINKS_MOST]; /* length of each rod, m */
    double torque[LINKS_MOST]; /* torque on each link, N m */
} links;

/* Writes a chain of links. Angles are zero when a link hangs down. Each link adds its own speed and height to those
 * of the link above. */
static char *written(const links *of) {
    char *text;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    fputs("mechanism links \"Links\"\n", out);
    for (int k = 0; k < of->n; k++) {
        fprintf(out, "coordinate a%d [rad]\n", k);
        fprintf(out, "parameter m%d = %.17g [kg]\n", k, of->mass[k]);
        fprintf(out, "parameter l%d = %.17g [m]\n", k, of->length[k]);
        fprintf(out, "input M%d = %.17g [N*m]\nQ(a%d) = M%d\n", k, of->torque[k], k, k);
    }
    fputs("let x0 = l0*a0'*cos(a0)\nlet y0 = l0*a0'*sin(a0)\nlet h0 = -l0*cos(a0)\n", out);
    for (int k = 1; k < of->n; k++) {
        fprintf(out, "let x%d = x%d + l%d*a%d'*cos(a%d)\n", k, k - 1, k, k, k);
        fprintf(out, "let y%d = y%d + l%d*a%d'*sin(a%d)\n", k, k - 1, k, k, k);
        fprintf(out, "let h%d = h%d - l%d*cos(a%d)\n", k, k - 1, k, k);
    }
    fputs("T = (", out);
    for (int k = 0; k < of->n; k++) {
        fprintf(out, "%sm%d*(x%d^2 + y%d^2)", k > 0 ? " + " : "", k, k, k);
    }
    fputs(")/2\nV = (", out);
    for (int k = 0; k < of->n; k++) {
        fprintf(out, "%sm%d*h%d", k > 0 ? " + " : "", k, k);
    }
    fprintf(out, ")*%.17g [m/s^2]\n", GRAVITY);
    fclose(out);
    return text;
}

/* Accelerations by hand: M_ij = mu l_i l_j cos(a_i - a_j), with the sum mu of the masses from link max(i, j) on. */
static void by_hand(const links *of, const state_values *s, long double *accel) {
    long double m[LINKS_MOST][LINKS_MOST + 1];
    long double below[LINKS_MOST + 1]; /* sum of the masses from link k on */
    long double length[LINKS_MOST];
    below[of->n] = 0.0L;
    for (int k = of->n; k-- > 0;) {
        below[k] = below[k + 1] + (long double)of->mass[k];
        length[k] = (long double)of->length[k];
    }
    for (int i = 0; i < of->n; i++) {
        const long double angle = (long double)s->value[i][0];
        m[i][of->n] =
            (long double)of->torque[i] - below[i] * (long double)GRAVITY * length[i] * sinl(angle);
        for (int j = 0; j < of->n; j++) {
            const long double between = angle - (long double)s->value[j][0];
            const long double rate = (long double)s->value[j][1];
            const long double both = below[i > j ? i : j] * length[i] * length[j];
            m[i][j] = both * cosl(between);
            m[i][of->n] -= both * sinl(between) * rate * rate;
        }
    }
    dense_solve(of->n, LINKS_MOST + 1, m[0], accel);
}

TEST(links, pendulums_of_so_many_links) {
    uint64_t seed = 12;
    double worst = 0.0;
    for (int n = 1; n <= LINKS_MOST; n++) {
        links of = {.n = n};
        for (int k = 0; k < n; k++) {
            of.mass[k] = random_between(&seed, 0.2, 2.0);
            of.length[k] = random_between(&seed, 0.1, 0.5);
            of.torque[k] = random_between(&seed, -3.0, 3.0);
        }
        char *text = written(&of);
        derived d = derived_text(text);
        derived_expect(&d, text);
        for (int i = 0; i < STATES; i++) {
            state_values s = {.instance = d.instance};
            double found[LINKS_MOST];
            long double wanted[LINKS_MOST];
            long double most = 0.0L;
            for (int k = 0; k < n; k++) {
                s.value[k][0] = random_between(&seed, -3.0, 3.0);
                s.value[k][1] = random_between(&seed, -4.0, 4.0);
            }
            derived_run(d.image->list[IMAGE_STEP], &d, &s, found);
            by_hand(&of, &s, wanted);
            for (int k = 0; k < n; k++) {
                most = fmaxl(most, fabsl(wanted[k]));
            }
            for (int k = 0; k < n; k++) {
                worst = fmax(worst, (double)(fabsl((long double)found[k] - wanted[k]) / most));
            }
        }
        derived_free(&d);
        free(text);
    }
    char said[80];
    snprintf(said, sizeof said, "off by at most %.1e of the largest acceleration", worst);
    TEST_MESSAGE(said);
    TEST_ASSERT_TRUE(worst > 0.0 && worst <= 1e-11);
}
