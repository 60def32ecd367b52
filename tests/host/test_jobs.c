/* test_jobs.c: worker processes of a sweep (host/os/jobs.h). Rows must come in sequence, whichever worker ends
 * first. Also a lost worker, refused rows, and a low limit of open files. */
#include "test.h"

#include <signal.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "blocks.h"
#include "command.h"
#include "host/base/alloc.h"
#include "host/os/jobs.h"
#include "host/study/session.h"

enum { FIRST = 5, END = 205, ENOUGH = 40 };

typedef struct log_of_rows {
    uint64_t next;
    bool in_order;
    bool as_worked;
    uint64_t failed;
    uint64_t limit; /* refuse all rows after this point */
} log_of_rows;

/* Writes a row of up to 200 kB, which is more than a pipe can hold. */
static bool quick_work(void *context, uint64_t point, FILE *row, FILE *reason) {
    (void)context;
    for (uint64_t i = 0; i < (point % 50 == 0 ? 20000U : 1U); i++) {
        fprintf(row, "%10llu", (unsigned long long)point);
    }
    if (point % 10 == 3) {
        fprintf(reason, "bad %llu", (unsigned long long)point);
    }
    return point % 10 != 3;
}

/* Sleeps less for a larger point % 8, so that points do not end in sequence. */
static bool slow_work(void *context, uint64_t point, FILE *row, FILE *reason) {
    const struct timespec nap = {0, (long)(7 - point % 8) * 300000};
    nanosleep(&nap, NULL);
    return quick_work(context, point, row, reason);
}

/* One point of forty takes so long that the other workers reach their limit before this point's row is written. */
static bool held_up_work(void *context, uint64_t point, FILE *row, FILE *reason) {
    const struct timespec nap = {0, 30000000L};
    if (point % 40 == 7) {
        nanosleep(&nap, NULL);
    }
    return quick_work(context, point, row, reason);
}

static bool note(void *context, uint64_t point, bool good, const char *row, const char *reason) {
    log_of_rows *log = context;
    char wanted[40];
    snprintf(wanted, sizeof wanted, "%10llu", (unsigned long long)point);
    log->in_order = log->in_order && point == log->next;
    log->as_worked = log->as_worked && strncmp(row, wanted, 10) == 0 &&
                     strlen(row) == (point % 50 == 0 ? 200000U : 10U);
    snprintf(wanted, sizeof wanted, "bad %llu", (unsigned long long)point);
    log->as_worked = log->as_worked && strcmp(reason, good ? "" : wanted) == 0;
    log->failed += good ? 0 : 1;
    log->next++;
    return log->next < log->limit;
}

static bool go_on(void *context, uint64_t next) {
    const log_of_rows *log = context;
    return next == log->next;
}

static int open_files(void) {
    int count = 0;
    for (int i = 0; i < 200; i++) {
        const int copy = dup(i);
        count += copy >= 0 ? 1 : 0;
        if (copy >= 0) {
            close(copy);
        }
    }
    return count;
}

static jobs_result run_rows(log_of_rows *log, uint64_t limit, int workers,
                            bool (*work)(void *, uint64_t, FILE *, FILE *)) {
    *log = (log_of_rows){.next = FIRST, .in_order = true, .as_worked = true, .limit = limit};
    const jobs plan = {.workers = workers,
                       .first = FIRST,
                       .end = END,
                       .context = log,
                       .work = work,
                       .deliver = note,
                       .pause = go_on};
    const int before = open_files();
    const long blocks = blocks_in_use();
    const jobs_result result = jobs_run(&plan);
    TEST_ASSERT_EQUAL_INT(before, open_files());
    TEST_ASSERT_TRUE(blocks_in_use() == blocks);
    return result;
}

TEST(jobs, rows_are_in_order) {
    static const int workers[] = {1, 2, 3, 5, 16};
    for (size_t i = 0; i < 2 * sizeof workers / sizeof workers[0]; i++) {
        log_of_rows log;
        TEST_ASSERT_EQUAL_INT(JOBS_DONE, (int)run_rows(&log, END + 1, workers[i / 2],
                                                       i % 2 == 0 ? slow_work : held_up_work));
        TEST_ASSERT_TRUE(log.in_order && log.as_worked && log.next == END);
        TEST_ASSERT_TRUE(log.failed == (END - FIRST) / 10);
    }
}

TEST(jobs, refused_rows_end_the_work) {
    log_of_rows log;
    TEST_ASSERT_EQUAL_INT(JOBS_REFUSED, (int)run_rows(&log, ENOUGH, 3, slow_work));
    TEST_ASSERT_TRUE(log.next == ENOUGH);
}

static bool die_at_20(void *context, uint64_t point, FILE *row, FILE *reason) {
    if (point == 20) {
        raise(SIGKILL);
    }
    return slow_work(context, point, row, reason);
}

