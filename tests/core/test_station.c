/* test_station.c: the rig's console. Each line has its answer, an order at the console acts like an order that is
 * posted, and a lost host does no harm. */
#include "console.h"
#include "core/text.h"
#include "draw.h"
#include "tests/suites.h"

static even_rig twin;
static uint64_t seed;
static void period(void) {
    even_step(&even);
    wh_station_step(&station, &even.rig);
}

TEST(station, help_lists_every_command) {
    console_begin();
    char list[WH_STATION_OUT_BYTES];
    strcpy(list, ask("help"));
#define NAME(name, most, takes, text) " " #name
    TEST_ASSERT_EQUAL_STRING("OK" WH_COMMAND_ROWS(NAME), list);
#undef NAME
    wh_words words;
    wh_line_split(&words, list + 3);
    for (unsigned i = 0; i < WH_LINE_WORDS; i++) {
        char line[40] = "help ";
        strcat(line, words.word[i]);
        const char *answer = ask(line);
        check_begins("OK ", answer);
        check_begins(words.word[i], answer + 3);
    }
    TEST_ASSERT_EQUAL_STRING("OK start RPM: a test run at this set-point", ask("help start"));
    check_begins("ERR 100 ", ask("help me"));
    TEST_ASSERT_EQUAL_STRING("OK program=rig board=here dialogue=1", ask("id"));
}

TEST(station, refusals_have_their_numbers) {
    static const struct {
        const char *line;
        const char *answer;
    } rows[] = {{"go", "ERR 100 "},
                {"ARM", "ERR 100 "},
                {"arms", "ERR 100 "},
                {"ar", "ERR 100 "},
                {"arm now", "ERR 102 "},
                {"start", "ERR 103 "},
                {"start fast", "ERR 103 "},
                {"start 3 3", "ERR 102 "},
                {"start 330", "ERR 1 "},
                {"set", "ERR 103 "},
                {"set 200", "ERR 7 "},
                {"clear", "ERR 6 "},
                {"measure", "ERR 104 "},
                {"conf list", "ERR 114 "},
                {"tel list", "ERR 114 "},
                {"selftest", "ERR 114 "},
                {"talk", "ERR 105 "},
                {"talk loud", "ERR 105 "},
                {"host", "ERR 106 "},
                {"host name", "ERR 106 "},
                {"host -1", "ERR 106 "},
                {"host 0.9", "ERR 106 "},
                {"host 3600.5", "ERR 106 "},
                {"host 3600", "OK"},
                {"host 1", "OK"},
                {"host 0", "OK"},
                {"\x01", "ERR 101 "},
                {"stop", "OK stop"},
                {"arm", "OK arm"},
                {"arm", "ERR 2 "},
                {"start 20", "ERR 14 "},
                {"start -330", "ERR 14 "},
                {"start 900", "ERR 14 "},
                {"start 330", "OK start"},
                {"arm", "ERR 3 "},
                {"start 330", "ERR 3 "},
                {"set 300.5", "OK set"},
                {"set 9", "ERR 14 "},
                {"clear", "ERR 6 "},
                {"fault", "OK trip=0 ended=none: no fault"}};
    console_begin();
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        check_begins(rows[i].answer, ask(rows[i].line));
    }
    TEST_ASSERT_TRUE(even.rig.state == WH_RIG_RUNNING);
    CHECK_NEAR(1e-3f, 300.5f * (float)EVEN_RPM, even.rig.run.target_radps);
}

TEST(station, a_whole_run) {
    console_begin();
    check_begins("OK state=idle speed_rpm=0.00 set_rpm=0.00 motor_V=0.00 trip=0 result=none",
                 ask("status"));
    check_begins("OK", ask("arm"));
    check_begins("OK", ask("start 330"));
    check_begins("OK state=tare ", ask("status"));
    even_go_on_until(&even, WH_PHASE_SPIN_UP);
    check_begins("OK state=spin_up speed_rpm=- set_rpm=330.00 ", ask("status"));
    even_go_on_until(&even, WH_PHASE_RECORD);
    check_begins("OK state=record speed_rpm=330.0", ask("status"));
    even_go_on_until(&even, WH_PHASE_RAMP_DOWN);
    check_begins("OK result=good turns=1", ask("measure"));
    TEST_ASSERT_NOT_NULL(strstr(heard, " speed_rpm=330.0"));
    TEST_ASSERT_NOT_NULL(strstr(heard, " force_N=42.0"));
    TEST_ASSERT_NOT_NULL(strstr(heard, ": no reason to doubt it"));
    check_begins("OK state=ramp_down ", ask("status"));
    check_begins("OK", ask("stop"));
    TEST_ASSERT_TRUE(even.command.way != WH_MOTOR_DRIVES);
}

