/* test_zonotope.c: the uncertainty of a point as a sum of generators (host/prove/flowpipe.h), under random maps. The
 * reference is the support function in long double: how far a set extends in a direction. A convex set contains
 * another one if it extends at least as far in every direction. The bounds on the excess have closed forms. */
#include "command.h"
#include "host/prove/flowpipe.h"

enum { SIZE = 4, MOST = 24, DIRECTIONS = 12 };

static dice die;

/* A copy of a zonotope in long double, made before a map. */
typedef struct exact_set {
    int n;
    int count;
    long double drift[SIZE];
    long double generator[MOST][SIZE];
} exact_set;

static exact_set copy_of(const zonotope *z) {
    exact_set s = {.n = z->n, .count = z->count};
    TEST_ASSERT_TRUE(z->count <= z->most && z->count <= MOST);
    for (int i = 0; i < z->n; i++) {
        s.drift[i] = (long double)z->drift[i];
        for (int k = 0; k < z->count; k++) {
            s.generator[k][i] = (long double)z->generator[k * z->n + i];
        }
    }
    return s;
}

static long double along(int n, const long double *a, const long double *b) {
    long double sum = 0.0L;
    for (int i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

static long double reach_of(const exact_set *s, const long double *direction) {
    long double sum = along(s->n, s->drift, direction);
    for (int k = 0; k < s->count; k++) {
        sum += fabsl(along(s->n, s->generator[k], direction));
    }
    return sum;
}

static long double length_of(int n, const long double *a) { return sqrtl(along(n, a, a)); }

/* A direction of length 1: a positive or negative axis, or any direction. */
static void draw_direction(int n, long double *direction) {
    const int axis = (int)dice_one_of(&die, 2U * (unsigned)n);
    for (int i = 0; i < n; i++) {
        direction[i] = axis < n ? (long double)dice_between(&die, -1.0, 1.0) : 0.0L;
    }
    direction[axis % n] += axis < n || dice_one_of(&die, 2) == 0 ? 1.0L : -1.0L;
    const long double length = length_of(n, direction);
    for (int i = 0; i < n; i++) {
        direction[i] /= length;
    }
}

static void draw_map(int n, double radius, enclosure *map) {
    for (int i = 0; i < n * n; i++) {
        const double middle = dice_between(&die, -0.7, 0.7) + (i % (n + 1) == 0 ? 0.5 : 0.0);
        map[i] = (enclosure){middle - radius, middle + radius};
    }
}

static void draw_box(int n, double radius, enclosure *box) {
    for (int i = 0; i < n; i++) {
        const double middle = dice_between(&die, -1.0, 1.0);
        const double own = dice_one_of(&die, 4) == 0 ? 0.0 : dice_between(&die, 0.0, radius);
        box[i] = (enclosure){middle - own, middle + own};
    }
}

static long double drawn_in(enclosure a) {
    const unsigned where = dice_one_of(&die, 3);
    return where == 0   ? (long double)a.low
           : where == 1 ? (long double)a.high
                        : (long double)dice_between(&die, a.low, a.high);
}

/* How far `before` extends in the direction after a random matrix within `map` is applied and the box `more` is
 * added. */
static long double mapped_reach(const exact_set *before, const enclosure *map,
                                const enclosure *more, const long double *direction) {
    const int n = before->n;
    long double back[SIZE] = {0.0L};
    long double sum = 0.0L;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            back[j] += drawn_in(map[i * n + j]) * direction[i];
        }
        sum += direction[i] * (long double)(direction[i] > 0.0L ? more[i].high : more[i].low);
    }
    return sum + reach_of(before, back);
}

static zonotope *drawn_zonotope(int n, int most, unsigned maps) {
    enclosure map[SIZE * SIZE] = {{0.0, 0.0}};
    enclosure more[SIZE] = {{0.0, 0.0}};
    zonotope *z = zonotope_new(n, most);
    for (unsigned k = 0; k < maps; k++) {
        draw_map(n, 0.0, map);
        draw_box(n, 0.3, more);
        zonotope_map(z, map, more);
    }
    return z;
}

