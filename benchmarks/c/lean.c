/* Paper A as lean as it gets by hand: the law of a mode combination is one array of constants, an
 * event is looked for where a margin or its rate changes sign over a step, and lies where the dense
 * output crosses it. Rodas5P while the column is at its stiff barrier, known beforehand, else
 * Dormand-Prince.
 *
 *     cc -O2 -shared -fPIC -DCASE='"torsion.h"' lean.c -lm
 */
#include <math.h>
#include <string.h>
#define torques slow_torques /* the header is here for its constants */
#define rates slow_rates
#define jacobian slow_jacobian
#define margins slow_margins
#include CASE
#undef torques
#undef rates
#undef jacobian
#undef margins

/* The law of a mode combination. */
enum { SWING, SPEED, ANGLE, KAPPA1, KAPPA2, PIN, PIN_AT, PIN_DAMPING, SOFT, SOFT_AT, SOFT_DAMPING,
       LEVEL, DECAY, STEEP, BUMP, VISCOUS, DRY, OVER_B1, OVER_B2, LAW };

static void law_of(const double *p, const int *m, double *law)
{
    int l = m[SPRING] > 0, plus = m[V2] > 0, right = m[V1] > 0;
    const double made[LAW] = {
        p[DRIVE], p[OMEGA], p[PHASE],
        l ? p[KAPPA1_L] : p[KAPPA1_R], l ? p[KAPPA2_L] : p[KAPPA2_R],
        m[COLUMN] ? p[K1] : 0.0, m[COLUMN] * p[PHI1_S], m[COLUMN] ? p[C1] : 0.0,
        m[DISK] ? p[K2] : 0.0, m[DISK] * p[PHI2_S],
        m[DISK] ? (m[DISK] > 0 ? p[C2_L] : p[C2_R]) : 0.0,
        plus ? p[T_S2_L] : p[T_S2_R], (plus ? p[T_02_L] : p[T_02_R]) * m[V2], p[ALPHA], p[BETA],
        right ? p[T_V1_L] : p[T_V1_R], m[V1] * p[T_B], m[V1] ? 1.0 / p[B1] : 0.0, 1.0 / p[B2]};
    memcpy(law, made, sizeof made);
}

/* The torque on the column without its own friction, and minus that on the disk. */
static inline double torques(const double *law, double t, const double *x, double *disk)
{
    double slack = law[SWING] * sin(law[SPEED] * t + law[ANGLE]) - x[0];
    double spring = slack * (law[KAPPA1] + law[KAPPA2] * slack * slack);
    double pin = law[PIN] * (x[0] - law[PIN_AT]) + law[PIN_DAMPING] * x[1];
    double soft = law[SOFT] * (x[2] - law[SOFT_AT]) + law[SOFT_DAMPING] * x[3];
    double fall = exp(-fabs(law[STEEP] * x[3])), square = fall * fall, over = 1.0 / (1.0 + square);
    double friction = law[LEVEL] * (1.0 + law[BUMP] * 2.0 * fall * over)
                      * copysign((1.0 - square) * over, x[3]) / (1.0 + law[DECAY] * x[3]);
    *disk = soft + friction;
    return spring - pin + *disk;
}

static inline void rates(const double *law, const int *m, double t, const double *x, double *dx)
{
    double disk, column = torques(law, t, x, &disk);
    dx[0] = x[1];
    dx[1] = (column - law[VISCOUS] * x[1] - law[DRY]) * law[OVER_B1];
    dx[2] = x[3];
    dx[3] = -disk * law[OVER_B2] - dx[1];
}

