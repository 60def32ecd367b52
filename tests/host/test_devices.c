/* test_devices.c: forces on the load frame and the carriage, compared with the dissertation (figures 19 and 20) and
 * closed forms. docs/conclusions.md has the dissertation's other claims. */
#include "ranges.h"
#include "test.h"

#define PI 3.14159265358979323846
#define LBF_N 4.4482216152605
#define INCH_M 0.0254

TEST(devices, figure_19_force_on_the_load_frame) {
    range r[] = {{.name = "pin_force"}, {.name = "cell_force"}};
    ranges_of("carriage_fixed", IN_DOUBLE, 2.0, 1e-3, r, 2);
    /* dissertation: 9.3 lbf in the computer model, 9.5 lbf measured (figures 17 and 19) */
    expect_between("fig 19: peak force, lbf", 9.3, 9.5, r[0].most / LBF_N);
    /* closed form: sum of m r w^2 = 2 (0.152 x 3.625 + 0.15 x 6.5) lb in at 330 rpm */
    const double w = 330.0 * 2.0 * PI / 60.0;
    const double S = 2.0 * (0.152 * 3.625 + 0.15 * 6.5) * 0.45359237 * INCH_M;
    expect_between("fig 19: peak / (m r w^2)", 1.0 - 1e-6, 1.0 + 1e-6, r[0].most / (S * w * w));
    /* dissertation: the force fully reverses; samples are 12 degrees of the arm's turn apart */
    expect_between("fig 17, 19: -least / peak", 0.9999, 1.0001, -r[0].least / r[0].most);
    /* the load cell also carries 12 lb and the weight of the masses */
    expect_between("fig 19: tare, lbf", 12.604 - 1e-3, 12.604 + 1e-3,
                   (r[1].most + r[1].least) / 2.0 / LBF_N);
}

TEST(devices, figure_20_from_the_energies_too) {
    range by_energy[] = {{.name = "pin_force"}, {.name = "X"}, {.name = "carriage_force"}};
    range outright[] = {{.name = "pin_force"}, {.name = "X"}};
    ranges_of("carriage_free", IN_DOUBLE, 2.0, 1e-3, by_energy, 3);
    ranges_of("carriage_ratio", IN_DOUBLE, 2.0, 1e-3, outright, 2);
    for (unsigned i = 0; i < 2; i++) {
        const double same = range_width(&outright[i]) / range_width(&by_energy[i]);
        expect_between("fig 20: outright / by energy", 1.0 - 1e-12, 1.0 + 1e-12, same);
    }
    /* Newton's third law: both forces are equal */
    expect_between("fig 18: force on the carriage / pin force", 1.0 - 1e-12, 1.0 + 1e-12,
                   range_width(&by_energy[2]) / range_width(&by_energy[0]));
    /* closed form: 2 m r/(m + M) = 2 x 3.05200 lb in/0.604 lb x 1/4 */
    const double swing_m = 2.0 * (0.152 * 3.625 + 0.15 * 6.5) / (0.152 + 0.15) * INCH_M / 4.0;
    expect_between("carriage swing / closed form", 0.99999, 1.00001,
                   range_width(&by_energy[1]) / swing_m);
}
