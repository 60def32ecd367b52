/* test_symmetry.c: affine symmetries (host/derive/symmetry.h) of random particles in a plane that springs connect,
 * some with a hidden force from outside. The reference differentiates the energies by formulas of its own and takes
 * the rank of their changes at random states. tests/cli/examine.sh tests the built-in mechanisms. WHIRL_CASES=N and
 * WHIRL_SEED=N choose other cases. */
#include "command.h"
#include "derived.h"
#include "host/derive/symmetry.h"

enum {
    ROWS = 7,
    BODIES = 3,
    N = 2 * BODIES,
    COLUMNS = N * (N + 1),
    STATES = 2 * COLUMNS,
    TEXT = 4000
};

enum {
    GRAVITY = 1,  /* V: a force along y */
    ANCHOR = 2,   /* V: pulls one x towards a point of the plane */
    DRAG = 4,     /* F: a loss of one y' */
    DAMPER = 8,   /* F: between two x', so no force from outside */
    HAND = 16,    /* Q: an input pushes along one x */
    COUPLE = 32,  /* Q: an input pushes two x apart, so no force from outside */
    WALL = 64,    /* a stop of one y */
    BUMPER = 128, /* a stop between two x, so no force from outside */
    CENTRE = 256, /* V: a spring from the origin, which allows rotations */
    SLIDER = 512, /* T: the sum of two x', so that a momentum depends on both rates */
    KICK = 1024,  /* a crossing that sets one x' */
    PUT = 2048,   /* a crossing that sets one x */
    KINDS = 12,
    ALL = (1 << KINDS) - 1
};

#define SLIDER_KG 1.7

typedef struct particles {
    int bodies;
    unsigned with;
    int at; /* the body with an outside force */
    double mass[BODIES];
    double spring[BODIES]; /* stiffness between body i and i + 1 */
    double length[BODIES];
    double strength; /* strength of the hidden force; 1e-6 at least */
} particles;

/* Writes the mechanism. Each sum begins with a zero, so that every part can be appended. */
static void write(const particles *p, char *text) {
    int used = snprintf(text, TEXT, "mechanism m\ninput hand = 0 [N]\n");
#define ADD(...) used += snprintf(text + used, (size_t)(TEXT - used), __VA_ARGS__)
    for (int i = 0; i < p->bodies; i++) {
        ADD("coordinate x%d [m]\ncoordinate y%d [m]\n", i, i);
    }
    ADD("T = 0");
    for (int i = 0; i < p->bodies; i++) {
        ADD(" + %.17g [kg]*(x%d'^2 + y%d'^2)/2", p->mass[i], i, i);
    }
    if ((p->with & SLIDER) != 0) {
        ADD(" + %.17g [kg]*(x0' + x1')^2/2", SLIDER_KG);
    }
    ADD("\nV = 0");
    for (int i = 0; i + 1 < p->bodies; i++) {
        ADD(" + %.17g [N/m]*(sqrt((x%d - x%d)^2 + (y%d - y%d)^2) - %.17g [m])^2/2", p->spring[i], i,
            i + 1, i, i + 1, p->length[i]);
    }
    for (int i = 0; i < p->bodies && (p->with & GRAVITY) != 0; i++) {
        ADD(" + %.17g [m/s^2]*%.17g [kg]*y%d", p->strength, p->mass[i], i);
    }
    if ((p->with & ANCHOR) != 0) {
        ADD(" + %.17g [N/m]*(x%d - 0.3 [m])^2/2", p->strength, p->at);
    }
    if ((p->with & CENTRE) != 0) {
        ADD(" + %.17g [N/m]*(x%d^2 + y%d^2)/2", p->strength, p->at, p->at);
    }
    ADD("\nF = 0");
    if ((p->with & DRAG) != 0) {
        ADD(" + %.17g [N*s/m]*y%d'^2/2", p->strength, p->at);
    }
    if ((p->with & DAMPER) != 0) {
        ADD(" + 0.4 [N*s/m]*(x0' - x1')^2/2");
    }
    for (int i = 0; i < p->bodies; i++) {
        const double hand = (p->with & HAND) != 0 && i == p->at ? p->strength : 0.0;
        const double couple = (p->with & COUPLE) == 0 ? 0.0 : i == 0 ? 1.0 : i == 1 ? -1.0 : 0.0;
        ADD("\nQ(x%d) = %.17g*hand + %.17g*hand", i, hand, couple);
    }
    if ((p->with & WALL) != 0) {
        ADD("\nstop y%d <= 50 [m] restitution 1", p->at);
    }
    if ((p->with & BUMPER) != 0) {
        ADD("\nstop x1 - x0 >= -50 [m] restitution 1");
    }
    if ((p->with & KICK) != 0) {
        ADD("\nwhen y0 crosses 40 [m] rising { set x%d' = -x%d' }", p->at, p->at);
    }
    if ((p->with & PUT) != 0) {
        ADD("\nwhen y0 crosses 41 [m] rising { set x%d = 0.5 [m] }", p->at);
    }
    ADD("\n");
#undef ADD
}

