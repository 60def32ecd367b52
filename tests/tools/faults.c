/* faults.c: a fault-injection campaign on the rig's controller. Runs the firmware in the loop with one fault each, judges the
 * run from the plant, and prints a matrix.
 *
 *     build/tools/faults --firmware IMAGE [--board B] [--runs N] [--seed S] [--jobs J] [--step 200us] [--only KIND]
 *     [--first N] [--also FAULTS]
 *
 * Run i depends on the seed only, not on the other runs or the number of processes. Exit status: 0 no violation, 1 violations,
 * 2 bad input, 130 interrupted after reporting the finished runs. */
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/base/alloc.h"
#include "host/cli/load.h"
#include "host/cli/options.h"
#include "host/os/system.h"
#include "tests/host/faults.h"

#define UNTIL_S 60.0
#define PATIENCE_S 600.0
#define JITTER_S 60e-6
#define INSTRUCTION_S (1.5 / 16e6) /* s per instruction, as in `whirl pil` */
enum { PLANTS_MAX = 16, JOBS_MAX = 64 };

static void on_interrupt(int signal_number) {
    (void)signal_number;
    interrupted = 1;
}

/* --- plants, one per set of parameters -------------------------------------------------------------------------------- */

typedef struct plants {
    source_model from;
    const mechanism *of;
    const scene *in;
    const char *step;
    unsigned count;
    char *parameter[PLANTS_MAX]; /* "" for no parameter */
    loaded made[PLANTS_MAX];
} plants;

static const image *plant_with(plants *p, const char *parameter) {
    for (unsigned i = 0; i < p->count; i++) {
        if (strcmp(p->parameter[i], parameter) == 0) {
            return p->made[i].image;
        }
    }
    if (p->count == PLANTS_MAX) {
        return NULL;
    }
    const overrides changes = {
        .step = p->step, .sets = &parameter, .set_count = parameter[0] != '\0' ? 1 : 0};
    const load_request what = {
        .settings = options_defaults().integration, .use = IMAGE_TO_RUN, .conserve = true};
    if (load(&p->made[p->count], &p->from, p->of, p->in, &changes, &what) != EXIT_DONE) {
        return NULL;
    }
    p->parameter[p->count] = alloc_copy(parameter, strlen(parameter));
    return p->made[p->count++].image;
}

static const image *plant_of(plants *p, const fault_plan *plan) {
    char *parameter = NULL;
    for (unsigned i = 0; i < plan->count && parameter == NULL; i++) {
        parameter = fault_parameter(plan, i);
    }
    const image *im = plant_with(p, parameter != NULL ? parameter : "");
    free(parameter);
    return im;
}

/* --- one run -------------------------------------------------------------------------------------------------------*/

static bool run_one(const campaign *c, plants *from, unsigned i, verdict *v) {
    campaign_case one;
    fault_plan plan = {.count = 0};
    judge j;
    lockstep_report report;
    campaign_draw(&one, c, i);
    plan.seed = one.seed;
    if (!fault_read(&plan, one.words)) {
        return false;
    }
    const image *im = plant_of(from, &plan);
    lockstep_request request = {
        .guest = {.image = c->firmware, .board = c->board, .mute = true, .patience_s = PATIENCE_S},
        .plant = {.seed = one.seed, .jitter_s = JITTER_S},
        .until_s = UNTIL_S,
        .instruction_s = INSTRUCTION_S};
    const tap taps[] = {fault_tap(&plan), judge_tap(&j, &one, &plan, &request.until_s)};
    request.taps = taps;
    request.tap_count = 2;
    if (im == NULL) {
        return false;
    }
    lockstep_run(&request, im, &report);
    judge_end(&j, &report);
    *v = j.verdict;
    v->run = i;
    return report.end != LOCKSTEP_BAD && report.end != LOCKSTEP_STOPPED;
}

/* --- many runs -----------------------------------------------------------------------------------------------------*/

