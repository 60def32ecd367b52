/* count_plugin.c: a QEMU plugin that counts the instructions a program executes between two markers.
 *
 *     qemu-system-arm ... -plugin count_plugin.so,begin=0x1a4,end=0x1a6 \
 *                         -d plugin -D counts.txt
 *
 *     begin, end    addresses of two functions without a body, wh_count_begin() and wh_count_end():
 *                   one return instruction each
 *     every=N       N intervals after each other count as one, which has the instructions of the largest; the last ones
 *                   may be fewer
 *     cycles=CORE   estimate cycles, too, as a Cortex of that name takes them: m0, m3 or m4 (thumb_cycles.h)
 *     marks=FILE    lines "ADDRESS KIND": places that cut intervals into stretches. A stretch runs from one
 *                   mark (or the interval's begin, which is kind 0) to the next, or to the interval's end
 *
 * An interval runs from the return instruction of wh_count_begin() to that of wh_count_end(), both
 * left out; the call of wh_count_end() is inside, which an interval around nothing shows. When the
 * program ends, the log holds
 *
 *     interval NUMBER INSTRUCTIONS             one line each
 *     cycles NUMBER CYCLES                     with cycles=CORE: the estimate for the same interval
 *     sums NUMBER HOW-MANY INSTRUCTIONS CYCLES with every=N: of all the intervals that count as this one
 *     stretches NUMBER KIND LONGEST MOST CYCLES  with marks=FILE, one line an interval and kind: instructions
 *                                              of the longest stretch of that kind, how many there were
 *                                              (the most, where several intervals count as one), and the
 *                                              most cycles of one, with cycles=CORE
 *     unfinished INSTRUCTIONS                  if it ended inside an interval
 *     intervals TOTAL                          always the last line
 *
 * Executed instructions are not cycles, and estimated cycles are no measured ones. A conditional instruction whose condition fails counts.
 *
 * No Debian package ships qemu-plugin.h, so the few calls used are declared here, after QEMU's
 * "TCG Plugins" chapter (interface version 1, QEMU 6.0 to 8.2). */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mk/count/thumb_cycles.h"

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
struct qemu_info_t;
enum qemu_plugin_cb_flags { QEMU_PLUGIN_CB_NO_REGS };

#define EXPORT __attribute__((visibility("default")))
extern EXPORT int qemu_plugin_version;
EXPORT int qemu_plugin_install(qemu_plugin_id_t id, const struct qemu_info_t *info, int argc,
                               char **argv);

size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *tb);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *tb, size_t index);
uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *insn);
const void *qemu_plugin_insn_data(const struct qemu_plugin_insn *insn);
size_t qemu_plugin_insn_size(const struct qemu_plugin_insn *insn);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*callback)(qemu_plugin_id_t,
                                                            struct qemu_plugin_tb *));
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn *insn,
                                            void (*callback)(unsigned, void *),
                                            enum qemu_plugin_cb_flags flags, void *data);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, void *),
                                    void *data);
void qemu_plugin_outs(const char *string);

int qemu_plugin_version = 1;

/* Instructions by address: a hash table with chains, one entry an instruction ever translated. */
typedef struct place {
    uint64_t address;
    uint64_t behind; /* address of what follows in memory */
    unsigned kind;   /* of the mark here, or 0 */
    thumb_timing timing;
    struct place *next;
} place;

#define BUCKETS 65536U
static place *buckets[BUCKETS];

static uint64_t begin_address;
static uint64_t end_address;
static uint64_t every = 1;

static bool counting;
static uint64_t count;
static thumb_core core;
static uint64_t cycles;
static place *last; /* executed in this interval, or NULL */

#define KINDS 4U
static bool marked;
static uint64_t stretch_begin; /* `count` there */
static uint64_t stretch_begin_cycles;
static unsigned stretch_kind;
static uint64_t stretches[KINDS]; /* in this interval, by kind */

/* What is kept of an interval, or of a group of them: the largest of each. */
typedef struct interval {
    uint64_t count;
    uint64_t cycles;
    uint64_t longest[KINDS]; /* stretch, in instructions */
    uint64_t longest_cycles[KINDS];
    uint64_t most[KINDS]; /* stretches */
    uint64_t members;     /* how many count as this one, and their sums */
    uint64_t all;
    uint64_t all_cycles;
} interval;

