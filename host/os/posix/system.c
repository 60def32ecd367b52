/* system.c: the functions of host/os/system.h for POSIX. */
#include "host/os/system.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "host/base/exit.h"

volatile sig_atomic_t interrupted;

static void on_interrupt(int signal_number) {
    (void)signal_number;
    interrupted = 1;
}

/* The signal handler until interrupts_catch(). */
static void end_at_once(int signal_number) {
    static const char said[] = "whirl: interrupted\n";
    (void)signal_number;
    (void)!write(STDERR_FILENO, said, sizeof said - 1);
    _exit(EXIT_INTERRUPTED);
}

static void catch_with(void (*handler)(int), int flags) {
    struct sigaction action = {.sa_handler = handler, .sa_flags = flags};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if ((flags & SA_RESTART) == 0) {
        sigaction(SIGHUP, &action, NULL);
    }
}

void interrupts_catch(void) { catch_with(on_interrupt, SA_RESTART | (int)SA_RESETHAND); }

void interrupts_catch_waiting(void) { catch_with(on_interrupt, (int)SA_RESETHAND); }

void system_begin(void) {
    catch_with(end_at_once, SA_RESTART);
#ifdef SIGXFSZ
    signal(SIGXFSZ, SIG_IGN);
#endif
}

double system_now_s(void) {
    struct timespec t = {0};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void system_set_mode(FILE *file, unsigned mode) { (void)fchmod(fileno(file), (mode_t)mode); }

FILE *system_scratch(void) { return tmpfile(); }

bool system_scratch_folder(char *name) { return mkdtemp(name) != NULL; }

bool system_lock(FILE *file) {
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    return fcntl(fileno(file), F_SETLK, &whole) == 0 || (errno != EACCES && errno != EAGAIN);
}

FILE *system_read_from(const char *command) { return popen(command, "r"); }

/* For system_write_to(): the command's input, and the handler of SIGPIPE to be restored. */
static FILE *written;
static void (*before)(int);

/* Redirects a stream to the file. Returns a copy of the stream for put_back(), or -1 if it was closed. */
static int put_in_place(FILE *file, int stream) {
    const int old = dup(stream);
    if (old >= 0) {
        dup2(fileno(file), stream);
    }
    return old;
}

static void put_back(int old, int stream) {
    if (old >= 0) {
        dup2(old, stream);
        close(old);
    }
}

FILE *system_write_to(const char *command, FILE *output, FILE *messages) {
    fflush(stdout);
    fflush(stderr);
    before = signal(SIGPIPE, SIG_IGN);
    const int out = put_in_place(output, STDOUT_FILENO);
    const int errors = put_in_place(messages, STDERR_FILENO);
    written = out < 0 ? NULL : popen(command, "w");
    put_back(errors, STDERR_FILENO);
    put_back(out, STDOUT_FILENO);
    if (written == NULL) {
        signal(SIGPIPE, before);
    }
    return written;
}

int system_end(FILE *command) {
    const int status = command == NULL ? -1 : pclose(command);
    if (command != NULL && command == written) {
        written = NULL;
        signal(SIGPIPE, before);
    }
    return status != -1 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