TEST(jobs, a_lost_worker_is_noticed) {
    log_of_rows log;
    TEST_ASSERT_EQUAL_INT(JOBS_WORKER_LOST, (int)run_rows(&log, END + 1, 2, die_at_20));
    TEST_ASSERT_TRUE(log.in_order && log.next <= 20);
}

/* With a low limit of open files, fewer workers must deliver all rows, or there must be an error. No file or memory
 * block may leak. */
TEST(jobs, few_files) {
    struct rlimit usual;
    int done = 0;
    const int before = open_files();
    const long blocks = blocks_in_use();
    TEST_ASSERT_EQUAL_INT(0, getrlimit(RLIMIT_NOFILE, &usual));
    for (int more = 0; more < 14; more++) {
        log_of_rows log;
        struct rlimit few = usual;
        errors_catch();
        few.rlim_cur = (rlim_t)(open_files() + more);
        TEST_ASSERT_EQUAL_INT(0, setrlimit(RLIMIT_NOFILE, &few));
        const jobs_result result = run_rows(&log, END + 1, 5, quick_work);
        TEST_ASSERT_EQUAL_INT(0, setrlimit(RLIMIT_NOFILE, &usual));
        const char *told = errors_caught();
        if (result == JOBS_DONE) {
            TEST_ASSERT_EQUAL_STRING("", told);
            TEST_ASSERT_TRUE(log.in_order && log.as_worked && log.next == END);
            done++;
        } else {
            TEST_ASSERT_EQUAL_INT(JOBS_WORKER_LOST, (int)result);
            TEST_ASSERT_EQUAL_STRING(
                "whirl sweep: error: no worker could be started: Too many open files\n", told);
            TEST_ASSERT_TRUE(more < 4 && log.next == FIRST);
        }
        TEST_ASSERT_EQUAL_INT(before, open_files());
    }
    TEST_ASSERT_TRUE(done >= 10 && done < 14);
    TEST_ASSERT_TRUE(blocks_in_use() == blocks);
}

static volatile sig_atomic_t caught;

static void catch (int signal) { caught = signal; }

/* Ctrl-C sends the signal to all processes of a terminal. A worker must go on, because the parent decides when
 * workers end. */
static bool interrupted_work(void *context, uint64_t point, FILE *row, FILE *reason) {
    raise(SIGINT);
    return quick_work(context, point, row, reason);
}

TEST(jobs, interrupts_are_the_parent_s) {
    log_of_rows log;
    void (*const before)(int) = signal(SIGINT, SIG_DFL);
    TEST_ASSERT_EQUAL_INT(JOBS_DONE, (int)run_rows(&log, END + 1, 3, interrupted_work));
    signal(SIGINT, before);
    TEST_ASSERT_TRUE(log.in_order && log.as_worked && log.next == END);
}

static bool endless_work(void *context, uint64_t point, FILE *row, FILE *reason) {
    const struct timespec nap = {0, 20000000L};
    for (int i = 0; i < 250 && point != FIRST; i++) { /* takes at least 5 s, unless it is stopped */
        nanosleep(&nap, NULL);
    }
    return quick_work(context, point, row, reason);
}

TEST(jobs, workers_can_be_stopped) {
    log_of_rows log;
    struct timespec begin;
    struct timespec end;
    void (*const before)(int) = signal(SIGTERM, catch);
    clock_gettime(CLOCK_MONOTONIC, &begin);
    TEST_ASSERT_EQUAL_INT(JOBS_REFUSED, (int)run_rows(&log, FIRST + 1, 3, endless_work));
    clock_gettime(CLOCK_MONOTONIC, &end);
    signal(SIGTERM, before);
    TEST_ASSERT_EQUAL_INT(0, caught);
    TEST_ASSERT_TRUE(log.next == FIRST + 1 && end.tv_sec - begin.tv_sec < 4);
}

/* Tests of the progress line of a sweep (host/study/session.h): percentage, pace, and remaining time at that
 * pace. */
TEST(jobs, progress_line) {
    static const struct {
        double ago_s;
        uint64_t from, done, end;
        const char *line;
    } rows[] = {{100.0, 0, 50, 100, "\r 50.0 % 50/100  0.5 points/s  0:01:40 to go  "},
                {1000.0, 40, 240, 3000, "\r  8.0 % 240/3000  0.2 points/s  3:50:00 to go  "},
                {5.0, 7, 7, 9, "\r 77.8 % 7/9"},
                {5.0, 0, 8, 8, "\r100.0 % 8/8  1.6 points/s  0:00:00 to go  "},
                {5.0, 0, 0, 8, "\r  0.0 % 0/8"},
                {5.0, 0, 0, 0, "\r100.0 % 0/0"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char *shown;
        size_t length;
        FILE *out = alloc_text(&shown, &length);
        sweep_progress(out, rows[i].from, rows[i].done, rows[i].end, rows[i].ago_s);
        alloc_text_end(out);
        TEST_ASSERT_EQUAL_STRING(rows[i].line, shown);
        free(shown);
    }
}
