/* test_thumb_cycles.c: the estimated cycles of a Cortex-M (mk/count/thumb_cycles.h), compared with Arm's published
 * timing. There is at least one instruction of each row of its tables, as the assembler encodes it, and pairs that
 * overlap or wait. */
#include "test.h"

#include "mk/count/thumb_cycles.h"

typedef struct timed {
    const char *text;
    unsigned first;
    unsigned second;
    unsigned cycles[3]; /* cycles on M0, M3, M4; 0: no such instruction */
} timed;

static const timed instructions[] = {
    {"movs r1, r2", 0x0011, 0, {1, 1, 1}},
    {"adds r2, #1", 0x3201, 0, {1, 1, 1}},
    {"cmp r3, #7", 0x2b07, 0, {1, 1, 1}},
    {"tst r2, r1", 0x420a, 0, {1, 1, 1}},
    {"muls r1, r2", 0x4351, 0, {1, 1, 1}},
    {"add r8, r1", 0x4488, 0, {1, 1, 1}},
    {"bx lr", 0x4770, 0, {1, 1, 1}},
    {"str r1, [r2, r3]", 0x50d1, 0, {2, 2, 2}},
    {"ldr r1, [r2, r3]", 0x58d1, 0, {2, 2, 2}},
    {"str r1, [r2, #4]", 0x6051, 0, {2, 1, 1}},
    {"ldr r1, [r2, #4]", 0x6851, 0, {2, 2, 2}},
    {"strb r1, [r2, #4]", 0x7111, 0, {2, 1, 1}},
    {"ldr r2, [sp, #4]", 0x9a01, 0, {2, 2, 2}},
    {"add r2, sp, #4", 0xaa01, 0, {1, 1, 1}},
    {"sub sp, #8", 0xb082, 0, {1, 1, 1}},
    {"push {r4, r5, lr}", 0xb530, 0, {4, 4, 4}},
    {"pop {r4}", 0xbc10, 0, {2, 2, 2}},
    {"sxtb r1, r2", 0xb251, 0, {1, 1, 1}},
    {"it eq", 0xbf08, 0, {1, 1, 1}},
    {"stmia r1!, {r2, r3, r4}", 0xc11c, 0, {4, 4, 4}},
    {"b", 0xe7ff, 0, {1, 1, 1}},
    {"bl", 0xf7ff, 0xfffe, {2, 1, 1}},
    {"dmb", 0xf3bf, 0x8f5f, {4, 1, 1}},
    {"ldr r3, [pc, #260]", 0xf8df, 0x3104, {0, 2, 2}},
    {"ldr r8, [r2, #400]", 0xf8d2, 0x8190, {0, 2, 2}},
    {"ldr r8, [r2, r3, lsl #2]", 0xf852, 0x8023, {0, 2, 2}},
    {"str r8, [r2, r3, lsl #2]", 0xf842, 0x8023, {0, 2, 2}},
    {"str r8, [r2, #400]", 0xf8c2, 0x8190, {0, 1, 1}},
    {"ldrd r4, r5, [r2]", 0xe9d2, 0x4500, {0, 3, 3}},
    {"ldmia r1!, {r4, r5, r8, r9}", 0xe8b1, 0x0330, {0, 5, 5}},
    {"tbb [pc, r1]", 0xe8df, 0xf001, {0, 2, 2}},
    {"mul r1, r2, r8", 0xfb02, 0xf108, {0, 1, 1}},
    {"mla r1, r2, r3, r4", 0xfb02, 0x4103, {0, 2, 1}},
    {"umull r3, r2, r0, r1", 0xfba0, 0x3201, {0, 4, 1}},
    {"smull r1, r2, r3, r4", 0xfb83, 0x1204, {0, 4, 1}},
    {"smlal r1, r2, r3, r4", 0xfbc3, 0x1204, {0, 6, 1}},
    {"umlal r1, r2, r3, r4", 0xfbe3, 0x1204, {0, 6, 1}},
    {"sdiv r1, r2, r3", 0xfb92, 0xf1f3, {0, 7, 7}},
    {"add r1, r2, r3, lsl #2", 0xeb02, 0x0183, {0, 1, 1}},
    {"cmp r1, #256", 0xf5b1, 0x7f80, {0, 1, 1}},
    {"vadd s1, s2, s3", 0xee71, 0x0a21, {0, 0, 1}},
    {"vmul s4, s1, s6", 0xee20, 0x2a83, {0, 0, 1}},
    {"vmla s1, s6, s7", 0xee43, 0x0a23, {0, 0, 3}},
    {"vfnma s1, s2, s3", 0xeed1, 0x0a61, {0, 0, 3}},
    {"vdiv s1, s2, s3", 0xeec1, 0x0a21, {0, 0, 14}},
    {"vsqrt s1, s2", 0xeef1, 0x0ac1, {0, 0, 14}},
    {"vmov s1, s2", 0xeef0, 0x0a41, {0, 0, 1}},
    {"vmov s1, #1.0", 0xeef7, 0x0a00, {0, 0, 1}},
    {"vcmp s6, s1", 0xeeb4, 0x3a60, {0, 0, 1}},
    {"vcvt s1, s2", 0xeef8, 0x0ac1, {0, 0, 1}},
    {"vmrs", 0xeef1, 0xfa10, {0, 0, 1}},
    {"vmov r0, s1", 0xee10, 0x0a90, {0, 0, 1}},
    {"vmov r1, r2, s4, s5", 0xec52, 0x1a12, {0, 0, 2}},
    {"vldr s2, [r3]", 0xed93, 0x1a00, {0, 0, 2}},
    {"vstr s1, [r3]", 0xedc3, 0x0a00, {0, 0, 2}},
    {"vpush {s16, s17, s18}", 0xed2d, 0x8a03, {0, 0, 4}},
    {"vstmia r3, {s0, s1, s2, s3}", 0xec83, 0x0a04, {0, 0, 5}},
};

