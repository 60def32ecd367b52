/* guest.c: the firmware's process: start, messages, end. */
#include "host/os/guest.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "host/os/system.h"
#if defined(__linux__)
#include <sys/prctl.h>
#endif

/* DOWN and UP: as in hal/link.h. ABOVE: the lowest temporary descriptor. */
enum { DOWN = 3, UP = 4, ABOVE = 10 };
enum { POLL_MS = 50 };

/* Returns false (reported) if the file is not in ELF. *arm: is it for Arm? */
static bool look_at_image(const char *name, bool *arm) {
    enum { MACHINE = 18, ARM = 40, LITTLE = 1 };
    unsigned char head[MACHINE + 2];
    FILE *file = fopen(name, "rb");
    if (file == NULL) {
        fprintf(stderr,
                "%s: error: cannot be read: %s\nhint: make pil-images builds build/pil_rig and "
                "build/BOARD/pil_rig.elf\n",
                name, strerror(errno));
        return false;
    }
    const size_t count = fread(head, 1, sizeof head, file);
    fclose(file);
    if (count < sizeof head || memcmp(head, "\177ELF", 4) != 0) {
        fprintf(
            stderr,
            "%s: error: not a firmware image: it is not in ELF\nhint: give an image for Arm that QEMU runs, or a program of this machine (docs/pil.md)\n",
            name);
        return false;
    }
    const int low = head[5] == LITTLE ? MACHINE : MACHINE + 1;
    const int high = head[5] == LITTLE ? MACHINE + 1 : MACHINE;
    *arm = (head[low] | (unsigned)head[high] << 8) == ARM;
    return true;
}

bool guest_machine_of(const char *board, char machine[GUEST_MACHINE_BYTES]) {
    char line[200];
    snprintf(line, sizeof line, "boards/%.100s/board.mk", board);
    FILE *file = fopen(line, "r");
    machine[0] = '\0';
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        (void)sscanf(line, "BOARD_MACHINE := %63s", machine);
    }
    if (file != NULL) {
        fclose(file);
    }
    return machine[0] != '\0';
}

/* Moves the pipes to DOWN and UP. Copies them first, because `up` may have the number DOWN. */
static bool place_line(int down, int up) {
    const int high_down = fcntl(down, F_DUPFD_CLOEXEC, ABOVE);
    const int high_up = fcntl(up, F_DUPFD_CLOEXEC, ABOVE);
    const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    return high_down >= 0 && high_up >= 0 && nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 &&
           dup2(high_down, DOWN) >= 0 && dup2(high_up, UP) >= 0;
}

/* Puts the guest into its own process group, so that Ctrl-C reaches only Whirl. Linux kills the guest if Whirl ends. */
static bool tie_to(pid_t parent) {
#if defined(__linux__)
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) {
        return false;
    }
#endif
    return setpgid(0, 0) == 0 && getppid() == parent;
}

/* The guest's console is Whirl's standard output. */
static bool mute(bool wished) {
    const int nowhere = wished ? open("/dev/null", O_WRONLY | O_CLOEXEC) : -1;
    return !wished || (nowhere >= 0 && dup2(nowhere, STDOUT_FILENO) >= 0);
}

static _Noreturn void become(const guest *g, int down, int up, pid_t parent) {
    char shift[64];
    snprintf(shift, sizeof shift, "shift=%d,align=off,sleep=off", GUEST_SHIFT);
    if (tie_to(parent) && mute(g->request.mute) && place_line(down, up)) {
        if (g->emulated) {
            execlp("qemu-system-arm", "qemu-system-arm", "-M", g->request.board, "-display", "none",
                   "-monitor", "none", "-serial", "stdio", "-icount", shift, "-semihosting-config",
                   "enable=on,target=native", "-kernel", g->request.image, (char *)NULL);
        } else {
            execl(g->request.image, g->request.image, (char *)NULL);
        }
    }
    fprintf(stderr, "%s: error: cannot be run: %s\n",
            g->emulated ? "qemu-system-arm" : g->request.image, strerror(errno));
    fflush(stderr);
    _exit(GUEST_NOT_RUN);
}

static bool make_line(int down[2], int up[2]) {
    if (pipe(down) != 0) {
        return false;
    }
    if (pipe(up) != 0) {
        close(down[0]);
        close(down[1]);
        return false;
    }
    return fcntl(down[0], F_SETFD, FD_CLOEXEC) == 0 && fcntl(down[1], F_SETFD, FD_CLOEXEC) == 0 &&
           fcntl(up[0], F_SETFD, FD_CLOEXEC) == 0 && fcntl(up[1], F_SETFD, FD_CLOEXEC) == 0;
}

