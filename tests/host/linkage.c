#include "linkage.h"
#include "test.h"

static uint64_t next(uint64_t *seed) { /* the random generator splitmix64 */
    uint64_t z = *seed += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
}

/* Draws a multiple of 1/8 between `least` and `most`. Decimal text gives such a number exactly. */
static double eighths(uint64_t *seed, int least, int most) {
    return (least + (int)(next(seed) % (uint64_t)(most - least + 1))) / 8.0;
}

static bool one_in(uint64_t *seed, unsigned n) { return next(seed) % n == 0; }

static linkage_body body_draw(uint64_t *seed, int number) {
    linkage_body b = {.parent = number - 1};
    /* the parent is any earlier body or the ground, so that trees occur, not only chains */
    if (one_in(seed, 4)) {
        b.parent = (int)(next(seed) % (uint64_t)(number + 1)) - 1;
    }
    b.slides = one_in(seed, 4);
    b.relative = one_in(seed, 2);
    b.at_m = eighths(seed, 2, 8);
    b.rail_rad = one_in(seed, 2) ? 0.0 : eighths(seed, -12, 12);
    b.mass_kg = eighths(seed, 1, 16);
    b.centre_m = one_in(seed, 5) ? 0.0 : eighths(seed, 1, 6);
    b.inertia_kgm2 = eighths(seed, 1, 8) / 16.0;
    b.stiffness = one_in(seed, 2) ? eighths(seed, 8, 80) : 0.0;
    b.rest = one_in(seed, 2) ? eighths(seed, -8, 8) : 0.0;
    b.damping = one_in(seed, 2) ? eighths(seed, 1, 8) / 4.0 : 0.0;
    b.drive = one_in(seed, 3) ? eighths(seed, -16, 16) : 0.0;
    b.wave = 1.0 + (double)(next(seed) % 3);
    b.drag_Nspm = one_in(seed, 3) ? eighths(seed, 1, 8) / 8.0 : 0.0;
    return b;
}

linkage linkage_draw(uint64_t *seed) {
    linkage of = {.bodies = 1 + (int)(next(seed) % LINKAGE_BODIES)};
    of.springs = (int)(next(seed) % (LINKAGE_SPRINGS + 1));
    for (int k = 0; k < of.bodies; k++) {
        of.body[k] = body_draw(seed, k);
        of.start[k] = eighths(seed, -12, 12) / (of.body[k].slides ? 4.0 : 1.0);
        of.start_rate[k] = eighths(seed, -12, 12) / (of.body[k].slides ? 4.0 : 1.0);
    }
    for (int k = 0; k < of.springs; k++) {
        of.spring[k] = (linkage_spring){.body = (int)(next(seed) % (uint64_t)of.bodies),
                                        .x_m = eighths(seed, -16, 16),
                                        /* so high that the body seldom reaches this point */
                                        .y_m = eighths(seed, 17, 40),
                                        .stiffness_Npm = eighths(seed, 8, 80),
                                        .length_m = one_in(seed, 2) ? 0.0 : eighths(seed, 2, 8)};
    }
    if (!one_in(seed, 4)) {
        of.gravity_mps2[0] = one_in(seed, 3) ? eighths(seed, -40, 40) : 0.0;
        of.gravity_mps2[1] = -9.875;
    }
    return of;
}

enum { KINETIC, POTENTIAL, DISSIPATION, FORCE, SUMS = FORCE + LINKAGE_BODIES, SUM_TEXT = 4096 };

typedef struct writer {
    const linkage *of;
    linkage_writing how;
    char *text;
    int used;
    char sum[SUMS][SUM_TEXT]; /* each sum since the last flush(), as text */
} writer;

/* Ends the program if a buffer of this file is too small. */
static void fits(bool holds) {
    if (!holds) {
        fputs("linkage.c: no room for the text\n", stderr);
        abort();
    }
}

__attribute__((format(printf, 2, 3))) static void say(writer *w, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    w->used += vsnprintf(w->text + w->used, (size_t)(LINKAGE_TEXT - w->used), format, arguments);
    va_end(arguments);
    fits(w->used < LINKAGE_TEXT);
}

/* Appends a summand, and a "+" after it, to a sum. */
__attribute__((format(printf, 3, 4))) static void add(writer *w, int sum, const char *format, ...) {
    const size_t used = strlen(w->sum[sum]);
    va_list arguments;
    va_start(arguments, format);
    const int more = vsnprintf(w->sum[sum] + used, SUM_TEXT - used, format, arguments);
    va_end(arguments);
    fits(used + (size_t)more + 5 < SUM_TEXT);
    strcat(w->sum[sum], "\n  + ");
}

