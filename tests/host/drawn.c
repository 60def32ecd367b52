#include "drawn.h"

#include "derived.h"

/* Solves a x = b by elimination with pivots. Column n of `a` is b. Returns false if the matrix is singular. */
static bool solve(int n, double a[DRAWN_CONTACTS][DRAWN_CONTACTS + 1], double *x) {
    for (int p = 0; p < n; p++) {
        int pivot = p;
        for (int r = p; r < n; r++) {
            pivot = fabs(a[r][p]) > fabs(a[pivot][p]) ? r : pivot;
        }
        if (fabs(a[pivot][p]) < 1e-9) {
            return false;
        }
        for (int c = 0; c <= n; c++) {
            const double kept = a[p][c];
            a[p][c] = a[pivot][c];
            a[pivot][c] = kept;
        }
        for (int r = 0; r < n; r++) {
            const double factor = r == p ? 0.0 : a[r][p] / a[p][p];
            for (int c = p; c <= n; c++) {
                a[r][c] -= factor * a[p][c];
            }
        }
    }
    for (int p = 0; p < n; p++) {
        x[p] = a[p][n] / a[p][p];
    }
    return true;
}

void drawn_inverse(const drawn *b, const double *y, double *x) {
    double a[DRAWN_CONTACTS][DRAWN_CONTACTS + 1] = {{0.0}};
    for (int i = 0; i < b->n; i++) {
        for (int j = 0; j < b->n; j++) {
            a[i][j] = b->mass[i][j];
        }
        a[i][b->n] = y[i];
    }
    TEST_ASSERT_TRUE(solve(b->n, a, x));
}

double drawn_along(const drawn *b, int k, const double *x) {
    double sum = 0.0;
    for (int i = 0; i < b->n; i++) {
        sum += b->contact[k].row[i] * x[i];
    }
    return sum;
}

/* Computes x = from + M^-1 J^T lambda. */
static void pushed(const drawn *b, const double *lambda, const double *from, double *x) {
    double force[DRAWN_MOST] = {0.0};
    for (int k = 0; k < b->contacts; k++) {
        for (int i = 0; i < b->n; i++) {
            force[i] += b->contact[k].row[i] * lambda[k];
        }
    }
    drawn_inverse(b, force, x);
    for (int i = 0; i < b->n; i++) {
        x[i] += from[i];
    }
}

/* Do the contact laws hold if which[k] is the case of contact k? In case 0 the contact reaches its target. In case 1
 * or -1 its force is the limit with this sign; a stop's limit is zero. */
static bool meets(const drawn *b, const int *which, const double *from, double *lambda, double *x) {
    double a[DRAWN_CONTACTS][DRAWN_CONTACTS + 1] = {{0.0}};
    double tight[DRAWN_CONTACTS];
    int member[DRAWN_CONTACTS];
    int count = 0;
    for (int k = 0; k < b->contacts; k++) {
        lambda[k] = which[k] * b->contact[k].limit;
    }
    pushed(b, lambda, from, x);
    for (int k = 0; k < b->contacts; k++) {
        if (which[k] == 0) {
            member[count++] = k;
        }
    }
    for (int c = 0; c < count; c++) {
        const double zero[DRAWN_MOST] = {0.0};
        double unit[DRAWN_CONTACTS] = {0.0};
        double way[DRAWN_MOST];
        unit[member[c]] = 1.0;
        pushed(b, unit, zero, way);
        for (int r = 0; r < count; r++) {
            a[r][c] = drawn_along(b, member[r], way);
        }
        a[c][count] = b->contact[member[c]].target - drawn_along(b, member[c], x);
    }
    if (!solve(count, a, tight)) {
        return false;
    }
    for (int c = 0; c < count; c++) {
        lambda[member[c]] = tight[c];
    }
    pushed(b, lambda, from, x);
    for (int k = 0; k < b->contacts; k++) {
        const drawn_contact *of = &b->contact[k];
        const double off = drawn_along(b, k, x) - of->target;
        const bool good = of->kind == 'h'   ? true
                          : of->kind == 's' ? lambda[k] >= -1e-9 && off >= -1e-9
                          : which[k] == 0   ? fabs(lambda[k]) <= of->limit + 1e-9
                                            : which[k] * off <= 1e-9;
        if (!good) {
            return false;
        }
    }
    return true;
}

/* The next case of a contact: 0 and 1 for a stop; 0, 1 and -1 for a friction; only 0 for a hold. */
static int next_case(char kind, int which) {
    if (kind == 'h') {
        return 0;
    }
    if (kind == 's') {
        return 1 - which;
    }
    return which == 1 ? -1 : which + 1;
}

bool drawn_solved(const drawn *b, const double *from, double *lambda, double *x) {
    int which[DRAWN_CONTACTS] = {0};
    for (;;) {
        if (meets(b, which, from, lambda, x)) {
            return true;
        }
        int k = 0;
        for (; k < b->contacts; k++) {
            which[k] = next_case(b->contact[k].kind, which[k]);
            if (which[k] != 0) {
                break;
            }
        }
        if (k == b->contacts) {
            return false;
        }
    }
}

