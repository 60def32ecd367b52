/* test_emitted_scene.c: the scene in generated C agrees with the image, for random scenes, read back word by word. */
#include "core/contact.h"
#include "emitted.h"
#include "host/image/image.h"
#include "test.h"

/* ".NAME = VALUE," in the object that begins after word `at`. */
static void expect_field(int at, const char *name, const char *value) {
    char words[300];
    char found[300];
    snprintf(words, sizeof words, ". %s =", name);
    const int from = c_need(&emitted.file, at, words);
    const int closing = c_closing(&emitted.file, at - 1);
    TEST_ASSERT_TRUE_MESSAGE(from < closing, name);
    int end = from;
    while (end < closing && !c_is(&emitted.file, end, ",")) {
        end = c_is(&emitted.file, end, "(") || c_is(&emitted.file, end, "{")
                  ? c_closing(&emitted.file, end) + 1
                  : end + 1;
    }
    c_text(&emitted.file, from, end, found, sizeof found);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(value, found, name);
}

static void expect_number(int at, const char *name, int value) {
    char words[20];
    snprintf(words, sizeof words, "%d", value);
    expect_field(at, name, words);
}

static void expect_real(int at, const char *name, double value) {
    char words[40];
    snprintf(words, sizeof words, ". %s =", name);
    at = c_need(&emitted.file, at, words);
    TEST_ASSERT_TRUE_MESSAGE(c_number(&emitted.file, &at) == value, name);
}

static void check_scene(const image *im) {
    char words[100];
    snprintf(words, sizeof words, "extern const wh_scene %s ; WH_LINKED_AS ( %s ,", im->name,
             im->name);
    int at = c_need(&emitted.file, 0, words);
    snprintf(words, sizeof words, ") ; const wh_scene %s = {", im->name);
    at = c_need(&emitted.file, at + 1, words);
    snprintf(words, sizeof words, "\"%s\"", im->name);
    expect_field(at, "name", words);
    expect_field(at, "form", im->form == WH_SECOND_ORDER ? "WH_SECOND_ORDER" : "WH_FIRST_ORDER");
    expect_field(at, "method", wh_methods[im->settings.method].name);
    expect_number(at, "angles", im->angles);
    expect_number(at, "reals", im->reals);
    expect_number(at, "inputs", im->inputs);
    expect_number(at, "outputs", im->outputs);
    if (im->contacts > 0) {
        expect_number(at, "contacts", im->contacts);
        expect_number(at, "held", im->held);
    }
    TEST_ASSERT_EQUAL(im->contacts > 0, c_behind(&emitted.file, at, ". contacts =") >= 0);
    TEST_ASSERT_EQUAL(im->ledger.kept, c_behind(&emitted.file, at, ". ledger = & ledger ,") >= 0);
    expect_field(at, "compensated", im->settings.compensated ? "true" : "false");
    expect_real(at, "step_s", im->step_s);
    snprintf(words, sizeof words, "{ UINT64_C ( %" PRIu64 " ) , UINT64_C ( %" PRIu64 " ) }",
             im->step.numerator, im->step.denominator);
    expect_field(at, "step", words);
    snprintf(words, sizeof words, "UINT64_C ( %" PRIu64 " )", im->steps);
    expect_field(at, "steps", words);
    expect_field(at, "start_angle", im->angles > 0 ? "start_angle" : "NULL");
    expect_field(at, "start_real", im->reals > 0 ? "start_real" : "NULL");
    expect_field(at, "start_input", im->inputs > 0 ? "start_input" : "NULL");
    expect_field(at, "model", "NULL");
    snprintf(words, sizeof words, "UINT64_C ( 0x%016" PRIx64 " )", im->hash);
    expect_field(at, "model_hash", words);
    expect_field(at, "advance", "advance");
    expect_field(at, "observe", im->outputs > 0 ? "observe" : "NULL");
    expect_field(at, "arithmetic", "wh_arithmetic");
    const bool ahead = im->contacts == 0 && !im->ledger.kept;
    TEST_ASSERT_EQUAL(ahead, c_behind(&emitted.file, at, ". ahead = ahead ,") >= 0);
    TEST_ASSERT_EQUAL(ahead, strstr(emitted.text,
                                    "#if defined(WH_AHEAD) && WH_AHEAD\n    .ahead = ahead,\n"
                                    "#endif\n    .observe") != NULL);
    TEST_ASSERT_EQUAL(ahead,
                      strstr(emitted.text, "#if defined(WH_AHEAD) && WH_AHEAD\nstatic wh_status "
                                           "ahead(") != NULL);
    TEST_ASSERT_TRUE(c_is(&emitted.file, emitted.file.words - 2, "}") &&
                     c_is(&emitted.file, emitted.file.words - 1, ";"));
}

TEST(emitted_scene, the_scene_is_the_images) { each_emitted(check_scene); }

