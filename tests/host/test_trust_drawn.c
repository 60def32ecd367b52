/* test_trust_drawn.c: the time until which chaotic runs are accurate, for random mechanisms: pendulums of two and three
 * links, on carriages and springs, turning arms, and planetary gears with a disc on a hinge. Masses, lengths, springs,
 * starts, number type and method vary. WHIRL_CASES=30 tests thirty mechanisms and prints them. */
#include "command.h"
#include "horizons.h"
#include "motion.h"

enum { TEXT = 3000, KINDS = 6 };

static double of(dice *d, double low, double high) {
    return number_nearest(dice_between(d, low, high) * 1000.0) / 1000.0;
}

static int double_pendulum(dice *d, char *to) {
    return snprintf(to, TEXT,
                    "mechanism drawn \"double pendulum\"\ncoordinate a [rad]\ncoordinate b [rad]\n"
                    "parameter p = %g [kg]\nparameter q = %g [kg]\nparameter l = %g [m]\n"
                    "parameter k = %g [m]\nparameter g = 9.81 [m/s^2]\n"
                    "let vx = l*a'*cos(a) + k*b'*cos(b)\nlet vy = l*a'*sin(a) + k*b'*sin(b)\n"
                    "T = p*(l*a')^2/2 + q*(vx^2 + vy^2)/2\n"
                    "V = -p*g*l*cos(a) - q*g*(l*cos(a) + k*cos(b)) + %g [J]*cos(a - b)\n"
                    "scene s {\n  start a = %g, b = %g, a' = %g [rad/s]\n",
                    of(d, 0.3, 3), of(d, 0.3, 3), of(d, 0.2, 1.5), of(d, 0.2, 1.5), of(d, 0, 2),
                    of(d, 2, 3), of(d, -3, 3), of(d, -2, 2));
}

static int triple_pendulum(dice *d, char *to) {
    return snprintf(
        to, TEXT,
        "mechanism drawn \"triple pendulum\"\ncoordinate a [rad]\ncoordinate b [rad]\ncoordinate c [rad]\n"
        "parameter p = %g [kg]\nparameter q = %g [kg]\nparameter r = %g [kg]\nparameter l = %g [m]\n"
        "parameter k = %g [m]\nparameter n = %g [m]\nparameter g = 9.81 [m/s^2]\n"
        "let x2 = l*a'*cos(a) + k*b'*cos(b)\nlet y2 = l*a'*sin(a) + k*b'*sin(b)\n"
        "let x3 = x2 + n*c'*cos(c)\nlet y3 = y2 + n*c'*sin(c)\n"
        "T = p*(l*a')^2/2 + q*(x2^2 + y2^2)/2 + r*(x3^2 + y3^2)/2\n"
        "V = -g*((p + q + r)*l*cos(a) + (q + r)*k*cos(b) + r*n*cos(c))\n"
        "scene s {\n  start a = %g, b = %g, c = %g\n",
        of(d, 0.3, 2), of(d, 0.3, 2), of(d, 0.3, 2), of(d, 0.3, 1), of(d, 0.3, 1), of(d, 0.3, 1),
        of(d, 1.5, 3), of(d, -3, 3), of(d, -3, 3));
}

static int on_a_carriage(dice *d, char *to) {
    return snprintf(to, TEXT,
                    "mechanism drawn \"double pendulum on a sprung carriage\"\ncoordinate x [m]\n"
                    "coordinate a [rad]\ncoordinate b [rad]\n"
                    "parameter M = %g [kg]\nparameter p = %g [kg]\nparameter q = %g [kg]\n"
                    "parameter l = %g [m]\nparameter k = %g [m]\nparameter s = %g [N/m]\n"
                    "parameter g = 9.81 [m/s^2]\n"
                    "let x1 = x' + l*a'*cos(a)\nlet y1 = l*a'*sin(a)\n"
                    "let x2 = x1 + k*b'*cos(b)\nlet y2 = y1 + k*b'*sin(b)\n"
                    "T = M*x'^2/2 + p*(x1^2 + y1^2)/2 + q*(x2^2 + y2^2)/2\n"
                    "V = -p*g*l*cos(a) - q*g*(l*cos(a) + k*cos(b)) + s*x^2/2\n"
                    "scene s {\n  start a = %g, b = %g, x = %g [m]\n",
                    of(d, 0.5, 4), of(d, 0.3, 2), of(d, 0.3, 2), of(d, 0.3, 1), of(d, 0.3, 1),
                    of(d, 5, 80), of(d, 2, 3), of(d, -3, 3), of(d, -0.5, 0.5));
}

