#include "energy_residual.h"

#include <math.h>
#include <stdlib.h>

#include "host/base/alloc.h"
#include "host/base/diag.h"
#include "host/number/functions.h"

/* === the run's own ledger (core/ledger.h) ====================================================== */

typedef enum entry_source {
    SOURCE_ENERGIES, /* the term dL/dq in a momentum's account */
    SOURCE_FORCE,    /* a statement Q */
    SOURCE_DAMPER,   /* a statement F */
    SOURCE_CONTACT,
    SOURCE_INPUT, /* changes of an input that occurs in the energies */
    SOURCE_STEPS  /* energy that --stabilized has added */
} entry_source;

static const entry_source sources[] = {[LEDGER_ENERGIES] = SOURCE_ENERGIES,
                                       [LEDGER_WORK] = SOURCE_FORCE,
                                       [LEDGER_DRIVE] = SOURCE_FORCE,
                                       [LEDGER_LOSS] = SOURCE_DAMPER,
                                       [LEDGER_DAMPING] = SOURCE_DAMPER};

typedef struct kept_entry {
    entry_source by;
    place at;     /* the statement; unused for SOURCE_ENERGIES and SOURCE_STEPS */
    double given; /* energy or momentum added to the account since the start, SI */
} kept_entry;

typedef struct kept_account {
    kept_entry *entry; /* [entries] of statements, then inputs, then contacts, then SOURCE_STEPS */
    int entries;
    double left; /* residual of the account, computed by the core; SI */
} kept_account;

/* Account 0 is the energy's; account k > 0 is the momentum of im->ledger.unknown[k]. The scene must have a ledger. All
 * numbers are zero before the first step. Free with kept_account_free(). */
static kept_account kept_account_read(const image *im, const engine_kind *kind, const void *run,
                                      int account) {
    const image_ledger *l = &im->ledger;
    const int stabilized = im->settings.stabilized;
    double *total = alloc(l->entries + l->accounts, sizeof *total);
    kept_account k = {.entry = alloc(l->entries, sizeof *k.entry)};
    if (kind->steps(run) > 0) {
        kind->ledger(run, total, total + l->entries);
    }
    for (int i = 0; i < l->smooth; i++) {
        if (l->entry[i].account == account) {
            k.entry[k.entries++] =
                (kept_entry){sources[l->entry[i].kind], l->entry[i].at, total[i]};
        }
    }
    for (int i = 0; i < l->inputs && account == 0; i++) {
        k.entry[k.entries++] = (kept_entry){SOURCE_INPUT, im->input[l->input[i]].at,
                                            total[l->entries - stabilized - l->inputs + i]};
    }
    for (int c = 0; c < im->contacts && account <= im->coordinates; c++) {
        k.entry[k.entries++] = (kept_entry){SOURCE_CONTACT, im->contact[c].at,
                                            total[l->smooth + c * (1 + im->coordinates) + account]};
    }
    if (stabilized && account == 0) {
        k.entry[k.entries++] = (kept_entry){.by = SOURCE_STEPS, .given = total[l->entries - 1]};
    }
    k.left = total[l->entries + account];
    free(total);
    return k;
}

static void kept_account_free(kept_account *k) { free(k->entry); }

/* === the energy residual ======================================================================= */

/* The allowance for N steps is ROUNDINGS * sqrt(N) times the round-off of one step. */
#define ROUNDINGS 32.0

static double larger(double a, double b) { return fabs(b) > a ? fabs(b) : a; }

/* Enters the entries of the run's own ledger into the balance. */
static void enter_kept(const image *im, const engine_kind *kind, const void *run,
                       energy_residual *made) {
    kept_account kept = kept_account_read(im, kind, run, 0);
    for (int i = 0; i < kept.entries; i++) {
        const kept_entry *e = &kept.entry[i];
        made->left_J -= e->given;
        made->largest_J = larger(made->largest_J, e->given);
        switch (e->by) {
        case SOURCE_FORCE:
        case SOURCE_INPUT: made->inputs_J += e->given; break;
        case SOURCE_DAMPER: made->losses_J += e->given; break;
        case SOURCE_CONTACT: made->contacts_J += e->given; break;
        case SOURCE_ENERGIES:     /* only momenta have such entries */
        case SOURCE_STEPS: break; /* a scene with contacts cannot be --stabilized */
        }
    }
    kept_account_free(&kept);
}

