/* fault_text.c: faults in words. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fault.h"
#include "host/base/nearest.h"
#include "host/base/room.h"
#include "host/number/decimal.h"
#include "host/number/functions.h"

#define FAULT_ROW(which, word, place, size, least, most, unit, words) \
    {word, place, size, least, most, unit, words},
const fault_row fault_rows[FAULT_KINDS] = {FAULT_ROWS(FAULT_ROW)};
#undef FAULT_ROW

/* What one fault's words are read from; `at` goes on, up to `end`. */
typedef struct words_of_fault {
    const char *begin;
    const char *at;
    const char *end;
} words_of_fault;

static bool wrong(const words_of_fault *w, const char *what, const char *hint) {
    fprintf(stderr, "whirl pil: error: --fault %.*s: %s\nhint: %s\n", (int)(w->end - w->begin),
            w->begin, what, hint);
    return false;
}

static bool takes(words_of_fault *w, char mark) {
    const bool is = w->at < w->end && *w->at == mark;
    w->at += is;
    return is;
}

static bool read_number(words_of_fault *w, double *number) {
    const char *end = w->at;
    *number = decimal_read(w->at, &end);
    const bool good = end > w->at && end <= w->end && isfinite(*number);
    w->at = good ? end : w->at;
    return good;
}

/* 20us, 1.5ms, 0.2s, or 0.2. */
static bool read_time(words_of_fault *w, double *time_s) {
    static const struct {
        const char *word;
        double s;
    } units[] = {{"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}};
    if (!read_number(w, time_s)) {
        return false;
    }
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        const size_t length = strlen(units[i].word);
        if ((size_t)(w->end - w->at) >= length && strncmp(w->at, units[i].word, length) == 0) {
            *time_s *= units[i].s;
            w->at += length;
            break;
        }
    }
    return *time_s >= 0.0;
}

static bool read_kind(words_of_fault *w, fault_case *f) {
    const size_t length = strcspn(w->begin, ":=@+,");
    nearest search = nearest_start(w->begin, length);
    for (int i = 0; i < FAULT_KINDS; i++) {
        const char *word = fault_rows[i].word;
        nearest_offer(&search, word);
        if (strlen(word) == length && strncmp(word, w->begin, length) == 0) {
            f->kind = (fault_kind)i;
            f->size = fault_rows[i].size;
            w->at = w->begin + length;
            return true;
        }
    }
    char *hint = search.best != NULL ? room_words("did you mean '%s'?", search.best)
                                     : room_words("whirl pil --faults lists the kinds");
    wrong(w, "no kind of fault is called so", hint);
    free(hint);
    return false;
}

static bool read_channel(words_of_fault *w, fault_case *f) {
    const fault_place at = fault_rows[f->kind].place;
    double number;
    f->channel = -1;
    if (!takes(w, ':')) {
        return true;
    }
    if (at != FAULT_EDGES && at != FAULT_SAMPLES && at != FAULT_SENSORS) {
        return wrong(w, "it has no channels", "leave :CHANNEL out");
    }
    if (!read_number(w, &number) || !(number >= 1.0 && number <= (double)WH_SIGNALS_MAX) ||
        number != number_floor(number)) {
        return wrong(w, "no such channel", "channels count from 1, such as edge-dead:2");
    }
    f->channel = (int)number - 1;
    return true;
}

static bool read_size(words_of_fault *w, fault_case *f) {
    const fault_row *row = &fault_rows[f->kind];
    if (!takes(w, '=')) {
        return true;
    }
    if (!(row->least < row->most)) {
        return wrong(w, "it has no size", "leave =SIZE out");
    }
    if (!(strcmp(row->unit, "s") == 0 && *w->at != '-' ? read_time(w, &f->size)
                                                       : read_number(w, &f->size)) ||
        !(f->size >= row->least && f->size <= row->most)) {
        char *hint = room_words("a number from %g to %g%s%s", row->least, row->most,
                                row->unit[0] != '\0' ? " " : "", row->unit);
        wrong(w, "no such size", hint);
        free(hint);
        return false;
    }
    return true;
}

static bool read_when(words_of_fault *w, fault_case *f) {
    static const char hint[] = "@1.5s, @state=4, or @state=4~200ms: so long after that";
    if (!takes(w, '@')) {
        return true;
    }
    if (fault_rows[f->kind].place == FAULT_PARAMETER) {
        return wrong(w, "it is there from the start to the end", "leave @WHEN out");
    }
    const size_t length = strcspn(w->at, "=,+~");
    if (w->at[length] != '=') {
        return read_time(w, &f->after_s) || wrong(w, "no such time", hint);
    }
    if (length == 0 || length >= sizeof f->note) {
        return wrong(w, "no such note", hint);
    }
    memcpy(f->note, w->at, length);
    w->at += length + 1;
    return (read_number(w, &f->value) && (!takes(w, '~') || read_time(w, &f->after_s))) ||
           wrong(w, "no such time", hint);
}

static bool read_duration(words_of_fault *w, fault_case *f) {
    f->duration_s = (double)INFINITY;
    if (!takes(w, '+')) {
        return true;
    }
    const bool lasts = fault_rows[f->kind].place != FAULT_PARAMETER && f->kind != FAULT_RESET;
    return (lasts && read_time(w, &f->duration_s)) ||
           wrong(w, "no such duration", "a time, such as +500ms");
}

static bool read_one(fault_plan *plan, words_of_fault *w) {
    fault_case *f = &plan->fault[plan->count];
    if (plan->count == FAULTS_MAX) {
        return wrong(w, "too many faults", "sixteen at most");
    }
    *f = (fault_case){.note_at = -1};
    if (!read_kind(w, f) || !read_channel(w, f) || !read_size(w, f) || !read_when(w, f) ||
        !read_duration(w, f)) {
        return false;
    }
    plan->count++;
    return w->at == w->end ||
           wrong(w, "what is behind it?", "KIND[:CHANNEL][=SIZE][@WHEN][+DURATION]");
}

bool fault_read(fault_plan *plan, const char *text) {
    for (const char *at = text; at != NULL;) {
        const char *end = at + strcspn(at, ",");
        words_of_fault w = {at, at, end};
        if (!read_one(plan, &w)) {
            return false;
        }
        at = *end == ',' ? end + 1 : NULL;
    }
    return true;
}

char *fault_parameter(const fault_plan *plan, unsigned i) {
    const fault_case *f = &plan->fault[i];
    const fault_row *row = &fault_rows[f->kind];
    return row->place == FAULT_PARAMETER ? room_words("%s=%.17g", row->word, f->size) : NULL;
}

void fault_print_kinds(FILE *out) {
    for (int i = 0; i < FAULT_KINDS; i++) {
        const fault_row *row = &fault_rows[i];
        char size[48] = "";
        if (row->least < row->most) {
            snprintf(size, sizeof size, "=%g%s%s", row->size, row->unit[0] != '\0' ? " " : "",
                     row->unit);
        }
        fprintf(out, "    %-16s%-10s %s\n", row->word, size, row->words);
    }
}
