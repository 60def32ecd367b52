/* function_atan_double.c: the inverse circular functions in double. The table `ray` has the angles of the rays with
 * slope c = i/64. For 0 <= y <= x, the angle from the nearest ray to the point (x, y) has the tangent
 * (y - c x)/(x + c y), at most 1/128 in size, so a short series suffices. asin s is the angle of (sqrt(1 - s^2), s). */
#include "function_double.h"
#include "root.h"

#if WH_DOUBLE

#define SMALL 0x1p-28 /* for smaller x, atan x and asin x round to x */

static const wh_pair pi = {0x1.921fb54442d18p1, 0x1.1a62633145c07p-53};
static const wh_pair half_pi = {0x1.921fb54442d18p0, 0x1.1a62633145c07p-54};

/* Entry i is atan(i/64). */
static const wh_pair ray[65] = {
    /* clang-format off */
    {0.0, 0.0}, {0x1.fff555bbb729bp-7, -0x1.220c39d4dff5p-61},
    {0x1.ffd55bba97625p-6, -0x1.5ec431444912cp-60}, {0x1.7fb818430da2ap-5, -0x1.86ef8f794f105p-63},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60}, {0x1.3f59f0e7c559dp-4, 0x1.ac4ce285df847p-58},
    {0x1.7ee182602f10fp-4, -0x1.cfb654c0c3d98p-58}, {0x1.be39ebe6f07c3p-4, 0x1.f7b8f29a05987p-58},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59}, {0x1.1e1fafb043727p-3, -0x1.b485914dacf8cp-59},
    {0x1.3d6eee8c6626cp-3, 0x1.61a3b0ce9281bp-57}, {0x1.5c9811e3ec26ap-3, -0x1.054ab2c010f3dp-58},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58}, {0x1.9a6a8e96c8626p-3, 0x1.cf601e7b4348ep-59},
    {0x1.b90d7529260a2p-3, 0x1.17b10d2e0e5abp-61}, {0x1.d77d5df205736p-3, 0x1.c648d1534597ep-57},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57}, {0x1.09dc597d86362p-2, 0x1.62e47390cb865p-56},
    {0x1.18bf5a30bf178p-2, 0x1.30ca4748b1bf9p-57}, {0x1.278372057ef46p-2, -0x1.077cdd36dfc81p-56},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57}, {0x1.44aa436c2af0ap-2, -0x1.5d5e43c55b3bap-56},
    {0x1.530ad9951cd4ap-2, -0x1.2566480884082p-57}, {0x1.614840309cfe2p-2, -0x1.a725715711fp-56},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56}, {0x1.7d5604b63b3f7p-2, 0x1.69c885c2b249ap-56},
    {0x1.8b24d394a1b25p-2, 0x1.b6d0ba3748fa8p-56}, {0x1.98cd5454d6b18p-2, 0x1.9e6c988fd0a77p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56}, {0x1.b3a911da65c6cp-2, 0x1.ae187b1ca504p-56},
    {0x1.c0db4c94ec9fp-2, -0x1.cc1ce70934c34p-56}, {0x1.cde53432c1351p-2, -0x1.a2cfa4418f1adp-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56}, {0x1.e77eb7f175a34p-2, 0x1.0e53dc1bf3435p-56},
    {0x1.f40dd0b541418p-2, -0x1.a3992dc382a23p-57}, {0x1.0039c73c1a40cp-1, -0x1.b32c949c9d593p-55},
    {0x1.0657e94db30dp-1, -0x1.d5b495f6349e6p-56}, {0x1.0c6145b5b43dap-1, 0x1.974fa13b5404fp-58},
    {0x1.1255d9bfbd2a9p-1, -0x1.2bdaee1c0ee35p-58}, {0x1.1835a88be7c13p-1, 0x1.c621cec00c301p-55},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58}, {0x1.23b71e2cc9e6ap-1, 0x1.c421c9f38224ep-57},
    {0x1.2958e59308e31p-1, -0x1.09e73b0c6c087p-56}, {0x1.2ee628406cbcap-1, 0x1.c5d5e9ff0cf8dp-55},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55}, {0x1.39c391cd4171ap-1, -0x1.2304331d8bf46p-55},
    {0x1.3f13fb89e96f4p-1, 0x1.ecf8b492644fp-56}, {0x1.445065b795b56p-1, -0x1.f76d0163f79c8p-56},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56}, {0x1.4e8de5bb6ec04p-1, 0x1.4a33dbeb3796cp-55},
    {0x1.538f57b89061fp-1, -0x1.1bb74abda520cp-55}, {0x1.587d81f732fbbp-1, -0x1.5e5c9d8c5a95p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57}, {0x1.6220d115d7b8ep-1, -0x1.2b785350ee8c1p-57},
    {0x1.66d663923e087p-1, -0x1.6ea6febe8bbbap-56}, {0x1.6b798920b3d99p-1, -0x1.a80386188c50ep-55},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56}, {0x1.748978fba8e0fp-1, 0x1.7b2a6165884a1p-59},
    {0x1.78f6bbd5d315ep-1, 0x1.406a08980374p-55}, {0x1.7d528289fa093p-1, 0x1.560821e2f3aa9p-55},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56}, {0x1.85d69576cc2c5p-1, 0x1.6b66e7fc8b8c3p-57},
    {0x1.89ff5ff57f1f8p-1, -0x1.55b9a5e177a1bp-55}, {0x1.8e17aa99cc05ep-1, -0x1.ec182ab042f61p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
    /* clang-format on */
};

