/* ledger_read.c: see ledger_read.h. */
#include "ledger_read.h"

#include <stdlib.h>

#include "host/base/room.h"

static giver giver_of(ledger_kind kind) {
    switch (kind) {
    case LEDGER_ENERGIES: return GIVER_ENERGIES;
    case LEDGER_WORK:
    case LEDGER_DRIVE: return GIVER_FORCE;
    case LEDGER_LOSS:
    case LEDGER_DAMPING: return GIVER_DAMPER;
    }
    return GIVER_ENERGIES;
}

kept_account kept_account_read(const image *im, const engine_kind *kind, const void *run,
                               int account) {
    const image_ledger *l = &im->ledger;
    const int stabilized = im->settings.stabilized;
    double *total = room(l->entries + l->accounts, sizeof *total);
    kept_account k = {.entry = room(l->entries, sizeof *k.entry)};
    if (kind->steps(run) > 0) {
        kind->ledger(run, total, total + l->entries);
    }
    for (int i = 0; i < l->smooth; i++) {
        if (l->entry[i].account == account) {
            k.entry[k.entries++] =
                (kept_entry){giver_of(l->entry[i].kind), l->entry[i].at, total[i]};
        }
    }
    for (int i = 0; i < l->inputs && account == 0; i++) {
        k.entry[k.entries++] = (kept_entry){GIVER_INPUT, im->input[l->input[i]].at,
                                            total[l->entries - stabilized - l->inputs + i]};
    }
    for (int c = 0; c < im->contacts && account <= im->coordinates; c++) {
        k.entry[k.entries++] = (kept_entry){GIVER_CONTACT, im->contact[c].at,
                                            total[l->smooth + c * (1 + im->coordinates) + account]};
    }
    if (stabilized && account == 0) {
        k.entry[k.entries++] = (kept_entry){.by = GIVER_STEPS, .given = total[l->entries - 1]};
    }
    k.left = total[l->entries + account];
    free(total);
    return k;
}

void kept_account_free(kept_account *k) { free(k->entry); }
