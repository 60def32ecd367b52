/* state_machine.c: the rig's life cycle, as one table. */
#include "state_machine.h"

#include "core/text.h"

#define TO(state) \
    { WH_RIG_##state, WH_ALLOWED }
#define NO(state, why) \
    { WH_RIG_##state, WH_REFUSED_##why }

/* clang-format off */
static const wh_rig_transition rules[WH_EVENTS][WH_RIG_STATES] = {
    /*                       idle                   armed                   running               stopping                tripped */
    [WH_EVENT_ARM]       = { TO(ARMED),             NO(ARMED, ARMED),       NO(RUNNING, RUNNING), NO(STOPPING, STOPPING), NO(TRIPPED, TRIPPED) },
    [WH_EVENT_START]     = { NO(IDLE, NOT_ARMED),   TO(RUNNING),            NO(RUNNING, RUNNING), NO(STOPPING, STOPPING), NO(TRIPPED, TRIPPED) },
    [WH_EVENT_SET]       = { NO(IDLE, NOT_RUNNING), NO(ARMED, NOT_RUNNING), TO(RUNNING),          NO(STOPPING, STOPPING), NO(TRIPPED, TRIPPED) },
    [WH_EVENT_STOP]      = { TO(IDLE),              TO(IDLE),               TO(STOPPING),         TO(STOPPING),           TO(TRIPPED) },
    [WH_EVENT_CLEAR]     = { NO(IDLE, NO_TRIP),     NO(ARMED, NO_TRIP),     NO(RUNNING, NO_TRIP), NO(STOPPING, NO_TRIP),  TO(IDLE) },
    [WH_EVENT_HOST_LOST] = { TO(IDLE),              TO(IDLE),               TO(STOPPING),         TO(STOPPING),           TO(TRIPPED) },
    [WH_EVENT_DONE]      = { NO(IDLE, NOT_RUNNING), NO(ARMED, NOT_RUNNING), TO(STOPPING),         NO(STOPPING, STOPPING), NO(TRIPPED, TRIPPED) },
    [WH_EVENT_RESTED]    = { TO(IDLE),              TO(ARMED),              TO(RUNNING),          TO(IDLE),               TO(TRIPPED) },
    [WH_EVENT_EXPIRED]   = { TO(IDLE),              TO(IDLE),               TO(RUNNING),          TO(STOPPING),           TO(TRIPPED) },
    [WH_EVENT_TRIP]      = { TO(TRIPPED),           TO(TRIPPED),            TO(TRIPPED),          TO(TRIPPED),            TO(TRIPPED) },
};
/* clang-format on */

wh_rig_transition wh_rig_transition_of(wh_rig_state state, wh_rig_event event) {
    if ((unsigned)state >= (unsigned)WH_RIG_STATES || (unsigned)event >= (unsigned)WH_EVENTS) {
        return (wh_rig_transition){state, WH_REFUSED_EVENT};
    }
    return rules[event][state];
}

#define ONE(name, number, words) +1
#define ITEM(name, words) words "\0"
#define NUMBERED_ITEM(name, number, words) words "\0"
_Static_assert(0 WH_REFUSAL_ROWS(ONE) == (int)WH_REFUSALS, "all numbers are used");

const char *wh_rig_state_text(wh_rig_state state) {
    static const char words[] WH_WORD_LIST = WH_RIG_STATE_ROWS(ITEM) WH_WORDS("unknown state");
    return wh_words_item(words, state);
}

const char *wh_rig_event_text(wh_rig_event event) {
    static const char words[] WH_WORD_LIST = WH_EVENT_ROWS(ITEM) WH_WORDS("unknown event");
    return wh_words_item(words, event);
}

const char *wh_refusal_text(wh_refusal refusal) {
    static const char words[] WH_WORD_LIST =
        WH_REFUSAL_ROWS(NUMBERED_ITEM) WH_WORDS("unknown refusal");
    return wh_words_item(words, refusal);
}

const char *wh_rig_end_text(wh_rig_end end) {
    static const char words[] WH_WORD_LIST = WH_END_ROWS(ITEM) WH_WORDS("unknown end");
    return wh_words_item(words, end);
}
