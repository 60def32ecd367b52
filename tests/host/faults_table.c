/* faults_table.c: a campaign in Markdown: the outcome by fault and state, and the worst runs with their commands. */
#include "faults.h"
#include "host/base/alloc.h"
#include "test.h"

#define OVERSPEED_SHARE 0.02 /* allowed share of all runs */
#define CAUGHT_S 0.25        /* deadline for a drive that ignores the voltage, */
#define CAUGHT_REST_S 0.35   /* from rest, */
#define TURNING_RPM 250.0    /* also for runs below this speed */
enum { WORST = 10, LONGEST = 20, TRIPS = 32 };

static bool is_lie(const verdict *v) { return v->lie > 0.0; }
static bool is_hang(const verdict *v) { return v->outcome == OUTCOME_HANG; }
static bool runs_on(const verdict *v) { return v->runs_on; }
static bool stays_on(const verdict *v) { return v->stays_on; }
static bool is_untold(const verdict *v) { return v->untold; }
static bool is_overspeed(const verdict *v) { return v->overspeed; }
static bool is_cut(const verdict *v) { return v->cut; }
static bool is_not_caught(const verdict *v) {
    const double most_s = v->began_rpm < TURNING_RPM ? CAUGHT_REST_S : CAUGHT_S;
    return v->lasting && !(v->off_s >= 0.0 && v->off_s <= most_s &&
                           v->caught_rpm <= rig_caught_rpm(v->target_rpm));
}

static bool is_not_halted(const verdict *v) { return v->halted && v->halted_s < 0.0; }
static bool forgets(const verdict *v) { return v->forgets; }

static bool is_violation(const verdict *v) {
    return is_lie(v) || is_hang(v) || runs_on(v) || is_overspeed(v) || is_not_caught(v) ||
           is_cut(v) || is_not_halted(v) || forgets(v) || stays_on(v) || is_untold(v);
}

void campaign_print_command(FILE *out, const campaign *c, unsigned i) {
    campaign_case one;
    campaign_draw(&one, c, i);
    fprintf(out, "build/whirl pil %s --firmware %s", c->plant, c->firmware);
    if (campaign_is_emulated(c)) {
        fprintf(out, " --board %s", c->board);
    }
    fprintf(out, " --step %s --jitter " CAMPAIGN_JITTER " --seed %u --fault %s", c->step, one.seed,
            one.words);
}

typedef struct cell_count {
    unsigned of[OUTCOMES];
    unsigned runs;
    unsigned wrong;
} cell_count;

static void count_in(cell_count *cell, const verdict *v) {
    cell->runs++;
    cell->of[v->outcome]++;
    cell->wrong += is_violation(v);
}

static void print_cell(FILE *out, const cell_count *cell) {
    if (cell->runs == 0) {
        fputs(" |", out);
        return;
    }
    fprintf(out, " %u·%u·%u·%u", cell->of[OUTCOME_TRIPPED], cell->of[OUTCOME_GOOD],
            cell->of[OUTCOME_DOUBTFUL], cell->of[OUTCOME_REFUSED] + cell->of[OUTCOME_NONE]);
    if (cell->wrong > 0) {
        fprintf(out, " **%u**", cell->wrong);
    }
    fputs(" |", out);
}

static void print_matrix(FILE *out, const verdict *all, unsigned count) {
    rig_stage stage[RIG_STAGES_MAX];
    const unsigned stages = rig_stages(stage);
    fputs("| fault |", out);
    for (unsigned s = 0; s < stages; s++) {
        fprintf(out, " %s |", stage[s].word);
    }
    fputs(" else |\n|---|", out);
    for (unsigned s = 0; s <= stages; s++) {
        fputs("---|", out);
    }
    fputc('\n', out);
    for (unsigned row = 0; row < campaign_rows(); row++) {
        cell_count cell[RIG_STAGES_MAX + 1] = {{.runs = 0}};
        unsigned runs = 0;
        for (unsigned i = 0; i < count; i++) {
            if (all[i].row == row) {
                count_in(&cell[all[i].stage >= 0 ? (unsigned)all[i].stage : stages], &all[i]);
                runs++;
            }
        }
        if (runs > 0) {
            fprintf(out, "| %s |", campaign_row_word(row));
            for (unsigned s = 0; s <= stages; s++) {
                print_cell(out, &cell[s]);
            }
            fputc('\n', out);
        }
    }
}

static unsigned count_of(const verdict *all, unsigned count, int row,
                         bool (*is)(const verdict *v)) {
    unsigned found = 0;
    for (unsigned i = 0; i < count; i++) {
        found += (row < 0 || all[i].row == (unsigned)row) && is(&all[i]);
    }
    return found;
}

