/* avr_main.cpp: firmware of an AVR in C++, for tests/embed/avr.sh. It runs a scene to its end and computes the
 * core's inline sine at phases all over the turn. It prints a hash of each on the UART. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>

#include "core/hash.h"
#include "core/text.h"
#include "generated.h"

static uint64_t memory[tested_MEMORY_WORDS];

static void say_hash(uint64_t hash) {
    char line[24];
    wh_text text;
    wh_text_start(&text, line, sizeof line);
    wh_text_add_hex(&text, hash, 16);
    wh_text_add_char(&text, '\n');
    for (unsigned i = 0; i < text.length; i++) {
        while (!(UCSR0A & _BV(UDRE0))) {
        }
        UDR0 = static_cast<uint8_t>(line[i]);
    }
}

int main() {
    UCSR0B = _BV(TXEN0);
    wh_state state;
    wh_status status = wh_scene_start(&tested, &state, memory, tested_MEMORY_BYTES);
    while (status == WH_OK && state.steps < tested.steps) {
        status = wh_scene_step(&tested, &state);
    }
    say_hash(wh_scene_hash(&tested, &state));
    uint64_t hash = WH_HASH_START;
    for (uint32_t i = 0; i < 1000; i++) {
        wh_real sine;
        wh_real cosine;
        wh_sincos(i * UINT32_C(4294967), &sine, &cosine);
        hash = wh_hash_real(wh_hash_real(hash, sine), cosine);
    }
    say_hash(hash);
    cli();
    sleep_enable();
    sleep_cpu();
    return 0;
}
