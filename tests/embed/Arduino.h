/* Arduino.h: as much of the framework as the sketches of the docs need to run on this machine. It also defines
 * Arduino's macros, with which the core's headers must compile. */
#ifndef TESTS_EMBED_ARDUINO_H
#define TESTS_EMBED_ARDUINO_H

/* clang-format off */
#define INPUT 0x0
#define OUTPUT 0x1
#define HIGH 0x1
#define PI 3.1415926535897932384626433832795
#define EULER 2.718281828459045235360287471352
#define DEFAULT 1
#define A0 14
#define B1 1
#define F(text) (text)
#define min(a, b) ((a) < (b) ? (a) : (b))
#define max(a, b) ((a) > (b) ? (a) : (b))
#define abs(x) ((x) > 0 ? (x) : -(x))
#define round(x) ((x) >= 0 ? (long)((x) + 0.5) : (long)((x)-0.5))
#define sq(x) ((x) * (x))
#define bit(b) (1UL << (b))
#define radians(deg) ((deg) * 0.0174532925)
#define degrees(rad) ((rad) * 57.2957795)
#define constrain(amt, low, high) ((amt) < (low) ? (low) : ((amt) > (high) ? (high) : (amt)))
#define lowByte(w) ((unsigned char)((w) & 0xff))
#define interrupts() (void)0
#define _BV(bit) (1 << (bit))
/* clang-format on */

#ifdef __cplusplus

class SerialPort {
  public:
    void begin(unsigned long baud);
    void println(const char *line);
};
extern SerialPort Serial;

void setup();
void loop();

#endif
#endif
