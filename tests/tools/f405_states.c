/* f405_states.c: faults and resets of the firmware in every state, with a plant inside (tests/boards/f405_plant.c). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/tools/f405.h"

#define ICSR 0xE000ED04U
#define ICSR_NMI 0x80000000U
#define AIRCR 0xE000ED0CU
#define AIRCR_RESET 0x05FA0004U
#define CPACR 0xE000ED88U
#define NVIC_ISER_1 0xE000E104U
#define NVIC_ISPR_1 0xE000E204U
#define MPU_RNR 0xE000ED98U
#define MPU_RBAR 0xE000ED9CU
#define MPU_RASR 0xE000EDA0U

static bool says_state(char *state, unsigned room, unsigned *trip) {
    char line[300];
    if (!answers_at_last("status", "OK state=", line, sizeof line)) {
        return false;
    }
    const char *end = strstr(line, " speed_rpm=");
    const char *latched = strstr(line, " trip=");
    if (end == NULL || latched == NULL) {
        return no("a status that is none: %s", line);
    }
    (void)snprintf(state, room, "%.*s", (int)(end - line - 9), line + 9);
    *trip = (unsigned)strtoul(latched + 6, NULL, 10);
    return true;
}

/* A random state: idle, armed, in any phase of a run, tripped. */
static bool bring_somewhere(char *state, unsigned room, unsigned *trip) {
    char line[300];
    const unsigned where = below(8);
    if (!says_state(state, room, trip)) {
        return false;
    }
    if (*trip != 0 && below(3) > 0) {
        if (!answers("clear", "", line, sizeof line)) {
            return false;
        }
    }
    if (where > 0 && *trip == 0) {
        emulated_store(&board, symbol("bench_rest"), 1);
        for (unsigned i = 0; i < 100; i++) { /* until the rig has detected that the rotor rests */
            if (!answers("arm", "", line, sizeof line)) {
                return false;
            }
            if (strncmp(line, "OK", 2) == 0) {
                break;
            }
            emulated_wait(&board, 50);
        }
        if (where > 1 && !answers("start 330", "", line, sizeof line)) {
            return false;
        }
        emulated_wait(&board, where > 2 ? below(where < 7 ? 2500 : 14000) : below(300));
        if (where > 1 && below(5) == 0) {
            emulated_store(&board, symbol("bench_silent"), 1);
            emulated_wait(&board, 300);
        }
    }
    return says_state(state, room, trip);
}

/* Checks the log after a mark. No store after the restart drives the motor. After a fault, the last two stores before
 * the restart switch PWM and enable off; all earlier ones are the loop's kicks and motor stores. */
static bool is_off_after(uint64_t mark, bool faulted) {
    uint64_t boot = 0;
    for (unsigned ms = 0; boot == 0; ms++) { /* the log lags on a busy machine */
        for (uint64_t n = mark + 1; n < board.stores && boot == 0; n++) {
            boot = is(seen_at(n), "RCC", 0) && seen_at(n)->value == 1 ? n : 0;
        }
        if (boot == 0 && ms == LOG_BEHIND_MS) {
            return no("no start is in the log");
        }
        emulated_wait(&board, boot == 0 ? 1U : 0U);
    }
    for (uint64_t n = boot; n < board.stores; n++) {
        if (drives(seen_at(n))) {
            return no("the motor is driven after the start");
        }
    }
    if (!faulted) {
        return true;
    }
    if (boot < mark + 3 || !is(seen_at(boot - 2), "timer[1]", 0x44) || drives(seen_at(boot - 2)) ||
        !is(seen_at(boot - 1), "GPIOB", 0x18) || seen_at(boot - 1)->value != 0x40000000U) {
        return no("the last stores before the start are not those that switch off");
    }
    for (uint64_t n = mark + 1; n < boot - 2; n++) {
        if (!kicks(seen_at(n)) && !is(seen_at(n), "timer[1]", 0x44) &&
            !is(seen_at(n), "GPIOB", 0x18)) {
            return no("%s 0x%x was written before the motor was off", seen_at(n)->device,
                      (unsigned)seen_at(n)->offset);
        }
    }
    return true;
}

typedef enum fault_kind { CRYSTAL, STRAY, NO_FPU, MEMORY, FAULT_KINDS } fault_kind;

