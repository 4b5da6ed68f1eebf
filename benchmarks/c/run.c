/* The same algorithm as tracewire's, by hand for one system: Dormand-Prince 5(4), and Rodas5P for
 * mode combinations that turn out stiff; frozen modes between located events.
 *
 *     cc -O2 -shared -fPIC -DCASE='"torsion.h"' run.c -lm
 */
#include <math.h>
#include <string.h>
#include CASE
#include "methods.h"
#include "events.h"
#define NEARBY 1e-5

typedef struct {
    const double *p, *times;
    double *out, t, h, end, length, rtol, atol, ratio, x[N];
    int m[MODES], samples, filled, stiff[KEYS], suspicious, calm;
    long steps, rejected, events;
} Run;

static double size(const Run *r, const double *error, const double *a, const double *b)
{
    double sum = 0.0;
    for (int i = 0; i < N; i++) {
        double part = error[i] / (r->atol + r->rtol * fmax(fabs(a[i]), fabs(b[i])));
        sum += part * part;
    }
    return sqrt(sum / N);
}

static double smallest(const Run *r)
{
    double t = fabs(r->t);
    return fmax(1e-15 * r->length, 16.0 * (nextafter(t, INFINITY) - t));
}

/* Hairer's starting step for a method of order 5. */
static double first_step(const Run *r, const double *rate, double limit)
{
    double at[N], moved[N], amount = size(r, r->x, r->x, r->x), speed = size(r, rate, r->x, r->x);
    double h = amount < 1e-5 || speed < 1e-5 ? 1e-6 * r->length : 0.01 * amount / speed;
    h = fmin(h, limit - r->t);
    for (int i = 0; i < N; i++)
        at[i] = r->x[i] + h * rate[i];
    rates(r->p, r->m, r->t + h, at, moved);
    for (int i = 0; i < N; i++)
        moved[i] -= rate[i];
    double bend = size(r, moved, r->x, r->x) / h, largest = fmax(bend, speed);
    double after = largest <= 1e-15 ? fmax(1e-6 * r->length, h * 1e-3) : pow(0.01 / largest, 0.2);
    return fmin(fmin(100.0 * h, after), r->length);
}

static void take(const Run *r, const double *rate, double h, int stiff, Step *s)
{
    if (stiff)
        stiff_step(r->p, r->m, r->t, r->x, rate, h, s);
    else
        explicit_step(r->p, r->m, r->t, r->x, rate, h, s);
}

/* `pow` without its last digits, which a step length does not need. */
static double power(double error, double exponent)
{
    return exp(exponent * log(error));
}

/* A step within the tolerances; 0 where none can be found. */
static int attempt(Run *r, const double *rate, double limit, Step *s)
{
    int stiff = r->stiff[key(r->m)];
    for (;;) {
        double h = fmin(r->h, 0.1 * r->length);
        if (r->t + 1.01 * h >= limit)
            h = limit - r->t;
        take(r, rate, h, stiff, s);
        r->steps++;
        double error = size(r, s->error, s->x, s->x_end);
        if (error <= 1.0) {
            r->ratio = fmin(6.0, fmax(0.2, 0.9 * power(fmax(error, 1e-10), -0.2)));
            return 1;
        }
        r->rejected++;
        r->h = h * (isfinite(error) ? fmax(0.1, 0.9 * power(error, -0.2)) : 0.1);
        if (r->h < smallest(r))
            return 0;
    }
}

static void watch_stiffness(Run *r, const Step *s)
{
    if (s->stiff)
        return;
    if (s->stiffness > 3.0)
        r->suspicious++, r->calm = 0;
    else if (++r->calm == 6)
        r->suspicious = 0;
    if (r->suspicious >= 8)
        r->stiff[key(r->m)] = 1, r->suspicious = 0;
}

static void sample(Run *r, const Step *s, double until)
{
    for (; r->filled < r->samples && r->times[r->filled] < until; r->filled++)
        inside(s, (r->times[r->filled] - s->t) / s->h, r->out + N * r->filled);
}