static void print_trips(FILE *out, const verdict *all, unsigned count) {
    fputs("\n| fault | runs | fastest turn, rpm | trips: number, runs |\n|---|---|---|---|\n", out);
    for (unsigned row = 0; row < campaign_rows(); row++) {
        unsigned trips[TRIPS] = {0};
        unsigned runs = 0;
        double fastest = 0.0;
        for (unsigned i = 0; i < count; i++) {
            if (all[i].row == row) {
                runs++;
                trips[all[i].trip >= 0 && all[i].trip < TRIPS ? all[i].trip : 0]++;
                fastest = all[i].turn_rpm > fastest ? all[i].turn_rpm : fastest;
            }
        }
        if (runs == 0) {
            continue;
        }
        fprintf(out, "| %s | %u | %.0f |", campaign_row_word(row), runs, fastest);
        for (int t = 1; t < TRIPS; t++) {
            if (trips[t] > 0) {
                fprintf(out, " %d: %u", t, trips[t]);
            }
        }
        fputs(" |\n", out);
    }
    fputs("\n| trip | runs | |\n|---|---|---|\n", out);
    for (int t = 1; t < TRIPS; t++) {
        unsigned runs = 0;
        for (unsigned i = 0; i < count; i++) {
            runs += all[i].trip == t;
        }
        if (runs > 0) {
            fprintf(out, "| %d | %u | %s |\n", t, runs, rig_trip_word(t));
        }
    }
}

static double by_lie(const verdict *v) { return v->lie; }
static double by_off(const verdict *v) { return v->off_s < 0.0 ? 1e9 : v->off_s; }
static double by_speed(const verdict *v) { return v->turn_rpm; }

/* The worst run that was not printed yet; `count` if there is none. */
static unsigned next_worst(const verdict *all, unsigned count, bool (*is)(const verdict *v),
                           double (*by)(const verdict *v), bool *shown) {
    unsigned worst = count;
    for (unsigned i = 0; i < count; i++) {
        if (is(&all[i]) && !shown[i] && (worst == count || by(&all[i]) > by(&all[worst]))) {
            worst = i;
        }
    }
    if (worst < count) {
        shown[worst] = true;
    }
    return worst;
}

static void print_worst(FILE *out, const campaign *c, const verdict *all, unsigned count,
                        const char *what, bool (*is)(const verdict *v),
                        double (*by)(const verdict *v)) {
    bool *shown = alloc(count, sizeof *shown);
    const unsigned found = count_of(all, count, -1, is);
    fprintf(out, "\n%s: %u of %u runs\n", what, found, count);
    for (unsigned n = 0; n < found && n < WORST; n++) {
        const verdict *v = &all[next_worst(all, count, is, by, shown)];
        fprintf(out, "\n    # run %u: ", v->run);
        if (is == is_lie) {
            fprintf(out, "off by %.3g %% more than it may be", 100.0 * v->lie);
        } else if (is == is_not_caught && v->off_s < 0.0) {
            fputs("never off", out);
        } else if (is == is_not_caught) {
            fprintf(out, "off after %.3f s, from %.1f rpm, by then up to %.1f rpm", v->off_s,
                    v->began_rpm, v->caught_rpm);
        } else {
            fprintf(out, "fastest turn %.1f rpm, fastest instant %.1f rpm", v->turn_rpm,
                    v->peak_rpm);
        }
        fputs("\n    ", out);
        campaign_print_command(out, c, v->run);
        fputc('\n', out);
    }
    free(shown);
}

/* Runs in which a drive ignored the voltage for too long: prints the time until the enable was off, and the speed at
 * that time. */
static void print_runaways(FILE *out, const verdict *all, unsigned count) {
    rig_stage stage[RIG_STAGES_MAX];
    const unsigned stages = rig_stages(stage);
    fputs("\n| the drive ignores the voltage, from | runs | never off | off after, s, at most | "
          "fastest instant until then, rpm |\n|---|---|---|---|---|\n",
          out);
    for (unsigned s = 0; s < stages; s++) {
        unsigned runs = 0;
        unsigned never = 0;
        double off_s = 0.0;
        double rpm = 0.0;
        for (unsigned i = 0; i < count; i++) {
            const verdict *v = &all[i];
            if (v->lasting && v->stage == (int)s) {
                runs++;
                never += v->off_s < 0.0;
                off_s = v->off_s > off_s ? v->off_s : off_s;
                rpm = v->caught_rpm > rpm ? v->caught_rpm : rpm;
            }
        }
        if (runs > 0) {
            fprintf(out, "| %s | %u | %u | %.3f | %.0f |\n", stage[s].word, runs, never, off_s,
                    rpm);
        }
    }
}

/* Prints, for stopped or reset runs, how long the motor still drove, and how many runs had tripped before a reset. */
static void print_halts(FILE *out, const verdict *all, unsigned count) {
    bool any = false;
    for (unsigned row = 0; row < campaign_rows(); row++) {
        unsigned runs = 0;
        unsigned latched = 0;
        double off_s = 0.0;
        for (unsigned i = 0; i < count; i++) {
            const verdict *v = &all[i];
            if (v->row == row && v->halted) {
                runs++;
                latched += v->latched;
                off_s = v->halted_s > off_s ? v->halted_s : off_s;
            }
        }
        if (runs > 0) {
            fputs(
                any ? ""
                    : "\n| stopped or reset | runs | motor off after, ms, at most | trips that were "
                      "latched, and are |\n|---|---|---|---|\n",
                out);
            fprintf(out, "| %s | %u | %.3g | %u |\n", campaign_row_word(row), runs, 1e3 * off_s,
                    latched);
            any = true;
        }
    }
}

