/* Bench for the rig's firmware, written from docs/dev/pil.md ("Bytes on the line") and docs/rig.md alone. It uses
 * libc and libm and nothing of the project: frames, plant, sensors and judge are its own. It starts the firmware as
 * a child process, exchanges frames with it, and adds faults to the plant or the sensors. It judges each run by the
 * plant's state. Exit status: 0: no rule is broken; 1: a rule is broken; 2: page and firmware differ, or bad usage. */
#include "tests/outside/bench_run.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

enum mode { BENCH, HEALTHY, RUNOUTS, STUCK, NOMINAL, MODES };
static const char *const mode_name[MODES] = {"bench", "healthy", "runouts", "stuck", "nominal"};
static const int mode_runs[MODES] = {500, 200, 2000, 500, 1};

typedef struct {
    enum mode mode;
    const char *firmware, *swing, *set[16];
    uint64_t seed;
    int runs, one, only, sets;
} campaign;

static void play(const campaign *c, int index, outcome *o) {
    dice d =
        c->seed * 0x2545F4914F6CDD1DU + (uint64_t)index * 0x9E6C63D0876A9A47U + (uint64_t)c->mode;
    bench b;
    dice_next(&d);
    switch (c->mode) {
    case BENCH: draw_bench(&b, c->only >= 0 ? c->only : index % KINDS, &d); break;
    case STUCK: draw_bench(&b, KIND_STUCK, &d); break;
    case RUNOUTS: draw_run_out(&b, &d); break;
    case HEALTHY: draw_healthy(&b, &d); break;
    case NOMINAL:
    case MODES:
        draw_healthy(&b, &d);
        b.noise = b.hum = b.jitter = 0;
        b.inertia = 1;
        b.rpm = 330;
    }
    for (int i = 0; i < c->sets; i++) {
        const char *value = strchr(c->set[i], '=');
#define X(name) \
    if (value != NULL && strncmp(c->set[i], #name "=", sizeof #name) == 0) { \
        b.name = strtod(value + 1, NULL); \
    }
        NUMBERS(X)
#undef X
    }
    const outcome fresh = {.index = index, .kind = b.kind, .second = b.second, .quality = -1};
    const char *firmware = b.swings != 0 ? c->swing : c->firmware;
    if (b.clip_above > 0 || b.clip_below > 0) { /* the limits are shares of unclipped peaks */
        bench whole = b;
        *o = fresh;
        run(firmware, &whole, o, false);
        b.clip_high = b.clip_above > 0 && o->peak_high > 0 ? b.clip_above * o->peak_high : NEVER;
        b.clip_low = b.clip_below > 0 && o->peak_low < 0 ? b.clip_below * o->peak_low : -NEVER;
    }
    if (c->one >= 0) {
#define X(name) b.name != 0 ? printf(#name " %g, ", b.name) : 0;
        NUMBERS(X)
#undef X
#define X(name) \
    b.name.state > NOT_AT_ALL ? printf(#name " %d+%gs, ", b.name.state, b.name.delay) : 0;
        EVENTS(X)
#undef X
        puts(kinds[b.kind].name);
    }
    *o = fresh;
    run(firmware, &b, o, c->one >= 0);
    if (c->one >= 0) {
        printf("status %d after %.3f s, trip %d, quality %d of %d turns at %.2f rpm\n", o->status,
               o->seconds, o->trip, o->quality, o->turns, o->rpm);
        printf("force %.3f +- %.3f N, true %.4f N; phase %.3f +- %.3f deg, true %.4f deg\n",
               o->note[AMPLITUDE], o->note[AMPLITUDE_HALF], o->amplitude, o->note[PHASE] / DEG,
               o->note[PHASE_HALF] / DEG, o->phase / DEG);
        printf("peaks %.2f %.2f N, fastest turn %.1f rpm, energy balance off by %.2e J\n%s\n",
               o->peak_low, o->peak_high, o->fastest, o->energy_off,
               o->wrong || o->on ? o->why : "no rule is broken");
    }
}

typedef struct {
    /* quality: none, good, doubtful, refused */
    int runs, quality[4], tripped, shown, wrong, on, trips[16];
    double on_s;
} tally;

static void count(tally *t, const outcome *o) {
    t->runs++;
    t->quality[(o->quality + 1) & 3]++;
    t->tripped += o->tripped;
    t->shown += o->shown;
    t->wrong += o->wrong;
    t->on += o->on;
    t->trips[o->tripped ? o->trip & 15 : 0]++;
    t->on_s = fmax(t->on_s, o->on_s);
}

static void print_row(const char *name, const tally *t) {
    printf("| %-11s | %4d | %4d | %8d | %7d | %4d | %4d | %5d | %5d | %2d | %5.3f |", name, t->runs,
           t->quality[1], t->quality[2], t->quality[3], t->quality[0], t->tripped, t->wrong,
           t->shown, t->on, t->on_s);
    for (int i = 1; i < 16; i++) {
        t->trips[i] > 0 ? printf(" %d: %d", i, t->trips[i]) : 0;
    }
    puts(" |");
}

static void print_run(const campaign *c, const outcome *o) {
    printf("run %d (%s%s%s): ", o->index, kinds[o->kind].name, o->second > 0 ? ", " : "",
           o->second > 0 ? kinds[o->second].name : "");
    if (o->wrong || o->on) {
        puts(o->why);
    } else {
        printf("quality %d, trip %d from state %d, %.3f s\n", o->quality, o->trip, o->trip_state,
               o->seconds);
    }
    printf("    build/tools/rig_bench %s --seed %llu --run %d", mode_name[c->mode],
           (unsigned long long)c->seed, o->index);
    c->only >= 0 ? printf(" --only %s", kinds[c->only].name) : 0;
    for (int i = 0; i < c->sets; i++) {
        printf(" --set %s", c->set[i]);
    }
    puts("");
}

/* Up to two workers do the runs. This process counts their results. */
static int play_all(const campaign *c) {
    static tally of[KINDS], all;
    const bool healthy = c->mode == HEALTHY || c->mode == RUNOUTS;
    int results[2];
    double energy_off = 0;
    if (pipe(results) != 0) {
        return 2;
    }
    for (int job = 0; job < 2; job++) {
        if (fork() == 0) {
            close(results[0]);
            for (int i = job; i < c->runs; i += 2) {
                outcome o;
                play(c, i, &o);
                if (write(results[1], &o, sizeof o) != (ssize_t)sizeof o) {
                    exit(1);
                }
            }
            exit(0);
        }
    }
    close(results[1]);
    for (outcome o; read(results[0], &o, sizeof o) == (ssize_t)sizeof o;) {
        count(&of[o.kind], &o);
        count(&all, &o);
        energy_off = fmax(energy_off, o.energy_off);
        if (o.wrong || o.on || (healthy && o.tripped) || (c->mode == HEALTHY && o.quality != 0)) {
            print_run(c, &o);
        }
    }
    puts(
        "| kind        | runs | good | doubtful | refused | none | trip | wrong | drove | on | on, s |"
        " trips: number, runs |\n|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (int k = 0; k < KINDS; k++) {
        of[k].runs > 0 && of[k].runs < all.runs ? print_row(kinds[k].name, &of[k]) : (void)0;
    }
    print_row("all", &all);
    bool right = all.wrong == 0 && all.on == 0 && energy_off < 1e-5;
    right = right && (!healthy || all.tripped == 0);
    right = right && (c->mode != HEALTHY || all.quality[1] * 20 >= all.runs * 19);
    printf("%s, %d runs, seed %llu, %s; the plant's energy balance is off by %.1e J: %s\n",
           mode_name[c->mode], all.runs, (unsigned long long)c->seed, c->firmware, energy_off,
           right ? "no rule is broken" : "a rule is broken");
    return all.runs != c->runs ? 2 : right ? 0 : 1;
}

int main(int argc, char **argv) {
    campaign c = {.firmware = "build/pil_dialled", .swing = "build/pil_swing", .seed = 1};
    int mode = MODES - 1;
    while (mode >= 0 && (argc < 2 || strcmp(argv[1], mode_name[mode]) != 0)) {
        mode--;
    }
    bool usage = mode < 0 || argc % 2 != 0;
    c.one = mode == NOMINAL ? 0 : -1;
    c.only = -1;
    for (int i = 2; i + 1 < argc; i += 2) {
        const char *option = argv[i], *value = argv[i + 1];
        if (strcmp(option, "--firmware") == 0) {
            c.firmware = value;
        } else if (strcmp(option, "--swing") == 0) {
            c.swing = value;
        } else if (strcmp(option, "--seed") == 0) {
            c.seed = strtoull(value, NULL, 0);
        } else if (strcmp(option, "--runs") == 0) {
            c.runs = (int)strtol(value, NULL, 0);
        } else if (strcmp(option, "--run") == 0) {
            c.one = (int)strtol(value, NULL, 0);
        } else if (strcmp(option, "--set") == 0 && c.sets < 16) {
            c.set[c.sets++] = value;
        } else if (strcmp(option, "--only") == 0) {
            for (c.only = KINDS - 1; c.only >= 0 && strcmp(kinds[c.only].name, value) != 0;
                 c.only--) {
            }
            usage = usage || c.only < 0;
        } else {
            usage = true;
        }
    }
    if (usage) {
        fputs("usage: rig_bench bench|healthy|runouts|stuck|nominal [--firmware PATH]\n"
              "    [--swing PATH] [--seed N] [--runs N] [--run I] [--only KIND]\n"
              "    [--set NUMBER=VALUE]\n",
              stderr);
        return 2;
    }
    c.mode = (enum mode)mode;
    c.runs = c.runs > 0 ? c.runs : mode_runs[mode];
    setvbuf(stdout, NULL, _IOLBF, 0);
    setpriority(PRIO_PROCESS, 0, 10);
    if (c.one >= 0) {
        outcome o;
        play(&c, c.one, &o);
        return o.wrong || o.on;
    }
    return play_all(&c);
}