static interval group;
static interval *intervals;
static size_t interval_count;
static size_t interval_room;

static void fail(const char *what) {
    fprintf(stderr, "count_plugin: %s\n", what);
    exit(EXIT_FAILURE);
}

static place *place_of(uint64_t address) {
    place **link = &buckets[(address >> 1) % BUCKETS];
    while (*link != NULL && (*link)->address != address) {
        link = &(*link)->next;
    }
    if (*link == NULL) {
        *link = calloc(1, sizeof **link);
        if (*link == NULL) {
            fail("out of memory");
        }
        (*link)->address = address;
    }
    return *link;
}

static void keep_larger(uint64_t *most, uint64_t value) { *most = value > *most ? value : *most; }

static void end_stretch(void) {
    keep_larger(&group.longest[stretch_kind], count - stretch_begin);
    keep_larger(&group.longest_cycles[stretch_kind], cycles - stretch_begin_cycles);
    stretches[stretch_kind]++;
}

static void begin_stretch(unsigned kind) {
    stretch_begin = count;
    stretch_begin_cycles = cycles;
    stretch_kind = kind;
}

/* What was executed last is followed by the instruction at `address`. True if that stands behind it in memory. */
static bool follows(uint64_t address) {
    if (last == NULL || last->behind == address) {
        return last != NULL;
    }
    cycles += last->timing.jumping;
    return false;
}

static void on_plain(unsigned cpu, void *data) {
    (void)cpu;
    if (counting) {
        place *const here = data;
        const place *const before = follows(here->address) ? last : NULL;
        cycles += thumb_cycles(before == NULL ? NULL : &before->timing, &here->timing);
        last = here;
        count++;
    }
}

static void on_mark(unsigned cpu, void *data) {
    if (counting) {
        end_stretch();
        begin_stretch(((place *)data)->kind);
    }
    on_plain(cpu, data);
}

static void on_begin(unsigned cpu, void *data) {
    (void)cpu;
    (void)data;
    if (counting) {
        fail("an interval begins inside another");
    }
    counting = true;
    count = 0;
    cycles = 0;
    last = NULL;
    memset(stretches, 0, sizeof stretches);
    begin_stretch(0);
}

static void end_group(void) {
    if (interval_count == interval_room) {
        interval_room = interval_room == 0 ? 1024 : 2 * interval_room;
        interval *const more = realloc(intervals, interval_room * sizeof *intervals);
        if (more == NULL) {
            fail("out of memory");
        }
        intervals = more;
    }
    intervals[interval_count++] = group;
    memset(&group, 0, sizeof group);
}

static void on_end(unsigned cpu, void *data) {
    (void)cpu;
    if (!counting) {
        fail("an interval ends that never began");
    }
    (void)follows(((place *)data)->address);
    counting = false;
    end_stretch();
    keep_larger(&group.count, count);
    keep_larger(&group.cycles, cycles);
    for (unsigned kind = 0; kind < KINDS; kind++) {
        keep_larger(&group.most[kind], stretches[kind]);
    }
    group.all += count;
    group.all_cycles += cycles;
    if (++group.members == every) {
        end_group();
    }
}

static void learn(place *here, const struct qemu_plugin_insn *insn) {
    const unsigned char *const byte = qemu_plugin_insn_data(insn);
    const size_t size = qemu_plugin_insn_size(insn);
    here->behind = here->address + size;
    if (core != THUMB_NONE) {
        const unsigned first = byte[0] | (unsigned)byte[1] << 8;
        const unsigned second = size == 4 ? byte[2] | (unsigned)byte[3] << 8 : 0U;
        here->timing = thumb_decode(core, first, second);
    }
}

/* Called when QEMU translates a block; what is registered here runs before each instruction. */
static void on_translate(qemu_plugin_id_t id, struct qemu_plugin_tb *tb) {
    (void)id;
    for (size_t i = 0; i < qemu_plugin_tb_n_insns(tb); i++) {
        struct qemu_plugin_insn *insn = qemu_plugin_tb_get_insn(tb, i);
        const uint64_t address = qemu_plugin_insn_vaddr(insn);
        place *here = place_of(address);
        learn(here, insn);
        void (*callback)(unsigned, void *) = here->kind != 0 ? on_mark : on_plain;
        if (address == begin_address) {
            callback = on_begin;
        } else if (address == end_address) {
            callback = on_end;
        }
        qemu_plugin_register_vcpu_insn_exec_cb(insn, callback, QEMU_PLUGIN_CB_NO_REGS, here);
    }
}