TEST(station, trip_is_reported_and_cleared) {
    console_begin();
    ask("arm");
    ask("start 330");
    even_go_on_until(&even, WH_PHASE_RECORD);
    even.inputs.supply_V = WH_R(40.0);
    even_step(&even);
    even.inputs.supply_V = WH_RIG_RATED_V;
    check_begins("OK trip=11 in=record speed_rpm=330.0", ask("fault"));
    TEST_ASSERT_NOT_NULL(
        strstr(heard, " supply_V=40.00 ended=trip: the motor's supply is out of its range"));
    check_begins("OK state=tripped ", ask("status"));
    check_begins("ERR 5 ", ask("arm"));
    check_begins("ERR 11 ", ask("clear"));
    even_go_on_until(&even, EVEN_NEVER);
    check_begins("OK clear", ask("clear"));
    check_begins("OK trip=0 ended=trip: no fault", ask("fault"));
}

/* Escape is executed before all earlier input, even before a line that is not complete. */
TEST(station, escape_stops_at_once) {
    for (unsigned i = 0; i < 40; i++) {
        console_begin();
        ask("arm");
        ask("start 330");
        even_go_on_until(&even, i % 2U == 0 ? WH_PHASE_RAMP : WH_PHASE_RECORD);
        heard_length = 0;
        for (unsigned k = 0; k < i; k++) {
            type(k % 3U == 0 ? "status\n" : k % 3U == 1U ? "set 200\n" : "he");
        }
        type("\x1b");
        period(); /* an earlier order may still wait for its answer */
        period();
        TEST_ASSERT_TRUE(even.command.way != WH_MOTOR_DRIVES);
        TEST_ASSERT_TRUE(even.rig.state == WH_RIG_STOPPING);
        period();
        hear();
        TEST_ASSERT_NOT_NULL(strstr(heard, "OK stop\r\n"));
        check_begins("OK state=coast", ask("status"));
    }
}

TEST(station, lines_are_obeyed_in_order) {
    console_begin();
    type("arm\rstart 330\r\nstatus\nnonsense\n\nset 250\r");
    for (unsigned i = 0; i < 12; i++) {
        period();
    }
    hear();
    const char *wanted[] = {"OK arm\r\n", "OK start\r\n", "OK state=tare", "ERR 100", "OK set\r\n"};
    const char *at = heard;
    for (unsigned i = 0; i < 5; i++) {
        at = strstr(at, wanted[i]);
        TEST_ASSERT_NOT_NULL(at);
        at++;
    }
    unsigned lines = 0;
    for (at = heard; *at != '\0'; at++) {
        lines += *at == '\n' ? 1U : 0U;
    }
    TEST_ASSERT_EQUAL_UINT(5, lines); /* an empty line needs no answer */
}

TEST(station, typed_characters_are_echoed) {
    console_begin();
    check_begins("OK", ask("talk on"));
    heard_length = 0;
    type("armm\x7f\r\n");
    for (unsigned i = 0; i < 4; i++) {
        period();
    }
    hear();
    TEST_ASSERT_EQUAL_STRING("armm\b \b\r\n# armed\r\nOK arm\r\n", heard);
    type("talk off\n");
    period();
    heard_length = 0;
    period();
    hear();
    TEST_ASSERT_NOT_NULL(strstr(heard, "talk off\r\nOK\r\n"));
    TEST_ASSERT_EQUAL_STRING("OK stop", ask("stop"));
}

/* Without a reader, whole answers are dropped and counted. So when a reader returns, the buffer has only complete
 * lines. */
TEST(station, whole_answers_are_dropped) {
    console_begin();
    for (unsigned i = 0; i < 30; i++) {
        type("status\n");
        period();
    }
    hear();
    TEST_ASSERT_TRUE(heard[heard_length - 1U] == '\n');
    unsigned told = 0;
    for (const char *at = strstr(heard, "OK state=idle"); at != NULL;
         at = strstr(at + 1, "OK state=idle")) {
        told++;
    }
    TEST_ASSERT_EQUAL_UINT(30, told + station.lost_answers);
    TEST_ASSERT_TRUE(station.lost_answers > 0 && station.lost_bytes == 0);
    TEST_ASSERT_NULL(strstr(ask("status"), "lost_answers=0"));
    /* more than the ring can store */
    char many[WH_STATION_IN_BYTES + 10U];
    memset(many, 'x', sizeof many);
    wh_station_take(&station, many, sizeof many);
    TEST_ASSERT_EQUAL_UINT32(10, station.lost_bytes);
}

