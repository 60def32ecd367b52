/* again.c: see again.h. */
#include "again.h"

/* Books, and what looks for events evaluates, in a step's evaluations. */
#define WATCHED_AS 2.0
#define EVENTS_AS 8.0

double again_operations_a_step(const image *im) {
    const double evaluation = im->list[IMAGE_STEP]->count + AGAIN_BESIDE;
    const tape *kept = im->list[IMAGE_BOOKS];
    const double watched = kept != NULL ? kept->count + AGAIN_BESIDE : evaluation;
    const double stages =
        wh_methods[im->settings.method].stages + (im->contacts > 0 ? EVENTS_AS : 0.0);
    return stages * evaluation + WATCHED_AS * watched;
}

void again_run(again *a, const image *im, const engine_kind *kind,
               const volatile sig_atomic_t *stop) {
    *a = (again){.image = *im, .kind = kind};
    a->run = kind->start(&a->image);
    a->books = books_open(&a->image);
    a->watch = watch_open(&a->image, kind);
    bool good = true;
    for (; a->steps <= im->steps && good && !a->stopped; a->steps++) {
        good = a->steps == 0 || kind->step(a->run) == WH_OK;
        if (good && a->books != NULL) {
            books_enter(a->books, kind, a->run);
        }
        if (good) {
            watch_enter(a->watch, kind, a->books, a->run);
            good = !jumped_some(a->watch->jumped);
        }
        a->stopped = stop != NULL && *stop;
    }
    a->done = good && !a->stopped;
    a->balance = belief_of(a->books, kind, a->run);
}

void again_forget(again *a) {
    watch_close(a->watch);
    books_close(a->books);
    a->kind->stop(a->run);
}
