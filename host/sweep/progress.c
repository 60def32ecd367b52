/* progress.c: drawing the progress of a sweep. */
#include "progress.h"

#include <time.h>

enum { BAR_WIDTH = 30 };
#define SHOW_EVERY_S 0.2

static double now_s(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

progress progress_start(FILE *out, uint64_t from, uint64_t end) {
    return (progress){.out = out, .from = from, .end = end, .start_s = now_s()};
}

double progress_elapsed_s(const progress *p) { return now_s() - p->start_s; }

void progress_show(progress *p, uint64_t done) {
    const double now = now_s();
    if (p->out == NULL || now - p->shown_s < SHOW_EVERY_S) {
        return;
    }
    p->shown_s = now;
    p->drawn = true;
    const double part = p->end > 0 ? (double)done / (double)p->end : 1.0;
    const double rate = (double)(done - p->from) / (now - p->start_s);
    char bar[BAR_WIDTH + 1];
    for (int i = 0; i < BAR_WIDTH; i++) {
        bar[i] = (double)i < part * BAR_WIDTH ? '#' : '.';
    }
    bar[BAR_WIDTH] = '\0';
    fprintf(p->out, "\r%5.1f %% [%s] %llu/%llu", 100.0 * part, bar, (unsigned long long)done,
            (unsigned long long)p->end);
    if (done > p->from && rate > 0.0) {
        const double left_s = (double)(p->end - done) / rate;
        fprintf(p->out, "  %.3g points/s  %.0f:%02.0f:%02.0f to go  ", rate,
                (double)(long)(left_s / 3600.0), (double)((long)(left_s / 60.0) % 60),
                (double)((long)left_s % 60));
    }
    fflush(p->out);
}

void progress_clear(progress *p) {
    if (p->drawn) {
        fprintf(p->out, "\r%*s\r", BAR_WIDTH + 70, "");
        fflush(p->out);
        p->drawn = false;
    }
}
