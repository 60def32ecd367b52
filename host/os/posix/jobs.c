/* jobs.c: workers, their pipes, and the order of rows. */
#include "host/os/jobs.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/os/system.h"

#define AHEAD 8U /* pool.window / number of workers */
#define PAUSE_MS 50
#define ASK_US 200000

/* The head of a worker's answer; the row and the reason follow. */
typedef struct answer {
    uint64_t point;
    uint64_t row_length;
    uint64_t reason_length;
    bool good;
} answer;

typedef struct worker {
    pid_t pid;
    int results; /* read end of the worker's pipe; -1 after its end */
    char *bytes; /* received, not yet evaluated */
    size_t length;
    size_t room;
} worker;

typedef struct slot {
    char *row; /* NULL: not received. The allocation also holds `reason`. */
    const char *reason;
    bool good;
} slot;

typedef struct pool {
    const jobs *jobs;
    worker *workers;
    int started;
    /* The pipe of points' numbers. The parent keeps its read end open, so that writes never raise SIGPIPE. */
    int tickets[2];
    slot *slots;     /* [window]; a point uses slots[point % window] */
    uint64_t window; /* largest number of points that are sent and not yet delivered */
    uint64_t sent;
    uint64_t delivered; /* all points below this are delivered */
} pool;

/* --- in a worker -------------------------------------------------------------------------------*/

static pid_t parent;

/* Signal handler: interrupts the worker if its parent has ended. */
static void ask_for_parent(int signal_number) {
    (void)signal_number;
    interrupted = getppid() != parent;
}

static bool write_all(int to, const void *bytes, size_t length) {
    const char *at = bytes;
    while (length > 0) {
        const ssize_t done = write(to, at, length);
        if (done < 0 && errno != EINTR) {
            return false;
        }
        at += done > 0 ? done : 0;
        length -= done > 0 ? (size_t)done : 0;
    }
    return true;
}

static void work(const jobs *j, int tickets, int results) {
    uint64_t point;
    /* Reads and writes of 8 bytes (below PIPE_BUF) are never partial. */
    while (read(tickets, &point, sizeof point) == (ssize_t)sizeof point) {
        char *text[2] = {NULL, NULL};
        size_t length[2] = {0, 0};
        FILE *row = alloc_text(&text[0], &length[0]);
        FILE *reason = alloc_text(&text[1], &length[1]);
        answer a;
        memset(&a, 0, sizeof a); /* also clears the padding, which is sent */
        a.point = point;
        a.good = j->work(j->context, point, row, reason);
        alloc_text_end(row);
        alloc_text_end(reason);
        a.row_length = length[0];
        a.reason_length = length[1];
        const bool sent = write_all(results, &a, sizeof a) &&
                          write_all(results, text[0], length[0]) &&
                          write_all(results, text[1], length[1]);
        free(text[0]);
        free(text[1]);
        if (!sent || interrupted) {
            break;
        }
    }
}

/* --- in the parent -----------------------------------------------------------------------------*/

static bool start_worker(pool *p) {
    int results[2];
    if (pipe(results) != 0) {
        return false;
    }
    fflush(NULL); /* the child must not have a copy of buffered text */
    /* signals wait until the child has its own handlers */
    sigset_t both;
    sigset_t usual;
    sigemptyset(&both);
    sigaddset(&both, SIGINT);
    sigaddset(&both, SIGTERM);
    sigprocmask(SIG_BLOCK, &both, &usual);
    const pid_t pid = fork();
    if (pid == 0) {
        signal(SIGINT, SIG_IGN); /* on Ctrl-C, the parent ends its workers */
        signal(SIGTERM, SIG_DFL);
        sigaction(SIGALRM,
                  &(struct sigaction){.sa_handler = ask_for_parent, .sa_flags = SA_RESTART}, NULL);
        setitimer(ITIMER_REAL, &(struct itimerval){{0, ASK_US}, {0, ASK_US}}, NULL);
        sigprocmask(SIG_SETMASK, &usual, NULL);
        close(p->tickets[1]);
        close(results[0]);
        for (int i = 0; i < p->started; i++) {
            close(p->workers[i].results);
        }
        work(p->jobs, p->tickets[0], results[1]);
        _exit(0);
    }
    sigprocmask(SIG_SETMASK, &usual, NULL);
    close(results[1]);
    if (pid < 0) {
        close(results[0]);
        return false;
    }
    p->workers[p->started++] = (worker){.pid = pid, .results = results[0]};
    return true;
}

static bool start(pool *p) {
    if (pipe(p->tickets) != 0) {
        return false;
    }
    parent = getpid();
    while (p->started < p->jobs->workers && start_worker(p)) {
    }
    return p->started > 0;
}

