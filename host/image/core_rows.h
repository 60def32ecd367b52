/* core_rows.h: an image as the core's tables (core/contact.h, core/ledger.h), for interpreter and generated C. */
#ifndef IMAGE_CORE_ROWS_H
#define IMAGE_CORE_ROWS_H

#include "core/contact.h"
#include "core/ledger.h"
#include "core/step/driven.h"
#include "core/version.h"
#include "host/image/image.h"

static inline wh_contact core_contact_row(const image_contact *c) {
    return (wh_contact){.kind = (uint8_t)c->kind,
                        .direction = (int8_t)c->direction,
                        .pin = (int16_t)c->pin,
                        .first_set = (uint8_t)c->first_set,
                        .sets = (uint8_t)c->sets};
}

/* The core's contact system. Its functions, ledger and number of evaluations are not set. The caller owns
 * `contact` [contacts] and `target` [set_count]. */
static inline wh_contact_system core_contact_system(const image *im, const wh_contact *contact,
                                                    const uint8_t *target) {
    unsigned kinds = 0;
    int pinned = 0;
    for (int k = 0; k < im->forced; k++) {
        kinds |= WH_KIND_BIT((unsigned)im->contact[k].kind);
        pinned += im->contact[k].pin >= 0;
    }
    return (wh_contact_system){.contact = contact,
                               .target = target,
                               .contacts = (uint8_t)im->contacts,
                               .forced = (uint8_t)im->forced,
                               .kinds = (uint8_t)kinds,
                               .pinned = (uint8_t)pinned,
                               .held = (uint8_t)im->held,
                               .method = im->settings.method,
                               .compensated = im->settings.compensated,
                               .angles = (uint8_t)im->angles,
                               .coordinates = (uint8_t)im->coordinates,
                               .driven = (uint8_t)im->drives};
}

static inline wh_driven core_drive(const image_drive *d) {
    return (wh_driven){(uint8_t)d->input, (uint8_t)d->rate, (uint8_t)d->value_at,
                       (uint8_t)d->rate_at};
}

static inline int core_stages(const image *im) {
    return im->settings.matrix != MATRIX_NONE ? 0 : wh_methods[im->settings.method].stages;
}

static inline int core_rates_at(const image *im) {
    return im->form == WH_SECOND_ORDER ? im->coordinates - im->angles : 0;
}

static inline int core_stops(const image *im) {
    int stops = 0;
    for (int k = 0; k < im->contacts; k++) {
        stops += im->contact[k].kind == WH_STOP;
    }
    return stops;
}

/* Largest number of evaluations of the accelerations (or derivatives) in a step. */
static inline int core_evaluations(const image *im) {
    const int stages = core_stages(im);
    return im->contacts == 0 ? stages : WH_CONTACT_EVALUATIONS(stages, core_stops(im), im->forced);
}

/* Largest number of evaluations of the contacts' signals in a step. */
static inline int core_signals(const image *im) {
    return im->contacts == 0 ? 0 : WH_CONTACT_SIGNALS(im->forced, im->contacts - im->forced);
}

/* The core's form of the ledger. Its functions are not set. The caller owns `account` [smooth] and `input` [inputs]. */
static inline wh_ledger_form core_ledger_form(const image *im, const uint8_t *account,
                                              const uint8_t *input) {
    const image_ledger *l = &im->ledger;
    return (wh_ledger_form){.account = account,
                            .input = input,
                            .smooth = (uint16_t)l->smooth,
                            .entries = (uint16_t)l->entries,
                            .accounts =
                                (uint8_t)(2 * l->accounts + l->inputs + im->settings.stabilized),
                            .coordinates = (uint8_t)im->coordinates,
                            .angles = (uint8_t)im->angles,
                            .inputs = (uint8_t)l->inputs,
                            .stabilized = im->settings.stabilized};
}

/* Number of reals for the ledger: the entries, the round-off of each, and form.accounts reals. */
static inline int core_ledger_words(const image *im) {
    const wh_ledger_form form = core_ledger_form(im, NULL, NULL);
    return im->ledger.kept ? 2 * form.entries + form.accounts : 0;
}

/* Number of reals for WH_MEMORY_BYTES(): the state, its low parts if sums are compensated, inputs, holds, ledger. */
static inline int core_memory_reals(const image *im) {
    const int carried = im->settings.compensated ? im->angles + im->reals : 0;
    return im->reals + carried + im->inputs + im->held + core_ledger_words(im);
}

#endif