static int on_a_spring(dice *d, char *to) {
    return snprintf(to, TEXT,
                    "mechanism drawn \"pendulum below an elastic one\"\ncoordinate x [m]\n"
                    "coordinate y [m]\ncoordinate a [rad]\n"
                    "parameter p = %g [kg]\nparameter q = %g [kg]\nparameter k = %g [N/m]\n"
                    "parameter L = %g [m]\nparameter l = %g [m]\nparameter g = 9.81 [m/s^2]\n"
                    "let s = sqrt(x^2 + y^2 + 0.01 [m^2])\n"
                    "let vx = x' + l*a'*cos(a)\nlet vy = y' + l*a'*sin(a)\n"
                    "T = p*(x'^2 + y'^2)/2 + q*(vx^2 + vy^2)/2\n"
                    "V = k*(s - L)^2/2 + p*g*y + q*g*(y - l*cos(a))\n"
                    "scene s {\n  start x = %g [m], y = %g [m], a = %g\n",
                    of(d, 0.3, 1.5), of(d, 0.3, 1.5), of(d, 40, 200), of(d, 0.5, 1), of(d, 0.3, 1),
                    of(d, 0.6, 1.2), of(d, -0.3, 0.6), of(d, 1.5, 3));
}

static int on_an_arm(dice *d, char *to) {
    return snprintf(
        to, TEXT,
        "mechanism drawn \"two pendulums on a turning arm\"\ncoordinate w [rad]\n"
        "coordinate a [rad]\ncoordinate b [rad]\n"
        "parameter J = %g [kg*m^2]\nparameter R = %g [m]\nparameter p = %g [kg]\n"
        "parameter l = %g [m]\nparameter q = %g [kg]\nparameter k = %g [m]\n"
        "parameter g = 9.81 [m/s^2]\n"
        "T = (J*w'^2/2 + p*((R*w' + l*a'*cos(a))^2 + (l*a'*sin(a))^2 + (l*w'*sin(a))^2)/2\n"
        "     + q*((R*w' + k*b'*cos(b))^2 + (k*b'*sin(b))^2 + (k*w'*sin(b))^2)/2)\n"
        "V = -p*g*l*cos(a) - q*g*k*cos(b) + %g [J]*cos(a - b)\n"
        "scene s {\n  start a = %g, b = %g, w' = %g [rad/s]\n",
        of(d, 0.02, 0.2), of(d, 0.2, 0.6), of(d, 0.3, 1), of(d, 0.2, 0.6), of(d, 0.3, 1),
        of(d, 0.2, 0.6), of(d, 0, 2), of(d, 2, 3), of(d, -3, 3), of(d, -4, 4));
}

static int planet(dice *d, char *to) {
    return snprintf(to, TEXT,
                    "mechanism drawn \"planet gear with a disc on its rim\"\ncoordinate a [rad]\n"
                    "coordinate b [rad]\ncoordinate X [m]\n"
                    "parameter m = %g [kg]\nparameter n = %g [kg]\nparameter r = %g [m]\n"
                    "parameter l = %g [m]\nparameter I = m*r^2/2\nparameter k = %g [N/m]\n"
                    "let bx = X' - 2*r*a'*sin(a)\nlet by = 2*r*a'*cos(a)\n"
                    "let dx = X' - 2*r*a'*(sin(a) + sin(2*a)) - l*b'*sin(b)\n"
                    "let dy = 2*r*a'*(cos(a) + cos(2*a)) + l*b'*cos(b)\n"
                    "T = m*X'^2/2 + m*(bx^2 + by^2)/2 + 2*I*a'^2 + n*(dx^2 + dy^2)/2\n"
                    "V = k*X^2/2\nQ(a) = %g [N*m]\n"
                    "scene s {\n  start a = %g, b = %g, a' = %g [rad/s]\n",
                    of(d, 1, 3), of(d, 0.5, 3), of(d, 0.1, 0.4), of(d, 0.1, 0.4), of(d, 0, 30),
                    of(d, -0.2, 0.2), of(d, -3, 3), of(d, -3, 3), of(d, 2, 6));
}