/* Sets the residual to the larger of two: with and without the energy corrections of --stabilized. */
static void enter_given_back(const image *im, const engine_kind *kind, const void *run,
                             energy_residual *made) {
    kept_account kept = kept_account_read(im, kind, run, 0);
    const double lost_J = made->left_J - kept.entry[kept.entries - 1].given;
    kept_account_free(&kept);
    made->stabilized = true;
    made->lost_J = fabs(lost_J);
    made->left_J = fabs(lost_J) >= fabs(made->left_J) ? lost_J : made->left_J;
}

/* With contacts the entries come from the run's ledger, because the balance of books.h omits contact forces. */
energy_residual energy_residual_of(books *b, const engine_kind *kind, const void *run) {
    energy_residual made = {.jump_s = -1.0};
    if (b == NULL || (b->image->contacts > 0 && !b->image->ledger.kept)) {
        return made;
    }
    if (b->image->contacts > 0) {
        made.left_J = b->energy_J[1] - b->energy_J[0];
        enter_kept(b->image, kind, run, &made);
    } else {
        made.left_J = books_left_J(b);
        made.largest_J = larger(larger(0.0, b->input_J), b->loss_J);
        if (b->image->settings.stabilized) {
            enter_given_back(b->image, kind, run, &made);
        }
        made.inputs_J = b->input_J;
        made.losses_J = -b->loss_J;
        made.jump_s = fabs(b->jump_J) > 0.5 * fabs(made.left_J) ? b->jump_s : -1.0;
    }
    made.saturated = kind->saturated != NULL && kind->saturated(run) > 0;
    made.largest_J = larger(made.largest_J, b->moving_J[1] - b->moving_J[0]);
    made.largest_J = larger(made.largest_J, b->stored_J[1] - b->stored_J[0]);
    made.largest_J = larger(made.largest_J, books_swing_J(b));
    const double step_J = books_rounding_J(b, kind, run);
    made.rounding_J = ROUNDINGS * number_root((double)b->entries) * step_J + 2.0 * b->computing_J;
    if (made.left_J != 0.0) { /* otherwise there is no residual to explain */
        made.rounding_J += (double)b->entries * b->lost_J;
    }
    made.exact = b->image->settings.matrix == MATRIX_EXACT;
    if (made.exact && made.left_J != 0.0) { /* the integration of the powers is not exact */
        made.rounding_J += b->rule_J;
    }
    made.rounded = made.rounding_J / ENERGY_RESIDUAL_LIMIT > made.largest_J;
    made.largest_J = number_most(made.largest_J, made.rounding_J / ENERGY_RESIDUAL_LIMIT);
    made.known = isfinite(made.left_J);
    made.ratio = made.left_J == 0.0 ? 0.0 : fabs(made.left_J) / made.largest_J;
    return made;
}

bool energy_residual_lost(const energy_residual *b, double limit) {
    return b->known && fabs(b->left_J) > b->rounding_J && !(b->ratio <= limit);
}

void energy_residual_print(FILE *out, const energy_residual *b) {
    if (b->known) {
        fprintf(out, "energy residual    %.2e of %s, %.3g J%s\n", b->ratio,
                b->rounded && b->exact ? "1000 times the balance's round-off and integration error"
                : b->rounded           ? "1000 times the balance's round-off"
                                       : "the largest entry of the energy balance",
                b->largest_J, b->rounded ? ": every entry is smaller" : "");
    }
}

/* === the books in words ========================================================================== */

#define ACCOUNT_WIDTH 44

static void account_print_level(FILE *out, const char *text, const double level[2]) {
    fprintf(out, "  %-*s %.9g -> %.9g\n", ACCOUNT_WIDTH, text, level[0], level[1]);
}

static void account_print_entry(FILE *out, const char *text, double given, const char *more) {
    fprintf(out, "  %-*s %+.9g%s\n", ACCOUNT_WIDTH, text, number_shown(given), more);
}

static void account_print_end(FILE *out, double change, double left) {
    account_print_entry(out, "change", change, "");
    fprintf(out, "  %-*s %+.2e (numerical)\n", ACCOUNT_WIDTH, "residual", left);
}