/* Forces along the coordinates at a state. stored[]: the slopes of V; force[]: all other forces. */
static void slopes(const particles *p, const double *q, const double *v, double hand,
                   double *stored, double *force) {
    memset(stored, 0, N * sizeof *stored);
    memset(force, 0, N * sizeof *force);
    for (int i = 0; i + 1 < p->bodies; i++) {
        const double dx = q[2 * i] - q[2 * i + 2];
        const double dy = q[2 * i + 1] - q[2 * i + 3];
        const double apart = sqrt(dx * dx + dy * dy);
        const double pull = p->spring[i] * (apart - p->length[i]) / apart;
        stored[2 * i] += pull * dx;
        stored[2 * i + 2] -= pull * dx;
        stored[2 * i + 1] += pull * dy;
        stored[2 * i + 3] -= pull * dy;
    }
    const int x = 2 * p->at;
    const int y = x + 1;
    for (int i = 0; i < p->bodies && (p->with & GRAVITY) != 0; i++) {
        stored[2 * i + 1] += p->strength * p->mass[i];
    }
    stored[x] += (p->with & ANCHOR) != 0 ? p->strength * (q[x] - 0.3) : 0.0;
    if ((p->with & CENTRE) != 0) {
        stored[x] += p->strength * q[x];
        stored[y] += p->strength * q[y];
    }
    force[y] -= (p->with & DRAG) != 0 ? p->strength * v[y] : 0.0;
    force[x] += (p->with & HAND) != 0 ? p->strength * hand : 0.0;
    const double inside = ((p->with & DAMPER) != 0 ? -0.4 * (v[0] - v[2]) : 0.0) +
                          ((p->with & COUPLE) != 0 ? hand : 0.0);
    force[0] += inside;
    force[2] -= inside;
}

/* The rank of m[rows][columns], by elimination with rows scaled to 1 and full pivoting. Overwrites m. */
static int rank_by_hand(double *m, int rows, int columns) {
    int rank = 0;
    for (int i = 0; i < rows; i++) {
        double most = 0.0;
        for (int j = 0; j < columns; j++) {
            most = fmax(most, fabs(m[i * columns + j]));
        }
        for (int j = 0; j < columns && most > 0.0; j++) {
            m[i * columns + j] /= most;
        }
    }
    for (; rank < columns && rank < rows; rank++) {
        int row = rank;
        int column = rank;
        for (int i = rank; i < rows; i++) {
            for (int j = rank; j < columns; j++) {
                if (fabs(m[i * columns + j]) > fabs(m[row * columns + column])) {
                    row = i;
                    column = j;
                }
            }
        }
        if (fabs(m[row * columns + column]) < 1e-11) {
            break;
        }
        for (int j = 0; j < columns; j++) {
            const double swap = m[row * columns + j];
            m[row * columns + j] = m[rank * columns + j];
            m[rank * columns + j] = swap;
        }
        for (int i = 0; i < rows; i++) {
            const double swap = m[i * columns + column];
            m[i * columns + column] = m[i * columns + rank];
            m[i * columns + rank] = swap;
        }
        for (int i = rank + 1; i < rows; i++) {
            const double part = m[i * columns + rank] / m[rank * columns + rank];
            for (int j = rank; j < columns; j++) {
                m[i * columns + j] -= part * m[rank * columns + j];
            }
        }
    }
    return rank;
}

/* How column k of a symmetry moves coordinate i at the position of[]. The columns are the entries of A, row by row,
 * then of b. */
static double moved(int n, int k, int i, const double *of) {
    if (k >= n * n) {
        return k - n * n == i ? 1.0 : 0.0;
    }
    return k / n == i ? of[k % n] : 0.0;
}

static double mass_of(const particles *p, int i, int j) {
    const bool slides = (p->with & SLIDER) != 0 && (i == 0 || i == 2) && (j == 0 || j == 2);
    return (i == j ? p->mass[i / 2] : 0.0) + (slides ? SLIDER_KG : 0.0);
}

/* *both: number of motions that leave T and V unchanged. *conserved: those along which no force or contact does
 * work. */
