/* test_mass_scales.c: singular mass matrices must be found whatever the units and mass ratios. Generated mechanisms
 * are compared with elimination in long double. test_rank.c tests matrices alone. */
#include "command.h"
#include "derived.h"

#include "host/derive/lagrange.h"

enum { MOST = 6, ROOM = MOST * MOST };

static int cases(int usual) {
    const char *more = getenv("WHIRL_MASS_CASES");
    return more != NULL ? (int)strtol(more, NULL, 10)
                        : (int)usual_or((unsigned)usual, (unsigned)usual / 4);
}

static void solve(const long double *mass, const long double *b, int n, long double *x) {
    long double a[MOST][MOST + 1];
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            a[i][j] = mass[i * n + j];
        }
        a[i][n] = b[i];
    }
    dense_solve(n, MOST + 1, a[0], x);
}

/* Bodies whose speeds are integer combinations of the rates of the coordinates. */
typedef struct bodies {
    int n;                /* number of coordinates */
    int count;            /* number of bodies */
    int part[ROOM];       /* [count][n] factors of the rates */
    double mass_kg[MOST]; /* [count] masses of the bodies */
    double unit[MOST];    /* [n] metres per unit of a coordinate, a power of ten */
} bodies;

static bodies random_bodies(uint64_t *seed, int n, int count, double decades) {
    bodies b = {.n = n, .count = count};
    for (int k = 0; k < count; k++) {
        b.mass_kg[k] = pow(10.0, random_between(seed, -decades / 2.0, decades / 2.0));
        for (int i = 0; i < n; i++) {
            b.part[k * n + i] = i == k % n ? 1 : i < k % n ? (int)(random_bits(seed) % 3) - 1 : 0;
        }
    }
    for (int i = 0; i < n; i++) {
        b.unit[i] = pow(10.0, (double)(int)random_between(seed, -6.0, 7.0));
    }
    return b;
}

static void mass_matrix(const bodies *b, long double *mass) {
    for (int i = 0; i < b->n; i++) {
        for (int j = 0; j < b->n; j++) {
            long double sum = 0.0L;
            for (int k = 0; k < b->count; k++) {
                sum += (long double)b->mass_kg[k] * b->part[k * b->n + i] * b->part[k * b->n + j];
            }
            mass[i * b->n + j] = sum * (long double)b->unit[i] * (long double)b->unit[j];
        }
    }
}

static char *text_of(const bodies *b, const double *force) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(out);
    fprintf(out, "mechanism bodies\n");
    for (int i = 0; i < b->n; i++) {
        fprintf(out, "coordinate q%d [m]\n", i);
    }
    for (int k = 0; k < b->count; k++) {
        fprintf(out, "let v%d = 0", k);
        for (int i = 0; i < b->n; i++) {
            if (b->part[k * b->n + i] != 0) {
                fprintf(out, " %c %.17g*q%d'", b->part[k * b->n + i] > 0 ? '+' : '-', b->unit[i],
                        i);
            }
        }
        fputc('\n', out);
    }
    fprintf(out, "T = ");
    for (int k = 0; k < b->count; k++) {
        fprintf(out, "%s%.17g [kg]*v%d^2/2", k > 0 ? " + " : "", b->mass_kg[k], k);
    }
    fputc('\n', out);
    for (int i = 0; i < b->n; i++) {
        fprintf(out, "Q(q%d) = %.17g [N]\n", i, force[i]);
    }
    fclose(out);
    return text;
}

/* How much the inverse of the matrix magnifies round-off: the one-norm of the inverse, after scaling to unit diagonal. */
static double inverse_size(const long double *mass, int n) {
    long double scaled[ROOM];
    double most = 0.0;
    for (int i = 0; i < n * n; i++) {
        scaled[i] = mass[i] / sqrtl(mass[i / n * (n + 1)] * mass[i % n * (n + 1)]);
    }
    for (int j = 0; j < n; j++) {
        long double one[MOST] = {0};
        long double x[MOST];
        double sum = 0.0;
        one[j] = 1.0L;
        solve(scaled, one, n, x);
        for (int i = 0; i < n; i++) {
            sum += (double)fabsl(x[i]);
        }
        most = fmax(most, sum);
    }
    return most;
}