/* Writes the collected sums as statements. Returns false if there were none. */
static bool flush(writer *w, const char *assign) {
    static const char *const letter[] = {"T", "V", "F"};
    bool any = false;
    for (int i = 0; i < SUMS; i++) {
        const size_t used = strlen(w->sum[i]);
        if (used == 0) {
            continue;
        }
        w->sum[i][used - 5] = '\0'; /* removes the last "+" */
        if (i < FORCE) {
            say(w, "%s %s (%s)\n", letter[i], assign, w->sum[i]);
        } else {
            say(w, "Q(q%d) %s (%s)\n", i - FORCE, assign, w->sum[i]);
        }
        w->sum[i][0] = '\0';
        any = true;
    }
    return any;
}

/* Number of the k-th item to be written, among `count` items: counted from the end if `backwards`. */
static int turn_of(const writer *w, int k, int count) {
    return w->how.backwards ? count - 1 - k : k;
}

/* Writes position (x, y) and velocity (u, v) of body k's joint, and the body's direction A and angular velocity W. */
static void say_joint(writer *w, int k) {
    const linkage_body *b = &w->of->body[k];
    const int p = b->parent;
    if (p < 0) {
        say(w, "let x%d = %.17g [m]\nlet y%d = 0 [m]\nlet u%d = 0 [m/s]\nlet v%d = 0 [m/s]\n", k,
            b->at_m, k, k, k);
    } else {
        say(w, "let x%d = X%d + %.17g [m]*cos(A%d)\nlet y%d = Y%d + %.17g [m]*sin(A%d)\n", k, p,
            b->at_m, p, k, p, b->at_m, p);
        say(w, "let u%d = U%d - %.17g [m]*W%d*sin(A%d)\nlet v%d = V%d + %.17g [m]*W%d*cos(A%d)\n",
            k, p, b->at_m, p, p, k, p, b->at_m, p, p);
    }
    if (b->slides && p < 0) {
        say(w, "let A%d = %.17g [rad]\nlet W%d = 0 [rad/s]\n", k, b->rail_rad, k);
    } else if (b->slides) {
        say(w, "let A%d = A%d + %.17g [rad]\nlet W%d = W%d\n", k, p, b->rail_rad, k, p);
    } else if (b->relative && p >= 0) {
        say(w, "let A%d = A%d + q%d\nlet W%d = W%d + q%d'\n", k, p, k, k, p, k);
    } else {
        say(w, "let A%d = q%d\nlet W%d = q%d'\n", k, k, k, k);
    }
}

/* Writes position (X, Y) and velocity (U, V) of body k's origin: the joint, displaced along the rail if there is a
 * rail. */
static void say_origin(writer *w, int k) {
    if (!w->of->body[k].slides) {
        say(w, "let X%d = x%d\nlet Y%d = y%d\nlet U%d = u%d\nlet V%d = v%d\n", k, k, k, k, k, k, k,
            k);
        return;
    }
    say(w, "let X%d = x%d + q%d*cos(A%d)\nlet Y%d = y%d + q%d*sin(A%d)\n", k, k, k, k, k, k, k, k);
    say(w, "let U%d = u%d + q%d'*cos(A%d) - q%d*W%d*sin(A%d)\n", k, k, k, k, k, k, k);
    say(w, "let V%d = v%d + q%d'*sin(A%d) + q%d*W%d*cos(A%d)\n", k, k, k, k, k, k, k);
}

/* Writes position and velocity of a point of body k, out_m from the origin: the body's centre or its end. */
static void say_point(writer *w, int k, const char *tag, double out_m) {
    say(w, "let %sx%d = X%d + %.17g [m]*cos(A%d)\nlet %sy%d = Y%d + %.17g [m]*sin(A%d)\n", tag, k,
        k, out_m, k, tag, k, k, out_m, k);
    say(w, "let %su%d = U%d - %.17g [m]*W%d*sin(A%d)\n", tag, k, k, out_m, k, k);
    say(w, "let %sv%d = V%d + %.17g [m]*W%d*cos(A%d)\n", tag, k, k, out_m, k, k);
}

static void add_inertia(writer *w) {
    const linkage *of = w->of;
    for (int i = 0; i < of->bodies; i++) {
        const int k = turn_of(w, i, of->bodies);
        const linkage_body *b = &of->body[k];
        add(w, KINETIC, "%.17g [kg]*(cu%d^2 + cv%d^2)/2", b->mass_kg, k, k);
        add(w, KINETIC, "%.17g [kg*m^2]*W%d^2/2", b->inertia_kgm2, k);
        for (int axis = 0; axis < 2; axis++) {
            if (of->gravity_mps2[axis] != 0.0) {
                add(w, POTENTIAL, "%.17g [kg]*%.17g [m/s^2]*c%c%d", b->mass_kg,
                    -of->gravity_mps2[axis], "xy"[axis], k);
            }
        }
    }
}