static void count_by_hand(const particles *p, uint64_t *seed, int *both, int *conserved) {
    static double energies[2 * STATES][COLUMNS];
    static double all[ROWS * STATES][COLUMNS];
    const int n = 2 * p->bodies;
    const int columns = n * (n + 1);
    double *e = &energies[0][0];
    double *a = &all[0][0];
    int rows = 0;
    int all_rows = 0;
    for (int s = 0; s < 2 * columns; s++) {
        double q[N];
        double v[N];
        double stored[N];
        double force[N];
        for (int i = 0; i < n; i++) {
            q[i] = random_between(seed, -2.0, 2.0);
            v[i] = random_between(seed, -2.0, 2.0);
        }
        slopes(p, q, v, random_between(seed, -3.0, 3.0), stored, force);
        const int x = 2 * p->at;
        for (int which = 0; which < ROWS; which++) {
            double *row = &a[all_rows++ * columns];
            for (int k = 0; k < columns; k++) {
                double sum = 0.0;
                for (int i = 0; i < n; i++) {
                    const double way = moved(n, k, i, q);
                    const double rate_way = k >= n * n ? 0.0 : moved(n, k, i, v);
                    const double wall = (p->with & WALL) != 0 && i == 2 * p->at + 1 ? 1.0 : 0.0;
                    const double bump = (p->with & BUMPER) != 0 ? (i == 2) - (double)(i == 0) : 0.0;
                    double momentum = 0.0;
                    for (int j = 0; j < n; j++) {
                        momentum += mass_of(p, i, j) * v[j];
                    }
                    /* change of the momentum along k by a crossing */
                    const double kick = (p->with & KICK) != 0 ? mass_of(p, i, x) : 0.0;
                    const bool turns =
                        (p->with & PUT) != 0 && k < n * n && k / n == i && k % n == x;
                    const double of[ROWS] = {
                        momentum * rate_way, stored[i] * way, force[i] * way,        wall * way,
                        bump * way,          kick * way,      turns ? momentum : 0.0};
                    sum += of[which];
                }
                row[k] = sum;
            }
            if (which < 2) {
                memcpy(&e[rows++ * columns], row, (size_t)columns * sizeof *row);
            }
        }
    }
    *both = columns - rank_by_hand(e, rows, columns);
    *conserved = columns - rank_by_hand(a, all_rows, columns);
}

TEST(symmetry, particles) {
    char text[TEXT];
    char why[TEXT + 100];
    dice die = dice_of("symmetry", 1);
    int with_rotation = 0;
    int with_none = 0;
    for (unsigned c = 0; c < dice_cases(few_or_all(usual_or(60, 24), 500)); c++) {
        uint64_t seed = die.state + 7919U * c;
        particles p = {.bodies = 2 + (int)(random_bits(&seed) % 2U)};
        p.at = (int)(random_bits(&seed) % (unsigned)p.bodies);
        p.strength = pow(10.0, random_between(&seed, -6.0, 0.0));
        /* nothing, one kind, or a few kinds */
        const uint64_t half = random_bits(&seed);
        p.with = c % 3U == 0 ? 0U : (unsigned)(half & random_bits(&seed)) & ALL;
        p.with = c % 3U == 1 ? 1U << (random_bits(&seed) % (unsigned)KINDS) : p.with;
        for (int i = 0; i < BODIES; i++) {
            p.mass[i] = random_between(&seed, 0.2, 4.0);
            p.spring[i] = random_between(&seed, 0.5, 9.0);
            p.length[i] = random_between(&seed, 0.3, 1.5);
        }
        write(&p, text);
        derived d = derived_surely(derived_text(text), text);
        symmetries *found = symmetries_find(d.equations);
        TEST_ASSERT_NOT_NULL_MESSAGE(found, text);
        int both = 0;
        int conserved = 0;
        int both_found = 0;
        int conserved_found = 0;
        count_by_hand(&p, &seed, &both, &conserved);
        for (int i = 0; i < found->count; i++) {
            conserved_found += found->each[i].conserved ? 1 : 0;
            both_found += poly_is_zero(found->each[i].stored) ? 1 : 0;
        }
        snprintf(why, sizeof why, "conserved %d, by hand %d; of T and V %d, by hand %d\n%s",
                 conserved_found, conserved, both_found, both, text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(conserved, conserved_found, why);
        TEST_ASSERT_EQUAL_INT_MESSAGE(both, both_found, why);
        TEST_ASSERT_TRUE_MESSAGE(found->complete && found->flat, why);
        with_rotation += conserved > 2 ? 1 : 0;
        with_none += conserved == 0 ? 1 : 0;
        derived_free(&d);
    }
    TEST_ASSERT_TRUE(with_rotation > 0 && with_none > 0);
}
