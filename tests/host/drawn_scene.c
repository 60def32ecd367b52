#include "drawn_scene.h"
#include "test.h"

#include "core/contact.h"
#include "host/number/phase.h"

#define PI 3.14159265358979323846

static const char *const unknown_names[] = {"theta", "X", "phi_2", "a_longer_name_than_others"};
static const char *const input_names[] = {"M", "F", "u3"};
static const char *const output_names[] = {"power", "x_cm", "o3"};
static const char *const parameter_names[] = {"m", "K1", "length_of_it"};
static const char *const texts[] = {"", "a carriage", "\"of\" both \\ ends", "50 % /* or so */"};

static const char file_text[] = "mechanism m\n"
                                "    coordinate X [m] # the carriage\n"
                                "\tinput M = 1 [N]  \n"
                                "    stop X >= 0 [m] restitution 0.5\n"
                                "scene s { hold X when M > 0\n"
                                "    Q(X) = M\r\n"
                                "F = 2*X'^2 }\n"
                                "\n"
                                "  end";

static const char *const statements[SCENE_LINES] = {"mechanism m",
                                                    "coordinate X [m]",
                                                    "input M = 1 [N]",
                                                    "stop X >= 0 [m] restitution 0.5",
                                                    "hold X when M > 0",
                                                    "Q(X) = M",
                                                    "F = 2*X'^2",
                                                    "",
                                                    "end"};

static const source file = {"x.whirl", file_text, sizeof file_text - 1};

const char *drawn_scene_statement(int line) { return line > 0 ? statements[line - 1] : ""; }

static place draw_place(dice *die) {
    const int line = (int)dice_one_of(die, SCENE_LINES + 1);
    if (line == 0) {
        return (place){NULL, 0, 0, 0};
    }
    size_t offset = 0;
    for (int i = 1; i < line; i++) {
        offset += strcspn(file_text + offset, "\n") + 1;
    }
    const size_t behind = strcspn(file_text + offset, "\n");
    size_t indent = strspn(file_text + offset, " \t");
    if (line == 5) { /* line 5 has a brace before its statement */
        indent = strlen("scene s { ");
    }
    return (place){&file, line, 1 + (int)dice_one_of(die, 40),
                   offset + (indent < behind ? indent : behind)};
}

static image_unit draw_unit(dice *die, bool turns) {
    static const image_unit units[] = {{"mm", "m", 1.0, 1000.0}, {"N", "N", 1.0, 1.0},
                                       {"kN", "N", 1000.0, 1.0}, {"1", "1", 1.0, 1.0},
                                       {"min", "s", 60.0, 1.0},  {"m/s", "m/s", 1.0, 1.0},
                                       {"deg", "rad", PI, 180.0}};
    return turns ? (image_unit){"deg", "rad", PI, 180.0} : units[dice_one_of(die, 7)];
}

static void draw_quantities(dice *die, image_quantity *q, const char *const *names, int count,
                            bool valued) {
    for (int i = 0; i < count; i++) {
        q[i] = (image_quantity){.name = names[i],
                                .text = texts[dice_one_of(die, 4)],
                                .unit = draw_unit(die, false),
                                .value = valued ? dice_between(die, -50.0, 50.0) : 0.0,
                                .at = draw_place(die)};
    }
}

