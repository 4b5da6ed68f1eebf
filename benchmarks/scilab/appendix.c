/* The criterion of paper A's appendix as one function of C, which Scilab links and Python loads:
 * mean((phi2 measured - phi2)^2)/2, of the double torsion pendulum in ../c/torsion.h.
 *
 *     cc -O2 -shared -fPIC -DCASE='"torsion.h"' appendix.c -lm
 */
#include "../c/run.c"

enum { MOST = 10000 };

/* `u`: alpha, beta, T_s2_l, T_02_l, T_s2_r, T_02_r, k2, c2_l, c2_r; `constants`: all of torsion.h;
 * `measured`: phi2 at `samples` times from 0 to `end`. A failed run counts as infinitely far. */
void appendix(const double *u, const double *constants, const double *measured,
              const double *samples, const double *end, const double *rtol, double *value)
{
    static double times[MOST], out[MOST * N];
    static const int free_ones[] = {ALPHA, BETA, T_S2_L, T_02_L, T_S2_R, T_02_R, K2, C2_L, C2_R};
    double p[PHI2_S + 1], sum = 0.0;
    int count = (int)*samples;
    long counts[3];
    memcpy(p, constants, sizeof p);
    for (int i = 0; i < 9; i++)
        p[free_ones[i]] = u[i];
    for (int i = 0; i < count; i++)
        times[i] = *end * i / (count - 1);
    if (count > MOST || run(p, *rtol, *rtol * 1e-3, times, count, out, counts, 0)) {
        *value = INFINITY;
        return;
    }
    for (int i = 0; i < count; i++) {
        double miss = measured[i] - out[N * i + 2];
        sum += miss * miss;
    }
    *value = sum / count / 2.0;
}
