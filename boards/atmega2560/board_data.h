/* Microchip's ATmega2560. */
#ifndef BOARD_DATA_H
#define BOARD_DATA_H

#define BOARD_NAME "atmega2560"

#endif
