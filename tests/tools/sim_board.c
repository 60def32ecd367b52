/* sim_board.c: board.h on this machine in simulated time, which runs hours of the rig's station in seconds. Time
 * passes as fast as the program waits. The serial line is a pseudo-terminal with a limited byte rate.
 *
 * SIM_SECONDS  simulated duration (default 60); each minute has the orders of a run
 * SIM_BAUD     the line's speed (default 115200); a byte is ten bits
 * SIM_LINK     a link to the terminal
 * SIM_ALONE    no reader: bytes that the terminal does not accept at once are lost
 * SIM_TEL      telemetry is on from the start
 * SIM_SEED     seed for settings, orders, an unsteady supply and hardware failures
 *
 * The first second takes SLOWLY real seconds, or until a reader has asked for telemetry. Later, unless SIM_ALONE is
 * set, time waits until the reader has read the line's bytes: a slow reader loses nothing. At the end the program
 * prints the hash of the plant's state on standard error. Equal commands give equal hashes. */
#define _XOPEN_SOURCE 700

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

#include "boards/board.h"
#include "hal/virtual/virtual_rig.h"
#include "tests/core/draw.h"

enum { BITS = 10, FIFO = 16, PATIENCE_MS = 600000, ASKING_US = 1000000, SLOWLY = 20 };

const char *const board_name = "sim";
const uint32_t board_ticks_per_s = 1000000U;

static uint64_t now_us;
static uint32_t last_ticks;
static uint64_t until_us;
static uint64_t credit; /* what the line may still send, in millionths of a byte */
static uint64_t baud;
static bool alone;
static bool asked; /* the reader has asked for telemetry */
static int line = -1;
static int other_end = -1;
static const char *link_name;
static uint64_t seed;    /* 0: no random events */
static unsigned drawn;   /* number of lines so far */
static unsigned ordered; /* orders given in this minute */
static uint64_t minute;

static const struct {
    double at_s; /* seconds after the begin of each minute */
    const char *line;
} orders[] = {
    {0.5, ""}, {3.0, "arm\n"}, {3.5, "start 330\n"}, {20.0, "set 250\n"}, {50.0, "stop\n"}};
enum { ORDERS = sizeof orders / sizeof orders[0] };

static double setting(const char *name, double usual) {
    const char *text = getenv(name);
    return text != NULL && text[0] != '\0' ? strtod(text, NULL) : usual;
}

void board_start(void) {
    until_us = (uint64_t)(setting("SIM_SECONDS", 60.0) * 1e6);
    baud = (uint64_t)setting("SIM_BAUD", 115200.0);
    alone = getenv("SIM_ALONE") != NULL;
    link_name = getenv("SIM_LINK");
    seed = (uint64_t)setting("SIM_SEED", 0.0);
}

void hal_console_write(const char *bytes, unsigned count) { (void)fwrite(bytes, 1, count, stderr); }

static void let_read(void) {
    const struct timespec nap = {.tv_nsec = 10000000L};
    int left = 1;
    for (int i = 0; i < 1000 && left > 0 && !alone; i++) {
        if (ioctl(other_end, FIONREAD, &left) != 0) {
            break;
        }
        (void)nanosleep(&nap, NULL);
    }
}

_Noreturn void board_exit(int code) {
    const hal_virtual_rig *plant = hal_virtual_rig_instance();
    if (line >= 0) {
        let_read();
    }
    if (link_name != NULL) {
        (void)unlink(link_name);
    }
    fprintf(stderr, "plant %016" PRIx64 " after %" PRIu64 " steps\n",
            plant->scene != NULL ? wh_scene_hash(plant->scene, &plant->state) : 0,
            plant->scene != NULL ? plant->state.steps : 0);
    exit(code);
}

/* --- random events ---------------------------------------------------------------------------------------------- */

static bool happens(unsigned one_in) { return draw_one_of(&seed, one_in) == 0; }

/* A control step of hardware with occasional failures. */
static void disturb(void) {
    hal_virtual_rig *plant = hal_virtual_rig_instance();
    hal_virtual_faults *faults = &plant->faults;
    plant->supply_V = HAL_VIRTUAL_RATED_V * (0.99f + 0.0001f * (float)draw_one_of(&seed, 201));
    if (happens(1500)) {
        faults->lose_pulses[draw_one_of(&seed, 2)] += 1U + draw_one_of(&seed, 2);
    }
    if (happens(1500)) {
        faults->lose_samples += 1U + draw_one_of(&seed, 5);
    }
    if (happens(20000)) {
        faults->stuck_load_cell = !faults->stuck_load_cell;
    }
    if (happens(20000)) {
        faults->dead_sensor[draw_one_of(&seed, 2)] = true;
    }
    if (happens(30000)) {
        faults->stuck = 1.0f - faults->stuck;
    }
    plant->stop_pressed = plant->stop_pressed ? !happens(300) : happens(15000);
}

