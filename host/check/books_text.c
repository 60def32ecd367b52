#include "books_text.h"

#include <math.h>

#include "host/base/diag.h"
#include "host/number/functions.h"

/* The columns that the text of a line gets. */
#define ACCOUNT_WIDTH 44

static void account_print_level(FILE *out, const char *text, const double level[2]) {
    fprintf(out, "  %-*s %.9g -> %.9g\n", ACCOUNT_WIDTH, text, level[0], level[1]);
}

/* `more` follows it, or is "". */
static void account_print_entry(FILE *out, const char *text, double given, const char *more) {
    fprintf(out, "  %-*s %+.9g%s\n", ACCOUNT_WIDTH, text, number_shown(given), more);
}

/* The last two lines: the change and the residual. */
static void account_print_end(FILE *out, double change, double left) {
    account_print_entry(out, "change", change, "");
    fprintf(out, "  %-*s %+.2e (numerical)\n", ACCOUNT_WIDTH, "residual", left);
}

/* The two energies, and the balanced energy if it differs from their sum. */
static void print_levels(FILE *out, const books *b) {
    fprintf(out, "energy book [J]\n");
    account_print_level(out, "kinetic", b->kinetic_J);
    account_print_level(out, "stored", b->stored_J);
    if (b->image->has_integral) {
        account_print_level(out, "booked: h = sum q' dL/dq' - L, not T + V", b->energy_J);
    }
}

/* --- in sum ------------------------------------------------------------------------------------------*/

static void print_momenta(FILE *out, const books *b) {
    const image *im = b->image;
    bool any = false;
    for (int i = 0; i < im->count; i++) {
        if (im->unknown[i].conserved) {
            if (!any) {
                fprintf(out, "conserved momentum [SI]\n");
            }
            any = true;
            fprintf(out, "  of %-13s %.9g, drift at most %.2e (numerical)\n", im->unknown[i].name,
                    b->momentum[i], b->drift[i]);
        }
    }
    if (!any) {
        fprintf(
            out,
            "no single coordinate's momentum is conserved; whirl examine finds those of sums and rotations\n");
    }
}

void books_print(FILE *out, const books *b, const energy_residual *balance) {
    static const char contacts[] = "impacts, friction, holds and settings";
    const book_account a = books_account(b);
    print_levels(out, b);
    if (balance->known) {
        account_print_entry(out, "work of inputs", balance->inputs_J, "");
        account_print_entry(out, "losses", balance->losses_J, "");
        if (b->image->contacts > 0) {
            account_print_entry(out, contacts, balance->contacts_J, " (--with ledger says which)");
        }
        account_print_end(out, b->energy_J[1] - b->energy_J[0], balance->left_J);
    } else if (!isfinite(a.left)) {
        fprintf(out, "  no balance: the energies are not finite numbers\n");
    } else { /* the ledger is not available, and the balance does not see internal forces */
        account_print_entry(out, "work of inputs", b->input_J, "");
        account_print_entry(out, "losses", -b->loss_J, "");
        account_print_entry(out, contacts, a.left, ", with numerical errors of unknown size");
    }
    print_momenta(out, b);
}

/* --- by statement ------------------------------------------------------------------------------------*/

/* The entries of an account, without contacts that gave nothing. */
static void print_entries(FILE *out, const kept_account *kept, const char *unknown) {
    char text[ACCOUNT_WIDTH + 1];
    for (int i = 0; i < kept->entries; i++) {
        const kept_entry *e = &kept->entry[i];
        if (e->by == GIVER_CONTACT && e->given == 0.0) {
            continue;
        }
        if (e->by == GIVER_STEPS) {
            snprintf(text, sizeof text, "given back (--stabilized)");
        } else if (e->by != GIVER_ENERGIES) {
            statement_text(e->at, text, sizeof text);
        } else {
            snprintf(text, sizeof text, "of the energies: dL/d%.20s", unknown);
        }
        account_print_entry(out, text, e->given, "");
    }
}

static void print_momentum(FILE *out, const image *im, const kept_account *kept, int i,
                           const books *b, double time_s) {
    const image_unknown *u = &im->unknown[i];
    const double change = b->momentum_now[i] - b->momentum[i];
    fprintf(out, "momentum book of %s [%s]\n", u->name, u->momentum_si);
    print_entries(out, kept, u->name);
    account_print_end(out, change, kept->left);
    if (u->is_length && time_s > 0.0) {
        fprintf(out, "  change divided by the run's length, along %s: %.9g N; closes to %.1e N\n",
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