/* Moves complete answers to their slots. */
static void take_answers(pool *p, worker *w) {
    size_t at = 0;
    answer a;
    while (w->length - at >= sizeof a) {
        memcpy(&a, w->bytes + at, sizeof a);
        const size_t row = (size_t)a.row_length;
        const size_t reason = (size_t)a.reason_length;
        if (w->length - at - sizeof a < row + reason) {
            break;
        }
        char *text = alloc((int64_t)(row + reason + 2), 1);
        memcpy(text, w->bytes + at + sizeof a, row);
        memcpy(text + row + 1, w->bytes + at + sizeof a + row, reason);
        p->slots[a.point % p->window] = (slot){text, text + row + 1, a.good};
        at += sizeof a + row + reason;
    }
    w->length -= at;
    memmove(w->bytes, w->bytes + at, w->length);
}

/* Returns false, with the pipe closed, if the worker has ended. */
static bool listen_to(pool *p, worker *w) {
    if (w->room - w->length < 65536) {
        w->room = 2 * w->room + 65536;
        w->bytes = alloc_more(w->bytes, (int64_t)w->room, 1);
    }
    const ssize_t got = read(w->results, w->bytes + w->length, w->room - w->length);
    if (got < 0 && errno == EINTR) {
        return true;
    }
    if (got <= 0) {
        close(w->results);
        w->results = -1;
        return false;
    }
    w->length += (size_t)got;
    take_answers(p, w);
    return true;
}

/* Delivers rows in order, as far as they are complete. */
static bool deliver(pool *p) {
    for (;;) {
        slot *next = &p->slots[p->delivered % p->window];
        if (p->delivered == p->jobs->end || next->row == NULL) {
            return true;
        }
        const bool go_on =
            p->jobs->deliver(p->jobs->context, p->delivered, next->good, next->row, next->reason);
        free(next->row);
        *next = (slot){0};
        p->delivered++;
        if (!go_on) {
            return false;
        }
    }
}

static jobs_result attend(pool *p) {
    const jobs *j = p->jobs;
    struct pollfd *ears = alloc(p->started, sizeof *ears);
    jobs_result result = JOBS_DONE;
    while (p->delivered < j->end && result == JOBS_DONE) {
        while (p->sent < j->end && p->sent < p->delivered + p->window &&
               write_all(p->tickets[1], &p->sent, sizeof p->sent)) {
            p->sent++;
        }
        for (int i = 0; i < p->started; i++) {
            ears[i] = (struct pollfd){.fd = p->workers[i].results, .events = POLLIN};
        }
        const int heard = poll(ears, (nfds_t)p->started, PAUSE_MS);
        for (int i = 0; i < p->started && heard > 0; i++) {
            if (ears[i].revents != 0 && !listen_to(p, &p->workers[i])) {
                result = JOBS_WORKER_LOST;
            }
        }
        if (!deliver(p) || !j->pause(j->context, p->delivered)) {
            result = JOBS_REFUSED;
        } else if (interrupted) {
            result = p->delivered < j->end ? JOBS_STOPPED : JOBS_DONE;
        } else if (p->delivered == j->end) {
            result = JOBS_DONE;
        }
    }
    free(ears);
    return result;
}

int jobs_workers(void) {
    const long online = sysconf(_SC_NPROCESSORS_ONLN);
    return online < 1 ? 1 : online > JOBS_WORKERS_MAX ? JOBS_WORKERS_MAX : (int)online;
}

jobs_result jobs_run(const jobs *j) {
    pool p = {.jobs = j, .tickets = {-1, -1}, .sent = j->first, .delivered = j->first};
    p.window = AHEAD * (uint64_t)j->workers;
    p.workers = alloc(j->workers, sizeof *p.workers);
    p.slots = alloc((int64_t)p.window, sizeof *p.slots);
    jobs_result result = JOBS_WORKER_LOST;
    if (start(&p)) {
        result = attend(&p);
    } else {
        fprintf(stderr, "whirl sweep: error: no worker could be started: %s\n", strerror(errno));
    }
    close(p.tickets[0]);
    close(p.tickets[1]);
    for (int i = 0; i < p.started; i++) {
        if (result != JOBS_DONE) {
            kill(p.workers[i].pid, SIGTERM);
        }
        if (p.workers[i].results >= 0) {
            close(p.workers[i].results);
        }
        while (waitpid(p.workers[i].pid, NULL, 0) < 0 && errno == EINTR) {
        }
        free(p.workers[i].bytes);
    }
    for (uint64_t i = 0; i < p.window; i++) {
        free(p.slots[i].row);
    }
    free(p.workers);
    free(p.slots);
    return result;
}