/* WH_TWO_PART(step, its remainder in float) */
static int expect_span(int at, double step_s) {
    at = c_need(&emitted.file, at, "WH_TWO_PART (");
    TEST_ASSERT_TRUE(c_number(&emitted.file, &at) == step_s);
    at++;
    TEST_ASSERT_TRUE(c_number(&emitted.file, &at) == step_s - (double)(float)step_s);
    return at + 1;
}

static void check_step(const image *im) {
    const bool second = im->form == WH_SECOND_ORDER;
    const bool turns = image_turns(im);
    const char *list = second ? "accelerations" : "slopes";
    const char *waves = turns ? " & waves ," : "";
    const char *compensated = im->settings.compensated ? "true" : "false";
    const char *method = wh_methods[im->settings.method].name;
    char words[200];
    int at = c_need(
        &emitted.file, 0,
        "WH_INLINE wh_status one_step ( const wh_scene * scene , wh_state * state ) { ( void ) scene ; return");
    if (im->contacts > 0) {
        at = c_need(&emitted.file, at, "wh_step_contact ( & contacts , WH_R (");
        TEST_ASSERT_TRUE(c_number(&emitted.file, &at) == im->step_s);
        c_need(&emitted.file, at, ") , state ) ; }");
        return;
    }
    if (im->settings.matrix != MATRIX_NONE) {
        snprintf(words, sizeof words,
                 "wh_step_matrix ( NULL , step_matrix , %s , %dU , %dU , %dU ,", compensated,
                 im->angles, im->reals, second ? im->coordinates - im->angles : 0);
    } else if (im->ledger.kept) {
        snprintf(words, sizeof words,
                 "wh_%s_ledger ( & ledger , NULL , accelerations ,%s %s , %s ,",
                 turns ? "turn" : "step", waves, method, compensated);
    } else {
        snprintf(words, sizeof words, "wh_%s_%s ( NULL , %s ,%s %s , %s , %dU , %dU ,",
                 turns ? "turn" : "step", second ? "second" : "first", list, waves, method,
                 compensated, im->angles, second ? im->coordinates : im->reals);
    }
    TEST_ASSERT_TRUE_MESSAGE(c_need(&emitted.file, at, words) - at < 40, words);
    at = expect_span(at, im->step_s);
    c_need(&emitted.file, at, ", state ) ; }");
    if (im->ledger.kept) {
        return;
    }
    snprintf(words, sizeof words,
             "return wh_steps_ahead ( scene , one_step , %dU , %dU , %s , state , steps ) ; }",
             im->angles, im->reals, compensated);
    c_need(&emitted.file, at, words);
}

TEST(emitted_scene, a_step_is_called_by_what_it_is) { each_emitted(check_step); }

static void check_contacts(const image *im) {
    static const char *const kinds[] = {"WH_STOP", "WH_HOLD", "WH_FRICTION", "WH_WHEN"};
    char words[400];
    char of[120] = "";
    int pinned = 0;
    int stops = 0;
    if (im->contacts == 0) {
        TEST_ASSERT_FALSE(emitted_says("wh_contact"));
        return;
    }
    snprintf(words, sizeof words, "wh_contact contact_table [ %d ] = {", im->contacts);
    int at = c_need(&emitted.file, 0, words);
    for (int k = 0; k < im->contacts; k++) {
        const image_contact *c = &im->contact[k];
        const char *sign[] = {"", "- "};
        snprintf(words, sizeof words, "{ %s , %s%d , %s%d , %d , %d } %s", kinds[c->kind],
                 sign[c->direction < 0], abs(c->direction), sign[c->pin < 0], abs(c->pin),
                 c->first_set, c->sets, k + 1 < im->contacts ? "," : "}");
        const int behind = c_need(&emitted.file, at, words);
        TEST_ASSERT_TRUE_MESSAGE(behind - at < 16, words);
        at = behind;
        stops += c->kind == WH_STOP;
        pinned += c->kind != WH_WHEN && c->pin >= 0;
    }
    for (int kind = 0; kind < WH_CONTACT_KIND_COUNT; kind++) {
        for (int k = 0; k < im->contacts; k++) {
            if (im->contact[k].kind == kind && kind != WH_WHEN) {
                snprintf(of + strlen(of), sizeof of - strlen(of), "%sWH_KIND_BIT ( %s )",
                         of[0] != '\0' ? " | " : "", kinds[kind]);
                break;
            }
        }
    }
    if (im->set_count > 0) {
        snprintf(words, sizeof words, "uint8_t contact_target [ %d ] = {", im->set_count);
        at = c_need(&emitted.file, 0, words);
        for (int i = 0; i < im->set_count; i++, at++) {
            TEST_ASSERT_TRUE((int)c_number(&emitted.file, &at) == im->target[i]);
            TEST_ASSERT_TRUE(c_is(&emitted.file, at, i + 1 < im->set_count ? "," : "}"));
        }
    }
    at = c_need(&emitted.file, 0, "wh_contact_system contacts = {");
    expect_field(at, "accel", "accelerations");
    expect_field(at, "signals", "contact_signals");
    expect_field(at, "forces", "contact_forces");
    expect_field(at, "sets", im->set_count > 0 ? "contact_sets" : "NULL");
    expect_field(at, "contact", "contact_table");
    expect_field(at, "target", im->set_count > 0 ? "contact_target" : "NULL");
    expect_field(at, "ledger", im->ledger.kept ? "& ledger" : "NULL");
    expect_number(at, "contacts", im->contacts);
    expect_number(at, "forced", im->forced);
    expect_field(at, "kinds", of[0] != '\0' ? of : "0");
    expect_number(at, "pinned", pinned);
    expect_number(at, "held", im->held);
    snprintf(words, sizeof words, "WH_CONTACT_EVALUATIONS ( %d , %d , %d )",
             wh_methods[im->settings.method].stages, stops, im->forced);
    expect_field(at, "evaluations", words);
    expect_field(at, "method", wh_methods[im->settings.method].name);
    expect_field(at, "compensated", im->settings.compensated ? "true" : "false");
    expect_number(at, "angles", im->angles);
    expect_number(at, "coordinates", im->coordinates);
}