bool drawn_independent(const drawn *b) {
    double a[DRAWN_CONTACTS][DRAWN_CONTACTS + 1] = {{0.0}};
    double x[DRAWN_CONTACTS];
    for (int c = 0; c < b->contacts; c++) {
        const double zero[DRAWN_MOST] = {0.0};
        double unit[DRAWN_CONTACTS] = {0.0};
        double way[DRAWN_MOST];
        unit[c] = 1.0;
        pushed(b, unit, zero, way);
        for (int r = 0; r < b->contacts; r++) {
            a[r][c] = drawn_along(b, r, way);
        }
    }
    return solve(b->contacts, a, x);
}

static void write_row(const drawn *b, const double *row, char *text, size_t size) {
    size_t end = 0;
    text[0] = '\0';
    for (int i = 0; i < b->n; i++) {
        if (row[i] != 0.0) {
            end += (size_t)snprintf(text + end, size - end, "%s%g*x%d", end > 0 ? " + " : "",
                                    row[i], i);
        }
    }
}

void drawn_open(motion *m, const drawn *b, const engine_kind *kind) {
    char text[4000];
    size_t at = 0;
#define PUT(...) at += (size_t)snprintf(text + at, sizeof text - at, __VA_ARGS__)
    PUT("mechanism drawn\n");
    for (int i = 0; i < b->n; i++) {
        PUT("coordinate x%d [m]\n", i);
    }
    PUT("T = 0 [J]");
    for (int i = 0; i < b->n; i++) {
        for (int j = 0; j < b->n; j++) {
            PUT(" + %g [kg]*x%d'*x%d'/2", b->mass[i][j], i, j);
        }
    }
    PUT("\nV = 0 [J]");
    for (int i = 0; i < b->n; i++) {
        PUT(" - %g [N]*x%d", b->load[i], i);
    }
    PUT("\n");
    for (int k = 0; k < b->contacts; k++) {
        const drawn_contact *of = &b->contact[k];
        char row[200];
        char since[200];
        write_row(b, of->row, row, sizeof row);
        write_row(b, of->since, since, sizeof since);
        if (of->kind == 's') {
            PUT("stop %s >= %.17g [m] restitution %g\n", row, of->offset, of->restitution);
        } else if (of->kind == 'h') {
            PUT("hold %s while %s > %.17g [m]\n", row, since[0] != '\0' ? since : "x0",
                since[0] != '\0' ? of->since_m : -1000.0);
        } else {
            int i = 0;
            while (of->row[i] == 0.0) {
                i++;
            }
            PUT("friction x%d static 0.5 kinetic 0.5 normal %g [N]\n", i, 2.0 * of->limit);
        }
    }
    PUT("scene s {\n  with ledger\n  step %.17g [s]\n  until 1 [s]\n", DRAWN_STEP_S);
    for (int i = 0; i < b->n; i++) {
        PUT("  start x%d' = %g [m/s]\n", i, b->rate[i]);
    }
    PUT("}\n");
#undef PUT
    motion_open_text(m, text, (stepping){.kind = kind, .method = WH_RK4});
}

double drawn_whole(uint64_t *seed, int least, int most) {
    return least + (int)(random_bits(seed) % (uint64_t)(most - least + 1));
}

/* Draws the mass matrix 1 + A^T A with an integer A: a positive definite integer matrix. */
static void draw_mass(drawn *b, uint64_t *seed) {
    double a[DRAWN_MOST][DRAWN_MOST];
    for (int i = 0; i < b->n; i++) {
        for (int j = 0; j < b->n; j++) {
            a[i][j] = drawn_whole(seed, -1, 1);
        }
    }
    for (int i = 0; i < b->n; i++) {
        for (int j = 0; j < b->n; j++) {
            b->mass[i][j] = i == j;
            for (int l = 0; l < b->n; l++) {
                b->mass[i][j] += a[l][i] * a[l][j];
            }
        }
    }
}

void drawn_row(const drawn *b, uint64_t *seed, double *row) {
    const bool one = random_bits(seed) % 3U == 0;
    for (int i = 0; i < b->n; i++) {
        row[i] = one ? 0.0 : drawn_whole(seed, -2, 2);
    }
    const int must = (int)(random_bits(seed) % (uint64_t)b->n);
    row[must] = row[must] == 0.0 ? (random_bits(seed) % 2U != 0 ? 1.0 : -1.0) : row[must];
}

void drawn_row_at_rest(const drawn *b, uint64_t *seed, double *row) {
    const int i = (int)(random_bits(seed) % (uint64_t)b->n);
    const int j = (i + 1 + (int)(random_bits(seed) % (uint64_t)(b->n - 1))) % b->n;
    for (int l = 0; l < b->n; l++) {
        row[l] = 0.0;
    }
    row[i] = b->rate[j];
    row[j] = -b->rate[i];
    if (row[i] == 0.0 && row[j] == 0.0) {
        row[i] = 1.0;
    }
}

drawn_contact *drawn_add(drawn *b, char kind) {
    drawn_contact *of = &b->contact[b->contacts++];
    *of = (drawn_contact){.kind = kind};
    return of;
}

drawn drawn_body(uint64_t *seed) {
    drawn b = {.n = 2 + (int)(random_bits(seed) % (DRAWN_MOST - 1U))};
    draw_mass(&b, seed);
    return b;
}