/* Returns a + c b; c has seven bits. */
static wh_pair with_part(wh_pair a, double c, wh_pair b) {
    const wh_pair part = wh_product(c, b.high);
    const wh_pair sum = wh_pair_sum(a.high, part.high);
    return (wh_pair){sum.high, sum.low + (a.low + part.low + c * b.low)};
}

/* Returns the angle of (x, y) for 0 <= y <= x, x > 0, to about 65 bits. */
static wh_pair eighth(wh_pair x, wh_pair y) {
    const int i = (int)(y.high / x.high * 64.0 + 0.5);
    const double c = i / 64.0;
    const wh_pair u = wh_quotient(with_part(y, -c, x), with_part(x, c, y));
    const double z = u.high * u.high;
    const double series = u.high * z * (-1.0 / 3.0 + z * (1.0 / 5.0 + z * (-1.0 / 7.0 + z / 9.0)));
    const wh_pair sum = wh_pair_sum(ray[i].high, u.high);
    return wh_pair_of(sum.high, sum.low + (ray[i].low + u.low + series));
}

/* Returns the angle of (x, y) for x >= 0, y >= 0, not both zero. */
static wh_pair quarter(wh_pair x, wh_pair y) {
    return y.high > x.high ? wh_difference(half_pi, eighth(y, x)) : eighth(x, y);
}

/* Returns sqrt(1 - s^2) for 0 <= s < 1. */
static wh_pair other_leg(double s) {
    const wh_pair square = wh_product(s, s);
    const wh_pair sum = wh_pair_sum(1.0, -square.high);
    const wh_pair rest = wh_pair_of(sum.high, sum.low - square.low);
    const double root = WH_SQRT(rest.high);
    const wh_pair back = wh_product(root, root);
    return wh_pair_of(root, (((rest.high - back.high) - back.low) + rest.low) / (2.0 * root));
}

double wh_atan(double x) {
    const double size = WH_ABS(x);
    if (wh_is_nan(x)) {
        return WH_NAN;
    }
    if (size < SMALL) {
        return x;
    }
    const wh_pair one = {1.0, 0.0};
    return wh_signed(size > 0x1p60 ? half_pi.high : quarter(one, (wh_pair){size, 0.0}).high,
                     x < 0.0);
}

double wh_asin(double x) {
    const double size = WH_ABS(x);
    if (!(size <= 1.0)) {
        return WH_NAN;
    }
    if (size < SMALL) {
        return x;
    }
    return wh_signed(
        size == 1.0 ? half_pi.high : quarter(other_leg(size), (wh_pair){size, 0.0}).high, x < 0.0);
}

double wh_acos(double x) {
    const double size = WH_ABS(x);
    if (!(size <= 1.0)) {
        return WH_NAN;
    }
    if (size == 1.0) {
        return x > 0.0 ? 0.0 : pi.high;
    }
    const wh_pair angle = quarter((wh_pair){size, 0.0}, other_leg(size));
    return x < 0.0 ? wh_difference(pi, angle).high : angle.high;
}

/* Returns the biased exponent: 0 for zero and subnormals, 2047 for infinity. */
static int field_of(double size) { return (int)(wh_bits(size) >> 52); }

/* Returns the angle of (x, y), or of (-x, y) if `behind`. x and y are positive and finite. */
static double finite_angle(double x, double y, bool behind) {
    const int rise = field_of(y) - field_of(x);
    if (rise < -64) {
        return behind ? pi.high : y / x;
    }
    if (rise > 64) {
        return half_pi.high;
    }
    /* Scale extreme points to about 1, so that products of pairs neither overflow nor underflow. */
    const int larger = rise > 0 ? field_of(y) : field_of(x);
    const double scale = larger > 1523 ? 0x1p-600 : larger < 623 ? 0x1p600 : 1.0;
    const wh_pair angle = quarter((wh_pair){x * scale, 0.0}, (wh_pair){y * scale, 0.0});
    return behind ? wh_difference(pi, angle).high : angle.high;
}

double wh_atan2(double y, double x) {
    if (wh_is_nan(x) || wh_is_nan(y)) {
        return WH_NAN;
    }
    const double x_size = WH_ABS(x);
    const double y_size = WH_ABS(y);
    const bool behind = wh_bits(x) >> 63 != 0;
    double angle;
    if (y_size == 0.0) {
        angle = behind ? pi.high : 0.0;
    } else if (x_size == WH_INFINITY) {
        if (y_size == WH_INFINITY) {
            angle = behind ? 0x1.2d97c7f3321d2p1 : 0x1.921fb54442d18p-1; /* 3 pi/4, pi/4 */
        } else {
            angle = behind ? pi.high : 0.0;
        }
    } else if (x_size == 0.0 || y_size == WH_INFINITY) {
        angle = half_pi.high;
    } else {
        angle = finite_angle(x_size, y_size, behind);
    }
    return wh_signed(angle, wh_bits(y) >> 63 != 0);
}

#endif