/* End the step at the crossing: located on the polynomial, then on true steps, and from the end of
 * the last one on where a correction is small. */
static void polish(Run *r, const double *rate, double theta, int mode, int to, int item, Step *s)
{
    double g[MARGINS], whole = s->h, h = fmax(theta * whole, smallest(r));
    int stiff = s->stiff, about[MARGINS], after[MARGINS];
    take(r, rate, h, stiff, s);
    for (int round = 0; round < 3; round++) {
        margins(r->p, r->m, r->t + h, s->x_end, g, about, after);
        double along = margin_rate(r->p, r->m, r->t + h, s->x_end, mode, to);
        double change = along != 0.0 ? -g[item] / along : 0.0;
        if (fabs(change) <= 1e-14 * r->length || !(0.0 < h + change && h + change <= whole)
            || fabs(change) > 0.1 * whole)
            return;
        h += change;
        if (!stiff && fabs(change) <= NEARBY * s->h)
            explicit_move(r->p, r->m, rate, change, s);
        else
            take(r, rate, h, stiff, s);
    }
}

/* Steps until something happens, and what happens. */
static int smooth(Run *r)
{
    Watch w = {0};
    Step s;
    double rate[N], theta, soon = due(r->p, r->m, r->t), limit = fmin(soon, r->end);
    int what = 0, how;
    w.count = margins(r->p, r->m, r->t, r->x, w.start, w.about, w.after);
    rates(r->p, r->m, r->t, r->x, rate);
    if (r->h <= 0.0)
        r->h = first_step(r, rate, limit);
    while (r->t < limit) {
        if (!attempt(r, rate, limit, &s))
            return 0;
        how = find(r->p, r->m, &s, &w, &theta, &what);
        if (how == AT_ONCE && s.h > 1e-9 * r->length) {
            r->h = s.h / 16.0;
            continue;
        }
        if (how != NOTHING) {
            polish(r, rate, theta, w.about[what], w.after[what], what, &s);
            sample(r, &s, s.t + s.h);
            r->t = s.t + s.h;
            memcpy(r->x, s.x_end, sizeof r->x);
            happen(r->p, r->m, r->t, r->x, w.about[what], w.after[what]);
            r->h /= 4.0;
            r->suspicious = 0;
            r->events++;
            return 1;
        }
        sample(r, &s, s.t + s.h);
        int last = s.t + s.h >= limit;
        r->t = last ? limit : s.t + s.h;
        r->h = last ? fmax(r->h, s.h * r->ratio) : s.h * r->ratio;
        memcpy(r->x, s.x_end, sizeof r->x);
        if (s.stiff)
            rates(r->p, r->m, r->t, r->x, rate);
        else
            memcpy(rate, s.rate_end, sizeof rate);
        int about[MARGINS], after[MARGINS];
        margins(r->p, r->m, r->t, r->x, w.start, about, after);
        watch_stiffness(r, &s);
    }
    if (limit == soon) {
        tick(r->p, r->m, r->t);
        r->h = 0.0;
        r->events++;
    }
    return 1;
}

/* From the case's own start to the last of `times`; out[samples][N]; counts: steps, rejected,
 * events. 0 is success. */
int run(const double *p, double rtol, double atol, const double *times, int samples, double *out,
        long *counts, int unused)
{
    Run r = {.p = p, .times = times, .out = out, .samples = samples, .rtol = rtol, .atol = atol};
    r.t = times[0], r.end = times[samples - 1], r.length = r.end - r.t;
    begin(p, r.m, r.x);
    while (r.t < r.end)
        if (!smooth(&r))
            return 1;
    for (; r.filled < samples; r.filled++)
        memcpy(out + N * r.filled, r.x, sizeof r.x);
    counts[0] = r.steps - r.rejected, counts[1] = r.rejected, counts[2] = r.events;
    return 0;
}