/* Lines arrive faster than they are processed. Each line is executed as typed, or refused because bytes were lost. */
TEST(station, incomplete_lines_are_not_obeyed) {
    seed = 12;
    console_begin();
    unsigned obeyed = 0;
    unsigned refused = 0;
    for (unsigned i = 0; i < 4000U; i++) {
        const unsigned lines = draw_one_of(&seed, draw_one_in(&seed, 40) ? 100 : 2);
        for (unsigned k = 0; k < lines; k++) {
            type("help start\r\n");
        }
        heard_length = 0;
        wh_station_step(&station, &even.rig);
        hear();
        if (heard_length > 0) {
            const bool whole = strncmp(heard, "OK start RPM", 12) == 0;
            check_begins(whole ? "OK start RPM" : "ERR 101 ", heard);
            obeyed += whole ? 1U : 0U;
            refused += whole ? 0U : 1U;
        }
    }
    TEST_ASSERT_TRUE(obeyed > 1000U && refused > 20U && station.lost_bytes > 1000U);
}

/* Random input, with or without a reader. The rig acts as if the same orders were posted, and each answer is that of
 * the rig. */
TEST(station, console_orders_equal_posted_orders) {
    static const struct {
        const char *line;
        wh_rig_event event;
        wh_real value;
    } orders[] = {{"arm", WH_EVENT_ARM, WH_R(0.0)},
                  {"start 330", WH_EVENT_START, WH_R(330.0) * EVEN_RPM},
                  {"start 1000", WH_EVENT_START, WH_R(1000.0) * EVEN_RPM},
                  {"set 250", WH_EVENT_SET, WH_R(250.0) * EVEN_RPM},
                  {"stop", WH_EVENT_STOP, WH_R(0.0)},
                  {"clear", WH_EVENT_CLEAR, WH_R(0.0)}};
    seed = 5;
    console_begin();
    twin = even;
    unsigned allowed = 0;
    for (unsigned i = 0; i < 400U; i++) {
        const unsigned k = draw_one_of(&seed, draw_one_in(&seed, 3) ? 6 : 2);
        const wh_real supply_V = draw_one_in(&seed, 20) ? WH_R(5.0) : WH_RIG_RATED_V;
        even.inputs.supply_V = supply_V;
        twin.inputs.supply_V = supply_V;
        heard_length = 0;
        type(orders[k].line);
        type(draw_one_in(&seed, 2) ? "\r\n" : "\n");
        period(); /* this period reads the line */
        even_step(&twin);
        period(); /* this one processes the order and answers */
        const wh_refusal answer = even_order(&twin, orders[k].event, orders[k].value);
        if (!draw_one_in(&seed, 8)) {
            hear();
            check_begins(answer == WH_ALLOWED ? "OK " : "ERR ", heard);
            allowed += answer == WH_ALLOWED ? 1U : 0U;
        }
        const unsigned steps = draw_one_of(&seed, draw_one_in(&seed, 6) ? 6000 : 60);
        for (unsigned step = 0; step < steps; step++) {
            period();
            even_step(&twin);
        }
        hear();
        TEST_ASSERT_TRUE(memcmp(&even.command, &twin.command, sizeof even.command) == 0);
        TEST_ASSERT_TRUE(even.rig.state == twin.rig.state && even.rig.answers == twin.rig.answers);
        TEST_ASSERT_EQUAL_UINT(wh_rig_stage(&twin.rig), wh_rig_stage(&even.rig));
    }
    TEST_ASSERT_TRUE(allowed > 60U);
}

/* Random bytes: every answer has a line end, and there are at most as many answers as lines. */
TEST(station, any_bytes) {
    static const char *const pieces[] = {"arm",    "start", " 330", "stop",    "\n",
                                         "\r\n",   "\x1b",  "help", " ",       "talk on",
                                         "status", "\b",    "\xff", "measure", "fault"};
    seed = 9;
    console_begin();
    uint32_t lines_in = 0;
    uint32_t lines_out = 0;
    for (unsigned i = 0; i < 20000U; i++) {
        const char *piece = pieces[draw_one_of(&seed, 15)];
        type(piece);
        lines_in += strpbrk(piece, "\n\x1b") != NULL ? 1U : 0U;
        /* an open order counts as answered, because the test ends here */
        even.rig.answers += station.waits ? 1U : 0U;
        even.rig.orders = 0;
        wh_station_step(&station, &even.rig);
        station.talks = false; /* without echo, because an echo is no answer */
        heard_length = 0;
        hear();
        TEST_ASSERT_TRUE(heard_length == 0 || heard[heard_length - 1U] == '\n');
        lines_out += heard_length > 0 ? 1U : 0U;
    }
    TEST_ASSERT_TRUE(lines_out <= lines_in && lines_out > 1000U);
    TEST_ASSERT_TRUE(station.lost_answers == 0);
}