static void print_levels(FILE *out, const books *b) {
    fprintf(out, "energy balance [J]\n");
    account_print_level(out, "kinetic", b->kinetic_J);
    account_print_level(out, "stored", b->stored_J);
    if (b->image->has_integral) {
        account_print_level(out, "h = sum q' dL/dq' - L, in place of T + V", b->energy_J);
    }
}

/* --- in sum ------------------------------------------------------------------------------------------*/

static void print_momenta(FILE *out, const books *b) {
    const image *im = b->image;
    bool any = false;
    for (int i = 0; i < im->count; i++) {
        if (im->unknown[i].conserved) {
            fprintf(out, "%s  of %-13s %.9g, drifts by at most %.2e (numerical)\n",
                    any ? "" : "conserved momentum [SI]\n", im->unknown[i].name, b->momentum[i],
                    b->drift[i]);
            any = true;
        }
    }
    if (!any) {
        fprintf(
            out,
            "no single coordinate's momentum is conserved; whirl examine finds other conserved momenta\n");
    }
}

void books_print(FILE *out, const books *b, const energy_residual *balance) {
    static const char contacts[] = "stops, friction, holds and crossings";
    const double left_J = books_left_J(b);
    print_levels(out, b);
    if (balance->known) {
        account_print_entry(out, "work of inputs", balance->inputs_J, "");
        account_print_entry(out, "losses", balance->losses_J, "");
        if (b->image->contacts > 0) {
            account_print_entry(out, contacts, balance->contacts_J, " (--with ledger lists each)");
        }
        account_print_end(out, b->energy_J[1] - b->energy_J[0], balance->left_J);
    } else if (!isfinite(left_J)) {
        fprintf(out, "  no balance: the energies are not finite numbers\n");
    } else { /* without a ledger the work of contacts is unknown */
        account_print_entry(out, "work of inputs", b->input_J, "");
        account_print_entry(out, "losses", -b->loss_J, "");
        account_print_entry(out, contacts, left_J, ", including numerical errors of unknown size");
    }
    print_momenta(out, b);
}

/* --- by statement ------------------------------------------------------------------------------------*/

static void print_entries(FILE *out, const kept_account *kept, const char *unknown) {
    char text[ACCOUNT_WIDTH + 1];
    for (int i = 0; i < kept->entries; i++) {
        const kept_entry *e = &kept->entry[i];
        if (e->by == SOURCE_CONTACT && e->given == 0.0) {
            continue;
        }
        if (e->by == SOURCE_STEPS) {
            snprintf(text, sizeof text, "energy correction (--stabilized)");
        } else if (e->by != SOURCE_ENERGIES) {
            statement_text(e->at, text, sizeof text);
        } else {
            snprintf(text, sizeof text, "from T and V: dL/d%.20s", unknown);
        }
        account_print_entry(out, text, e->given, "");
    }
}

static void print_momentum(FILE *out, const image *im, const kept_account *kept, int i,
                           const books *b, double time_s) {
    const image_unknown *u = &im->unknown[i];
    const double change = b->momentum_now[i] - b->momentum[i];
    fprintf(out, "momentum balance of %s [%s]\n", u->name, u->momentum_si);
    print_entries(out, kept, u->name);
    account_print_end(out, change, kept->left);
    if (u->is_length && time_s > 0.0) {
        fprintf(out, "  change divided by the run's duration, along %s: %.9g N; residual %.1e N\n",
                u->name, change / time_s, fabs(kept->left) / time_s);
    }
}

void books_print_kept(FILE *out, const image *im, const engine_kind *kind, const void *run,
                      const books *b) {
    const double time_s = (double)kind->steps(run) * im->step_s;
    kept_account energy = kept_account_read(im, kind, run, 0);
    print_levels(out, b);
    print_entries(out, &energy, "");
    account_print_end(out, b->energy_J[1] - b->energy_J[0], energy.left);
    kept_account_free(&energy);
    for (int account = 1; account < im->ledger.accounts; account++) {
        if (im->unknown[im->ledger.unknown[account]].driven) {
            continue;
        }
        kept_account kept = kept_account_read(im, kind, run, account);
        print_momentum(out, im, &kept, im->ledger.unknown[account], b, time_s);
        kept_account_free(&kept);
    }
}
