/* Microchip's ATmega328P. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "atmega328p"

#endif
