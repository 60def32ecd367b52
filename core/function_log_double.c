/* function_log_double.c: the natural logarithm in double. If x = 2^e (1 + r)/c, log x is e log 2 - log c + log(1 + r).
 * A table gives c, so that |r| <= 2^-8. Each c has 15 bits, so r is exact. The result is a pair, because pow() needs
 * more than 53 bits. */
#include "function_double.h"

#if WH_DOUBLE

#define LN2_HIGH \
    0x1.62e42fefa4p-1 /* a multiple of 2^-40, so exponent * LN2_HIGH + entry.high is exact */
#define LN2_LOW (-0x1.8432a1b0e2634p-43)

/* The bits of 0.7051. In x = 2^e m, the mantissa m is at least this number and below twice this number. */
#define LEAST_BITS UINT64_C(0x3fe6900000000000)

typedef struct entry {
    double inverse; /* c, about 1/m */
    double high;    /* -log c, a multiple of 2^-40 */
    double low;
} entry;

static const entry table[128] = {
    /* clang-format off */
    {0x1.6a14p0, -0x1.6300c0b3ap-2, -0x1.492956630606p-43},
    {0x1.6818p0, -0x1.5d601df354p-2, 0x1.6d8573fcee5e7p-47},
    {0x1.662p0, -0x1.57c2f53b04p-2, -0x1.20929802f854ap-42},
    {0x1.642cp0, -0x1.5229607344p-2, 0x1.c2951f024672dp-42},
    {0x1.624p0, -0x1.4c9f09e154p-2, 0x1.3c3bbce1c05bcp-42},
    {0x1.6058p0, -0x1.47189c271cp-2, 0x1.be4fb16826024p-42},
    {0x1.5e74p0, -0x1.4196323a2cp-2, 0x1.9641e21a9169cp-42},
    {0x1.5c98p0, -0x1.3c23a772ecp-2, 0x1.cfad569e12885p-43},
    {0x1.5acp0, -0x1.36b5776bcp-2, -0x1.1169785a9c224p-42},
    {0x1.58ecp0, -0x1.314bbe1bc8p-2, -0x1.4d6e01d7fe1fp-42},
    {0x1.572p0, -0x1.2bf287cc4p-2, -0x1.361e9ea93b1dap-42},
    {0x1.5554p0, -0x1.269221114cp-2, -0x1.b7d22d6961455p-42},
    {0x1.539p0, -0x1.214296d088p-2, -0x1.8d2759fe6d04dp-42},
    {0x1.51dp0, -0x1.1bf816356p-2, 0x1.46c4256280861p-42},
    {0x1.5014p0, -0x1.16b2bcb9a4p-2, 0x1.a58e52f8087cdp-44},
    {0x1.4e6p0, -0x1.117ee81ep-2, 0x1.b3c221d745cd1p-42},
    {0x1.4cacp0, -0x1.0c444675d4p-2, -0x1.c81dba5bec16cp-47},
    {0x1.4afcp0, -0x1.070f26027p-2, -0x1.0468980207adcp-42},
    {0x1.4954p0, -0x1.01ec15624p-2, 0x1.6dcf3b825b48fp-43},
    {0x1.47bp0, -0x1.f99dc6c238p-3, -0x1.a04be7ba12f26p-42},
    {0x1.460cp0, -0x1.ef563e4c78p-3, -0x1.bdda05c5c7ap-43},
    {0x1.447p0, -0x1.e533effdep-3, -0x1.0145226be4225p-43},
    {0x1.42d8p0, -0x1.db1e1b06b8p-3, 0x1.99835a55aabfbp-45},
    {0x1.414p0, -0x1.d0fb7f2258p-3, 0x1.0d7a9590319d9p-42},
    {0x1.3fbp0, -0x1.c6ff3c6fp-3, 0x1.847b3206bbe05p-42},
    {0x1.3e24p0, -0x1.bd10338p-3, 0x1.b96136e974dcp-42},
    {0x1.3c98p0, -0x1.b314c570fp-3, -0x1.f0269a94f5e94p-42},
    {0x1.3b14p0, -0x1.a940d3c87p-3, 0x1.30df314c56ed5p-42},
    {0x1.399p0, -0x1.9f60c06848p-3, 0x1.50d5541f0590dp-42},
    {0x1.3814p0, -0x1.95a8edcec8p-3, 0x1.cfc024bff78d6p-44},
    {0x1.3698p0, -0x1.8be53eb18p-3, 0x1.183acfde38461p-43},
    {0x1.352p0, -0x1.8230164c18p-3, -0x1.198dd68a5d0b5p-42},
    {0x1.33bp0, -0x1.78a4584cp-3, -0x1.9e3f57d3f542ep-44},
    {0x1.324p0, -0x1.6f0d28ae58p-3, 0x1.4b4641b664613p-43},
    {0x1.30dp0, -0x1.656a6be1ep-3, 0x1.693437cb77ef4p-42},
    {0x1.2f68p0, -0x1.5bf206b5p-3, -0x1.ed8a86be42126p-42},
    {0x1.2e04p0, -0x1.52897e426p-3, 0x1.c009111f7446ep-44},
    {0x1.2cap0, -0x1.4915d832f8p-3, -0x1.ab0c47fe50c28p-42},
    {0x1.2b4p0, -0x1.3fb25a595p-3, -0x1.4656f9acd63fep-42},
    {0x1.29e4p0, -0x1.365f4b0158p-3, 0x1.7f4e98143bf9cp-42},
    {0x1.288cp0, -0x1.2d1cf0c57p-3, -0x1.eaa7582f75eeap-42},
    {0x1.2734p0, -0x1.23cfd2a15p-3, -0x1.8f0f158dd0fcdp-42},
    {0x1.25e4p0, -0x1.1aaf97d7ep-3, -0x1.9edde8286b49dp-42},
    {0x1.2494p0, -0x1.1184e8198p-3, 0x1.af4226e73fb9ep-43},
    {0x1.2344p0, -0x1.084fab53c8p-3, -0x1.adb24878407e7p-42},
    {0x1.21fcp0, -0x1.fe90939cp-4, 0x1.2a4684ab9e215p-42},
    {0x1.20b4p0, -0x1.ec6d582f7p-4, 0x1.db9529bb17c3fp-42},
    {0x1.1f7p0, -0x1.da6e7637cp-4, -0x1.1a83eac951c1bp-42},
    {0x1.1e3p0, -0x1.c8948014cp-4, 0x1.a4b23a7216241p-43},
    {0x1.1cfp0, -0x1.b6a688d9bp-4, -0x1.6c5d7fcef8959p-42},
    {0x1.1bb4p0, -0x1.a4de24087p-4, 0x1.7b1a7e7482bbap-45},
    {0x1.1a7cp0, -0x1.933be5d47p-4, -0x1.2634b8706a914p-42},
    {0x1.1944p0, -0x1.818622ea3p-4, -0x1.6dee654e4b9b3p-42},
    {0x1.181p0, -0x1.6ff7309f9p-4, 0x1.ffe70e666b0c9p-43},
    {0x1.16ep0, -0x1.5e8fa4d86p-4, 0x1.b8e40c7dca3bcp-42},
    {0x1.15bp0, -0x1.4d1515b98p-4, -0x1.f38c17e8e050bp-42},
    {0x1.1484p0, -0x1.3bc29a635p-4, 0x1.6e2b9b7673452p-42},
    {0x1.135cp0, -0x1.2a98ca42bp-4, 0x1.0c87cb4ca73cep-45},
    {0x1.1234p0, -0x1.195c7d038p-4, -0x1.8c1f4ef37e16cp-45},
    {0x1.111p0, -0x1.08498b51ep-4, -0x1.cd899875409b6p-43},
    {0x1.0ffp0, -0x1.eec11bf26p-5, 0x1.1bdebfdb4a12ep-43},
    {0x1.0edp0, -0x1.cccb3cd7ap-5, 0x1.342b3a33257e5p-43},
    {0x1.0db4p0, -0x1.ab2aacd86p-5, -0x1.514c04298730ep-47},
    {0x1.0c98p0, -0x1.8966a13dcp-5, 0x1.3129d7777e259p-43},
    {0x1.0b8p0, -0x1.67f94f094p-5, -0x1.7b307cf9f93b6p-42},
    {0x1.0a68p0, -0x1.4668ed42cp-5, -0x1.c7d303bf2db06p-42},
    {0x1.0954p0, -0x1.2530b2f8cp-5, -0x1.107d3ec0431bfp-42},
    {0x1.0844p0, -0x1.0451d8664p-5, 0x1.6ead2c2d848a6p-42},
    {0x1.0734p0, -0x1.c6a22e718p-6, -0x1.902f0ff619f43p-42},
    {0x1.0624p0, -0x1.845c5275cp-6, -0x1.27c60c6632001p-44},
    {0x1.0518p0, -0x1.42cc92148p-6, 0x1.dde394cdaf04bp-44},
    {0x1.041p0, -0x1.01f565874p-6, 0x1.4f7c16c8368a6p-43},
    {0x1.0308p0, -0x1.81b889ecp-7, 0x1.834c73c4ec934p-45},
    {0x1.0204p0, -0x1.00fd57588p-7, 0x1.0c76e4447e693p-46},
    {0x1.01p0, -0x1.ff00aa2cp-9, 0x1.de87f6bef2953p-42},
    {0x1p0, 0.0, 0.0},
    {0x1.fc08p-1, 0x1.fdfaa6b1p-8, 0x1.33c478c65f4c7p-43},
    {0x1.f82p-1, 0x1.fbea8b14p-7, -0x1.fe136d84e81b2p-42},
    {0x1.f448p-1, 0x1.7b5bb0944p-6, -0x1.cfb25e564bfb2p-42},
    {0x1.f08p-1, 0x1.f7a9b1678p-6, 0x1.42ad9271be7d7p-45},
    {0x1.eccp-1, 0x1.39f07ba0ep-5, 0x1.7ac4a7590b95ep-42},
    {0x1.e91p-1, 0x1.77798f8d6p-5, 0x1.bfb13e0da8ff3p-42},
    {0x1.e57p-1, 0x1.b46bd74dap-5, 0x1.da60510e2b79ap-43},
    {0x1.e1ep-1, 0x1.f0c30c112p-5, -0x1.395de6b116fbp-42},
    {0x1.de6p-1, 0x1.163d6ef95p-4, 0x1.e80c4fc727191p-42},
    {0x1.dae8p-1, 0x1.340c796acp-4, 0x1.45a8e101a3184p-42},
    {0x1.d778p-1, 0x1.51cdf40b9p-4, 0x1.d2b21b03ee255p-43},
    {0x1.d42p-1, 0x1.6ef528c05p-4, 0x1.a8ae74a260d49p-42},
    {0x1.d0c8p-1, 0x1.8c51dd7e5p-4, -0x1.0b20c06971e57p-42},
    {0x1.cd88p-1, 0x1.a90fd3b53p-4, 0x1.5197adc9ba16bp-42},
    {0x1.ca48p-1, 0x1.c601c90f2p-4, -0x1.6daa1a59af65dp-44},
    {0x1.c72p-1, 0x1.e2507702bp-4, -0x1.f897980522249p-45},
    {0x1.c3f8p-1, 0x1.fed1932p-4, 0x1.58eeb117feaf2p-45},
    {0x1.c0ep-1, 0x1.0d79e7cd48p-3, 0x1.cb422847849e4p-44},
    {0x1.bddp-1, 0x1.1b7f2d5cb8p-3, 0x1.4217637b610fep-42},
    {0x1.badp-1, 0x1.29532f824p-3, -0x1.5babd495c735ep-44},
    {0x1.b7d8p-1, 0x1.371a0203f8p-3, 0x1.f64642b7657cap-43},
    {0x1.b4e8p-1, 0x1.44d336ccb8p-3, 0x1.e8f353f420dd2p-42},
    {0x1.b2p-1, 0x1.527e5e4a18p-3, 0x1.ac67d1cad2fb9p-42},
    {0x1.af28p-1, 0x1.5ff5070ab8p-3, 0x1.3d4731eacb4b8p-43},
    {0x1.ac58p-1, 0x1.6d5c3e7308p-3, -0x1.dec60fce4d8ecp-43},
    {0x1.a99p-1, 0x1.7ab39022ap-3, -0x1.380a7612ebfd9p-42},
    {0x1.a6dp-1, 0x1.87fa86521p-3, 0x1.2212595679851p-44},
    {0x1.a418p-1, 0x1.9530a9d6d8p-3, -0x1.46e4f50e13125p-42},
    {0x1.a17p-1, 0x1.a22e42099p-3, -0x1.6d3db8ae31ba8p-44},
    {0x1.9ec8p-1, 0x1.af4114e95p-3, -0x1.63cb9af155c9p-53},
    {0x1.9c3p-1, 0x1.bc19e75p-3, -0x1.a13f101175083p-42},
    {0x1.9998p-1, 0x1.c9077c7da8p-3, 0x1.a4c56f082e337p-43},
    {0x1.971p-1, 0x1.d5b996b98p-3, -0x1.287466dffc818p-45},
    {0x1.9488p-1, 0x1.e27ff6f1bp-3, 0x1.a0e1f2c12c2c3p-42},
    {0x1.921p-1, 0x1.ef095cbde8p-3, 0x1.9360a18e87436p-43},
    {0x1.8fap-1, 0x1.fb7d86eeep-3, 0x1.dc7f3c648fed1p-42},
    {0x1.8d3p-1, 0x1.0402994b5p-2, -0x1.f7e47905d93e9p-43},
    {0x1.8ac8p-1, 0x1.0a3b8e31ecp-2, -0x1.c299ada41582p-43},
    {0x1.887p-1, 0x1.10547f9d28p-2, -0x1.5447df6a600b3p-42},
    {0x1.8618p-1, 0x1.1676cabadcp-2, -0x1.9f1a70dd2d536p-42},
    {0x1.83c8p-1, 0x1.1c8d6c187cp-2, -0x1.df19f00af5429p-42},
    {0x1.818p-1, 0x1.22981fbef8p-2, -0x1.a1421609580dap-44},
    {0x1.7f4p-1, 0x1.2896a13e08p-2, 0x1.a8ed027e16952p-44},
    {0x1.7d08p-1, 0x1.2e88abb1d8p-2, 0x1.cf92710a48647p-42},
    {0x1.7adp-1, 0x1.348399ada8p-2, 0x1.d94353464592ap-42},
    {0x1.78a8p-1, 0x1.3a5c056028p-2, -0x1.af5860d1a4e55p-42},
    {0x1.768p-1, 0x1.403d086cecp-2, -0x1.86442a2ede33ep-42},
    {0x1.746p-1, 0x1.4610bc29c4p-2, 0x1.e17d360cef372p-42},
    {0x1.724p-1, 0x1.4becf95d98p-2, -0x1.bb33b20023a7p-44},
    {0x1.703p-1, 0x1.51a55876a8p-2, -0x1.014d6a5ce66ddp-43},
    {0x1.6e2p-1, 0x1.5765f1749cp-2, 0x1.a6b349b07c9f5p-42},
    {0x1.6c18p-1, 0x1.5d185bf708p-2, 0x1.3780bd888bc6dp-43},
    /* clang-format on */
};

