/* root_exhaustive.c: the float square root in integers at all 2^32 numbers.
 *
 * The reference is the processor's or library's root in double, rounded to float. That is the nearest float: double has more
 * than twice a float's bits plus two (Figueroa, When is double rounding innocuous?, SIGNUM Newsletter 30 (1995) 3). WH_SQRT,
 * the root that scenes use, is compared too. NaN equals NaN. The exit status is 1 if one differs. */
#include "core/root.h"

#include <math.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

typedef union number {
    uint32_t bits;
    float value;
} number;

static bool same(number a, number b) {
    return a.bits == b.bits || (isnan(a.value) && isnan(b.value));
}

/* Counts the wrong roots of numbers first to last - 1. */
static uint64_t measure(uint64_t first, uint64_t last) {
    uint64_t wrong = 0;
    for (uint64_t bits = first; bits < last; bits++) {
        const number x = {.bits = (uint32_t)bits};
        const number wanted = {.value = (float)sqrt((double)x.value)};
        const number own = {.value = wh_sqrt(x.value)};
        const number used = {.value = WH_SQRT(x.value)};
        if (!same(own, wanted) || !same(used, wanted)) {
            if (wrong++ == 0) {
                printf("root of %a: in integers %a, in scenes %a, not %a\n", (double)x.value,
                       (double)own.value, (double)used.value, (double)wanted.value);
            }
        }
    }
    return wrong;
}

/* The second half in a child process, the first half here. */
int main(void) {
    const uint64_t all = UINT64_C(1) << 32;
    const pid_t child = fork();
    if (child < 0) {
        perror("root_exhaustive: fork");
        return 1;
    }
    if (child == 0) {
        const uint64_t wrong = measure(all / 2, all);
        fflush(stdout);
        _exit(wrong == 0 ? 0 : 1);
    }
    const uint64_t wrong = measure(0, all / 2);
    int status = 1;
    if (waitpid(child, &status, 0) != child) {
        perror("root_exhaustive: the second process");
        return 1;
    }
    const bool good = wrong == 0 && status == 0;
    printf("float square root of all 2^32 numbers: %s\n",
           good ? "every one the nearest" : "NOT every one the nearest");
    return good ? 0 : 1;
}
