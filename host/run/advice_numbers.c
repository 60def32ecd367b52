/* advice_numbers.c: see advice_numbers.h. */
#include "advice_numbers.h"

#include "host/number/functions.h"

static void say_blurred(FILE *out, const judged *j) {
    const image *im = j->image;
    if (!judged_blurred(j)) {
        return;
    }
    fprintf(out,
            "whirl run: warning: %s of '%s' is singular but for a last digit or two: rounding, in "
            "double, too, may put what it gives %.2g %% off\n"
            "hint: %s\n",
            im->has_energies ? "the mass matrix" : "what stands with the highest derivatives",
            im->mechanism, 100.0 * number_least(im->mass_blur, 1.0),
            im->has_energies ? "a coordinate that is counted from a light body to a heavy one does "
                               "that: count it from the heavy one"
                             : "two equations say nearly the same: their difference tells more");
}

static void say_folded(FILE *out, judged *j) {
    if (!judged_folded(j)) {
        return;
    }
    const component c = image_component(j->image, j->folded);
    fprintf(
        out,
        "whirl run: warning: constants of '%s' are sums in which a small one is lost beside a large "
        "one: rounding them, in double, too, may put %s%.*s %.2g %% off\n"
        "hint: %s\n",
        j->image->mechanism, j->image->unknown[c.unknown].name, c.primes + 1, "''''''''''",
        100.0 * number_least(j->folded_off, 1.0),
        j->image->has_energies
            ? "give the small one by itself; a coordinate that is counted from a light body to one "
              "that a stiff spring holds needs such sums: count it from that one, or from the ground"
            : "two equations say nearly the same: their difference tells more");
}

static void say_start(FILE *out, judged *j) {
    if (!judged_start(j)) {
        return;
    }
    const component c = image_component(j->image, j->start);
    fprintf(
        out,
        "whirl run: warning: the initial value of %s%.*s of '%s' is computed of sums in which a "
        "small one is lost beside a large one: rounding them, in double, too, may put it %.2g %% off\n"
        "hint: give the small one by itself\n",
        j->image->unknown[c.unknown].name, c.primes, "''''''''''", j->image->mechanism,
        100.0 * number_least(j->start_off, 1.0));
}

static void say_contacts(FILE *out, judged *j) {
    if (judged_contacts(j)) {
        fprintf(
            out,
            "whirl run: warning: numbers of the contacts of '%s' are computed of sums in which a "
            "small one is lost beside a large one: rounding them, in double, too, may put one %.2g "
            "%% off\n"
            "hint: give the small one by itself\n",
            j->image->mechanism, 100.0 * number_least(j->contacts_off, 1.0));
    }
}

static void say_unbounded(FILE *out, const judged *j) {
    if (j->image->unbounded) {
        fprintf(
            out,
            "whirl run: warning: numbers of '%s' are computed of sums in which a small one is lost "
            "beside a large one: rounding them, in double, too, may put one beyond all bounds\n"
            "hint: give the small one by itself\n",
            j->image->mechanism);
    }
}

void advice_numbers_say(FILE *out, judged *j) {
    say_blurred(out, j);
    say_folded(out, j);
    say_start(out, j);
    say_contacts(out, j);
    say_unbounded(out, j);
}