static void draw_unknowns(dice *die, drawn_scene *d) {
    image *im = &d->im;
    const bool second = im->form == WH_SECOND_ORDER;
    im->count = 1 + (int)dice_one_of(die, SCENE_UNKNOWNS);
    for (int i = 0; i < im->count; i++) {
        image_unknown *u = &d->unknown[i];
        const bool turns = dice_one_of(die, 2) == 0;
        *u = (image_unknown){.name = unknown_names[i],
                             .text = texts[dice_one_of(die, 4)],
                             .is_angle = turns,
                             .order = second ? 2 : 1 + (int)dice_one_of(die, 3),
                             .unit = d->unit[i],
                             .momentum_si = turns ? "kg*m^2/s" : "kg*m/s"};
        for (int k = 0; k < 4; k++) {
            d->unit[i][k] = draw_unit(die, turns && k == 0);
        }
        const bool recovered = second && i > 0 && dice_one_of(die, 5) == 0;
        d->place[i] = recovered ? -1 : 0;
        if (recovered) {
            d->from_momentum[im->recovered++] = i;
        } else if (turns) {
            d->angle[im->angles++] = (component){i, 0};
        } else {
            d->real[im->reals++] = (component){i, 0};
        }
    }
    im->coordinates = second ? im->angles + im->reals : 0;
    for (int c = 0; c < im->coordinates; c++) {
        d->place[image_component(im, c).unknown] = c;
    }
    const int values = im->angles + im->reals;
    for (int level = 1; level < 3; level++) {
        for (int c = 0; c < values; c++) {
            const int i = image_component(im, c).unknown;
            if (d->unknown[i].order > level) {
                d->real[im->reals++] = (component){i, level};
            }
        }
    }
    for (int i = 0; i < im->angles; i++) {
        d->start_rad[i] = dice_between(die, -20.0, 20.0);
        d->start_turns[i] = phase_of_start(d->start_rad[i]);
    }
    for (int i = 0; i < im->reals; i++) {
        d->start_real[i] = dice_between(die, -20.0, 20.0);
    }
}

const char *drawn_scene_name(const drawn_scene *d, component c, char *text) {
    snprintf(text, 40, "%s%.*s", d->unknown[c.unknown].name, c.primes, "'''");
    return text;
}

static void draw_ranges(dice *die, drawn_scene *d) {
    for (int i = 0; i < d->im.reals + d->im.inputs; i++) {
        const double low = dice_between(die, -9.0, 0.0);
        d->range[i] = (image_range){.name = i < d->im.reals ? d->unknown[d->real[i].unknown].name
                                                            : d->input[i - d->im.reals].name,
                                    .declared = dice_one_of(die, 2) == 0,
                                    .low = low,
                                    .high = low + dice_between(die, 1.0, 9.0)};
    }
}

static void draw_contacts(dice *die, drawn_scene *d) {
    static const char *const words[] = {"stop", "hold", "friction", "when"};
    image *im = &d->im;
    im->contacts = 1 + (int)dice_one_of(die, SCENE_CONTACTS);
    int kind = WH_STOP;
    for (int k = 0; k < im->contacts; k++) {
        image_contact *c = &d->contact[k];
        kind += (int)dice_one_of(die, (unsigned)(WH_CONTACT_KIND_COUNT - kind));
        *c = (image_contact){.kind = kind,
                             .word = words[kind],
                             .direction = (int)dice_one_of(die, 3) - 1,
                             .pin = (int)dice_one_of(die, (unsigned)im->coordinates + 1) - 1,
                             .at = draw_place(die)};
        im->forced += kind != WH_WHEN;
        if (kind == WH_HOLD && c->pin < 0) {
            c->first_set = im->held++;
        } else if (kind == WH_WHEN && im->set_count < SCENE_SETS) {
            c->first_set = im->set_count;
            c->sets = 1 + (int)dice_one_of(die, (unsigned)(SCENE_SETS - im->set_count));
            im->set_count += c->sets;
        }
    }
    for (int i = 0; i < im->set_count; i++) {
        d->target[i] = (int)dice_one_of(die, (unsigned)(im->angles + im->reals));
    }
    drawn_scene_list(d, die, IMAGE_SIGNALS, 2 * im->contacts, TAKES_RATES);
    drawn_scene_list(d, die, IMAGE_FORCES, im->forced * (WH_LAW_ROWS + 2 * im->coordinates),
                     TAKES_RATES);
    if (im->set_count > 0) {
        drawn_scene_list(d, die, IMAGE_SETS, im->set_count, TAKES_RATES);
    }
}