static void catch_interrupts(void) {
    const struct sigaction action = {.sa_handler = on_interrupt};
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

/* Does every jobs-th run, beginning with number `job`. A verdict is one write(), so that verdicts do not mix. */
static int work(const campaign *c, plants *from, int job, int onto) {
    for (unsigned i = (unsigned)job; i < c->runs && !interrupted; i += (unsigned)c->jobs) {
        verdict v;
        if (!run_one(c, from, c->first + i, &v)) {
            return interrupted ? 0 : 2;
        }
        if (write(onto, &v, sizeof v) != (ssize_t)sizeof v) {
            return 2;
        }
    }
    return 0;
}

/* An interrupt of this process alone ends the whole campaign. */
static void pass_on(const campaign *c, const pid_t *worker) {
    for (int job = 0; job < c->jobs && interrupted; job++) {
        if (worker[job] > 0) {
            kill(worker[job], SIGINT);
        }
    }
}

static void collect(const campaign *c, const pid_t *worker, int from, verdict *all) {
    const bool shown = isatty(STDERR_FILENO) == 1;
    unsigned count = 0;
    verdict v;
    for (;;) {
        const ssize_t got = read(from, &v, sizeof v);
        if (got == (ssize_t)sizeof v && v.run - c->first < c->runs) {
            verdict *of = &all[v.run - c->first];
            *of = v;
            of->time_s = v.time_s > 0.0 ? v.time_s : 1e-9;
            count++;
        } else if (got >= 0 || !interrupted) {
            break;
        } else {
            pass_on(c, worker);
            continue;
        }
        if (shown || count % 1000 == 0) {
            fprintf(stderr, shown ? "\r%u of %u" : "%u of %u\n", count, c->runs);
        }
    }
    fputs(shown ? "\n" : "", stderr);
}

static int run_all(const campaign *c, plants *from) {
    int line[2];
    int worst = 0;
    pid_t worker[JOBS_MAX] = {0};
    verdict *all = alloc(c->runs, sizeof *all);
    if (pipe(line) != 0) {
        return 2;
    }
    for (int job = 0; job < c->jobs; job++) {
        const pid_t pid = fork();
        worker[job] = pid;
        if (pid == 0) {
            close(line[0]);
            _exit(work(c, from, job, line[1]));
        }
        worst = pid < 0 ? 2 : worst;
    }
    close(line[1]);
    collect(c, worker, line[0], all);
    close(line[0]);
    for (int status; wait(&status) > 0;) {
        worst = !WIFEXITED(status) || WEXITSTATUS(status) != 0 ? 2 : worst;
    }
    unsigned count = 0;
    for (unsigned i = 0; i < c->runs; i++) {
        if (all[i].time_s > 0.0) {
            all[count++] = all[i];
        }
    }
    const int code = count > 0 ? campaign_print(stdout, c, all, count) : 2;
    free(all);
    return interrupted ? 130 : worst != 0 ? worst : code;
}

/* --- words -----------------------------------------------------------------------------------------------------------*/

static bool is_number(const char *text, unsigned long *number) {
    char *end = NULL;
    *number = text != NULL ? strtoul(text, &end, 10) : 0;
    return text != NULL && *end == '\0' && end != text;
}

static bool read_words(int count, char **words, campaign *c) {
    for (int i = 1; i + 1 < count; i += 2) {
        const char *option = words[i];
        const char *value = words[i + 1];
        unsigned long number = 0;
        const bool is = is_number(value, &number);
        if (strcmp(option, "--firmware") == 0) {
            c->firmware = value;
        } else if (strcmp(option, "--board") == 0) {
            c->board = value;
        } else if (strcmp(option, "--step") == 0) {
            c->step = value;
        } else if (strcmp(option, "--only") == 0) {
            c->only = value;
        } else if (strcmp(option, "--also") == 0) {
            c->also = value;
        } else if (strcmp(option, "--runs") == 0 && is && number > 0 && number <= 10000000) {
            c->runs = (unsigned)number;
        } else if (strcmp(option, "--first") == 0 && is && number <= 10000000) {
            c->first = (unsigned)number; /* continues an interrupted campaign */
        } else if (strcmp(option, "--seed") == 0 && is && number <= UINT32_MAX) {
            c->seed = (uint32_t)number;
        } else if (strcmp(option, "--jobs") == 0 && is && number > 0 && number <= JOBS_MAX) {
            c->jobs = (int)number;
        } else {
            fprintf(stderr, "faults: error: %s %s\n", option, value);
            return false;
        }
    }
    return count % 2 == 1 && c->firmware != NULL;
}

static bool has_row(const campaign *c) {
    const bool has = campaign_has_any(c);
    if (!has) {
        fprintf(stderr, "faults: error: no fault is called '%s', with %s\n", c->only, c->firmware);
    }
    return has;
}

int main(int count, char **words) {
    campaign c = {.plant = "docs/plants/rig.whirl",
                  .board = "mps2-an386",
                  .step = "200us",
                  .runs = 20000,
                  .seed = 1,
                  .jobs = 2};
    if (!read_words(count, words, &c) || !has_row(&c)) {
        fprintf(
            stderr,
            "usage: faults --firmware IMAGE [--board B] [--runs N] [--first N] [--seed S] [--jobs J] "
            "[--step 200us] [--only KIND] [--also FAULTS]\n");
        return 2;
    }
    plants from = {.step = c.step};
    int code = source_open(&from.from, c.plant);
    code = code == EXIT_DONE ? source_pick(&from.from, true, &from.of, &from.in) : code;
    if (code == EXIT_DONE) {
        catch_interrupts();
        code = run_all(&c, &from);
    }
    for (unsigned i = 0; i < from.count; i++) {
        unload(&from.made[i]);
        free(from.parameter[i]);
    }
    source_close(&from.from);
    return code;
}
