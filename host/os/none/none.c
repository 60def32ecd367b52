/* none.c: a machine without processes, signals and serial lines. Jobs run in this process. */
#include <errno.h>
#include <stdlib.h>
#include <time.h>

#include "host/base/alloc.h"
#include "host/os/guest.h"
#include "host/os/jobs.h"
#include "host/os/port.h"
#include "host/os/system.h"

volatile sig_atomic_t interrupted;

void interrupts_catch(void) {}

void interrupts_catch_waiting(void) {}

void system_begin(void) {}

double system_now_s(void) {
    struct timespec t = {0};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void system_set_mode(FILE *file, unsigned mode) {
    (void)file;
    (void)mode;
}

static FILE *refuse(void) {
    errno = ENOTSUP;
    return NULL;
}

FILE *system_scratch(void) { return refuse(); }

bool system_scratch_folder(char *name) {
    (void)name;
    return refuse() != NULL;
}

bool system_lock(FILE *file) {
    (void)file;
    return true;
}

FILE *system_read_from(const char *command) {
    (void)command;
    return refuse();
}

FILE *system_write_to(const char *command, FILE *output, FILE *messages) {
    (void)command;
    (void)output;
    (void)messages;
    return refuse();
}

int system_end(FILE *command) {
    (void)command;
    return -1;
}

int jobs_workers(void) { return 1; }

jobs_result jobs_run(const jobs *j) {
    for (uint64_t point = j->first; point < j->end; point++) {
        char *text[2];
        size_t length[2];
        FILE *row = alloc_text(&text[0], &length[0]);
        FILE *reason = alloc_text(&text[1], &length[1]);
        const bool good = j->work(j->context, point, row, reason);
        alloc_text_end(row);
        alloc_text_end(reason);
        const bool go_on = j->deliver(j->context, point, good, text[0], text[1]) &&
                           j->pause(j->context, point + 1);
        free(text[0]);
        free(text[1]);
        if (!go_on) {
            return JOBS_REFUSED;
        }
    }
    return JOBS_DONE;
}

bool guest_machine_of(const char *board, char machine[GUEST_MACHINE_BYTES]) {
    (void)board;
    machine[0] = '\0';
    return false;
}

bool guest_start(guest *g, const guest_request *request) {
    *g = (guest){.request = *request, .up = -1, .down = -1};
    fputs("whirl pil: error: this build of whirl cannot start firmware\n", stderr);
    return false;
}

guest_heard guest_receive(guest *g, wh_frame *frame) {
    (void)g;
    (void)frame;
    return GUEST_ENDED;
}

guest_heard guest_send(guest *g, const uint8_t *bytes, unsigned count) {
    (void)g;
    (void)bytes;
    (void)count;
    return GUEST_ENDED;
}

guest_end_status guest_end(guest *g) {
    (void)g;
    return (guest_end_status){.status = -1};
}

bool port_has_speed(double baud) { return baud > 0.0; }

bool port_open(port *p, const char *name, double baud) {
    (void)name;
    (void)baud;
    *p = (port){.file = -1};
    return refuse() != NULL;
}

void port_say_unopened(const char *name, const char *hint) {
    (void)hint;
    fprintf(stderr, "%s: error: this build of whirl cannot open serial lines\n", name);
}

void port_forget(const port *p) { (void)p; }

void port_close(port *p) { (void)p; }

int port_read(port *p, uint8_t *bytes, size_t room, int wait_ms, bool *typed) {
    (void)p;
    (void)bytes;
    (void)room;
    (void)wait_ms;
    (void)typed;
    return -1;
}

bool port_write(port *p, const char *bytes, size_t count) {
    (void)p;
    (void)bytes;
    (void)count;
    return false;
}