static void draw_ledger(dice *die, drawn_scene *d) {
    image *im = &d->im;
    image_ledger *l = &im->ledger;
    l->kept = true;
    l->asked = dice_one_of(die, 2) == 0;
    l->turned = im->angles > 0 && dice_one_of(die, 2) == 0;
    l->smooth = (int)dice_one_of(die, SCENE_ROWS + 1);
    l->accounts = 1 + im->count;
    for (int i = 0; i < im->inputs; i++) {
        if (dice_one_of(die, 2) == 0) {
            d->booked[l->inputs++] = i;
        }
    }
    l->entries = l->smooth + im->contacts * (1 + im->coordinates) + l->inputs;
    for (int i = 0; i < l->smooth; i++) {
        d->entry[i] = (image_entry){.kind = (ledger_kind)dice_one_of(die, LEDGER_DAMPING + 1),
                                    .account = (int)dice_one_of(die, (unsigned)l->accounts),
                                    .at = draw_place(die)};
    }
    d->account_of[0] = -1;
    for (int i = 0; i < im->count; i++) {
        d->account_of[1 + i] = im->count - 1 - i;
    }
    drawn_scene_list(d, die, IMAGE_POWERS, l->smooth,
                     TAKES_RATES | (l->turned ? TAKES_RECORDS : 0U));
    drawn_scene_list(d, die, IMAGE_LEVELS, l->accounts, TAKES_RATES | TAKES_RECORDS);
}

static void draw_matrix(dice *die, drawn_scene *d) {
    image *im = &d->im;
    const int states = im->angles + im->reals;
    im->matrix =
        (image_matrix){.states = states, .columns = states + im->inputs + 1, .entry = d->entries};
    for (int i = 0; i < states * im->matrix.columns; i++) {
        d->entries[i] = dice_one_of(die, 3) == 0 ? 0.0 : dice_between(die, -2.0, 2.0);
    }
    drawn_scene_list(d, die, IMAGE_MATRIX, states, TAKES_RATES | TAKES_SUMS);
}

static void draw_settings(dice *die, image *im) {
    static const image_settings usual = IMAGE_SETTINGS_DEFAULT;
    im->settings = usual;
    do {
        im->settings.method = (wh_method)dice_one_of(die, WH_METHODS);
    } while (!wh_method_takes(im->settings.method, im->form));
    im->settings.compensated = dice_one_of(die, 2) == 0;
    im->settings.angles = dice_one_of(die, 3) == 0 ? ANGLES_LOOKUP : ANGLES_TURNED;
    im->step = (whole_ratio){1 + dice_one_of(die, 9), 1000 + dice_one_of(die, 7)};
    im->step_s = (double)im->step.numerator / (double)im->step.denominator;
    im->steps = 1 + dice_one_of(die, 100000);
    im->until_s = im->step_s * (double)im->steps;
    im->hash = (uint64_t)dice_one_of(die, 1U << 31) << 33 | dice_one_of(die, 1U << 31);
}