static int (*const kinds[KINDS])(dice *, char *) = {double_pendulum, triple_pendulum, on_a_carriage,
                                                    on_a_spring,     on_an_arm,       planet};

typedef struct drawn_setting {
    const char *name;
    horizons_setting how;
    double step_ms;
} drawn_setting;

static drawn_setting setting_of(dice *d) {
    static const drawn_setting all[] = {
        {"float", {&engine_float, false, WH_RK4, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"float compensated", {&engine_float, true, WH_RK4, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"double", {&engine_double, false, WH_RK4, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"double, nystroem5", {&engine_double, false, WH_NYSTROEM5, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"float, heun", {&engine_float, false, WH_HEUN, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"float, nystroem4", {&engine_float, false, WH_NYSTROEM4, TABLES_NONE, MATRIX_NONE}, 1.0},
        {"double compensated, rk38",
         {&engine_double, true, WH_RK38, TABLES_NONE, MATRIX_NONE},
         1.0},
    };
    static const double steps_ms[] = {0.5, 1.0, 1.0, 2.0};
    drawn_setting s = all[dice_one_of(d, sizeof all / sizeof all[0])];
    s.step_ms = steps_ms[dice_one_of(d, 4)];
    return s;
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

static void spread_of(const char *what, double *ratio, unsigned count) {
    qsort(ratio, count, sizeof *ratio, by_size);
    printf("  %-28s %u ratios: least %.3f, tenth %.3f, middle %.3f, ninth tenth %.3f, most %.3f\n",
           what, count, ratio[0], ratio[count / 10], ratio[count / 2],
           ratio[count - 1 - count / 10], ratio[count - 1]);
}

enum { MOST_CASES = 400 };

TEST(trust_drawn, drawn_mechanisms) {
    static double ratio[MOST_CASES];
    dice d = dice_of("trust_drawn", 14);
    const unsigned wanted = dice_cases(few_or_all(3, 12));
    unsigned count = 0;
    unsigned near = 0;
    unsigned regular = 0;
    unsigned beyond = 0;
    for (unsigned i = 0; count < wanted && count < MOST_CASES && i < 3 * wanted + 10; i++) {
        char text[TEXT + 200];
        const int length = kinds[i % KINDS](&d, text);
        const drawn_setting s = setting_of(&d);
        TEST_ASSERT_TRUE(length > 0 && length < TEXT);
        snprintf(text + length, sizeof text - (size_t)length, "  step %g [ms]\n  until 30 [s]\n}\n",
                 s.step_ms);
        horizons h = horizons_of(text, "s", s.how, HORIZON_TOLERANCE);
        char what[60] = "";
        sscanf(text, "mechanism drawn \"%59[^\"]", what);
        if (h.known >= 0.05) { /* the references disagree, so no truth is known */
            beyond++;
        } else if (h.estimate.to_the_end && h.true_until_s >= h.doubling->end_s) {
            regular++; /* run and estimate are accurate to the end */
        } else {
            ratio[count] = horizons_ratio(&h);
            near += ratio[count] >= 0.8 && ratio[count] <= 1.2;
            printf("  %2u %-40s %-24s %g ms: %.5g s, true %.5g s: %.3f\n", count, what, s.name,
                   s.step_ms, h.estimate.until_s, h.true_until_s, ratio[count]);
            TEST_ASSERT_TRUE_MESSAGE(ratio[count] > 0.5 && ratio[count] <= 1.3, text);
            count++;
        }
        horizons_free(&h);
    }
    printf("  %u chaotic, %u right to the end by both, %u beyond the references\n", count, regular,
           beyond);
    TEST_ASSERT_EQUAL_UINT(wanted, count);
    TEST_ASSERT_TRUE_MESSAGE(10 * near >= 9 * count, "nine of ten within 0.8 ... 1.2");
    TEST_ASSERT_TRUE_MESSAGE(beyond <= count / 5, "the references know too little");
    spread_of("whirl trust", ratio, count);
}