enum { INSTRUCTIONS = sizeof instructions / sizeof *instructions };

static thumb_timing decoded(thumb_core core, const char *text) {
    for (unsigned i = 0; i < INSTRUCTIONS; i++) {
        if (strcmp(instructions[i].text, text) == 0) {
            return thumb_decode(core, instructions[i].first, instructions[i].second);
        }
    }
    TEST_FAIL_MESSAGE(text);
    return (thumb_timing){0};
}

TEST(thumb_cycles, cycles_equal_arms_published_numbers) {
    static const char *const names[] = {"m0", "m3", "m4"};
    for (unsigned i = 0; i < INSTRUCTIONS; i++) {
        const timed *at = &instructions[i];
        TEST_ASSERT_EQUAL_MESSAGE(at->second != 0, thumb_is_wide(at->first), at->text);
        for (unsigned c = 0; c < 3; c++) {
            const thumb_core core = thumb_core_of(names[c]);
            const thumb_timing alone = thumb_decode(core, at->first, at->second);
            const bool is_slow = core == THUMB_M0 && (at->first & 0xF600U) == 0xB400U;
            if (at->cycles[c] > 0) {
                TEST_ASSERT_EQUAL_MESSAGE(at->cycles[c], thumb_cycles(NULL, &alone), at->text);
                TEST_ASSERT_EQUAL_MESSAGE(is_slow ? 3 : 2, alone.jumping, at->text);
            }
        }
    }
    TEST_ASSERT_EQUAL(THUMB_NONE, thumb_core_of("m7"));
}

/* A load overlaps the next load or indexed store. A load or store waits for its address, and the FPU for its
 * operand. */
TEST(thumb_cycles, pairs_overlap_or_wait) {
    static const struct {
        const char *last;
        const char *now;
        unsigned cycles; /* cycles of `now` on an M4 */
    } pairs[] = {
        {"ldr r1, [r2, #4]", "ldr r8, [r2, #400]", 1},
        {"ldr r1, [r2, #4]", "str r1, [r2, r3]", 1},
        {"ldr r1, [r2, #4]", "str r1, [r2, #4]", 1},
        {"ldr r1, [r2, #4]", "vstr s1, [r3]", 1},
        {"vldr s2, [r3]", "vldr s2, [r3]", 1},
        {"ldr r2, [sp, #4]", "ldr r1, [r2, #4]", 2},
        {"str r1, [r2, r3]", "ldr r1, [r2, #4]", 2},
        {"adds r2, #1", "ldr r1, [r2, #4]", 3},
        {"add r2, sp, #4", "str r8, [r2, #400]", 2},
        {"umull r3, r2, r0, r1", "ldr r1, [r2, #4]", 3},
        {"umull r3, r2, r0, r1", "vldr s2, [r3]", 3},
        {"adds r2, #1", "str r1, [r2, r3]", 3},
        {"adds r2, #1", "movs r1, r2", 1},
        {"cmp r3, #7", "vldr s2, [r3]", 2},
        {"tst r2, r1", "ldr r1, [r2, #4]", 2},
        {"vadd s1, s2, s3", "vmul s4, s1, s6", 2},
        {"vadd s1, s2, s3", "vmla s1, s6, s7", 4},
        {"vadd s1, s2, s3", "vcmp s6, s1", 2},
        {"vadd s1, s2, s3", "vstr s1, [r3]", 3},
        {"vadd s1, s2, s3", "vstmia r3, {s0, s1, s2, s3}", 6},
        {"vadd s1, s2, s3", "vmov r0, s1", 2},
        {"vmov s1, s2", "vmul s4, s1, s6", 1},
        {"vcmp s6, s1", "vmul s4, s1, s6", 1},
    };
    for (unsigned i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        const thumb_timing last = decoded(THUMB_M4, pairs[i].last);
        const thumb_timing now = decoded(THUMB_M4, pairs[i].now);
        TEST_ASSERT_EQUAL_MESSAGE(pairs[i].cycles, thumb_cycles(&last, &now), pairs[i].now);
    }
    const thumb_timing last = decoded(THUMB_M0, "adds r2, #1");
    const thumb_timing now = decoded(THUMB_M0, "ldr r1, [r2, #4]");
    TEST_ASSERT_EQUAL(2, thumb_cycles(&last, &now)); /* the M0 does not wait for an address */
}