void drawn_scene_draw(drawn_scene *d, dice *die) {
    memset(d, 0, sizeof *d);
    image *im = &d->im;
    im->name = dice_one_of(die, 2) == 0 ? "drawn" : "a_scene_2";
    im->title = texts[dice_one_of(die, 4)];
    im->mechanism = "of_nothing";
    im->form = dice_one_of(die, 3) == 0 ? WH_FIRST_ORDER : WH_SECOND_ORDER;
    im->has_energies = im->form == WH_SECOND_ORDER;
    im->effect = d->effect;
    im->unknown = d->unknown;
    im->angle = d->angle;
    im->real = d->real;
    im->place = d->place;
    im->from_momentum = d->from_momentum;
    im->input = d->input;
    im->output = d->output;
    im->parameter = d->parameter;
    im->start_rad = d->start_rad;
    im->start_turns = d->start_turns;
    im->start_real = d->start_real;
    im->range = d->range;
    im->contact = d->contact;
    im->target = d->target;
    im->ledger.entry = d->entry;
    im->ledger.unknown = d->account_of;
    im->ledger.input = d->booked;
    draw_settings(die, im);
    draw_unknowns(die, d);
    im->inputs = (int)dice_one_of(die, SCENE_FEW + 1);
    im->own_outputs = (int)dice_one_of(die, SCENE_FEW + 1);
    im->outputs = im->own_outputs + 2 * im->recovered;
    im->parameters = (int)dice_one_of(die, SCENE_FEW + 1);
    draw_quantities(die, d->input, input_names, im->inputs, true);
    draw_quantities(die, d->output, output_names, im->own_outputs, false);
    draw_quantities(die, d->parameter, parameter_names, im->parameters, true);
    draw_ranges(die, d);
    for (im->effects = 0; im->effects < (int)dice_one_of(die, SCENE_FEW + 1); im->effects++) {
        d->effect[im->effects] = (image_effect){
            parameter_names[im->effects], texts[dice_one_of(die, 4)], dice_one_of(die, 2) == 0};
    }
    const bool second = im->form == WH_SECOND_ORDER;
    const unsigned what = dice_one_of(die, 5);
    if (what == 0 && im->angles > 0) {
        im->settings.tables = dice_one_of(die, 2) == 0 ? TABLES_LINEAR : TABLES_CUBIC;
        im->settings.cells = 8 << dice_one_of(die, 3);
    } else if (what == 1) {
        im->settings.matrix = dice_one_of(die, 2) == 0 ? MATRIX_EXACT : MATRIX_RK4;
        draw_matrix(die, d);
    } else if (what > 1 && second) {
        if (dice_one_of(die, 2) == 0) {
            draw_contacts(die, d);
        }
        if (dice_one_of(die, 2) == 0) {
            draw_ledger(die, d);
        }
    }
    drawn_scene_list(d, die, IMAGE_STEP, second ? im->coordinates : im->angles + im->reals,
                     (second ? TAKES_RATES : 0U) |
                         (im->settings.tables != TABLES_NONE ? TAKES_TABLES : 0U));
    drawn_scene_list(d, die, IMAGE_OBSERVE, im->outputs,
                     (second ? TAKES_RATES : 0U) | TAKES_RECORDS | TAKES_STATE |
                         (im->contacts > 0 ? TAKES_ACCEL : 0U));
}

const char *const drawn_scene_roles[IMAGE_ROLES] = {"step",   "observe", "books",  "signals",
                                                    "forces", "sets",    "powers", "levels",
                                                    "matrix", "tables"};

int drawn_scene_numbers(const image *im) {
    int numbers = im->reals + im->inputs + im->held;
    numbers += im->settings.compensated ? im->angles + im->reals : 0;
    if (im->ledger.kept) {
        /* an entry has a total and a carry; an account has a start and a correction */
        numbers += 2 * (im->ledger.entries + im->ledger.accounts) + im->ledger.inputs;
    }
    return numbers;
}

size_t drawn_scene_bytes(const image *im, size_t number) {
    return 8 * (size_t)im->angles + number * (size_t)drawn_scene_numbers(im);
}

int drawn_scene_evaluations(const image *im) {
    int stops = 0;
    for (int k = 0; k < im->contacts; k++) {
        stops += im->contact[k].kind == WH_STOP;
    }
    const int stages =
        im->settings.matrix != MATRIX_NONE ? 0 : wh_methods[im->settings.method].stages;
    return im->contacts > 0 ? WH_CONTACT_EVALUATIONS(stages, stops, im->forced) : stages;
}

int drawn_scene_signals(const image *im) {
    return im->contacts > 0 ? WH_CONTACT_SIGNALS(im->forced, im->contacts - im->forced) : 0;
}
