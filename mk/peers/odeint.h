/* odeint.h: Boost's odeint, its classic Runge-Kutta stepper. C++. */
#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

typedef std::array<double, STATES> peer_state;

static void peer_slope(const peer_state &y, peer_state &dy, double) { slope(y.data(), dy.data()); }

void naive_start(double y[]) { reinterpret_cast<peer_state *>(y)->fill(0.0); }

void naive_step(double y[], double h) {
    static boost::numeric::odeint::runge_kutta4<peer_state> stepper;
    static_assert(sizeof(peer_state) == STATES * sizeof(double), "the same memory");
    stepper.do_step(peer_slope, *reinterpret_cast<peer_state *>(y), 0.0, h);
}

void naive_read(double y[]) { (void)y; }