/* Draws the next typed line: first the settings, later orders. Returns "" if nothing is typed now. */
static const char *draw_line(void) {
    static char words[40];
    static const char *const numbers[] = {"conf set gain 0.%02u\n", "conf set settle_time 0.%02u\n",
                                          "conf set record_turns %u\n",
                                          "conf set cell_offset 0.%02u\n"};
    enum { NUMBERS = sizeof numbers / sizeof numbers[0] };
    words[0] = '\0';
    if (drawn < NUMBERS) {
        snprintf(words, sizeof words, numbers[drawn], 10U + draw_one_of(&seed, 20));
    } else if (drawn == NUMBERS) {
        snprintf(words, sizeof words, "conf set compensation %s\n", happens(2) ? "always" : "slow");
    } else if (now_us > 2 * ASKING_US && happens(250)) {
        const char *const orders_of[] = {"arm\n",      "arm\n",    "start %u\n", "start %u\n",
                                         "start %u\n", "set %u\n", "clear\n",    "stop\n"};
        const unsigned which = draw_one_of(&seed, happens(4) ? 8 : 7);
        snprintf(words, sizeof words, orders_of[which], 100U + draw_one_of(&seed, 260));
    }
    drawn += words[0] != '\0';
    return words;
}

/* --- board.h ------------------------------------------------------------------------------------------------------ */

uint32_t board_ticks(void) { return (uint32_t)now_us; }

void board_wait_until(uint32_t ticks) {
    const uint32_t passed = ticks - last_ticks;
    last_ticks = ticks;
    now_us += passed;
    credit += passed * (baud / BITS);
    const uint64_t most = FIFO * UINT64_C(1000000) + passed * (baud / BITS);
    credit = credit < most ? credit : most;
    if (now_us >= until_us) {
        board_exit(0);
    }
    if (seed != 0) {
        disturb();
    }
    if (!alone && !asked && now_us < ASKING_US) {
        const struct timespec nap = {.tv_nsec = (long)passed * SLOWLY * 1000L};
        (void)nanosleep(&nap, NULL);
    }
}

bool board_converse(void) {
    struct termios plain;
    line = posix_openpt(O_RDWR | O_NOCTTY);
    const char *name =
        line >= 0 && grantpt(line) == 0 && unlockpt(line) == 0 ? ptsname(line) : NULL;
    other_end = name != NULL ? open(name, O_RDWR | O_NOCTTY) : -1;
    if (other_end < 0 || tcgetattr(other_end, &plain) != 0) {
        return false;
    }
    plain.c_iflag = 0;
    plain.c_oflag = 0;
    plain.c_lflag = 0;
    if (tcsetattr(other_end, TCSANOW, &plain) != 0 ||
        fcntl(line, F_SETFL, fcntl(line, F_GETFL) | O_NONBLOCK) != 0 ||
        (link_name != NULL && symlink(name, link_name) != 0)) {
        return false;
    }
    if (!alone) { /* waits until a reader opens the terminal */
        struct pollfd wait = {.fd = line, .events = POLLIN};
        (void)poll(&wait, 1, PATIENCE_MS);
    }
    return true;
}

static unsigned give(const char *given, char *bytes) {
    unsigned count = 0;
    while (given[count] != '\0') {
        bytes[count] = given[count];
        count++;
    }
    return count;
}

/* The orders of each minute, as whole typed lines. */
static unsigned order(char *bytes, unsigned room) {
    const double at_s = (double)(now_us - minute * 60000000U) / 1e6;
    if (at_s >= 60.0) {
        minute++;
        ordered = 0;
        return 0;
    }
    if (ordered == ORDERS || at_s < orders[ordered].at_s || strlen(orders[ordered].line) > room) {
        return 0;
    }
    const bool turns_on = ordered == 0 && minute == 0 && getenv("SIM_TEL") != NULL;
    const char *given = turns_on ? "tel rate 500\n" : orders[ordered].line;
    ordered++;
    return give(given, bytes);
}

unsigned hal_console_read(char *bytes, unsigned room) {
    const char *line_drawn = seed != 0 && room >= 32U ? draw_line() : "";
    if (line_drawn[0] != '\0') {
        return give(line_drawn, bytes);
    }
    static char typed[256]; /* an order must not split the reader's line */
    static unsigned length;
    const ssize_t more = alone ? 0 : read(line, typed + length, sizeof typed - length);
    length += more > 0 ? (unsigned)more : 0U;
    const char *end = memchr(typed, '\n', length);
    if (end != NULL && (unsigned)(end - typed) < room) {
        const unsigned count = (unsigned)(end - typed) + 1U;
        memcpy(bytes, typed, count);
        asked = asked || strncmp(typed, "tel rate", 8) == 0;
        length -= count;
        memmove(typed, typed + count, length);
        return count;
    }
    return seed != 0 ? 0U : order(bytes, room);
}

unsigned hal_console_offer(const char *bytes, unsigned count) {
    const unsigned most = (unsigned)(credit / 1000000U);
    unsigned done = 0;
    count = count < most ? count : most;
    while (done < count) {
        struct pollfd wait = {.fd = line, .events = POLLOUT};
        const ssize_t taken = write(line, bytes + done, count - done);
        done += taken > 0 ? (unsigned)taken : 0U;
        if (alone || (done < count && poll(&wait, 1, PATIENCE_MS) == 0)) {
            break;
        }
    }
    credit -= done * UINT64_C(1000000);
    return done;
}

void board_stack_paint(void) {}
unsigned board_stack_used_bytes(void) { return 0; }
unsigned board_stack_size_bytes(void) { return 0; }
bool board_cycles_start(void) { return false; }
uint32_t board_cycles(void) { return 0; }