static const char *inject(fault_kind kind) {
    switch (kind) {
    case CRYSTAL: emulated_store(&board, ICSR, ICSR_NMI); return "NMI, PC ";
    case STRAY:
        emulated_store(&board, NVIC_ISER_1, 1U << 8);
        emulated_store(&board, NVIC_ISPR_1, 1U << 8);
        return "unexpected interrupt 40, PC ";
    case NO_FPU: emulated_store(&board, CPACR, 0); return "UsageFault, PC ";
    case MEMORY: /* 256 bytes of the variables become inaccessible: neither the stack nor the stored memory */
        emulated_store(&board, MPU_RNR, 1);
        emulated_store(&board, MPU_RBAR, symbol("rig") & ~0xFFU);
        emulated_store(&board, MPU_RASR, 7U << 1 | 1U);
        return "MemManage, PC ";
    case FAULT_KINDS: break;
    }
    return "";
}

static bool faults_once(unsigned number, unsigned *changed) {
    char state[60];
    char line[400];
    char after[60];
    unsigned trip = 0;
    unsigned trip_after = 0;
    uint64_t mark;
    if (!bring_somewhere(state, sizeof state, &trip)) {
        return false;
    }
    const uint32_t stage = emulated_load(&board, symbol("kept_state"));
    set_mark(0xFA000000U + number);
    const char *begin = inject((fault_kind)below(FAULT_KINDS));
    if (!hear("# reset: ", line, sizeof line, 60000)) {
        return false;
    }
    const char *report = line + strlen("# reset: fault: ");
    const char *pc = strstr(line, "PC 0x");
    const char *told = strstr(line, ", state ");
    const char *count = strstr(line, ", faults ");
    if (strncmp(report, begin, strlen(begin)) != 0 || pc == NULL || told == NULL || count == NULL) {
        return no("in %s, '%s' is told as: %s", state, begin, line);
    }
    const unsigned long at = strtoul(pc + 3, NULL, 16);
    if (at < 0x0800C000UL || at > 0x08100000UL || strtoul(count + 9, NULL, 10) != number + 1U) {
        return no("not our code, or not fault %u: %s", number + 1U, line);
    }
    if (strtoul(told + 8, NULL, 10) != stage) {
        *changed += 1U;
    }
    if (!says_state(after, sizeof after, &trip_after)) {
        return false;
    }
    if (strcmp(after, trip != 0 ? "tripped" : "idle") != 0 || trip_after != trip) {
        return no("in %s with trip %u, after the reset %s with trip %u", state, trip, after,
                  trip_after);
    }
    if (!marked(0xFA000000U + number, &mark)) {
        return false;
    }
    if (!is_off_after(mark, true)) {
        char because[sizeof why];
        memcpy(because, why, sizeof because); /* no() overwrites it */
        return no("%.200s (in %s, %s)", because, state, begin);
    }
    return true;
}

bool all_faults(unsigned times) {
    unsigned changed = 0;
    for (unsigned i = 0; i < times; i++) {
        if (!faults_once(i, &changed)) {
            return false;
        }
    }
    return changed <= 1U + times / 20U || no("%u of %u records have another state", changed, times);
}

static bool resets_once(unsigned number) {
    char state[60] = "starting";
    char line[400];
    char after[60];
    unsigned trip = 0;
    unsigned trip_after = 0;
    uint64_t mark;
    const bool at_once = below(2) == 0; /* true: the reset comes during a start */
    if (at_once) {
        static unsigned last_trip;
        if (!says_state(state, sizeof state, &last_trip)) {
            return false;
        }
        trip = last_trip;
        emulated_store(&board, AIRCR, AIRCR_RESET);
        emulated_wait(&board, below(8));
    } else if (!bring_somewhere(state, sizeof state, &trip)) {
        return false;
    }
    set_mark(0x5E000000U + number);
    emulated_store(&board, AIRCR, AIRCR_RESET);
    if (!marked(0x5E000000U + number, &mark) || !starts_after(mark)) {
        return false;
    }
    if (!hear("# reset: other", line, sizeof line, 60000)) {
        return no("in %s: the cause is not told", state);
    }
    emulated_wait(&board, 20);
    if (!says_state(after, sizeof after, &trip_after)) {
        return false;
    }
    if (strcmp(after, trip != 0 ? "tripped" : "idle") != 0 || trip_after != trip) {
        return no("in %s with trip %u, after the reset %s with trip %u", state, trip, after,
                  trip_after);
    }
    return is_off_after(mark, false);
}

bool all_resets(unsigned times) {
    char line[300];
    if (!answers("id", "OK ", line, sizeof line)) {
        return false;
    }
    for (unsigned i = 0; i < times; i++) {
        if (!resets_once(i)) {
            return false;
        }
    }
    return true;
}