TEST(emitted_scene, contacts_are_the_images) { each_emitted(check_contacts); }

static void expect_numbers(const char *name, const int *value, int count) {
    char words[100];
    snprintf(words, sizeof words, "uint8_t %s [ %d ] = {", name, count);
    TEST_ASSERT_EQUAL_MESSAGE(count > 0, emitted_says(words), words);
    int at = c_behind(&emitted.file, 0, words);
    for (int i = 0; i < count; i++, at++) {
        TEST_ASSERT_TRUE((int)c_number(&emitted.file, &at) == value[i]);
        TEST_ASSERT_TRUE(c_is(&emitted.file, at, i + 1 < count ? "," : "}"));
    }
}

static void check_books(const image *im) {
    const image_ledger *l = &im->ledger;
    int account[SCENE_ROWS];
    TEST_ASSERT_EQUAL(l->kept, emitted_says("wh_ledger_form ledger = {"));
    if (!l->kept) {
        return;
    }
    for (int i = 0; i < l->smooth; i++) {
        account[i] = l->entry[i].account;
    }
    expect_numbers("ledger_accounts", account, l->smooth);
    expect_numbers("ledger_inputs", l->input, l->inputs);
    const int at = c_need(&emitted.file, 0, "wh_ledger_form ledger = {");
    expect_field(at, l->turned ? "turned" : "powers", "ledger_powers");
    expect_field(at, "levels", "ledger_levels");
    expect_field(at, "account", l->smooth > 0 ? "ledger_accounts" : "NULL");
    expect_number(at, "smooth", l->smooth);
    expect_number(at, "entries", l->entries);
    expect_number(at, "accounts", 2 * l->accounts + l->inputs);
    expect_number(at, "coordinates", im->coordinates);
    expect_number(at, "angles", im->angles);
    if (l->inputs > 0) {
        expect_field(at, "input", "ledger_inputs");
        expect_number(at, "inputs", l->inputs);
    }
}

TEST(emitted_scene, books_are_the_images) { each_emitted(check_books); }

static void check_observer(const image *im) {
    char words[200];
    if (im->outputs == 0) {
        TEST_ASSERT_FALSE(emitted_says("observe ("));
        return;
    }
    const int at = c_need(
        &emitted.file, 0,
        "static void observe ( const wh_scene * scene , const wh_state * state , wh_real * output ) {");
    const int end = c_closing(&emitted.file, at - 1);
    snprintf(words, sizeof words, "rate = state -> real + %d ;", im->coordinates - im->angles);
    const int rate = c_behind(&emitted.file, at, "const wh_real * rate");
    TEST_ASSERT_EQUAL(rate >= 0 && rate < end, c_behind(&emitted.file, at, words) >= 0);
    if (c_behind(&emitted.file, at, "phase [") >= 0) {
        snprintf(words, sizeof words,
                 "wh_phase phase [ %d ] ; for ( int i = 0 ; i < %d ; i ++ ) { phase [ i ] = "
                 "wh_phase_of ( state -> angle [ i ] ) ; }",
                 im->angles, im->angles);
        c_need(&emitted.file, at, words);
    }
    if (c_behind(&emitted.file, at, "accel [") >= 0) {
        snprintf(words, sizeof words,
                 "wh_real accel [ %d ] ; wh_contact_observe ( & contacts , state , accel ) ;",
                 im->coordinates);
        c_need(&emitted.file, at, words);
    }
}

TEST(emitted_scene, observers_have_what_they_read) { each_emitted(check_observer); }

SUITE(emitted_scene) { emitted_die = dice_of("emitted_scene", 4110); }
