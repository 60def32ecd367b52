/* cost_fixed_rows.h: what each class of work costs in fixed point, by board: fitted to counted steps and written by
 * `make price-fit-fixed`. Do not edit. */
/* clang-format off */
#include "cost_fixed_row.h"

static const cost_fixed_row cost_fixed_rows[] = {
    {.board = "atmega328p",
     .compiler = "avr-gcc 5.4.0 -mmcu=atmega328p -Os",
     .spread = 1.012, .spread_cycles = 1.008,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 77, .bound = 1.76, .largest = 56251, .figure = {
             [COST_X_ANGLES] = 964.5, [COST_X_PLACES] = 746.5, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_PLACES] = 511.4,
             [COST_X_STAGED_RATES] = 89.02, [COST_X_FIRSTS] = 64.09, [COST_X_SUMS] = 90.31, [COST_X_PRODUCTS] = 308.2, [COST_X_BY_CONSTANT] = 355.5,
             [COST_X_BY_SHORT] = 1249, [COST_X_BITS] = 18.91, [COST_X_QUOTIENTS] = 2169, [COST_X_WAVE_ALONE] = 3797, [COST_X_WAVES] = 3789,
             [COST_X_CHOICES] = 498.4, [COST_X_CARRIED] = 3.123,
         }},
         [COST_OF_CYCLES] = {.cases = 77, .bound = 1.69, .largest = 75122, .figure = {
             [COST_X_ONE] = 32.06, [COST_X_ANGLES] = 1178, [COST_X_PLACES] = 1018, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_PLACES] = 637, [COST_X_STAGED_RATES] = 118.8, [COST_X_FIRSTS] = 153.1, [COST_X_SUMS] = 123.9,
             [COST_X_PRODUCTS] = 397.6, [COST_X_BY_CONSTANT] = 473.9, [COST_X_BY_SHORT] = 1574, [COST_X_BITS] = 27.84, [COST_X_QUOTIENTS] = 2656,
             [COST_X_WAVE_ALONE] = 5117, [COST_X_WAVES] = 5060, [COST_X_TERMS] = 57.52, [COST_X_CHOICES] = 596.7, [COST_X_CARRIED] = 12.46,
         }},
         [COST_OF_FLASH] = {.cases = 77, .bound = 1.22, .largest = 14268, .figure = {
             [COST_X_ONE] = 1241, [COST_X_ANGLES] = 983.8, [COST_X_PLACES] = 629, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 167.1, [COST_X_STAGED_PLACES] = 408.4, [COST_X_STAGED_RATES] = 67.44, [COST_X_FIRST_ANGLES] = 408,
             [COST_X_CALLED] = 3470, [COST_X_CODE_SUMS] = 9.127, [COST_X_CODE_PRODUCTS] = 5.284, [COST_X_CODE_BY_CONSTANT] = 8.29,
             [COST_X_CODE_BY_SHORT] = 26.79, [COST_X_CODE_WAVE_ALONE] = 255.1, [COST_X_CODE_OTHERS] = 2.376, [COST_X_CODE_LEAVES] = 15.29,
             [COST_X_CODE_CARRIED] = 5.39, [COST_X_ANY_WAVE] = 488.6, [COST_X_ANY_SHARED_WAVE] = 832.2, [COST_X_ANY_QUOTIENT] = 817.4,
             [COST_X_NUMBERS] = 26.15,
         }},
         [COST_OF_RAM] = {.cases = 77, .bound = 1.09, .largest = 352, .figure = {
             [COST_X_ONE] = 40.5, [COST_X_ANY_WAVE] = 1.485, [COST_X_ANY_QUOTIENT] = 0.6769, [COST_X_NUMBERS] = 10.71, [COST_X_STATE_BYTES] = 1.835,
         }},
         [COST_OF_STACK] = {.cases = 77, .bound = 1.26, .largest = 639, .figure = {
             [COST_X_ONE] = 305.3, [COST_X_LIES_COMPONENTS] = 24.35, [COST_X_LIES_RATES] = 8.936, [COST_X_ANY_WAVE] = 38.62,
             [COST_X_ANY_QUOTIENT] = 13.51, [COST_X_LIES_WAVES] = 5.459, [COST_X_LIES_OPERATIONS] = 0.5834,
         }},
     }},
    {.board = "atmega2560",
     .compiler = "avr-gcc 5.4.0 -mmcu=atmega2560 -Os",
     .spread = 1.012, .spread_cycles = 1.008,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 77, .bound = 1.77, .largest = 56251, .figure = {
             [COST_X_ANGLES] = 963.6, [COST_X_PLACES] = 746.9, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_PLACES] = 511.3,
             [COST_X_STAGED_RATES] = 89.21, [COST_X_FIRSTS] = 64.65, [COST_X_SUMS] = 90.5, [COST_X_PRODUCTS] = 307.6, [COST_X_BY_CONSTANT] = 355.1,
             [COST_X_BY_SHORT] = 1250, [COST_X_BITS] = 18.86, [COST_X_QUOTIENTS] = 2171, [COST_X_WAVE_ALONE] = 3799, [COST_X_WAVES] = 3791,
             [COST_X_CHOICES] = 498.8, [COST_X_CARRIED] = 3.862,
         }},
         [COST_OF_CYCLES] = {.cases = 77, .bound = 1.69, .largest = 75888, .figure = {
             [COST_X_ONE] = 45.12, [COST_X_ANGLES] = 1181, [COST_X_PLACES] = 1025, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_PLACES] = 637.2, [COST_X_STAGED_RATES] = 119, [COST_X_FIRSTS] = 155.9, [COST_X_SUMS] = 124, [COST_X_PRODUCTS] = 405.3,
             [COST_X_BY_CONSTANT] = 481.4, [COST_X_BY_SHORT] = 1582, [COST_X_BITS] = 27.82, [COST_X_QUOTIENTS] = 2666, [COST_X_WAVE_ALONE] = 5155,
             [COST_X_WAVES] = 5098, [COST_X_TERMS] = 58.86, [COST_X_CHOICES] = 596.9, [COST_X_CARRIED] = 13.09,
         }},
         [COST_OF_FLASH] = {.cases = 77, .bound = 1.20, .largest = 14404, .figure = {
             [COST_X_ONE] = 1370, [COST_X_ANGLES] = 982, [COST_X_PLACES] = 633.9, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 171, [COST_X_STAGED_PLACES] = 405.3, [COST_X_STAGED_RATES] = 60.87, [COST_X_FIRST_ANGLES] = 404.1,
             [COST_X_CALLED] = 3498, [COST_X_CODE_SUMS] = 9.037, [COST_X_CODE_PRODUCTS] = 5.391, [COST_X_CODE_BY_CONSTANT] = 8.377,
             [COST_X_CODE_BY_SHORT] = 26.3, [COST_X_CODE_WAVE_ALONE] = 256.3, [COST_X_CODE_OTHERS] = 2.441, [COST_X_CODE_LEAVES] = 16.39,
             [COST_X_CODE_CARRIED] = 5.299, [COST_X_ANY_WAVE] = 486.4, [COST_X_ANY_SHARED_WAVE] = 839.4, [COST_X_ANY_QUOTIENT] = 817.3,
             [COST_X_NUMBERS] = 25.14,
         }},
         [COST_OF_RAM] = {.cases = 77, .bound = 1.09, .largest = 352, .figure = {
             [COST_X_ONE] = 40.5, [COST_X_ANY_WAVE] = 1.485, [COST_X_ANY_QUOTIENT] = 0.6769, [COST_X_NUMBERS] = 10.71, [COST_X_STATE_BYTES] = 1.835,
         }},
         [COST_OF_STACK] = {.cases = 77, .bound = 1.26, .largest = 645, .figure = {
             [COST_X_ONE] = 310.3, [COST_X_LIES_COMPONENTS] = 24.35, [COST_X_LIES_RATES] = 8.936, [COST_X_ANY_WAVE] = 39.61,
             [COST_X_ANY_QUOTIENT] = 13.5, [COST_X_LIES_WAVES] = 5.462, [COST_X_LIES_OPERATIONS] = 0.583,
         }},
     }},
    {.board = "mps2-an385-m0",
     .compiler = "arm-none-eabi-gcc 12.2.1 -mcpu=cortex-m0 -mthumb -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 77, .bound = 1.30, .largest = 13179, .figure = {
             [COST_X_ANGLES] = 134.8, [COST_X_PLACES] = 133.5, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_PLACES] = 42.14,
             [COST_X_STAGED_RATES] = 62.03, [COST_X_FIRSTS] = 29.12, [COST_X_FIRST_ANGLES] = 74.82, [COST_X_CALLED_DATA] = 7.131,
             [COST_X_PRODUCTS] = 94.27, [COST_X_BY_CONSTANT] = 116, [COST_X_BY_SHORT] = 157.3, [COST_X_QUOTIENTS] = 360.8,
             [COST_X_WAVE_ALONE] = 397.9, [COST_X_WAVES] = 557.4, [COST_X_TERMS] = 12.25, [COST_X_CHOICES] = 2.993, [COST_X_CARRIED] = 48.41,
         }},
         [COST_OF_CYCLES] = {.cases = 77, .bound = 1.39, .largest = 16396, .figure = {
             [COST_X_ANGLES] = 119.6, [COST_X_PLACES] = 146.5, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_PLACES] = 83.49,
             [COST_X_STAGED_RATES] = 88.95, [COST_X_FIRSTS] = 4.541, [COST_X_FIRST_ANGLES] = 61.87, [COST_X_CALLED_DATA] = 30.44,
             [COST_X_PRODUCTS] = 107.8, [COST_X_BY_CONSTANT] = 139.2, [COST_X_BY_SHORT] = 152.6, [COST_X_QUOTIENTS] = 350.5,
             [COST_X_WAVE_ALONE] = 511.2, [COST_X_WAVES] = 729.4, [COST_X_TERMS] = 30.15, [COST_X_CARRIED] = 71.37,
         }},
         [COST_OF_FLASH] = {.cases = 77, .bound = 1.15, .largest = 16476, .figure = {
             [COST_X_ONE] = 2115, [COST_X_ANGLES] = 299.5, [COST_X_PLACES] = 217.7, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 38.76, [COST_X_STAGED_PLACES] = 60.93, [COST_X_STAGED_RATES] = 76.14, [COST_X_FIRST_ANGLES] = 217.2,
             [COST_X_CODE_PRODUCTS] = 54.77, [COST_X_CODE_BY_CONSTANT] = 72.33, [COST_X_CODE_BY_SHORT] = 49.85, [COST_X_CODE_WAVE_ALONE] = 314.7,
             [COST_X_CODE_WAVES] = 23.81, [COST_X_CODE_CARRIED] = 14.57, [COST_X_ANY_WAVE] = 214.1, [COST_X_ANY_SHARED_WAVE] = 352.8,
             [COST_X_ANY_QUOTIENT] = 979.1, [COST_X_NUMBERS] = 108,
         }},
         [COST_OF_RAM] = {.cases = 77, .bound = 1.02, .largest = 84, .figure = {
             [COST_X_ONE] = 4, [COST_X_ANY_WAVE] = 6.106e-13, [COST_X_NUMBERS] = 1.991e-13, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 77, .bound = 1.34, .largest = 988, .figure = {
             [COST_X_ONE] = 355.8, [COST_X_LIES_COMPONENTS] = 17.78, [COST_X_LIES_RATES] = 11.08, [COST_X_CALLED] = 100.2,
             [COST_X_ANY_WAVE] = 4.601, [COST_X_ANY_SHARED_WAVE] = 5.233, [COST_X_LIES_OPERATIONS] = 2.395,
         }},
     }},
    {.board = "mps2-an385",
     .compiler = "arm-none-eabi-gcc 12.2.1 -mcpu=cortex-m3 -mthumb -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 77, .bound = 1.96, .largest = 2689, .figure = {
             [COST_X_ANGLES] = 105.7, [COST_X_PLACES] = 35.41, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_ANGLES] = 32.13,
             [COST_X_STAGED_PLACES] = 39.23, [COST_X_STAGED_RATES] = 21.8, [COST_X_FIRST_ANGLES] = 81.86, [COST_X_CALLED_DATA] = 3.302,
             [COST_X_SUMS] = 6.418, [COST_X_PRODUCTS] = 14.01, [COST_X_BY_CONSTANT] = 10.22, [COST_X_BY_SHORT] = 9.726, [COST_X_ROUNDED] = 1.652,
             [COST_X_BITS] = 0.4806, [COST_X_QUOTIENTS] = 128, [COST_X_WAVE_ALONE] = 74.68, [COST_X_WAVES] = 74.85, [COST_X_TERMS] = 6.519,
             [COST_X_CHOICES] = 19.84, [COST_X_CARRIED] = 5.872,
         }},
         [COST_OF_CYCLES] = {.cases = 77, .bound = 1.47, .largest = 4247, .figure = {
             [COST_X_ONE] = 17.17, [COST_X_ANGLES] = 132.6, [COST_X_PLACES] = 51.68, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 30.85, [COST_X_STAGED_PLACES] = 57.03, [COST_X_STAGED_RATES] = 25.89, [COST_X_FIRST_ANGLES] = 92.95,
             [COST_X_CALLED_DATA] = 9.202, [COST_X_SUMS] = 8.185, [COST_X_PRODUCTS] = 29.37, [COST_X_BY_CONSTANT] = 23.19,
             [COST_X_BY_SHORT] = 22.59, [COST_X_ROUNDED] = 2.825, [COST_X_QUOTIENTS] = 164.1, [COST_X_WAVE_ALONE] = 138.9,
             [COST_X_WAVES] = 142.9, [COST_X_TERMS] = 1.478, [COST_X_CHOICES] = 23.9, [COST_X_CARRIED] = 7.569,
         }},
         [COST_OF_FLASH] = {.cases = 77, .bound = 1.08, .largest = 9476, .figure = {
             [COST_X_ONE] = 2589, [COST_X_ANGLES] = 251, [COST_X_PLACES] = 215, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 1.667, [COST_X_STAGED_PLACES] = 112.7, [COST_X_STAGED_RATES] = 51.36, [COST_X_FIRSTS] = 31.46,
             [COST_X_FIRST_ANGLES] = 128.4, [COST_X_CODE_SUMS] = 3.249, [COST_X_CODE_PRODUCTS] = 15.15, [COST_X_CODE_BY_CONSTANT] = 13.78,
             [COST_X_CODE_SHIFTS] = 0.09416, [COST_X_CODE_QUOTIENTS] = 105.4, [COST_X_CODE_WAVE_ALONE] = 254.8, [COST_X_CODE_WAVES] = 141.8,
             [COST_X_CODE_OTHERS] = 4.677, [COST_X_CODE_LEAVES] = 1.971, [COST_X_CODE_CARRIED] = 2.951, [COST_X_ANY_WAVE] = 162.6,
             [COST_X_ANY_SHARED_WAVE] = 314.8, [COST_X_ANY_QUOTIENT] = 259.8,
         }},
         [COST_OF_RAM] = {.cases = 77, .bound = 1.02, .largest = 84, .figure = {
             [COST_X_ONE] = 4, [COST_X_ANY_WAVE] = 6.106e-13, [COST_X_NUMBERS] = 1.991e-13, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 77, .bound = 1.37, .largest = 768, .figure = {
             [COST_X_ONE] = 336.2, [COST_X_LIES_COMPONENTS] = 10.9, [COST_X_LIES_RATES] = 11.86, [COST_X_CALLED] = 82.61,
             [COST_X_CARRIED] = 0.06411, [COST_X_LIES_WAVES] = 14.49, [COST_X_LIES_OPERATIONS] = 0.9763,
         }},
     }},
    {.board = "mps2-an386",
     .compiler = "arm-none-eabi-gcc 12.2.1 -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 77, .bound = 2.56, .largest = 2739, .figure = {
             [COST_X_ANGLES] = 125.7, [COST_X_PLACES] = 34.26, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_ANGLES] = 42.25,
             [COST_X_STAGED_PLACES] = 39.5, [COST_X_STAGED_RATES] = 21.97, [COST_X_FIRST_ANGLES] = 105.1, [COST_X_CALLED_DATA] = 1.064,
             [COST_X_SUMS] = 7.878, [COST_X_PRODUCTS] = 14.62, [COST_X_BY_CONSTANT] = 11.75, [COST_X_BY_SHORT] = 5.179, [COST_X_ROUNDED] = 2.575,
             [COST_X_QUOTIENTS] = 134.8, [COST_X_WAVE_ALONE] = 43.96, [COST_X_WAVES] = 44.44, [COST_X_TERMS] = 13.81, [COST_X_CHOICES] = 17.48,
             [COST_X_CARRIED] = 6.501,
         }},
         [COST_OF_CYCLES] = {.cases = 77, .bound = 1.84, .largest = 3262, .figure = {
             [COST_X_ONE] = 12.45, [COST_X_ANGLES] = 135.3, [COST_X_PLACES] = 44.9, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 39.45, [COST_X_STAGED_PLACES] = 52.98, [COST_X_STAGED_RATES] = 23.91, [COST_X_FIRST_ANGLES] = 102.4,
             [COST_X_CALLED_DATA] = 7.04, [COST_X_SUMS] = 10.56, [COST_X_PRODUCTS] = 13.46, [COST_X_BY_CONSTANT] = 11.63,
             [COST_X_BY_SHORT] = 5.419, [COST_X_ROUNDED] = 1.747, [COST_X_BITS] = 0.322, [COST_X_QUOTIENTS] = 144.6, [COST_X_WAVE_ALONE] = 85.6,
             [COST_X_WAVES] = 88.57, [COST_X_TERMS] = 14.74, [COST_X_CHOICES] = 20.44, [COST_X_CARRIED] = 7.224,
         }},
         [COST_OF_FLASH] = {.cases = 77, .bound = 1.08, .largest = 9404, .figure = {
             [COST_X_ONE] = 2631, [COST_X_ANGLES] = 273.3, [COST_X_PLACES] = 220.2, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 5.292, [COST_X_STAGED_PLACES] = 93.7, [COST_X_STAGED_RATES] = 39.18, [COST_X_FIRSTS] = 35,
             [COST_X_FIRST_ANGLES] = 138.7, [COST_X_CODE_SUMS] = 3.279, [COST_X_CODE_PRODUCTS] = 13.87, [COST_X_CODE_BY_CONSTANT] = 14.58,
             [COST_X_CODE_SHIFTS] = 0.7678, [COST_X_CODE_QUOTIENTS] = 158.1, [COST_X_CODE_WAVE_ALONE] = 241.3, [COST_X_CODE_WAVES] = 135.9,
             [COST_X_CODE_OTHERS] = 3.749, [COST_X_CODE_CARRIED] = 1.683, [COST_X_ANY_WAVE] = 177.7, [COST_X_ANY_SHARED_WAVE] = 296.7,
             [COST_X_ANY_QUOTIENT] = 42.19,
         }},
         [COST_OF_RAM] = {.cases = 77, .bound = 1.02, .largest = 84, .figure = {
             [COST_X_ONE] = 4, [COST_X_ANY_WAVE] = 6.106e-13, [COST_X_NUMBERS] = 1.991e-13, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 77, .bound = 1.39, .largest = 768, .figure = {
             [COST_X_ONE] = 335.4, [COST_X_LIES_COMPONENTS] = 13.32, [COST_X_LIES_RATES] = 10.81, [COST_X_CALLED] = 104.7,
             [COST_X_CARRIED] = 0.08698, [COST_X_LIES_WAVES] = 11.98, [COST_X_LIES_OPERATIONS] = 0.8586,
         }},
     }},
    {.board = "mps2-an500",
     .compiler = "arm-none-eabi-gcc 12.2.1 -mcpu=cortex-m7 -mthumb -mfpu=fpv5-sp-d16 -mfloat-abi=hard -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 77, .bound = 2.10, .largest = 2743, .figure = {
             [COST_X_ANGLES] = 107.3, [COST_X_PLACES] = 35.07, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_ANGLES] = 35.34,
             [COST_X_STAGED_PLACES] = 38.85, [COST_X_STAGED_RATES] = 22.27, [COST_X_FIRST_ANGLES] = 94.35, [COST_X_CALLED_DATA] = 1.543,
             [COST_X_SUMS] = 5.997, [COST_X_PRODUCTS] = 12.97, [COST_X_BY_CONSTANT] = 11.38, [COST_X_ROUNDED] = 2.97, [COST_X_BITS] = 0.4431,
             [COST_X_QUOTIENTS] = 133.1, [COST_X_WAVE_ALONE] = 67.55, [COST_X_WAVES] = 66.53, [COST_X_TERMS] = 12.68, [COST_X_CHOICES] = 18.13,
             [COST_X_CARRIED] = 7.126,
         }},
         [COST_OF_FLASH] = {.cases = 77, .bound = 1.07, .largest = 9340, .figure = {
             [COST_X_ONE] = 2647, [COST_X_ANGLES] = 233.4, [COST_X_PLACES] = 224.3, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 5.028, [COST_X_STAGED_PLACES] = 82.69, [COST_X_STAGED_RATES] = 52.37, [COST_X_FIRSTS] = 49.17,
             [COST_X_FIRST_ANGLES] = 121.1, [COST_X_CODE_SUMS] = 2.755, [COST_X_CODE_PRODUCTS] = 13.19, [COST_X_CODE_BY_CONSTANT] = 14.55,
             [COST_X_CODE_BY_SHORT] = 7.938, [COST_X_CODE_SHIFTS] = 0.5551, [COST_X_CODE_QUOTIENTS] = 133.8, [COST_X_CODE_WAVE_ALONE] = 244,
             [COST_X_CODE_WAVES] = 136.9, [COST_X_CODE_OTHERS] = 4.22, [COST_X_CODE_CARRIED] = 2.849, [COST_X_ANY_WAVE] = 193.6,
             [COST_X_ANY_SHARED_WAVE] = 325.8, [COST_X_ANY_QUOTIENT] = 149.5,
         }},
         [COST_OF_RAM] = {.cases = 77, .bound = 1.02, .largest = 84, .figure = {
             [COST_X_ONE] = 4, [COST_X_ANY_WAVE] = 6.106e-13, [COST_X_NUMBERS] = 1.991e-13, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 77, .bound = 1.39, .largest = 768, .figure = {
             [COST_X_ONE] = 337.3, [COST_X_LIES_COMPONENTS] = 13.91, [COST_X_LIES_RATES] = 11.6, [COST_X_CALLED] = 106.1,
             [COST_X_CARRIED] = 0.8781, [COST_X_LIES_WAVES] = 9.952, [COST_X_LIES_OPERATIONS] = 0.5376,
         }},
     }},
    {.board = "mps2-an505",
     .compiler = "arm-none-eabi-gcc 12.2.1 -mcpu=cortex-m33 -mthumb -mfpu=fpv5-sp-d16 -mfloat-abi=hard -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 77, .bound = 2.26, .largest = 2759, .figure = {
             [COST_X_ANGLES] = 123, [COST_X_PLACES] = 34.79, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_ANGLES] = 39.34,
             [COST_X_STAGED_PLACES] = 38.34, [COST_X_STAGED_RATES] = 20.95, [COST_X_FIRST_ANGLES] = 101.4, [COST_X_CALLED_DATA] = 1.889,
             [COST_X_SUMS] = 7.236, [COST_X_PRODUCTS] = 13.72, [COST_X_BY_CONSTANT] = 11.41, [COST_X_BY_SHORT] = 11.32, [COST_X_ROUNDED] = 2.668,
             [COST_X_BITS] = 0.3197, [COST_X_QUOTIENTS] = 132.4, [COST_X_WAVE_ALONE] = 53.18, [COST_X_WAVES] = 55.98, [COST_X_TERMS] = 7.42,
             [COST_X_CHOICES] = 18.63, [COST_X_CARRIED] = 6.942,
         }},
         [COST_OF_FLASH] = {.cases = 77, .bound = 1.06, .largest = 9852, .figure = {
             [COST_X_ONE] = 3039, [COST_X_ANGLES] = 270.1, [COST_X_PLACES] = 206.1, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 7.32, [COST_X_STAGED_PLACES] = 106.6, [COST_X_STAGED_RATES] = 44.54, [COST_X_FIRSTS] = 31.09,
             [COST_X_FIRST_ANGLES] = 144.1, [COST_X_CODE_SUMS] = 3.372, [COST_X_CODE_PRODUCTS] = 14.92, [COST_X_CODE_BY_CONSTANT] = 13.74,
             [COST_X_CODE_SHIFTS] = 0.1085, [COST_X_CODE_QUOTIENTS] = 159.6, [COST_X_CODE_WAVE_ALONE] = 247.6, [COST_X_CODE_WAVES] = 137.1,
             [COST_X_CODE_OTHERS] = 3.83, [COST_X_CODE_LEAVES] = 2.506, [COST_X_CODE_CARRIED] = 2.49, [COST_X_ANY_WAVE] = 156.8,
             [COST_X_ANY_SHARED_WAVE] = 310, [COST_X_ANY_QUOTIENT] = 32.16,
         }},
         [COST_OF_RAM] = {.cases = 77, .bound = 1.02, .largest = 84, .figure = {
             [COST_X_ONE] = 4, [COST_X_ANY_WAVE] = 6.106e-13, [COST_X_NUMBERS] = 1.991e-13, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 77, .bound = 1.36, .largest = 768, .figure = {
             [COST_X_ONE] = 335.6, [COST_X_LIES_COMPONENTS] = 11.6, [COST_X_LIES_RATES] = 10.97, [COST_X_CALLED] = 79, [COST_X_LIES_WAVES] = 14.44,
             [COST_X_LIES_OPERATIONS] = 1.068,
         }},
     }},
    {.board = "rv32imac",
     .compiler = "riscv64-unknown-elf-gcc 12.2.0 -march=rv32imac -mabi=ilp32 -misa-spec=2.2 -mcmodel=medany -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 77, .bound = 1.22, .largest = 3257, .figure = {
             [COST_X_ONE] = 6.535, [COST_X_ANGLES] = 80.21, [COST_X_PLACES] = 50.93, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 11.1, [COST_X_STAGED_PLACES] = 46.3, [COST_X_STAGED_RATES] = 19.38, [COST_X_FIRSTS] = 5.251,
             [COST_X_FIRST_ANGLES] = 39.7, [COST_X_CALLED_DATA] = 14.11, [COST_X_SUMS] = 9.648, [COST_X_PRODUCTS] = 15.44,
             [COST_X_BY_CONSTANT] = 9.894, [COST_X_BY_SHORT] = 12.09, [COST_X_ROUNDED] = 1.224, [COST_X_BITS] = 0.08314, [COST_X_QUOTIENTS] = 198.2,
             [COST_X_SEARCHED] = 31.35, [COST_X_WAVE_ALONE] = 204.3, [COST_X_WAVES] = 198.1, [COST_X_TERMS] = 1.899, [COST_X_CHOICES] = 22.19,
             [COST_X_CARRIED] = 3.644,
         }},
         [COST_OF_FLASH] = {.cases = 77, .bound = 1.12, .largest = 9224, .figure = {
             [COST_X_ONE] = 1690, [COST_X_ANGLES] = 286.2, [COST_X_PLACES] = 244.1, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_PLACES] = 137.6, [COST_X_STAGED_RATES] = 61.67, [COST_X_FIRSTS] = 40.46, [COST_X_FIRST_ANGLES] = 80.52,
             [COST_X_CALLED] = 138.2, [COST_X_CODE_SUMS] = 4.445, [COST_X_CODE_PRODUCTS] = 14.46, [COST_X_CODE_BY_CONSTANT] = 10.99,
             [COST_X_CODE_BY_SHORT] = 6.722, [COST_X_CODE_QUOTIENTS] = 32.27, [COST_X_CODE_WAVE_ALONE] = 267.3, [COST_X_CODE_WAVES] = 157.1,
             [COST_X_CODE_OTHERS] = 7.098, [COST_X_CODE_CARRIED] = 1.691, [COST_X_ANY_WAVE] = 205, [COST_X_ANY_SHARED_WAVE] = 357.9,
             [COST_X_ANY_QUOTIENT] = 718,
         }},
         [COST_OF_RAM] = {.cases = 77, .bound = 1.02, .largest = 80, .figure = {
             [COST_X_ONE] = 8.58e-15, [COST_X_ANY_WAVE] = 5.254e-14, [COST_X_NUMBERS] = 1.698e-14, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 77, .bound = 1.63, .largest = 836, .figure = {
             [COST_X_ONE] = 334.8, [COST_X_LIES_COMPONENTS] = 16.64, [COST_X_LIES_RATES] = 18.41, [COST_X_CALLED] = 62.85,
             [COST_X_ANY_WAVE] = 16.34, [COST_X_ANY_QUOTIENT] = 2.373, [COST_X_LIES_WAVES] = 30.65, [COST_X_LIES_OPERATIONS] = 1.052,
         }},
     }},
    {.board = "rv32imafc",
     .compiler = "riscv64-unknown-elf-gcc 12.2.0 -march=rv32imafc -mabi=ilp32f -misa-spec=2.2 -mcmodel=medany -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 77, .bound = 1.22, .largest = 3257, .figure = {
             [COST_X_ONE] = 6.535, [COST_X_ANGLES] = 80.21, [COST_X_PLACES] = 50.93, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 11.1, [COST_X_STAGED_PLACES] = 46.3, [COST_X_STAGED_RATES] = 19.38, [COST_X_FIRSTS] = 5.251,
             [COST_X_FIRST_ANGLES] = 39.7, [COST_X_CALLED_DATA] = 14.11, [COST_X_SUMS] = 9.648, [COST_X_PRODUCTS] = 15.44,
             [COST_X_BY_CONSTANT] = 9.894, [COST_X_BY_SHORT] = 12.09, [COST_X_ROUNDED] = 1.224, [COST_X_BITS] = 0.08314, [COST_X_QUOTIENTS] = 198.2,
             [COST_X_SEARCHED] = 31.35, [COST_X_WAVE_ALONE] = 204.3, [COST_X_WAVES] = 198.1, [COST_X_TERMS] = 1.899, [COST_X_CHOICES] = 22.19,
             [COST_X_CARRIED] = 3.644,
         }},
         [COST_OF_FLASH] = {.cases = 77, .bound = 1.12, .largest = 9232, .figure = {
             [COST_X_ONE] = 1704, [COST_X_ANGLES] = 290.2, [COST_X_PLACES] = 244.5, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_PLACES] = 137.5, [COST_X_STAGED_RATES] = 61.49, [COST_X_FIRSTS] = 41.03, [COST_X_FIRST_ANGLES] = 83.98,
             [COST_X_CALLED] = 133.3, [COST_X_CODE_SUMS] = 4.461, [COST_X_CODE_PRODUCTS] = 14.46, [COST_X_CODE_BY_CONSTANT] = 10.92,
             [COST_X_CODE_BY_SHORT] = 5.541, [COST_X_CODE_QUOTIENTS] = 32.05, [COST_X_CODE_WAVE_ALONE] = 266.9, [COST_X_CODE_WAVES] = 156.3,
             [COST_X_CODE_OTHERS] = 6.977, [COST_X_CODE_CARRIED] = 1.754, [COST_X_ANY_WAVE] = 205.4, [COST_X_ANY_SHARED_WAVE] = 358,
             [COST_X_ANY_QUOTIENT] = 715.6,
         }},
         [COST_OF_RAM] = {.cases = 77, .bound = 1.02, .largest = 80, .figure = {
             [COST_X_ONE] = 8.58e-15, [COST_X_ANY_WAVE] = 5.254e-14, [COST_X_NUMBERS] = 1.698e-14, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 77, .bound = 1.63, .largest = 836, .figure = {
             [COST_X_ONE] = 334.8, [COST_X_LIES_COMPONENTS] = 16.64, [COST_X_LIES_RATES] = 18.41, [COST_X_CALLED] = 62.85,
             [COST_X_ANY_WAVE] = 16.34, [COST_X_ANY_QUOTIENT] = 2.373, [COST_X_LIES_WAVES] = 30.65, [COST_X_LIES_OPERATIONS] = 1.052,
         }},
     }},
};
/* clang-format on */
