#define _POSIX_C_SOURCE 200809L

#include "tests/tools/emulated.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { CONSOLE = 10, TEST = 11, LOG = 12 };

static pid_t running;

static void end_running(void) {
    if (running > 0) {
        (void)kill(running, SIGKILL);
    }
}

_Noreturn static void give_up(const char *what) {
    fprintf(stderr, "emulated: %s: %s\n", what, strerror(errno));
    exit(2);
}

static long clock_ms(clockid_t clock) {
    struct timespec now;
    if (clock_gettime(clock, &now) != 0) {
        give_up("no clock");
    }
    return (long)now.tv_sec * 1000L + now.tv_nsec / 1000000L;
}

static long now_ms(void) { return clock_ms(CLOCK_MONOTONIC); }

/* Time limits count the emulator's processor time plus a twentieth of the elapsed time: a sleeping guest uses no processor. */
static long worked_ms(void) {
    clockid_t clock;
    if (running <= 0 || clock_getcpuclockid(running, &clock) != 0) {
        give_up("the emulator has no clock");
    }
    return clock_ms(clock) + now_ms() / 20L;
}

static void run(const char *machine, const char *elf, unsigned serial, unsigned shift) {
    char icount[32];
    const char *words[64];
    unsigned count = 0;
    (void)snprintf(icount, sizeof icount, "shift=%u", shift);
    const char *fixed[] = {"qemu-system-arm",
                           "-M",
                           machine,
                           "-display",
                           "none",
                           "-monitor",
                           "none",
                           "-chardev",
                           "socket,id=console,fd=10",
                           "-chardev",
                           "socket,id=qtest,fd=11",
                           "-qtest",
                           "chardev:qtest",
                           "-qtest-log",
                           "none",
                           "-d",
                           "unimp",
                           "-D",
                           "/dev/fd/12",
                           "-icount",
                           icount,
                           "-kernel",
                           elf};
    for (unsigned i = 0; i < sizeof fixed / sizeof fixed[0]; i++) {
        words[count++] = fixed[i];
    }
    for (unsigned i = 0; i < serial; i++) {
        words[count++] = "-serial";
        words[count++] = "null";
    }
    words[count++] = "-serial";
    words[count++] = "chardev:console";
    words[count++] = "-accel";
    words[count++] = "tcg";
    words[count] = NULL;
    execvp(words[0], (char *const *)words);
    _exit(127);
}

void emulated_start(emulated *e, const char *machine, const char *elf, unsigned serial,
                    unsigned shift) {
    int console[2];
    int test[2];
    int log[2];
    memset(e, 0, sizeof *e);
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, console) != 0 ||
        socketpair(AF_UNIX, SOCK_STREAM, 0, test) != 0 || pipe(log) != 0 ||
        signal(SIGPIPE, SIG_IGN) == SIG_ERR) {
        give_up("no pipes");
    }
    e->process = fork();
    if (e->process < 0) {
        give_up("no process");
    }
    running = e->process;
    if (running > 0 && atexit(end_running) != 0) {
        give_up("no end");
    }
    if (e->process == 0) {
        if (dup2(console[1], CONSOLE) < 0 || dup2(test[1], TEST) < 0 || dup2(log[1], LOG) < 0) {
            _exit(127);
        }
        run(machine, elf, serial, shift);
    }
    (void)close(console[1]);
    (void)close(test[1]);
    (void)close(log[1]);
    e->console = console[0];
    e->test = test[0];
    e->log = log[0];
}

void emulated_end(emulated *e) {
    (void)kill(e->process, SIGKILL);
    (void)waitpid(e->process, NULL, 0);
    running = 0;
    (void)close(e->console);
    (void)close(e->test);
    (void)close(e->log);
}

/* Reads a line like "timer[1]: unimplemented device write (size 4, offset 0x044, value 0x00001e00)". */
static void see_log_line(emulated *e) {
    const char *words = strstr(e->logged, ": unimplemented device write");
    const char *offset = strstr(e->logged, "offset 0x");
    const char *value = strstr(e->logged, "value 0x");
    if (words == NULL || offset == NULL || value == NULL) {
        return;
    }
    emulated_store_seen *seen = &e->store[e->stores++ % EMULATED_STORES];
    (void)snprintf(seen->device, sizeof seen->device, "%.*s", (int)(words - e->logged), e->logged);
    seen->offset = (uint32_t)strtoul(offset + 7, NULL, 16);
    seen->value = (uint32_t)strtoul(value + 6, NULL, 16);
}

