#include "finding.h"

#include "apart.h"
#include "core/state.h"
#include "energy_residual.h"
#include "host/check/horizon.h"
#include "slow.h"

_Static_assert(WH_EVENTS_MAX == 8, "messages in finding.c, horizon.c and choice.c say eight");

const finding_row finding_rows[FINDINGS] = {
    [FINDING_MASS] =
        {"mass", FINDING_WARNING, 1e-4, "of an acceleration",
         "an upper bound on the error from rounding the matrix; the real error is smaller",
         "have a mass matrix that is nearly singular"},
    [FINDING_CONSTANTS] =
        {"constants", FINDING_WARNING, 0.0, "numbers",
         "a value becomes infinite or undefined if the file's numbers are rounded differently",
         "have constants that add a small number to a large one, and lose it in rounding"},
    [FINDING_ENERGY] =
        {"energy", FINDING_WARNING, ENERGY_RESIDUAL_LIMIT, "of the largest entry",
         "a relative energy error of this size is an amplitude error of half the size: too small to see in a plot",
         "fail the energy balance: the residual exceeds its limit at the end or before (column " ENERGY_RESIDUAL_COLUMN
         ")"},
    [FINDING_ACCURACY] =
        {"accuracy", FINDING_WARNING, 0.5, "of the run",
         "an error that grows steadily, and is 1 % at half of the run, is 2 % at the end",
         "have a coordinate or rate with a sudden error, or with an error above 1 % of its range in the first half of the run"},
    [FINDING_POLE] = {"pole", FINDING_WARNING, 0.0, "steps", "no motion continues through a pole",
                      "jumped over a pole of an expression"},
    [FINDING_MISSED] = {"missed", FINDING_WARNING, 0.0, "steps",
                        "the run ignores a contact or force that acts only between two evaluations",
                        "missed, or may have missed, a contact or a brief force"},
    [FINDING_ALIASED] = {"aliased", FINDING_WARNING, HORIZON_TOLERANCE, "of a range",
                         "the tolerance of a trusted run, plus the error of the steps",
                         "alias a force or motion that is faster than the step"},
    [FINDING_EVENTS] = {"events", FINDING_WARNING, 0.0, "steps",
                        "Whirl completes such a step with all loaded contacts at rest or sticking",
                        "had steps with more than eight moments with events"},
    [FINDING_APART] = {"apart", FINDING_WARNING, APART_LEAST, "of the terms of the held expression",
                       "rounding a start to decimal digits violates a hold by less than this",
                       "have holds that the start violates"},
    [FINDING_DIGITS] =
        {"digits", FINDING_NOTE, SLOW_SHARE,
         "of the distance that the component "
         "should cover",
         "the round-off of all steps together may be this large",
         "have a coordinate or rate that changes in a step by less than its resolution"},
};

void finding_say_names(FILE *out, unsigned ids) {
    const char *before = "";
    for (int id = 0; id < FINDINGS; id++) {
        if ((ids & FINDING_BIT(id)) != 0) {
            fprintf(out, "%s[%s]", before, finding_rows[id].word);
            before = " ";
        }
    }
}

void finding_say_status(FILE *out, const char *command, unsigned fails) {
    fprintf(out, "whirl %s: exit status 1 because of ", command);
    finding_say_names(out, fails);
    fputs(" (0 with --strict=off)\n", out);
}
