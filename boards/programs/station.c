/* station.c: the rig's firmware with a console (core/station). The program never ends. If a model simulates the
 * hardware (hal/virtual), its time follows the board's clock. */
#include "core/station/station.h"

#include "boards/board.h"
#include "hal/clock.h"
#include "hal/console.h"
#include "hal/motor.h"
#include "hal/reset.h"
#include "hal/watchdog.h"
#include "rig_control.h"
#include "rig_report.h"
#include "rig_settings.h"

/* largest number of bytes that a control step reads from the console; at 115,200 baud 23 arrive in a step */
#define BYTES_A_STEP 32U

static wh_station station;
static wh_rig_config config;
static wh_conf conf;
#if WH_STATION_TELEMETRY
static wh_tel tel;
#endif

static void converse(void) {
    char bytes[BYTES_A_STEP];
    wh_station_take(&station, bytes, hal_console_read(bytes, sizeof bytes));
    wh_station_see(&station, &config, &rig, &seen);
    wh_station_step(&station, &rig);
    const unsigned waiting = wh_station_peek(&station, bytes, sizeof bytes);
    wh_station_drop(&station, hal_console_offer(bytes, waiting));
}

/* Reports a reset, and a missing crystal. */
static void tell_reset(void) {
    char words[200];
    if (hal_reset_cause() != HAL_RESET_POWER_ON) {
        const unsigned count = hal_reset_words(words, sizeof words);
        put("\r\n"
            "# reset: "); /* The line end comes first, because the reset may have cut a line. */
        hal_console_write(words, count);
        put("\r\n");
    }
    if (hal_clock_source_now() == HAL_CLOCK_FALLBACK) {
        put("# no crystal clock: runs are refused until it works"
            "\r\n");
    }
}

#if HAL_VIRTUAL
/* Waits for the next period of the board's clock. After a long delay (a debugger, a sleeping laptop) the next period
 * begins now. */
static void keep_time(uint32_t *due_ticks) {
    const uint32_t period_ticks = board_ticks_per_s / (HAL_TICKS_PER_S / CONTROL_TICKS);
    *due_ticks += period_ticks;
    if ((int32_t)(board_ticks() - *due_ticks) > (int32_t)(100U * period_ticks)) {
        *due_ticks = board_ticks();
    }
    board_wait_until(*due_ticks);
}
#endif

/* Returns the time of the next step. After a long delay, such as the erase of a sector, missed steps are skipped. */
static uint32_t next_step(uint32_t due_ticks) {
    const uint32_t now = hal_clock_ticks();
    const bool late = (int32_t)(now - due_ticks) > (int32_t)WATCHDOG_TICKS;
    return (late ? now : due_ticks) + CONTROL_TICKS;
}

int main(void) {
    board_start();
    if (!board_converse()) {
        board_exit(2);
    }
    const char *why = why_not_started();
    if (why != NULL) {
        put("NOT STARTED: ");
        put(why);
        put("\r\n");
        board_exit(2);
    }
    wh_conf_start(&conf, own_configuration, &settings_memory, &config);
    uint32_t due = hal_clock_ticks();
#if HAL_VIRTUAL
    uint32_t paced = board_ticks();
#endif
    trip_memory_start(&kept_trip, &config, &rig, due);
    tell_reset();
    wh_station_start(&station, "rig", board_name, HAL_TICKS_PER_S / CONTROL_TICKS);
    station.conf = &conf;
#if WH_STATION_TELEMETRY
    station.tel = &tel;
#endif
    hal_watchdog_start(WATCHDOG_TICKS);
    for (;;) {
        due = next_step(due);
        hal_clock_wait_until(due);
        control(&config);
        converse();
#if HAL_VIRTUAL
        keep_time(&paced);
#endif
    }
}
