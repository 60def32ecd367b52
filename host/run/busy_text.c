/* busy_text.c: see busy_text.h. */
#include "busy_text.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "core/contact.h"
#include "host/base/room.h"
#include "host/base/statement.h"
#include "step_text.h"

static char *quoted(const image *im, int contact) {
    char text[STATEMENT_SIZE];
    statement_text(im->contact[contact].at, text, sizeof text);
    return room_words("'%s'", text);
}

/* The contact with the most events in steps that overran, but for `besides`; -1: none had any. */
static int busiest(const busy *b, int besides) {
    int found = -1;
    for (int k = 0; k < b->image->contacts; k++) {
        if (k != besides && b->in_overruns[k] > 0 &&
            (found < 0 || b->in_overruns[k] > b->in_overruns[found])) {
            found = k;
        }
    }
    return found;
}

static double time_of(const busy *b, uint64_t steps) { return ratio_times(steps, b->image->step); }

static void say_overruns(FILE *out, const char *who, const busy *b) {
    const int first = busiest(b, -1);
    const int second = first < 0 ? -1 : busiest(b, first);
    char *most = first < 0 ? room_words("what shares a load") : quoted(b->image, first);
    char *other = second < 0 ? NULL : quoted(b->image, second);
    fprintf(out,
            "%s: %" PRIu64 " step%s of %" PRIu64
            ", the first at t = %.6g s, had more than %d moments with events, most of %s%s%s: what "
            "was left of %s counts as rest or sticking",
            who, b->overruns, b->overruns == 1 ? "" : "s", b->steps, time_of(b, b->overran_at),
            WH_EVENTS_MAX, most, other != NULL ? " and " : "", other != NULL ? other : "",
            b->overruns == 1 ? "it" : "them");
    free(most);
    free(other);
}

static void say_chatter(FILE *out, const char *who, const busy *b) {
    char *name = quoted(b->image, b->chatters);
    fprintf(out,
            "%s: %s changes at the pace of the steps, in %" PRIu64 " of %" PRIu64
            " steps from t = %.6g s on",
            who, name, b->changes[b->chatters], b->steps - b->chatters_at,
            time_of(b, b->chatters_at));
    free(name);
}

/* What of the scene brings it about, where no step helps. */
static void say_scene(FILE *out, const busy *b, const retrial *r) {
    const int busy_one = b->overruns > 0 ? busiest(b, -1) : b->chatters;
    const int k = busy_one < 0 ? 0 : busy_one;
    char *name = quoted(b->image, k);
    char text[STEP_WORD];
    const double finest_s = ratio_times(1, b->image->step) / (double)r->finest;
    const char *step = step_text(finest_s, text);
    fprintf(out, "hint: steps down to %s do not resolve it; ", step);
    switch ((wh_contact_kind)b->image->contact[k].kind) {
    case WH_STOP: fprintf(out, "restitution 0 of %s ends its bounces\n", name); break;
    case WH_HOLD:
        fprintf(out, "let the condition of %s take longer to come true again once it has held\n",
                name);
        break;
    case WH_FRICTION:
        fprintf(out,
                "a static friction that it does not break, or a softer drive, ends what %s does\n",
                name);
        break;
    case WH_WHEN:
    case WH_CONTACT_KIND_COUNT:
        fprintf(out, "let %s set what takes longer to cross again\n", name);
        break;
    }
    free(name);
}

static void say_cure(FILE *out, const busy *b, const retrial *r, const busy_cure *cure) {
    char text[STEP_WORD];
    char own[STEP_WORD + 8];
    snprintf(own, sizeof own, "--step %s",
             step_text(ratio_times(1, b->image->step) / (double)r->parts, text));
    static const char *const does[] = {
        [CURE_DOES] = "would do",
        [CURE_DOES_NOT] = "resolves that, but is not all that it takes",
        [CURE_ROUNDS] = "resolves that, but is not all that it takes",
        [CURE_NOT_TRIED] = "resolves that; whether that is all was not tried: it takes long"};
    const cure_outcome outcome = cure == NULL ? CURE_DOES : cure->outcome;
    fprintf(out, "hint: %s %s%s\n", cure != NULL && outcome == CURE_DOES ? cure->options : own,
            does[outcome],
            r->agreed ? "" : ", as far as the steps go: still finer ones end elsewhere");
}

void busy_say(FILE *out, const char *who, const busy *b, const retrial *r, const busy_cure *cure) {
    if (!r->told) {
        return;
    }
    if (b->overruns > 0) {
        say_overruns(out, who, b);
    } else {
        say_chatter(out, who, b);
    }
    if (r->known) {
        fprintf(out, "; finer steps end elsewhere, by %.2g of a coordinate's range", r->off);
    }
    fputc('\n', out);
    if (r->parts > 0) {
        say_cure(out, b, r, cure);
    } else if (r->finest > 1) {
        say_scene(out, b, r);
    } else {
        fputs("hint: a smaller --step; which was not tried, as it takes longer than a second\n",
              out);
    }
}