/* Returns log(1 + r) - r + r^2/2. */
static double from_cube(double r) {
    const double upper = 1.0 / 7.0 + r * (-1.0 / 8.0 + r / 9.0);
    return r * r * r *
           (1.0 / 3.0 + r * (-1.0 / 4.0 + r * (1.0 / 5.0 + r * (-1.0 / 6.0 + r * upper))));
}

wh_pair wh_log_pair(double x) {
    uint64_t bits = wh_bits(x);
    int exponent = 0;
    if (bits < UINT64_C(1) << 52) { /* subnormal */
        bits = wh_bits(x * 0x1p52);
        exponent = -52;
    }
    const uint64_t above = bits - LEAST_BITS + (UINT64_C(1024) << 52);
    const int power = (int)(above >> 52) - 1024;
    const double m = wh_of_bits(bits - (above & (UINT64_C(0xfff) << 52)) + (UINT64_C(1024) << 52));
    const entry *at = &table[(above >> 45) & 127U];
    exponent += power;

    const double m_high = wh_upper(m);
    const wh_pair r = wh_pair_sum(m_high * at->inverse - 1.0, (m - m_high) * at->inverse);
    const wh_pair square = wh_product(r.high, r.high);
    const wh_pair first = wh_pair_sum(exponent * LN2_HIGH + at->high, r.high);
    const wh_pair second = wh_pair_sum(first.high, -0.5 * square.high);
    const double small = first.low + second.low + (r.low - r.high * r.low) - 0.5 * square.low +
                         (exponent * LN2_LOW + at->low) + from_cube(r.high);
    return wh_pair_of(second.high, small);
}

double wh_log(double x) {
    if (!(x > 0.0)) {
        return x == 0.0 ? -WH_INFINITY : WH_NAN;
    }
    return x == WH_INFINITY ? x : wh_log_pair(x).high;
}

#endif
