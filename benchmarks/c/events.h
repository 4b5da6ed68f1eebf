/* The first margin that falls through zero inside a step: five samples, dips foretold by a
 * parabola, the root by false position (Illinois) on the dense output. A margin is armed once it
 * has been positive; only then may it cross. */
#define SAMPLES 5
#define ROOT 1e-14
#define NOISE 1e-14
enum { NOTHING, INSIDE, AT_ONCE };

typedef struct {
    int count, about[MARGINS], after[MARGINS], armed[MARGINS];
    double start[MARGINS];
} Watch;

static void margins_at(const double *p, const int *m, const Step *s, double theta, double *g)
{
    double x[N];
    int about[MARGINS], after[MARGINS];
    if (theta == 1.0)
        memcpy(x, s->x_end, sizeof x);
    else
        inside(s, theta, x);
    margins(p, m, s->t + theta * s->h, x, g, about, after);
}

static double root(const double *p, const int *m, const Step *s, int item, double low, double high)
{
    double g[MARGINS], above, below;
    int side = 0;
    margins_at(p, m, s, low, g);
    if ((above = g[item]) <= 0.0)
        return low;
    margins_at(p, m, s, high, g);
    if ((below = g[item]) >= 0.0)
        return high;
    for (int round = 0; round < 200 && high - low > ROOT; round++) {
        double theta = low + (high - low) * above / (above - below);
        if (round % 4 == 3 || !(low < theta && theta < high))
            theta = low + 0.5 * (high - low);
        margins_at(p, m, s, theta, g);
        if (g[item] == 0.0)
            return theta;
        if (g[item] > 0.0) {
            low = theta, above = g[item];
            below *= side > 0 ? 0.5 : 1.0;
            side = 1;
        } else {
            high = theta, below = g[item];
            above *= side < 0 ? 0.5 : 1.0;
            side = -1;
        }
    }
    return high;
}

static double dip(const double *p, const int *m, const Step *s, double rows[SAMPLES][MARGINS],
                  int count, int item, double floor)
{
    double g[MARGINS];
    for (int k = 1; k < count - 1; k++) {
        double before = rows[k - 1][item], here = rows[k][item], after = rows[k + 1][item];
        double bend = after - 2.0 * here + before, slope = after - before;
        if (!(bend > 0.0 && slope * slope > 8.0 * bend * here && fabs(slope) <= 2.0 * bend
              && before > floor))
            continue;
        double shift = -slope / (2.0 * bend), theta = (k + shift) / (SAMPLES - 1);
        margins_at(p, m, s, theta, g);
        if (g[item] < -floor)
            return root(p, m, s, item, (shift <= 0.0 ? k - 1.0 : k) / (SAMPLES - 1), theta);
    }
    return INFINITY;
}

/* Where and what crosses first. */
static int find(const double *p, const int *m, const Step *s, Watch *w, double *where, int *what)
{
    double rows[SAMPLES][MARGINS], largest = 0.0;
    int first = SAMPLES - 1, crossed[MARGINS] = {0}, fresh = -1;
    if (!w->count)
        return NOTHING;
    for (int i = 0; i < N; i++)
        largest = fmax(largest, fabs(s->x[i]));
    double floor = NOISE * (1.0 + largest);
    memcpy(rows[0], w->start, sizeof rows[0]);
    for (int k = 1; k < SAMPLES; k++)
        margins_at(p, m, s, k / (SAMPLES - 1.0), rows[k]);
    for (int k = 1; k < SAMPLES && first == SAMPLES - 1; k++)
        for (int i = 0; i < w->count; i++)
            if (rows[k][i] < fmin(w->start[i], 0.0) - floor) {
                int armed = w->armed[i];
                for (int j = 0; j < k; j++)
                    armed |= rows[j][i] > floor;
                first = k - 1;
                if (armed)
                    crossed[i] = 1;
                else
                    fresh = i;
            }
    if (fresh >= 0) {
        *what = fresh, *where = 1.0;
        return AT_ONCE;
    }
    *where = INFINITY;
    int rows_used = first + 2 < SAMPLES ? first + 2 : SAMPLES;
    for (int i = 0; i < w->count; i++) {
        double at = dip(p, m, s, rows, rows_used, i, floor);
        if (crossed[i])
            at = fmin(at, root(p, m, s, i, first / (SAMPLES - 1.0), (first + 1) / (SAMPLES - 1.0)));
        if (at < *where)
            *where = at, *what = i;
    }
    if (*where < INFINITY)
        return INSIDE;
    for (int i = 0; i < w->count; i++)
        for (int k = 0; k < SAMPLES; k++)
            w->armed[i] |= rows[k][i] > floor;
    return NOTHING;
}