/* The image must always contain the exact one, however often it is reduced. Without a reduction, the excess is
 * round-off. With a reduction, the excess is that of a box around the shortest generators, up to sqrt(n) times their
 * length. */
TEST(zonotope, mapped) {
    unsigned reductions = 0;
    for (unsigned c = 0; c < dice_cases(usual_or(150, 50)); c++) {
        const int n = 1 + (int)dice_one_of(&die, SIZE);
        const int most = 4 * n + (int)dice_one_of(&die, (unsigned)(MOST - 4 * SIZE) + 1);
        const double radius =
            dice_one_of(&die, 2) == 0 ? 0.0 : pow(10.0, dice_between(&die, -9, -2));
        zonotope *z = drawn_zonotope(n, most, 0);
        for (int step = 0; step < 12; step++) {
            enclosure map[SIZE * SIZE] = {{0.0, 0.0}};
            enclosure more[SIZE] = {{0.0, 0.0}};
            const exact_set before = copy_of(z);
            draw_map(n, radius, map);
            draw_box(n, pow(10.0, dice_between(&die, -6, 0)), more);
            zonotope_map(z, map, more);
            const exact_set now = copy_of(z);
            const bool reduced = before.count + 2 * n > z->most;
            TEST_ASSERT_TRUE(now.count <= (reduced ? z->most / 2 + 2 * n : before.count + n));
            TEST_ASSERT_TRUE(!reduced || now.count >= z->most / 2 + n);
            long double size = 1.0L;
            long double shorter = 0.0L; /* total length of the generators in the box */
            long double length[MOST] = {0.0L};
            for (int k = 0; k < before.count; k++) {
                long double to[SIZE] = {0.0L};
                for (int i = 0; i < n * n; i++) {
                    const long double middle =
                        ((long double)map[i].low + (long double)map[i].high) / 2;
                    to[i / n] += middle * before.generator[k][i % n];
                }
                length[k] = length_of(n, to);
                size += length[k];
            }
            if (reduced) {
                reductions++;
                for (int k = z->most / 2; k < before.count; k++) { /* of the shortest */
                    int least = 0;
                    for (int l = 1; l < before.count; l++) {
                        least = length[l] < length[least] ? l : least;
                    }
                    /* the vectors have equal 1-norms */
                    shorter += length[least] * sqrtl((long double)n);
                    length[least] = (long double)INFINITY;
                }
            }
            for (int d = 0; d < DIRECTIONS; d++) {
                long double direction[SIZE] = {0.0L};
                draw_direction(n, direction);
                const long double wanted = mapped_reach(&before, map, more, direction);
                const long double got = reach_of(&now, direction);
                TEST_ASSERT_TRUE_MESSAGE(got >= wanted - 1e-17L * size, "something is lost");
                /* each of the n by n entries is uncertain by the radius */
                const long double wide =
                    4.0L * (long double)(radius * n) * (size + 2.0L * length_of(n, before.drift));
                const long double least = n == 1 ? 0.0L : sqrtl((long double)n) * shorter;
                TEST_ASSERT_TRUE_MESSAGE(got <= wanted + least + wide * 3.0L + 1e-12L * size,
                                         "too wide");
            }
        }
        zonotope_free(z);
    }
    TEST_ASSERT_TRUE(reductions > 50);
}

TEST(zonotope, box) {
    for (unsigned c = 0; c < dice_cases(usual_or(60, 20)); c++) {
        const int n = 1 + (int)dice_one_of(&die, SIZE);
        zonotope *z = drawn_zonotope(n, MOST, 1 + dice_one_of(&die, 8));
        const exact_set s = copy_of(z);
        enclosure box[SIZE] = {{0.0, 0.0}};
        zonotope_box(z, box);
        for (int i = 0; i < n; i++) {
            long double direction[SIZE] = {0.0L};
            direction[i] = 1.0L;
            const long double high = reach_of(&s, direction);
            direction[i] = -1.0L;
            const long double low = -reach_of(&s, direction);
            const long double size = fabsl(high) + fabsl(low);
            TEST_ASSERT_TRUE((long double)box[i].low <= low + 1e-18L * size &&
                             (long double)box[i].high >= high - 1e-18L * size);
            TEST_ASSERT_TRUE((long double)box[i].low >= low - 1e-14L * size &&
                             (long double)box[i].high <= high + 1e-14L * size);
        }
        zonotope_free(z);
    }
}