/* Accelerations must be right within the matrix's round-off. Returns the worst error, divided by that bound. */
static double check_right(const bodies *b, uint64_t *seed) {
    long double mass[ROOM];
    long double wanted[MOST];
    long double right[MOST];
    double force[MOST];
    const int n = b->n;
    mass_matrix(b, mass);
    for (int i = 0; i < n; i++) {
        force[i] = random_between(seed, -1.0, 1.0) * sqrt((double)mass[i * n + i]);
        right[i] = (long double)force[i];
    }
    solve(mass, right, n, wanted);
    char *text = text_of(b, force);
    derived d = derived_text(text);
    TEST_ASSERT_NOT_NULL_MESSAGE(d.image, d.errors[0] != '\0' ? d.errors : text);
    double result[64];
    state_values at = {.instance = d.instance};
    TEST_ASSERT_TRUE(d.image->list[IMAGE_BOOKS]->results <= 64);
    derived_run(d.image->list[IMAGE_BOOKS], &d, &at, result);
    double size = 0.0;
    double off = 0.0;
    for (int i = 0; i < n; i++) {
        const double scale = sqrt((double)mass[i * n + i]);
        size = fmax(size, scale * (double)fabsl(wanted[i]));
        off = fmax(off, scale * fabs(result[i] - (double)wanted[i]));
    }
    const double worst = off / (size * (double)n * DBL_EPSILON * inverse_size(mass, n));
    if (!(worst < 4.0)) {
        printf("%s", text);
        TEST_FAIL_MESSAGE("accelerations are further off than rounding makes them");
    }
    free(text);
    derived_free(&d);
    return worst;
}

/* Mass ratios up to 1e12, and units from micrometres to thousands of kilometres. */
TEST(mass_scales, mixed_masses_and_units_are_right) {
    uint64_t seed = 90210;
    double worst = 0.0;
    const int all = cases(150);
    for (int i = 0; i < all; i++) {
        const int n = 2 + (int)(random_bits(&seed) % 4);
        const bodies b = random_bodies(&seed, n, n, i % 2 == 0 ? 12.0 : 3.0);
        worst = fmax(worst, check_right(&b, &seed));
    }
    printf("  %d mechanisms from seed 90210: at most %.2f of n eps |inverse|\n", all, worst);
}

TEST(mass_scales, fewer_bodies_than_coordinates_are_refused) {
    uint64_t seed = 77;
    for (int i = 0; i < cases(150); i++) {
        const int n = 2 + (int)(random_bits(&seed) % 4);
        bodies b = random_bodies(&seed, n, n - 1, i % 2 == 0 ? 3.0 : 12.0);
        for (int k = 0; k < b.count * n; k++) {
            b.part[k] = 1 + (int)(random_bits(&seed) % 7);
        }
        const double force[MOST] = {0};
        char *text = text_of(&b, force);
        derived d = derived_text(text);
        TEST_ASSERT_NULL_MESSAGE(d.image, text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, "singular mass matrix"), d.errors);
        free(text);
        derived_free(&d);
    }
}

/* Two squares of speeds for three rates: a' and b' occur in a single combination, with sines as factors. So the
 * matrix is singular. */
TEST(mass_scales, one_speed_through_sines_is_refused) {
    uint64_t seed = 31;
    for (int i = 0; i < 60; i++) {
        char text[600];
        const double small = pow(10.0, random_between(&seed, -6.0, 6.0));
        snprintf(text, sizeof text,
                 "mechanism one\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate c [rad]\n"
                 "let s = %.17g*a'*sin(b + %.3g) + %.17g*b'*cos(%d*a - c) + c'*cos(a)^2*sin(c)\n"
                 "let t = %.17g*a'*sin(b + %.3g) + %.17g*b'*cos(%d*a - c) - c'\n"
                 "T = %.17g [kg*m^2]*s^2 + 1 [kg*m^2]*t^2\n",
                 small, 0.3 * i, 1.0 / small, 1 + i % 3, small, 0.3 * i, 1.0 / small, 1 + i % 3,
                 random_between(&seed, 0.1, 3.0));
        derived d = derived_text(text);
        TEST_ASSERT_NULL_MESSAGE(d.image, text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(d.errors, "singular mass matrix"), d.errors);
        derived_free(&d);
    }
}