bool guest_start(guest *g, const guest_request *request) {
    *g = (guest){.request = *request, .up = -1, .down = -1};
    wh_frame_reader_start(&g->reader, g->frame, sizeof g->frame);
    if (request->by_line) {
        g->up = request->line;
        g->down = request->line;
        return true;
    }
    if (!look_at_image(request->image, &g->emulated)) {
        return false;
    }
    int down[2];
    int up[2];
    if (!make_line(down, up)) {
        fprintf(stderr, "whirl pil: error: no pipe can be made: %s\n", strerror(errno));
        return false;
    }
    signal(SIGPIPE, SIG_IGN); /* writes to a dead guest fail, and do not end Whirl */
    fflush(stdout);           /* before the guest's console writes to the same file */
    const pid_t parent = getpid();
    g->pid = fork();
    if (g->pid == 0) {
        become(g, down[0], up[1], parent);
    }
    close(down[0]);
    close(up[1]);
    g->down = down[1];
    g->up = up[0];
    if (g->pid < 0) {
        g->pid = 0;
        fprintf(stderr, "whirl pil: error: the process cannot be started: %s\n", strerror(errno));
        return false;
    }
    return true;
}

/* Waits in short intervals, because a signal just before poll() does not end poll(). */
static guest_heard wait_to_read(const guest *g, double end_s) {
    struct pollfd line = {.fd = g->up, .events = POLLIN};
    do {
        if (interrupted) {
            return GUEST_STOPPED;
        }
        if (poll(&line, 1, POLL_MS) > 0) {
            return GUEST_FRAME;
        }
    } while (system_now_s() < end_s);
    return GUEST_SILENT;
}

/* Invalid frames count as silence, so that a line with noise reaches the timeout. */
guest_heard guest_receive(guest *g, wh_frame *frame) {
    const double end_s = system_now_s() + g->request.patience_s;
    for (;;) {
        while (g->line_at < g->line_end) {
            if (wh_frame_take(&g->reader, g->line[g->line_at++], frame)) {
                return GUEST_FRAME;
            }
        }
        if (system_now_s() > end_s) {
            return interrupted ? GUEST_STOPPED : GUEST_SILENT;
        }
        const guest_heard heard = wait_to_read(g, end_s);
        if (heard != GUEST_FRAME) {
            return heard;
        }
        const ssize_t count = read(g->up, g->line, sizeof g->line);
        if (count == 0 || (count < 0 && errno != EINTR && errno != EAGAIN)) {
            return GUEST_ENDED;
        }
        g->line_at = 0;
        g->line_end = count > 0 ? (unsigned)count : 0;
    }
}

/* If a serial line is full, waits until it has space. */
guest_heard guest_send(guest *g, const uint8_t *bytes, unsigned count) {
    struct pollfd line = {.fd = g->down, .events = POLLOUT};
    for (unsigned done = 0; done < count;) {
        const ssize_t more = write(g->down, bytes + done, count - done);
        if (more < 0 && errno != EINTR && errno != EAGAIN) {
            return GUEST_ENDED;
        }
        if (more < 0 && errno == EAGAIN) {
            (void)poll(&line, 1, POLL_MS);
        }
        done += more > 0 ? (unsigned)more : 0;
        if (more < 0 && interrupted) {
            return GUEST_STOPPED;
        }
    }
    return GUEST_FRAME;
}

static void close_line(int *descriptor) {
    if (*descriptor >= 0) {
        close(*descriptor);
        *descriptor = -1;
    }
}

/* Returns false if the guest still runs after patience_s. */
static bool wait_for_end(const guest *g, int *status) {
    const double end_s = system_now_s() + g->request.patience_s;
    const struct timespec pause = {.tv_nsec = 1000000};
    pid_t ended = 0;
    do {
        ended = waitpid(g->pid, status, WNOHANG);
        if (ended == 0) {
            nanosleep(&pause, NULL);
        }
    } while (ended == 0 && system_now_s() < end_s);
    return ended != 0;
}

guest_end_status guest_end(guest *g) {
    guest_end_status end = {.status = -1};
    int status = 0;
    if (g->request.by_line) {
        g->up = -1;
        g->down = -1;
        return end;
    }
    close_line(&g->down);
    close_line(&g->up);
    if (g->pid == 0) {
        return end;
    }
    if (!wait_for_end(g, &status)) {
        end.killed = true;
        kill(g->pid, SIGKILL);
        while (waitpid(g->pid, &status, 0) < 0 && errno == EINTR) {
        }
    }
    g->pid = 0;
    if (WIFEXITED(status)) {
        end.status = WEXITSTATUS(status);
    } else if (WIFSIGNALED(status)) {
        end.signal_number = WTERMSIG(status);
        end.signal_name = strsignal(end.signal_number);
    }
    return end;
}
