/* cost_fixed_rows.h: what each class of work costs in fixed point, by board: fitted to counted steps and written by
 * `make price-fit-fixed`. Do not edit. */
/* clang-format off */
#include "cost_fixed.h"

static const cost_fixed_row cost_fixed_rows[] = {
    {.board = "atmega328p",
     .compiler = "avr-gcc 5.4.0 -mmcu=atmega328p -Os",
     .spread = 1.012, .spread_cycles = 1.008,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 92, .bound = 1.83, .largest = 36672, .figure = {
             [COST_X_ONE] = 12.66, [COST_X_ANGLES] = 1493, [COST_X_PLACES] = 724.2, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_PLACES] = 477.3, [COST_X_STAGED_RATES] = 102.1, [COST_X_FIRSTS] = 55.6, [COST_X_FIRST_ANGLES] = 553.6,
             [COST_X_CALLED] = 6.884, [COST_X_CALLED_DATA] = 1.539e-11, [COST_X_SUMS] = 77.73, [COST_X_PRODUCTS] = 349.2,
             [COST_X_BY_CONSTANT] = 379.9, [COST_X_BY_SHORT] = 1373, [COST_X_BITS] = 13.76, [COST_X_QUOTIENTS] = 2112, [COST_X_WAVE_ALONE] = 3169,
             [COST_X_WAVES] = 3205, [COST_X_TERMS] = 50.47, [COST_X_CHOICES] = 453.3, [COST_X_LEAVES] = 23.37,
         }},
         [COST_OF_CYCLES] = {.cases = 92, .bound = 1.78, .largest = 48732, .figure = {
             [COST_X_ONE] = 53.08, [COST_X_ANGLES] = 1996, [COST_X_PLACES] = 976.3, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_PLACES] = 605.6, [COST_X_STAGED_RATES] = 121.7, [COST_X_FIRSTS] = 118.1, [COST_X_FIRST_ANGLES] = 844.1,
             [COST_X_CALLED] = 106.6, [COST_X_CALLED_DATA] = 1.172e-10, [COST_X_SUMS] = 118.9, [COST_X_PRODUCTS] = 457.5,
             [COST_X_BY_CONSTANT] = 503.1, [COST_X_BY_SHORT] = 1755, [COST_X_BITS] = 19.59, [COST_X_QUOTIENTS] = 2581, [COST_X_WAVE_ALONE] = 4168,
             [COST_X_WAVES] = 4183, [COST_X_TERMS] = 111.5, [COST_X_CHOICES] = 522, [COST_X_LEAVES] = 41.6,
         }},
         [COST_OF_FLASH] = {.cases = 92, .bound = 1.35, .largest = 14268, .figure = {
             [COST_X_ONE] = 1209, [COST_X_ANGLES] = 1092, [COST_X_PLACES] = 600.9, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_PLACES] = 475.1, [COST_X_STAGED_RATES] = 137.5, [COST_X_FIRST_ANGLES] = 489.4, [COST_X_CALLED] = 2026,
             [COST_X_CODE_SUMS] = 10.08, [COST_X_CODE_PRODUCTS] = 6.59, [COST_X_CODE_BY_CONSTANT] = 7.189, [COST_X_CODE_BY_SHORT] = 46.14,
             [COST_X_CODE_QUOTIENTS] = 196.8, [COST_X_CODE_WAVE_ALONE] = 232, [COST_X_CODE_WAVES] = 8.461, [COST_X_CODE_OTHERS] = 3.091,
             [COST_X_CODE_CARRIED] = 0.5871, [COST_X_ANY_WAVE] = 648.2, [COST_X_ANY_SHARED_WAVE] = 833.2, [COST_X_ANY_QUOTIENT] = 0.3019,
             [COST_X_NUMBERS] = 51.75,
         }},
         [COST_OF_RAM] = {.cases = 92, .bound = 1.09, .largest = 352, .figure = {
             [COST_X_ONE] = 40.09, [COST_X_ANY_QUOTIENT] = 1.235, [COST_X_NUMBERS] = 10.43, [COST_X_STATE_BYTES] = 1.918,
         }},
         [COST_OF_STACK] = {.cases = 92, .bound = 1.25, .largest = 639, .figure = {
             [COST_X_ONE] = 302.8, [COST_X_LIES_COMPONENTS] = 24.81, [COST_X_LIES_RATES] = 8.655, [COST_X_ANY_WAVE] = 37.78,
             [COST_X_ANY_QUOTIENT] = 15.73, [COST_X_LIES_WAVES] = 6.446, [COST_X_LIES_OPERATIONS] = 0.5564,
         }},
     }},
    {.board = "mps2-an385-m0",
     .compiler = "arm-none-eabi-gcc 12.2.1 -mcpu=cortex-m0 -mthumb -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 92, .bound = 1.83, .largest = 7185, .figure = {
             [COST_X_ANGLES] = 286.6, [COST_X_PLACES] = 139.2, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_PLACES] = 32.82,
             [COST_X_STAGED_RATES] = 59.29, [COST_X_FIRSTS] = 34.04, [COST_X_FIRST_ANGLES] = 178.2, [COST_X_CALLED] = 233,
             [COST_X_CALLED_DATA] = 2.905e-11, [COST_X_PRODUCTS] = 99.1, [COST_X_BY_CONSTANT] = 115.8, [COST_X_BY_SHORT] = 140.3,
             [COST_X_QUOTIENTS] = 301, [COST_X_WAVE_ALONE] = 282.5, [COST_X_WAVES] = 444.4, [COST_X_CHOICES] = 1.185, [COST_X_CARRIED] = 46.01,
         }},
         [COST_OF_CYCLES] = {.cases = 92, .bound = 1.80, .largest = 9459, .figure = {
             [COST_X_ANGLES] = 339.9, [COST_X_PLACES] = 152.2, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_PLACES] = 74.8,
             [COST_X_STAGED_RATES] = 88.12, [COST_X_FIRSTS] = 10.17, [COST_X_FIRST_ANGLES] = 215.4, [COST_X_CALLED] = 652.4,
             [COST_X_CALLED_DATA] = 4.031e-14, [COST_X_PRODUCTS] = 107.1, [COST_X_BY_CONSTANT] = 138.6, [COST_X_BY_SHORT] = 129.8,
             [COST_X_QUOTIENTS] = 309.6, [COST_X_SEARCHED] = 76.14, [COST_X_WAVE_ALONE] = 330, [COST_X_WAVES] = 573, [COST_X_CARRIED] = 70.8,
         }},
         [COST_OF_FLASH] = {.cases = 92, .bound = 1.16, .largest = 16476, .figure = {
             [COST_X_ONE] = 2051, [COST_X_ANGLES] = 353.4, [COST_X_PLACES] = 307.8, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_PLACES] = 62.26, [COST_X_STAGED_RATES] = 54.91, [COST_X_FIRSTS] = 50.91, [COST_X_FIRST_ANGLES] = 173,
             [COST_X_CODE_PRODUCTS] = 56.38, [COST_X_CODE_BY_CONSTANT] = 71.85, [COST_X_CODE_BY_SHORT] = 43.63, [COST_X_CODE_QUOTIENTS] = 231.5,
             [COST_X_CODE_WAVE_ALONE] = 302.4, [COST_X_CODE_CARRIED] = 12.48, [COST_X_ANY_WAVE] = 280.4, [COST_X_ANY_SHARED_WAVE] = 439.8,
             [COST_X_ANY_QUOTIENT] = 0.07004, [COST_X_NUMBERS] = 16.78, [COST_X_STATE_BYTES] = 14.37,
         }},
         [COST_OF_RAM] = {.cases = 92, .bound = 1.02, .largest = 84, .figure = {
             [COST_X_ONE] = 4, [COST_X_ANY_WAVE] = 6.444e-13, [COST_X_NUMBERS] = 2.046e-13, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 92, .bound = 1.67, .largest = 988, .figure = {
             [COST_X_ONE] = 354.3, [COST_X_LIES_COMPONENTS] = 19.41, [COST_X_LIES_RATES] = 6.228, [COST_X_CALLED] = 238.5,
             [COST_X_ANY_WAVE] = 8.722, [COST_X_ANY_SHARED_WAVE] = 8.308, [COST_X_LIES_OPERATIONS] = 2.538,
         }},
     }},
    {.board = "mps2-an385",
     .compiler = "arm-none-eabi-gcc 12.2.1 -mcpu=cortex-m3 -mthumb -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 92, .bound = 1.75, .largest = 1825, .figure = {
             [COST_X_ANGLES] = 87.93, [COST_X_PLACES] = 35.64, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_ANGLES] = 31.57,
             [COST_X_STAGED_PLACES] = 36.39, [COST_X_STAGED_RATES] = 24.92, [COST_X_FIRST_ANGLES] = 57.45, [COST_X_CALLED] = 74.83,
             [COST_X_CALLED_DATA] = 1.744e-13, [COST_X_SUMS] = 4.338, [COST_X_PRODUCTS] = 15.44, [COST_X_BY_CONSTANT] = 12,
             [COST_X_BY_SHORT] = 6.34, [COST_X_BITS] = 0.594, [COST_X_QUOTIENTS] = 121.1, [COST_X_WAVE_ALONE] = 90.76, [COST_X_WAVES] = 94.45,
             [COST_X_TERMS] = 7.477, [COST_X_CHOICES] = 18.1, [COST_X_CARRIED] = 5.869,
         }},
         [COST_OF_CYCLES] = {.cases = 92, .bound = 1.56, .largest = 2672, .figure = {
             [COST_X_ONE] = 15.19, [COST_X_ANGLES] = 136.3, [COST_X_PLACES] = 51.84, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 2.361, [COST_X_STAGED_PLACES] = 54.95, [COST_X_STAGED_RATES] = 31.61, [COST_X_FIRST_ANGLES] = 88.91,
             [COST_X_CALLED] = 194.5, [COST_X_CALLED_DATA] = 4.725e-12, [COST_X_SUMS] = 4.141, [COST_X_PRODUCTS] = 32.6, [COST_X_BY_CONSTANT] = 25.88,
             [COST_X_BY_SHORT] = 19.7, [COST_X_ROUNDED] = 0.7903, [COST_X_BITS] = 0.07796, [COST_X_QUOTIENTS] = 154.1, [COST_X_WAVE_ALONE] = 162.5,
             [COST_X_WAVES] = 167.7, [COST_X_TERMS] = 5.504, [COST_X_CHOICES] = 21.94, [COST_X_CARRIED] = 7.005,
         }},
         [COST_OF_FLASH] = {.cases = 92, .bound = 1.09, .largest = 9596, .figure = {
             [COST_X_ONE] = 2592, [COST_X_ANGLES] = 361.9, [COST_X_PLACES] = 218.7, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_PLACES] = 98.81, [COST_X_STAGED_RATES] = 54.85, [COST_X_FIRSTS] = 29.13, [COST_X_FIRST_ANGLES] = 207.1,
             [COST_X_CODE_SUMS] = 2.145, [COST_X_CODE_PRODUCTS] = 15.76, [COST_X_CODE_BY_CONSTANT] = 16.51, [COST_X_CODE_QUOTIENTS] = 167.1,
             [COST_X_CODE_WAVE_ALONE] = 216.8, [COST_X_CODE_WAVES] = 112.9, [COST_X_CODE_OTHERS] = 3.287, [COST_X_CODE_CARRIED] = 3.161,
             [COST_X_ANY_WAVE] = 189, [COST_X_ANY_SHARED_WAVE] = 305.2, [COST_X_ANY_QUOTIENT] = 0.2426,
         }},
         [COST_OF_RAM] = {.cases = 92, .bound = 1.02, .largest = 84, .figure = {
             [COST_X_ONE] = 4, [COST_X_ANY_WAVE] = 6.444e-13, [COST_X_NUMBERS] = 2.046e-13, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 92, .bound = 1.78, .largest = 768, .figure = {
             [COST_X_ONE] = 339.6, [COST_X_LIES_COMPONENTS] = 10.47, [COST_X_LIES_RATES] = 12.29, [COST_X_CALLED] = 182, [COST_X_CARRIED] = 1.868,
             [COST_X_LIES_WAVES] = 16.55, [COST_X_LIES_OPERATIONS] = 0.585,
         }},
     }},
    {.board = "mps2-an386",
     .compiler = "arm-none-eabi-gcc 12.2.1 -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -O2",
     .spread = 1.000, .spread_cycles = 1.000,
     .fit = {
         [COST_OF_INSTRUCTIONS] = {.cases = 92, .bound = 1.93, .largest = 1893, .figure = {
             [COST_X_ANGLES] = 85.93, [COST_X_PLACES] = 34.92, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1, [COST_X_STAGED_ANGLES] = 80.76,
             [COST_X_STAGED_PLACES] = 37.5, [COST_X_STAGED_RATES] = 24.92, [COST_X_FIRST_ANGLES] = 55.43, [COST_X_CALLED] = 1.633,
             [COST_X_CALLED_DATA] = 5.81e-12, [COST_X_SUMS] = 6.316, [COST_X_PRODUCTS] = 13.61, [COST_X_BY_CONSTANT] = 12.02,
             [COST_X_BY_SHORT] = 2.786, [COST_X_ROUNDED] = 0.9301, [COST_X_BITS] = 0.3544, [COST_X_QUOTIENTS] = 131.3, [COST_X_WAVE_ALONE] = 42.83,
             [COST_X_WAVES] = 50.11, [COST_X_TERMS] = 13.48, [COST_X_CHOICES] = 18.14, [COST_X_CARRIED] = 7.807,
         }},
         [COST_OF_CYCLES] = {.cases = 92, .bound = 1.52, .largest = 2334, .figure = {
             [COST_X_ONE] = 12.69, [COST_X_ANGLES] = 103.2, [COST_X_PLACES] = 46.13, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 87.13, [COST_X_STAGED_PLACES] = 50.07, [COST_X_STAGED_RATES] = 27.49, [COST_X_FIRST_ANGLES] = 59.1,
             [COST_X_CALLED] = 111.3, [COST_X_CALLED_DATA] = 2.644e-15, [COST_X_SUMS] = 8.278, [COST_X_PRODUCTS] = 13.15,
             [COST_X_BY_CONSTANT] = 12.55, [COST_X_BY_SHORT] = 4.714, [COST_X_BITS] = 0.5934, [COST_X_QUOTIENTS] = 139, [COST_X_WAVE_ALONE] = 69.53,
             [COST_X_WAVES] = 78.67, [COST_X_TERMS] = 14.9, [COST_X_CHOICES] = 20.56, [COST_X_CARRIED] = 8.63,
         }},
         [COST_OF_FLASH] = {.cases = 92, .bound = 1.14, .largest = 9564, .figure = {
             [COST_X_ONE] = 2662, [COST_X_ANGLES] = 326.9, [COST_X_PLACES] = 207.8, [COST_X_STILL_ANGLES] = -1, [COST_X_STILL_PLACES] = -1,
             [COST_X_STAGED_ANGLES] = 119.8, [COST_X_STAGED_PLACES] = 72.35, [COST_X_STAGED_RATES] = 48.88, [COST_X_FIRSTS] = 22.11,
             [COST_X_FIRST_ANGLES] = 170.6, [COST_X_CALLED] = 37.85, [COST_X_CODE_SUMS] = 2.722, [COST_X_CODE_PRODUCTS] = 14.94,
             [COST_X_CODE_BY_CONSTANT] = 17.5, [COST_X_CODE_QUOTIENTS] = 166.8, [COST_X_CODE_WAVE_ALONE] = 188.8, [COST_X_CODE_WAVES] = 90.39,
             [COST_X_CODE_OTHERS] = 1.425, [COST_X_CODE_CARRIED] = 3.924, [COST_X_ANY_WAVE] = 163.1, [COST_X_ANY_SHARED_WAVE] = 268.9,
         }},
         [COST_OF_RAM] = {.cases = 92, .bound = 1.02, .largest = 84, .figure = {
             [COST_X_ONE] = 4, [COST_X_ANY_WAVE] = 6.444e-13, [COST_X_NUMBERS] = 2.046e-13, [COST_X_STATE_BYTES] = 1,
         }},
         [COST_OF_STACK] = {.cases = 92, .bound = 1.61, .largest = 768, .figure = {
             [COST_X_ONE] = 338.6, [COST_X_LIES_COMPONENTS] = 12.22, [COST_X_LIES_RATES] = 11.8, [COST_X_CALLED] = 184.9,
             [COST_X_CARRIED] = 1.375, [COST_X_LIES_WAVES] = 13.91, [COST_X_LIES_OPERATIONS] = 0.5739,
         }},
     }},
};
/* clang-format on */
