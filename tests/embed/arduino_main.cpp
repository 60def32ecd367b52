/* arduino_main.cpp: runs a sketch on this machine: setup() once, then loop() a given number of times. */
#include <cstdio>
#include <cstdlib>

#include "Arduino.h"

SerialPort Serial;

void SerialPort::begin(unsigned long baud) { (void)baud; }

void SerialPort::println(const char *line) { std::puts(line); }

int main(int count, char **words) {
    setup();
    for (long i = count > 1 ? std::atol(words[1]) : 0; i > 0; i--) {
        loop();
    }
    return 0;
}