static void jacobian(const double *law, const int *m, double t, const double *x, double J[N][N + 1])
{
    double angle = law[SPEED] * t + law[ANGLE], slack = law[SWING] * sin(angle) - x[0];
    double stiff = law[KAPPA1] + 3.0 * law[KAPPA2] * slack * slack;
    double z = law[STEEP] * x[3], sech = 1.0 / cosh(z), th = tanh(z), bump = 1.0 + law[BUMP] * sech;
    double below = 1.0 / (1.0 + law[DECAY] * x[3]);
    double slope = law[LEVEL] * below * (-law[DECAY] * below * bump * th
                   + law[STEEP] * sech * (bump * sech - law[BUMP] * th * th));
    double damping = law[SOFT_DAMPING] + slope;
    const double column[N + 1] = {-stiff - law[PIN], -law[PIN_DAMPING] - law[VISCOUS], law[SOFT],
                                  damping, stiff * law[SWING] * law[SPEED] * cos(angle)};
    const double disk[N + 1] = {0.0, 0.0, law[SOFT], damping, 0.0};
    memset(J, 0, sizeof(double) * N * (N + 1));
    J[0][1] = J[2][3] = 1.0;
    for (int j = 0; j <= N; j++) {
        J[1][j] = column[j] * law[OVER_B1];
        J[3][j] = -disk[j] * law[OVER_B2] - J[1][j];
    }
}

/* Positions are eliminated by hand: of the matrix of a Rosenbrock step two rows are left. */
static int factor(double a[N][N], int *pivot)
{
    double g = 1.0 / a[0][0], b = a[1][1] + g * a[1][0], c = a[1][3] + g * a[1][2];
    double d = a[3][1] + g * a[3][0], e = a[3][3] + g * a[3][2], whole = b * e - c * d;
    a[0][0] = g, a[0][1] = e / whole, a[0][2] = -c / whole;
    a[2][1] = -d / whole, a[2][2] = b / whole;
    return isfinite(1.0 / whole);
}

static inline void substitute(double a[N][N], const int *pivot, double *b)
{
    double g = a[0][0], x = g * b[0], y = g * b[2];
    double v = b[1] - a[1][0] * x - a[1][2] * y, w = b[3] - a[3][0] * x - a[3][2] * y;
    b[1] = a[0][1] * v + a[0][2] * w;
    b[3] = a[2][1] * v + a[2][2] * w;
    b[0] = x + g * b[1];
    b[2] = y + g * b[3];
}

#define OWN_FACTORS
#include "methods.h"
#define NOISE 1e-14 /* of a margin */

/* What is positive while the modes hold: of a state, or where `state` is N of the torque. */
typedef struct {
    int state, mode, to;
    double sign, level;
} Margin;

static int margins_of(const double *p, const int *m, Margin *w)
{
    int n = 0;
    w[n++] = (Margin){3, V2, -m[V2], m[V2], 0.0};
    if (m[COLUMN])
        w[n++] = (Margin){0, COLUMN, 0, m[COLUMN], -p[PHI1_S]};
    else {
        w[n++] = (Margin){0, COLUMN, m[SPRING], -m[SPRING], p[PHI1_S]};
        w[n++] = (Margin){0, SPRING, -m[SPRING], m[SPRING], 0.0};
    }
    if (m[DISK])
        w[n++] = (Margin){2, DISK, 0, m[DISK], -p[PHI2_S]};
    else
        for (int side = -1; side < 2; side += 2)
            w[n++] = (Margin){2, DISK, side, -side, p[PHI2_S]};
    if (m[V1])
        w[n++] = (Margin){1, V1, -m[V1], m[V1], 0.0};
    else
        for (int side = -1; side < 2; side += 2)
            w[n++] = (Margin){N, V1, side, -side, p[T_B]};
    return n;
}

static double value(const double *law, const Margin *w, double t, const double *x)
{
    double disk;
    return w->level + w->sign * (w->state < N ? x[w->state] : torques(law, t, x, &disk));
}

static double value_at(const double *law, const Margin *w, const Step *s, double theta)
{
    double x[N];
    inside(s, theta, x);
    return value(law, w, s->t + theta * s->h, x);
}

/* Where a margin falls through zero between `low`, where it is not negative, and `high`, where it
 * is: by false position (Illinois). */