static void report(qemu_plugin_id_t id, void *data) {
    (void)id;
    (void)data;
    char line[112];
    if (group.members > 0) {
        end_group();
    }
    for (size_t i = 0; i < interval_count; i++) {
        snprintf(line, sizeof line, "interval %zu %" PRIu64 "\n", i, intervals[i].count);
        qemu_plugin_outs(line);
        if (core != THUMB_NONE) {
            snprintf(line, sizeof line, "cycles %zu %" PRIu64 "\n", i, intervals[i].cycles);
            qemu_plugin_outs(line);
        }
        if (every > 1) {
            snprintf(line, sizeof line, "sums %zu %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", i,
                     intervals[i].members, intervals[i].all, intervals[i].all_cycles);
            qemu_plugin_outs(line);
        }
        for (unsigned kind = 0; kind < KINDS && marked; kind++) {
            snprintf(line, sizeof line, "stretches %zu %u %" PRIu64 " %" PRIu64 " %" PRIu64 "\n", i,
                     kind, intervals[i].longest[kind], intervals[i].most[kind],
                     intervals[i].longest_cycles[kind]);
            qemu_plugin_outs(line);
        }
    }
    if (counting) {
        snprintf(line, sizeof line, "unfinished %" PRIu64 "\n", count);
        qemu_plugin_outs(line);
    }
    snprintf(line, sizeof line, "intervals %zu\n", interval_count);
    qemu_plugin_outs(line);
}

/* The value of argument `name`, or NULL if this is another argument. */
static const char *value_of(const char *argument, const char *name) {
    const size_t length = strlen(name);
    return strncmp(argument, name, length) == 0 && argument[length] == '=' ? argument + length + 1
                                                                           : NULL;
}

static uint64_t number_of(const char *text) {
    char *end = NULL;
    const uint64_t number = strtoull(text, &end, 0);
    if (end == text || *end != '\0') {
        fail("a number is expected after '='");
    }
    return number;
}

static void read_marks(const char *path) {
    FILE *file = fopen(path, "r");
    char line[80];
    if (file == NULL) {
        fail("cannot open the file of marks");
    }
    while (fgets(line, sizeof line, file) != NULL) {
        char *kind = strchr(line, ' ');
        if (kind == NULL) {
            fail("a line of the file of marks is not ADDRESS KIND");
        }
        *kind++ = '\0';
        kind[strcspn(kind, "\n")] = '\0';
        place *here = place_of(number_of(line));
        here->kind = (unsigned)number_of(kind);
        if (here->kind == 0 || here->kind >= KINDS) {
            fail("a mark's kind is not between 1 and 3");
        }
    }
    fclose(file);
    marked = true;
}

int qemu_plugin_install(qemu_plugin_id_t id, const struct qemu_info_t *info, int argc,
                        char **argv) {
    (void)info;
    for (int i = 0; i < argc; i++) {
        const char *value = NULL;
        if ((value = value_of(argv[i], "begin")) != NULL) {
            begin_address = number_of(value);
        } else if ((value = value_of(argv[i], "end")) != NULL) {
            end_address = number_of(value);
        } else if ((value = value_of(argv[i], "every")) != NULL) {
            every = number_of(value);
        } else if ((value = value_of(argv[i], "cycles")) != NULL) {
            core = thumb_core_of(value);
            if (core == THUMB_NONE) {
                fprintf(stderr, "count_plugin: no timing for a core %s\n", value);
                return -1;
            }
        } else if ((value = value_of(argv[i], "marks")) != NULL) {
            read_marks(value);
        } else {
            fprintf(stderr, "count_plugin: unknown argument %s\n", argv[i]);
            return -1;
        }
    }
    if (begin_address == end_address) {
        fprintf(stderr, "count_plugin: begin= and end= must be two addresses\n");
        return -1;
    }
    qemu_plugin_register_vcpu_tb_trans_cb(id, on_translate);
    qemu_plugin_register_atexit_cb(id, report, NULL);
    return 0;
}