static bool takes_time(const verdict *v) {
    /* the last includes resets during a hang */
    static const char *const words[] = {"slow", "late", "hang", "two faults"};
    const char *word = campaign_row_word(v->row);
    bool takes = false;
    for (int i = 0; i < 4; i++) {
        takes = takes || strncmp(word, words[i], strlen(words[i])) == 0;
    }
    return takes;
}

static bool has_steps(const verdict *v) { return v->most > 0.0; }
static double by_step(const verdict *v) { return v->most; }

/* Each row has the command that repeats its run. */
static void print_longest(FILE *out, const campaign *c, const verdict *all, unsigned count) {
    bool *shown = alloc(count, sizeof *shown);
    fprintf(out, "\nThe longest control steps of %d runs:\n", LONGEST);
    for (unsigned n = 0; n < LONGEST; n++) {
        const unsigned i = next_worst(all, count, has_steps, by_step, shown);
        if (i < count) {
            fprintf(out, "\n    # run %u: step of %.0f instructions, at t = %.3f s\n    ",
                    all[i].run, all[i].most, all[i].most_s);
            campaign_print_command(out, c, all[i].run);
            fputc('\n', out);
        }
    }
    free(shown);
}

/* Prints the histogram of instructions per control step, which only the emulator counts. */
static void print_steps(FILE *out, const campaign *c, const verdict *all, unsigned count) {
    uint64_t steps[STEP_BINS] = {0};
    uint64_t sum = 0;
    uint64_t overruns = 0;
    double loop = 0.0;
    double start = 0.0;
    for (unsigned i = 0; i < count; i++) {
        const verdict *v = &all[i];
        for (int bin = 0; bin < STEP_BINS; bin++) {
            steps[bin] += v->steps[bin];
            sum += v->steps[bin];
        }
        if (!takes_time(v)) {
            overruns += v->overruns;
            loop = v->loop > loop ? v->loop : loop;
            start = v->start > start ? v->start : start;
        }
    }
    if (sum == 0) {
        return;
    }
    fputs("\n| instructions of a control step | steps |\n|---|---|\n", out);
    for (int bin = 0; bin < STEP_BINS; bin++) {
        fprintf(out, "| %s%d | %llu |\n", bin == STEP_BINS - 1 ? "from " : "below ",
                STEP_BIN * (bin + (bin < STEP_BINS - 1)), (unsigned long long)steps[bin]);
    }
    fprintf(out,
            "\nWhere nothing takes time by itself: with HAL and printing between two waits at most "
            "%.0f, before the first step %.0f; overruns: %llu.\n",
            loop, start, (unsigned long long)overruns);
    print_longest(out, c, all, count);
}

int campaign_print(FILE *out, const campaign *c, const verdict *all, unsigned count) {
    print_matrix(out, all, count);
    print_trips(out, all, count);
    print_runaways(out, all, count);
    print_halts(out, all, count);
    print_steps(out, c, all, count);
    print_worst(out, c, all, count, "Does not end, or is silent", is_hang, by_speed);
    print_worst(out, c, all, count, "Ends with the motor on", runs_on, by_speed);
    print_worst(out, c, all, count, "Has the enable on, though turns show a drive", stays_on,
                by_speed);
    print_worst(out, c, all, count, "Is driven with the motor off, and does not trip", is_untold,
                by_speed);
    print_worst(out, c, all, count, "Called good, and is not", is_lie, by_lie);
    print_worst(out, c, all, count, "Too fast, and the controller's doing", is_overspeed, by_speed);
    print_worst(out, c, all, count, "Cut by the watchdog, and nothing was late", is_cut, by_speed);
    print_worst(out, c, all, count, "Ignores the voltage, and is not off in time", is_not_caught,
                by_off);
    print_worst(out, c, all, count, "Drives after stop or a reset", is_not_halted, by_speed);
    print_worst(out, c, all, count, "A reset loses the trip, or is not known of", forgets,
                by_speed);
    const bool good =
        count_of(all, count, -1, is_not_halted) == 0 && count_of(all, count, -1, forgets) == 0 &&
        count_of(all, count, -1, is_hang) == 0 && count_of(all, count, -1, runs_on) == 0 &&
        count_of(all, count, -1, is_lie) == 0 && count_of(all, count, -1, is_not_caught) == 0 &&
        count_of(all, count, -1, is_cut) == 0 && count_of(all, count, -1, stays_on) == 0 &&
        count_of(all, count, -1, is_untold) == 0 &&
        count_of(all, count, -1, is_overspeed) <= OVERSPEED_SHARE * count;
    fprintf(out, "\n%u runs, seed %u, %s: %s\n", count, c->seed, c->firmware,
            good ? "nothing is wrong" : "there are violations");
    return good ? 0 : 1;
}