static void add_springs(writer *w) {
    const linkage *of = w->of;
    for (int i = 0; i < of->bodies; i++) {
        const int k = turn_of(w, i, of->bodies);
        const linkage_body *b = &of->body[k];
        if (b->stiffness != 0.0) {
            add(w, POTENTIAL, "%.17g [%s]*(q%d - %.17g [%s])^2/2", b->stiffness,
                b->slides ? "N/m" : "N*m/rad^2", k, b->rest, b->slides ? "m" : "rad");
        }
    }
    for (int i = 0; i < of->springs; i++) {
        const linkage_spring *s = &of->spring[turn_of(w, i, of->springs)];
        char apart[200];
        snprintf(apart, sizeof apart, "(ex%d - %.17g [m])^2 + (ey%d - %.17g [m])^2", s->body,
                 s->x_m, s->body, s->y_m);
        if (s->length_m == 0.0) {
            add(w, POTENTIAL, "%.17g [N/m]*(%s)/2", s->stiffness_Npm, apart);
        } else {
            add(w, POTENTIAL, "%.17g [N/m]*(sqrt(%s) - %.17g [m])^2/2", s->stiffness_Npm, apart,
                s->length_m);
        }
    }
}

static void add_losses(writer *w) {
    for (int i = 0; i < w->of->bodies; i++) {
        const int k = turn_of(w, i, w->of->bodies);
        const linkage_body *b = &w->of->body[k];
        if (b->damping != 0.0) {
            add(w, DISSIPATION, "%.17g [%s]*q%d'^2/2", b->damping,
                b->slides ? "N*s/m" : "N*m*s/rad^2", k);
        }
        if (b->drag_Nspm != 0.0) {
            add(w, DISSIPATION, "%.17g [N*s/m]*(eu%d^2 + ev%d^2)/2", b->drag_Nspm, k, k);
        }
    }
}

static void add_drives(writer *w) {
    for (int i = 0; i < w->of->bodies; i++) {
        const int k = turn_of(w, i, w->of->bodies);
        const linkage_body *b = &w->of->body[k];
        if (b->drive != 0.0) {
            add(w, FORCE + k, "%.17g [%s]*cos(%.17g%s*q%d)", b->drive, b->slides ? "N" : "N*m",
                b->wave, b->slides ? " [1/m]" : "", k);
        }
    }
}

void linkage_write(const linkage *of, const char *name, linkage_writing how,
                   char text[static LINKAGE_TEXT]) {
    enum { PARTS = 3 };
    static void (*const add_part[PARTS])(writer *) = {add_springs, add_losses, add_drives};
    static const char *const names[PARTS] = {"springs", "losses", "drives"};
    static writer w; /* too large for the stack */
    bool has[PARTS] = {false};
    w = (writer){.of = of, .how = how, .text = text};
    say(&w, "mechanism %s \"a planar linkage\"\n", name);
    for (int i = 0; i < of->bodies; i++) {
        const int k = turn_of(&w, i, of->bodies);
        say(&w, "coordinate q%d [%s]\n", k, of->body[k].slides ? "m" : "rad");
    }
    /* not backwards: a name must be defined before its use */
    for (int k = 0; k < of->bodies; k++) {
        say_joint(&w, k);
        say_origin(&w, k);
        say_point(&w, k, "c", of->body[k].centre_m);
        say_point(&w, k, "e", 2.0 * of->body[k].centre_m);
    }
    add_inertia(&w);
    for (int i = 0; i < PARTS && how.forces == LINKAGE_INSIDE; i++) {
        add_part[turn_of(&w, i, PARTS)](&w);
    }
    flush(&w, "=");
    for (int i = 0; i < PARTS && how.forces >= LINKAGE_EFFECTS_OFF; i++) {
        const int part = turn_of(&w, i, PARTS);
        const int before = w.used;
        say(&w, "effect %s \"one kind of forces\" {\n", names[part]);
        add_part[part](&w);
        has[part] = flush(&w, "+=");
        if (has[part]) {
            say(&w, "}\n");
        } else { /* an effect without statements is removed */
            w.used = before;
            text[before] = '\0';
        }
    }
    say(&w, "%s", how.more == NULL ? "" : how.more);
    say(&w, "scene %s_moves {\n", name);
    for (int part = 0; part < PARTS && how.forces == LINKAGE_EFFECTS_ON; part++) {
        if (has[part]) {
            say(&w, "with %s\n", names[part]);
        }
    }
    for (int i = 0; i < of->bodies; i++) {
        const int k = turn_of(&w, i, of->bodies);
        const char *unit = of->body[k].slides ? "m" : "rad";
        say(&w, "start q%d = %.17g [%s], q%d' = %.17g [%s/s]\n", k, of->start[k], unit, k,
            of->start_rate[k], unit);
    }
    const double until_s = how.until_s > 0.0 ? how.until_s : 0.5;
    say(&w, "step %.17g [s]\nuntil %.17g [s]\n}\n", until_s / 500.0, until_s);
}
