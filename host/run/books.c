/* books.c: energy and momentum beside a run. */
#include "books.h"

#include <math.h>
#include <stdlib.h>

#include "number.h"

books *books_open(const program *p, const equations *e) {
    if (e->kinetic == NULL) {
        return NULL;
    }
    books *b = calloc(1, sizeof *b);
    const size_t count = (size_t)p->books->results + 3 * (size_t)p->count + (size_t)p->inputs;
    double *numbers = calloc(count, sizeof *numbers);
    if (b == NULL || numbers == NULL) {
        abort();
    }
    b->program = p;
    b->equations = e;
    b->evaluator = evaluator_new(p->books);
    b->value = numbers;
    b->momentum = numbers + p->books->results;
    b->drift = b->momentum + p->count;
    b->momentum_now = b->drift + p->count;
    b->input = b->momentum_now + p->count;
    program_inputs(p, e->instance, b->input);
    b->step_s = e->instance->step_s;
    return b;
}

void books_close(books *b) {
    if (b != NULL) {
        evaluator_free(b->evaluator);
        free(b->value);
        free(b);
    }
}

/* Simpson's rule needs pairs of steps: between them, the last step counts as a trapezoid, which the
 * next entry takes back. */
static void add_work(books *b, const double power_W[2]) {
    double *work[2] = {&b->input_J, &b->loss_J};
    for (int k = 0; k < 2; k++) {
        if (b->entries % 2 == 1) {
            *work[k] += 0.5 * b->step_s * (b->power_W[0][k] + power_W[k]);
            b->power_W[1][k] = power_W[k];
        } else {
            *work[k] -= 0.5 * b->step_s * (b->power_W[0][k] + b->power_W[1][k]);
            *work[k] += b->step_s / 3.0 * (b->power_W[0][k] + 4.0 * b->power_W[1][k] + power_W[k]);
            b->power_W[0][k] = power_W[k];
        }
    }
}

void books_enter(books *b, const engine_kind *kind, const void *run) {
    const program *p = b->program;
    kind->state(run, b->angle_rad, b->real);
    evaluator_run(b->evaluator, (double)kind->steps(run) * b->step_s, b->angle_rad, b->real,
                  b->real + (p->coordinates - p->angles), b->input, b->value);
    for (int i = 0; i < p->books->results; i++) {
        b->value[i] = number_shown(b->value[i]);
    }
    const double *entry = b->value + p->count;
    const double power_W[2] = {entry[BOOK_INPUT_POWER], entry[BOOK_LOSS_POWER]};
    b->kinetic_J[1] = entry[BOOK_KINETIC];
    b->stored_J[1] = entry[BOOK_STORED];
    b->energy_J[1] =
        p->integral != NULL ? entry[BOOK_MOMENTA + p->count] : b->kinetic_J[1] + b->stored_J[1];
    if (b->entries == 0) {
        b->kinetic_J[0] = b->kinetic_J[1];
        b->stored_J[0] = b->stored_J[1];
        b->energy_J[0] = b->energy_J[1];
        for (int k = 0; k < 2; k++) {
            b->power_W[0][k] = power_W[k];
        }
        for (int i = 0; i < p->count; i++) {
            b->momentum[i] = entry[BOOK_MOMENTA + i];
        }
    } else {
        add_work(b, power_W);
    }
    for (int i = 0; i < p->count; i++) {
        b->momentum_now[i] = entry[BOOK_MOMENTA + i];
        b->drift[i] = fmax(b->drift[i], fabs(entry[BOOK_MOMENTA + i] - b->momentum[i]));
    }
    b->entries++;
}

double books_error_J(const books *b) {
    return b->energy_J[1] - b->energy_J[0] - b->input_J + b->loss_J;
}
