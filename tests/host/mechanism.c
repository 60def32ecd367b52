#include "mechanism.h"
#include "test.h"

enum { COORDINATES_MAX = 4, PHRASE = 64, PHRASES = 3 * COORDINATES_MAX + 4 };

typedef struct writer {
    uint64_t seed;
    char *text;
    size_t at;
    int coordinates;
    bool is_angle[COORDINATES_MAX];
    bool functions; /* use all fourteen functions, not only those of the smallest board */
    int shapes;     /* number of shapes w0, w1, ...: dimensionless functions of coordinates */
    bool shaped;    /* may expressions use the shapes now? */
} writer;

static unsigned draw(writer *w, unsigned bound) { /* the random generator splitmix64 */
    uint64_t x = w->seed += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (unsigned)((x ^ (x >> 31)) % bound);
}

static void put(writer *w, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void put(writer *w, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(w->text + w->at, MECHANISM_SIZE - w->at, format, arguments);
    va_end(arguments);
    w->at += (size_t)length;
    if (length < 0 || w->at >= MECHANISM_SIZE) {
        fputs("mechanism.c: error: MECHANISM_SIZE is too small\n", stderr);
        exit(2);
    }
}

/* Writes a number between 0.1 and about 10 with two to twenty digits. */
static void number(writer *w) {
    const unsigned whole = draw(w, 10);
    const unsigned places = draw(w, 6);
    put(w, "%u.", whole);
    if (whole == 0) {
        put(w, "%u", 1 + draw(w, 9));
    }
    for (unsigned i = 0; i < (places < 5 ? places + 1 : 19); i++) {
        put(w, "%u", draw(w, 10));
    }
    if (draw(w, 8) == 0) {
        put(w, "e%s", draw(w, 2) == 0 ? "0" : "-0");
    }
}

/* --- expressions without dimension ----------------------------------------------------------------*/

static void leaf(writer *w) {
    const unsigned which = draw(w, w->shaped && w->shapes > 0 ? 8 : 6);
    const unsigned i = draw(w, (unsigned)w->coordinates);
    if (which >= 6) {
        put(w, "w%u", draw(w, (unsigned)w->shapes));
    } else if (which == 5) {
        put(w, "a");
    } else if (which == 4) {
        number(w);
    } else if (w->is_angle[i]) {
        switch (draw(w, 6)) {
        case 0: put(w, "2*q%u/(1 [rad])", i); break;
        case 1: put(w, "q%u/2/(1 [rad])", i); break;
        case 2: put(w, "3*q%u/(1 [rad])", i); break;
        default: put(w, "q%u/(1 [rad])", i); break;
        }
    } else {
        put(w, "(q%u/l%u)", i, i);
    }
}

static void expression(writer *w, int depth);

static void call(writer *w, const char *before, int depth, const char *after) {
    put(w, "%s", before);
    expression(w, depth);
    put(w, "%s", after);
}

/* Writes a function that is defined for all arguments and whose slope is bounded, or nearly so. */
static void function(writer *w, int depth) {
    static const char *const exponents[] = {"2", "3", "4", "-1", "-2", "0.5", "1.5", "-0.5"};
    switch (draw(w, w->functions ? 21 : 8)) {
    case 0: call(w, "sin(", depth, ")"); break;
    case 1: call(w, "cos(", depth, ")"); break;
    case 2: call(w, "sqrt(2.5 + sin(", depth, "))"); break;
    case 3: call(w, "abs(", depth, ")"); break;
    case 4: call(w, "sign(", depth, ")"); break;
    case 5:
        call(w, "min(", depth, ", ");
        call(w, "", depth, ")");
        break;
    case 6:
        call(w, "max(", depth, ", ");
        call(w, "", depth, ")");
        break;
    case 7:
        call(w, "(2.5 + cos(", depth, "))^");
        put(w, "(%s)", exponents[draw(w, 8)]);
        break;
    case 8: call(w, "tan(0.5*sin(", depth, "))"); break;
    case 9: call(w, "asin(0.9*sin(", depth, "))"); break;
    case 10: call(w, "acos(0.9*cos(", depth, "))"); break;
    case 11: call(w, "atan(", depth, ")"); break;
    case 12:
        call(w, "atan2(", depth, ", 2.5 + ");
        call(w, "cos(", depth, "))");
        break;
    case 13: call(w, "exp(cos(", depth, "))"); break;
    case 14: call(w, "log(1.5 + abs(", depth, "))"); break;
    case 15:
        call(w, "(2 + sin(", depth, "))^");
        number(w);
        break;
    case 16:
        call(w, "(1.5 + cos(", depth, "))^(");
        call(w, "sin(", depth, "))");
        break;
    case 17: call(w, "sinh(cos(", depth, "))"); break;
    case 18: call(w, "cosh(2*sin(", depth, "))"); break;
    case 19: call(w, "tanh(", depth, ")"); break;
    default: call(w, "(1.5 + sin(", depth, "))^a"); break;
    }
}

static void expression(writer *w, int depth) {
    if (depth <= 0) {
        leaf(w);
        return;
    }
    switch (draw(w, 9)) {
    case 0:
    case 1:
        call(w, "(", depth - 1, " + ");
        call(w, "", depth - 1, ")");
        break;
    case 2:
        call(w, "(", depth - 1, " - ");
        call(w, "", depth - 1, ")");
        break;
    case 3:
        call(w, "", depth - 1, "*");
        expression(w, depth - 1);
        break;
    case 4:
        call(w, "", depth - 1, "/(3 + cos(");
        call(w, "", depth - 1, "))");
        break;
    case 5: call(w, "(", depth - 1, draw(w, 2) == 0 ? ")^2" : ")^3"); break;
    default: function(w, depth - 1); break;
    }
}

/* --- declarations ----------------------------------------------------------------------------------*/

static void parameter(writer *w, const char *name, unsigned i, const char *const units[],
                      unsigned count) {
    put(w, "parameter %s%u = ", name, i);
    number(w);
    put(w, " [%s]\n", units[draw(w, count)]);
}

static void declare(writer *w) {
    static const char *const angles[] = {"rad", "rad", "rad", "deg", "rev"};
    static const char *const lengths[] = {"m", "m", "mm", "in"};
    static const char *const masses[] = {"kg", "lb", "oz"};
    static const char *const arms[] = {"m", "ft", "in"};
    static const char *const springs[] = {"N/m", "lbf/in", "kN/m"};
    static const char *const torsions[] = {"N*m", "lbf*in", "N*mm"};
    for (int i = 0; i < w->coordinates; i++) {
        w->is_angle[i] = draw(w, 5) < 3;
        put(w, "coordinate q%d [%s]\n", i,
            w->is_angle[i] ? angles[draw(w, 5)] : lengths[draw(w, 4)]);
    }
    put(w, "parameter g = 9.81 [m/s^2]\nparameter a = ");
    number(w);
    put(w, "\n");
    for (unsigned i = 0; i < (unsigned)w->coordinates; i++) {
        parameter(w, "m", i, masses, 3);
        parameter(w, "l", i, arms, 3);
        if (w->is_angle[i]) {
            parameter(w, "k", i, torsions, 3);
        } else {
            parameter(w, "k", i, springs, 3);
        }
        switch (draw(w, 3)) {
        case 0: put(w, "parameter J%u = m%u*l%u^2/3\n", i, i, i); break;
        case 1: put(w, "parameter J%u = m%u*l%u^2*sqrt(2)/12\n", i, i, i); break;
        default: put(w, "parameter J%u = 2*m%u*(l%u*sin(pi/5))^2\n", i, i, i); break;
        }
    }
    put(w, "input drive = ");
    number(w);
    put(w, " [N]\n");
    for (int i = (int)draw(w, 3); i > 0; i--) {
        put(w, "let w%d = ", w->shapes);
        w->shaped = true;
        expression(w, 1);
        put(w, "\n");
        w->shapes++;
    }
}

/* --- energies ------------------------------------------------------------------------------------*/

/* Positions x and y of a body, and their rates, as sums. Each body is attached to the previous body or to the
 * ground. */
typedef struct place {
    char x[PHRASES * PHRASE];
    char y[PHRASES * PHRASE];
    char x_rate[PHRASES * PHRASE];
    char y_rate[PHRASES * PHRASE];
} place;

static void join(char *sum, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void join(char *sum, const char *format, ...) {
    size_t at = 0;
    while (sum[at] != '\0') {
        at++;
    }
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sum + at, (size_t)PHRASES * PHRASE - at, format, arguments);
    va_end(arguments);
}

static void carry(writer *w, int i, place *p) {
    if (!w->is_angle[i]) {
        if (draw(w, 2) == 0) {
            join(p->x, " + q%d", i);
            join(p->x_rate, " + q%d'", i);
        } else { /* the body moves on an incline */
            const unsigned deg = 5 + 5 * draw(w, 14);
            join(p->x, " + q%d*cos(%u [deg])", i, deg);
            join(p->y, " + q%d*sin(%u [deg])", i, deg);
            join(p->x_rate, " + q%d'*cos(%u [deg])", i, deg);
            join(p->y_rate, " + q%d'*sin(%u [deg])", i, deg);
        }
        return;
    }
    char turn[PHRASE];
    char rate[PHRASE];
    int other = (int)draw(w, (unsigned)w->coordinates);
    while (other > 0 && !w->is_angle[other]) {
        other--;
    }
    const unsigned which = draw(w, 6);
    if (which == 0 && w->is_angle[other] && other != i) {
        snprintf(turn, sizeof turn, "q%d + q%d", other, i);
        snprintf(rate, sizeof rate, "(q%d' + q%d')", other, i);
    } else if (which == 1 && w->is_angle[other] && other != i) {
        snprintf(turn, sizeof turn, "2*q%d - q%d", i, other);
        snprintf(rate, sizeof rate, "(2*q%d' - q%d')", i, other);
    } else {
        snprintf(turn, sizeof turn, "q%d", i);
        snprintf(rate, sizeof rate, "q%d'", i);
    }
    join(p->x, " + l%d*sin(%s)", i, turn);
    join(p->y, " - l%d*cos(%s)", i, turn);
    join(p->x_rate, " + l%d*%s*cos(%s)", i, rate, turn);
    join(p->y_rate, " + l%d*%s*sin(%s)", i, rate, turn);
}

static void energies(writer *w) {
    static place places[COORDINATES_MAX];
    for (int i = 0; i < w->coordinates; i++) {
        places[i] = (place){"0", "0", "0", "0"};
        if (i > 0 && draw(w, 4) > 0) {
            places[i] = places[i - 1];
        }
        carry(w, i, &places[i]);
        put(w, "let x%d = %s\nlet y%d = %s\n", i, places[i].x, i, places[i].y);
        put(w, "let u%d = %s\nlet v%d = %s\n", i, places[i].x_rate, i, places[i].y_rate);
    }
    put(w, "T = ");
    for (int i = 0; i < w->coordinates; i++) {
        put(w, "%sm%d*(u%d^2 + v%d^2)/2", i > 0 ? " + " : "", i, i, i);
        if (w->is_angle[i] || draw(w, 3) == 0) {
            put(w, w->is_angle[i] ? " + J%d*q%d'^2/2" : " + 0.5*m%d*q%d'^2", i, i);
            if (draw(w, 6) == 0) {
                put(w, "*(2.5 + sin(");
                w->shaped = false;
                expression(w, 1);
                put(w, "))");
            }
        }
    }
    put(w, "\nV = ");
    for (int i = 0; i < w->coordinates; i++) {
        put(w, "%sm%d*g*y%d", i > 0 ? " + " : "", i, i);
        switch (draw(w, 4)) {
        case 0: put(w, " + k%d*q%d^2/2", i, i); break;
        case 1:
            put(w, w->is_angle[i] ? " + k%d*(q%d - 0.3)^2/2" : " + k%d*(q%d - l0)^2/2", i, i);
            break;
        case 2:
            put(w, " + k%d*q%d^2/2*(1 + 1e-3*cos(q%d/%s))", i, i, i, w->is_angle[i] ? "2" : "l0");
            break;
        default: break;
        }
    }
    for (unsigned more = draw(w, 3); more > 0; more--) {
        put(w, " + ");
        number(w);
        put(w, " [J]*");
        w->shaped = true;
        function(w, 1 + (int)draw(w, 2));
    }
    put(w, "\n");
}

/* --- losses, forces, outputs, effects, contacts ------------------------------------------------------*/

static const char *unit_of(const writer *w, unsigned i) { return w->is_angle[i] ? "1" : "m"; }

static void loss(writer *w, unsigned i) {
    number(w);
    if (draw(w, 3) == 0) {
        put(w, " [W]*abs(q%u'/(1 [%s/s]))^3/3", i, unit_of(w, i));
    } else {
        put(w, " [W]*(q%u'/(1 [%s/s]))^2/2", i, unit_of(w, i));
    }
}

static void force(writer *w, unsigned i) {
    put(w, w->is_angle[i] ? "drive*l%u*" : "drive/1e%u*", w->is_angle[i] ? i : draw(w, 3));
    put(w, "(1 + ");
    w->shaped = true;
    expression(w, 1);
    put(w, " - 0.1*q%u'/(1 [%s/s]))", i, unit_of(w, i));
}

static void contact(writer *w, unsigned i) {
    static const char *const restitutions[] = {"0", "0.5", "1", "a/(1 + a)"};
    const unsigned which = draw(w, 4);
    if (which == 0) {
        put(w, "stop q%u %s %s%u%s restitution %s\n", i, draw(w, 2) == 0 ? ">= -" : "<= ", "",
            1 + draw(w, 3), w->is_angle[i] ? "" : " [m]", restitutions[draw(w, 4)]);
    } else if (which == 1) {
        put(w, "friction q%u static 0.4 kinetic 0.3 normal m%u*g*%s*(2 + sin(", i, i,
            w->is_angle[i] ? "l0" : "1");
        w->shaped = false;
        expression(w, 1);
        put(w, "))/10\n");
    } else if (which == 2) {
        put(w, "hold q%u while q%u > 0.05 [%s] and q%u' < 10 [%s/s]\n", i, i, unit_of(w, i), i,
            unit_of(w, i));
    } else {
        put(w, "when q%u crosses %u/20*(1 [%s]) %s { set q%u' = q%u'*", i, draw(w, 9),
            unit_of(w, i), draw(w, 2) == 0 ? "rising" : "falling", i, i);
        number(w);
        put(w, "/10 }\n");
    }
}

static void effects(writer *w) {
    for (unsigned k = 0; k < 2; k++) {
        const unsigned i = draw(w, (unsigned)w->coordinates);
        put(w, "effect e%u \"generated\" {\nparameter b%u = ", k, k);
        number(w);
        put(w, " [J]\n");
        switch (draw(w, 4)) {
        case 0:
            put(w, "F += ");
            loss(w, i);
            put(w, "\n");
            break;
        case 1:
            put(w, "Q(q%u) += ", i);
            force(w, i);
            put(w, "\n");
            break;
        case 2:
            put(w, "V += b%u*", k);
            w->shaped = true;
            function(w, 1);
            put(w, "\n");
            break;
        default: contact(w, i); break;
        }
        put(w, "}\n");
    }
}

static void scene_of(writer *w, unsigned name, bool contacts) {
    put(w, "scene s%u {\n", name);
    switch (draw(w, 4)) {
    case 0: put(w, "with e0\n"); break;
    case 1: put(w, "with e0, e1\n"); break;
    case 2: put(w, "with e1, ledger\n"); break;
    default: break;
    }
    if (draw(w, 3) == 0) {
        put(w, "set a = ");
        number(w);
        put(w, "\nset drive = 3 [lbf]\n");
    }
    for (int i = 0; i < w->coordinates; i++) {
        put(w, "start q%d = %s0.%u [%s], q%d' = %s", i, contacts && draw(w, 2) == 0 ? "-" : "",
            draw(w, 1000), w->is_angle[i] ? "rad" : "m", i, draw(w, 2) == 0 ? "-" : "");
        number(w);
        put(w, " [%s/s]\n", w->is_angle[i] ? "rad" : "m");
    }
    put(w, "step %s\nuntil 0.1 [s]\n}\n", draw(w, 2) == 0 ? "1 [ms]" : "1 [s]/1024");
}

/* --- systems -----------------------------------------------------------------------------------------*/

static void system_of(writer *w, unsigned name) {
    bool second[COORDINATES_MAX] = {false};
    for (int i = 0; i < w->coordinates; i++) {
        w->is_angle[i] = true;
        second[i] = draw(w, 2) == 0;
        put(w, "state q%d%s\n", i, draw(w, 2) == 0 ? " [rad]" : "");
    }
    put(w, "parameter a = ");
    number(w);
    put(w, "\ninput drive = 0.7\n");
    for (int i = 0; i < w->coordinates; i++) {
        put(w, "equation q%d%s*1 [%s]*(2.5 + sin(", i, second[i] ? "''" : "'",
            second[i] ? "s^2" : "s");
        expression(w, 1);
        put(w, "))");
        if (i > 0) {
            put(w, " + 0.1*q%d%s*1 [%s]", i - 1, second[i - 1] ? "''" : "'",
                second[i - 1] ? "s^2" : "s");
        }
        put(w, " = drive*(");
        expression(w, 2);
        put(w, ") - q%d\n", i);
    }
    put(w, "output o = ");
    expression(w, 2);
    put(w, "\nscene s%u {\nstart q0 = 0.%u\nuntil 0.1 [s]\n}\n", name, draw(w, 1000));
}

void mechanism_write(unsigned name, uint64_t seed, char text[static MECHANISM_SIZE]) {
    writer w = {.seed = seed, .text = text};
    put(&w, "mechanism m%u \"Generated from seed %" PRIu64 "\"\n", name, seed);
    static const int coordinates[] = {1, 1, 2, 2, 2, 3, 3, COORDINATES_MAX};
    w.coordinates = coordinates[draw(&w, 8)];
    w.functions = draw(&w, 2) == 0;
    if (draw(&w, 8) == 0) {
        system_of(&w, name);
        return;
    }
    declare(&w);
    energies(&w);
    if (draw(&w, 2) == 0) {
        put(&w, "F = ");
        loss(&w, draw(&w, (unsigned)w.coordinates));
        put(&w, "\n");
    }
    if (draw(&w, 2) == 0) {
        const unsigned i = draw(&w, (unsigned)w.coordinates);
        put(&w, "Q(q%u) = ", i);
        force(&w, i);
        put(&w, "\n");
    }
    put(&w, "output height [m] = y0\noutput shape = ");
    w.shaped = true;
    expression(&w, 2);
    put(&w, "\n");
    const bool contacts = draw(&w, 4) == 0;
    if (contacts) {
        contact(&w, draw(&w, (unsigned)w.coordinates));
    }
    effects(&w);
    scene_of(&w, name, contacts);
}