static void take_log(emulated *e) {
    char bytes[8192];
    const ssize_t count = read(e->log, bytes, sizeof bytes);
    for (ssize_t i = 0; i < count; i++) {
        if (bytes[i] == '\n') {
            e->logged[e->logged_bytes] = '\0';
            see_log_line(e);
            e->logged_bytes = 0;
        } else if (e->logged_bytes < sizeof e->logged - 1U) {
            e->logged[e->logged_bytes++] = bytes[i];
        }
    }
}

/* Reads for up to `ms`; returns after the first bytes. */
static void pump(emulated *e, unsigned ms) {
    struct pollfd ready[3] = {{.fd = e->console, .events = POLLIN},
                              {.fd = e->test, .events = POLLIN},
                              {.fd = e->log, .events = POLLIN}};
    if (poll(ready, 3, (int)ms) <= 0) {
        return;
    }
    if ((ready[0].revents & POLLIN) != 0 && e->heard_bytes < sizeof e->heard) {
        const ssize_t count =
            read(e->console, e->heard + e->heard_bytes, sizeof e->heard - e->heard_bytes);
        e->heard_bytes += count > 0 ? (unsigned)count : 0U;
    }
    if ((ready[1].revents & POLLIN) != 0) {
        const ssize_t count =
            read(e->test, e->said + e->said_bytes, sizeof e->said - 1U - e->said_bytes);
        e->said_bytes += count > 0 ? (unsigned)count : 0U;
    }
    if ((ready[2].revents & POLLIN) != 0) {
        take_log(e);
    }
    if ((ready[1].revents & POLLHUP) != 0) {
        errno = 0;
        give_up("the emulator has ended");
    }
}

void emulated_wait(emulated *e, unsigned ms) {
    for (const long until = now_ms() + (long)ms; now_ms() < until;) {
        pump(e, (unsigned)(until - now_ms() > 0 ? until - now_ms() : 0));
    }
}

static void send_all(int to, const char *words) {
    for (size_t done = 0, all = strlen(words); done < all;) {
        const ssize_t count = write(to, words + done, all - done);
        if (count < 0 && errno != EINTR) {
            give_up("the emulator does not listen");
        }
        done += count > 0 ? (size_t)count : 0U;
    }
}

void emulated_say(emulated *e, const char *words) { send_all(e->console, words); }

bool emulated_hear(emulated *e, char *line, unsigned room, unsigned ms) {
    const long until = worked_ms() + (long)ms;
    for (;;) {
        const char *end = memchr(e->heard, '\n', e->heard_bytes);
        if (end != NULL) {
            const unsigned bytes = (unsigned)(end - e->heard);
            const unsigned kept = bytes > 0 && e->heard[bytes - 1U] == '\r' ? bytes - 1U : bytes;
            (void)snprintf(line, room, "%.*s", (int)kept, e->heard);
            e->heard_bytes -= bytes + 1U;
            memmove(e->heard, end + 1, e->heard_bytes);
            return true;
        }
        const long left = until - worked_ms();
        if (left <= 0) {
            return false;
        }
        pump(e, (unsigned)left);
    }
}

static uint32_t ask(emulated *e, const char *order) {
    e->said_bytes = 0;
    send_all(e->test, order);
    const long until = worked_ms() + 20000L;
    while (memchr(e->said, '\n', e->said_bytes) == NULL) {
        if (worked_ms() > until) {
            errno = 0;
            give_up("qtest does not answer");
        }
        pump(e, 1000);
    }
    e->said[e->said_bytes] = '\0';
    if (strncmp(e->said, "OK", 2) != 0) {
        fprintf(stderr, "emulated: %s answers %s", order, e->said);
        exit(2);
    }
    return e->said[2] == ' ' ? (uint32_t)strtoul(e->said + 3, NULL, 16) : 0U;
}

uint32_t emulated_load(emulated *e, uint32_t address) {
    char order[64];
    (void)snprintf(order, sizeof order, "readl 0x%x\n", (unsigned)address);
    return ask(e, order);
}

void emulated_store(emulated *e, uint32_t address, uint32_t value) {
    char order[64];
    (void)snprintf(order, sizeof order, "writel 0x%x 0x%x\n", (unsigned)address, (unsigned)value);
    (void)ask(e, order);
}