static double root(const double *law, const Margin *w, const Step *s, double low, double high)
{
    double above = value_at(law, w, s, low), below = value_at(law, w, s, high);
    if (above <= 0.0) { /* it is where the last event was: look behind that */
        for (low = 0.5 * high; low > 1e-9 && value_at(law, w, s, low) <= 0.0; low *= 0.5)
            high = low;
        above = value_at(law, w, s, low), below = value_at(law, w, s, high);
        if (above <= 0.0)
            return high;
    }
    for (int side = 0, round = 0; round < 60 && high - low > 1e-13; round++) {
        double theta = low + (high - low) * above / (above - below);
        double here = value_at(law, w, s, theta);
        if (here > 0.0)
            low = theta, above = here, below *= side > 0 ? 0.5 : 1.0, side = 1;
        else
            high = theta, below = here, above *= side < 0 ? 0.5 : 1.0, side = -1;
        if (fabs(here) < NOISE)
            return theta;
    }
    return high;
}

/* Where a margin that turns inside of the step is lowest; 1 where it does not turn. */
static double lowest(const Margin *w, const Step *s, const double *rate)
{
    if (w->state == N)
        return 1.0;
    double a = w->sign * rate[w->state], b = w->sign * s->rate_end[w->state];
    return a < 0.0 && b > 0.0 ? a / (a - b) : 1.0;
}

static double norm(const Step *s, double rtol, double atol)
{
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        double size = fmax(fabs(s->x[i]), fabs(s->x_end[i]));
        double part = s->error[i] / (atol + rtol * size);
        sum += part * part;
    }
    return sqrt(sum / N);
}

/* From the case's own start to the last of `times`; out[samples][N]; counts: steps, rejected,
 * events. 0 is success. */
int run(const double *p, double rtol, double atol, const double *times, int samples, double *out,
        long *counts, int unused)
{
    double x[N], rate[N], law[LAW], t = times[0], end = times[samples - 1], h = 1e-4;
    int m[MODES], filled = 0;
    Margin watched[MARGINS];
    Step s;
    begin(p, m, x);
    law_of(p, m, law);
    int count = margins_of(p, m, watched);
    rates(law, m, t, x, rate);
    while (t < end) {
        int stiff = m[COLUMN] && p[C1] > 10.0, what = -1;
        if (t + 1.01 * h >= end)
            h = end - t;
        if (stiff)
            stiff_step(law, m, t, x, rate, h, &s);
        else
            explicit_step(law, m, t, x, rate, h, &s);
        double error = norm(&s, rtol, atol);
        if (!(error <= 1.0)) {
            counts[1]++;
            h *= isfinite(error) ? fmax(0.1, 0.9 * pow(error, -0.2)) : 0.1;
            if (h < 1e-14)
                return 1;
            continue;
        }
        counts[0]++;
        if (stiff)
            rates(law, m, t + h, s.x_end, s.rate_end);
        double first = 1.0;
        for (int i = 0; i < count; i++) {
            const Margin *w = watched + i;
            int below = value(law, w, t + h, s.x_end) < -NOISE;
            double at = below ? 1.0 : lowest(w, &s, rate);
            if (below || (at < 1.0 && value_at(law, w, &s, at) < -NOISE)) {
                double where = root(law, w, &s, 0.0, at);
                if (what < 0 || where < first)
                    first = where, what = i;
            }
        }
        double until = what < 0 ? t + h : t + first * h;
        for (; filled < samples && times[filled] < until; filled++)
            inside(&s, (times[filled] - t) / h, out + N * filled);
        double next = h * fmin(6.0, fmax(0.2, 0.9 * pow(fmax(error, 1e-10), -0.2)));
        if (what < 0) {
            t = t + h >= end ? end : t + h;
            memcpy(x, s.x_end, sizeof x);
            memcpy(rate, s.rate_end, sizeof rate);
            h = next;
        } else {
            inside(&s, first, x);
            t = until;
            happen(p, m, t, x, watched[what].mode, watched[what].to);
            law_of(p, m, law);
            count = margins_of(p, m, watched);
            rates(law, m, t, x, rate);
            h *= 0.25;
            counts[2]++;
        }
    }
    for (; filled < samples; filled++)
        memcpy(out + N * filled, x, sizeof x);
    return 0;
}