/* The inverse of a nearly orthogonal matrix, by Newton's iteration from the transpose. */
static void inverse_of(int n, const double *axes, long double *inverse) {
    long double rest[SIZE * SIZE] = {0.0L};
    long double next[SIZE * SIZE] = {0.0L};
    for (int i = 0; i < n * n; i++) {
        inverse[i] = (long double)axes[i % n * n + i / n];
    }
    for (int pass = 0; pass < 3; pass++) { /* X += X (1 - A X) */
        for (int i = 0; i < n * n; i++) {
            rest[i] = i % (n + 1) == 0 ? 1.0L : 0.0L;
            for (int j = 0; j < n; j++) {
                rest[i] -= (long double)axes[i / n * n + j] * inverse[j * n + i % n];
            }
        }
        for (int i = 0; i < n * n; i++) {
            next[i] = inverse[i];
            for (int j = 0; j < n; j++) {
                next[i] += inverse[i / n * n + j] * rest[j * n + i % n];
            }
        }
        memcpy(inverse, next, (size_t)n * (size_t)n * sizeof *next);
    }
}

/* The axes must be orthogonal, the first along the longest generator, and the box along them must be the smallest. */
static void expect_frame(const zonotope *z) {
    const int n = z->n;
    const exact_set s = copy_of(z);
    double axes[SIZE * SIZE] = {0.0};
    enclosure off[SIZE] = {{0.0, 0.0}};
    long double inverse[SIZE * SIZE] = {0.0L};
    zonotope_frame(z, axes, off);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            double sum = i == j ? -1.0 : 0.0;
            for (int k = 0; k < n; k++) {
                sum += axes[k * n + i] * axes[k * n + j];
            }
            TEST_ASSERT_TRUE(fabs(sum) < 1e-13);
        }
    }
    int longest = 0;
    for (int k = 1; k < s.count; k++) {
        longest = length_of(n, s.generator[k]) > length_of(n, s.generator[longest]) ? k : longest;
    }
    const long double length = s.count > 0 ? length_of(n, s.generator[longest]) : 0.0L;
    if (length > 0.0L) {
        long double sum = 0.0L;
        for (int i = 0; i < n; i++) {
            sum += (long double)axes[i * n] * s.generator[longest][i];
        }
        TEST_ASSERT_TRUE(fabsl(sum) > length * (1.0L - 1e-13L));
    }
    long double size = length_of(n, s.drift);
    for (int k = 0; k < s.count; k++) {
        size += length_of(n, s.generator[k]);
    }
    inverse_of(n, axes, inverse);
    for (int i = 0; i < n; i++) {
        long double back[SIZE] = {0.0L};
        for (int j = 0; j < n; j++) {
            back[j] = -inverse[i * n + j];
        }
        const long double high = reach_of(&s, &inverse[i * n]);
        const long double low = -reach_of(&s, back);
        TEST_ASSERT_TRUE((long double)off[i].low <= low + 1e-17L * size &&
                         (long double)off[i].high >= high - 1e-17L * size);
        TEST_ASSERT_TRUE((long double)off[i].low >= low - 1e-12L * size &&
                         (long double)off[i].high <= high + 1e-12L * size);
    }
}

TEST(zonotope, frame) {
    for (unsigned c = 0; c < dice_cases(usual_or(80, 25)); c++) {
        const int n = 1 + (int)dice_one_of(&die, SIZE);
        zonotope *z = drawn_zonotope(n, MOST, dice_one_of(&die, 9));
        expect_frame(z);
        /* two generators along one line, and one of length 0 */
        z->count = 3;
        for (int i = 0; i < n; i++) {
            z->generator[i] = 1.0;
            z->generator[n + i] = -2.0;
            z->generator[2 * n + i] = 0.0;
            /* must not be read, because count is 3 */
            z->generator[3 * n + i] = i == 0 ? 100.0 : 0.0;
        }
        expect_frame(z);
        zonotope_free(z);
    }
}

SUITE(zonotope) { die = dice_of("zonotope", 43); }
