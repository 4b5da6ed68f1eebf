/* One step of Dormand-Prince 5(4) and of Rodas5P, both with dense output of order 4.
 *
 * Sources: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, table II.5.2 and
 * section II.6; Steinebach, BIT Numerical Mathematics 63:27, 2023.
 */
typedef struct {
    double t, h, stiffness;
    double x[N], x_end[N], rate_end[N], error[N], inner[3][N];
    int stiff; /* made by Rodas5P */
} Step;

static void explicit_step(const double *p, const int *m, double t, const double *x,
                          const double *rate, double h, Step *s)
{
    double k2[N], k3[N], k4[N], k5[N], k6[N], at[N], *k7 = s->rate_end, *end = s->x_end;
    const double *k1 = rate;
    for (int i = 0; i < N; i++)
        at[i] = x[i] + h * (k1[i] / 5);
    rates(p, m, t + h / 5, at, k2);
    for (int i = 0; i < N; i++)
        at[i] = x[i] + h * (3.0 / 40 * k1[i] + 9.0 / 40 * k2[i]);
    rates(p, m, t + 3.0 / 10 * h, at, k3);
    for (int i = 0; i < N; i++)
        at[i] = x[i] + h * (44.0 / 45 * k1[i] - 56.0 / 15 * k2[i] + 32.0 / 9 * k3[i]);
    rates(p, m, t + 4.0 / 5 * h, at, k4);
    for (int i = 0; i < N; i++)
        at[i] = x[i] + h * (19372.0 / 6561 * k1[i] - 25360.0 / 2187 * k2[i]
                            + 64448.0 / 6561 * k3[i] - 212.0 / 729 * k4[i]);
    rates(p, m, t + 8.0 / 9 * h, at, k5);
    for (int i = 0; i < N; i++)
        at[i] = x[i] + h * (9017.0 / 3168 * k1[i] - 355.0 / 33 * k2[i] + 46732.0 / 5247 * k3[i]
                            + 49.0 / 176 * k4[i] - 5103.0 / 18656 * k5[i]);
    rates(p, m, t + h, at, k6);
    for (int i = 0; i < N; i++)
        end[i] = x[i] + h * (35.0 / 384 * k1[i] + 500.0 / 1113 * k3[i] + 125.0 / 192 * k4[i]
                             - 2187.0 / 6784 * k5[i] + 11.0 / 84 * k6[i]);
    rates(p, m, t + h, end, k7);
    double change = 0.0, apart = 0.0;
    for (int i = 0; i < N; i++) {
        double rise = end[i] - x[i];
        apart += (end[i] - at[i]) * (end[i] - at[i]);
        change += (k7[i] - k6[i]) * (k7[i] - k6[i]);
        s->x[i] = x[i];
        s->error[i] = h * (71.0 / 57600 * k1[i] - 71.0 / 16695 * k3[i] + 71.0 / 1920 * k4[i]
                           - 17253.0 / 339200 * k5[i] + 22.0 / 525 * k6[i] - k7[i] / 40);
        s->inner[0][i] = h * k1[i] - rise;
        s->inner[1][i] = rise - h * k7[i] - s->inner[0][i];
        s->inner[2][i] = h * (-12715105075.0 / 11282082432 * k1[i]
                              + 87487479700.0 / 32700410799 * k3[i]
                              - 10690763975.0 / 1880347072 * k4[i]
                              + 701980252875.0 / 199316789632 * k5[i]
                              - 1453857185.0 / 822651844 * k6[i] + 69997945.0 / 29380423 * k7[i]);
    }
    s->t = t, s->h = h, s->stiff = 0;
    s->stiffness = apart > 0.0 ? h * sqrt(change / apart) : 0.0;
}

/* Let the step be longer by so little that the trapezoidal rule is exact but for rounding. */
static void explicit_move(const double *p, const int *m, const double *rate, double change, Step *s)
{
    double at[N], further[N], part = (s->h + change) / s->h;
    s->h += change;
    for (int i = 0; i < N; i++)
        at[i] = s->x_end[i] + change * s->rate_end[i];
    rates(p, m, s->t + s->h, at, further);
    for (int i = 0; i < N; i++) {
        s->x_end[i] += 0.5 * change * (s->rate_end[i] + further[i]);
        s->rate_end[i] = further[i];
        double rise = s->x_end[i] - s->x[i];
        s->inner[0][i] = s->h * rate[i] - rise;
        s->inner[1][i] = rise - s->h * further[i] - s->inner[0][i];
        s->inner[2][i] *= part;
    }
}

static const double GAMMA = 0.21193756319429014;
static const double R_C[8] = {0.0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716,
                              0.4288403609558664, 1.0, 1.0, 1.0};
static const double R_D[8] = {0.21193756319429014, -0.42387512638858027, -0.3384627126235924,
                              1.8046452872882734, 2.325825639765069, 0.0, 0.0, 0.0};
#define LAST -7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256, \
             0.030198172008377946
static const double R_A[8][7] = {
    {0.0}, {3.0}, {2.849394379747939, 0.45842242204463923},
    {-6.954028509809101, 2.489845061869568, -10.358996098473584},
    {2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641},
    {LAST}, {LAST, 1.0}, {LAST, 1.0, 1.0}};
static const double R_G[8][7] = {
    {0.0}, {-14.155112264123755}, {-17.97296035885952, -2.859693295451294},
    {147.12150275711716, -1.41221402718213, 71.68940251302358},
    {165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306},
    {24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125,
     -0.6610691825249471},
    {30.91273214028599, -3.1208243349937974, 77.79954646070892, 34.28646028294783,
     -19.097331116725623, -28.087943162872662},
    {37.80277123390563, -3.2571969029072276, 112.26918849496327, 66.9347231244047,
     -40.06618937091002, -54.66780262877968, -9.48861652309627}};
static const double R_IN[3][8] = {
    {25.948786856663858, -2.5579724845846235, 10.433815404888879, -2.3679251022685204,
     0.524948541321073, 1.1241088310450404, 0.4272876194431874, -0.17202221070155493},
    {-9.91568850695171, -0.9689944594115154, 3.0438037242978453, -24.495224566215796,
     20.176138334709044, 15.98066361424651, -6.789040303419874, -6.710236069923372},
    {11.419903575922262, 2.8879645146136994, 72.92137995996029, 80.12511834622643,
     -52.072871366152654, -59.78993625266729, -0.15582684282751913, 4.883087185713722}};

#ifndef OWN_FACTORS
/* LU with row exchange in place; 0 where the matrix is singular. */
static int factor(double a[N][N], int *pivot)
{
    for (int k = 0; k < N; k++) {
        int best = k;
        for (int i = k + 1; i < N; i++)
            if (fabs(a[i][k]) > fabs(a[best][k]))
                best = i;
        pivot[k] = best;
        if (!(fabs(a[best][k]) > 0.0))
            return 0;
        for (int j = 0; best != k && j < N; j++) {
            double kept = a[k][j];
            a[k][j] = a[best][j], a[best][j] = kept;
        }
        for (int i = k + 1; i < N; i++) {
            a[i][k] /= a[k][k];
            for (int j = k + 1; j < N; j++)
                a[i][j] -= a[i][k] * a[k][j];
        }
    }
    return 1;
}

static void substitute(double a[N][N], const int *pivot, double *b)
{
    for (int k = 0; k < N; k++) {
        double kept = b[k];
        b[k] = b[pivot[k]], b[pivot[k]] = kept;
    }
    for (int i = 1; i < N; i++)
        for (int j = 0; j < i; j++)
            b[i] -= a[i][j] * b[j];
    for (int i = N - 1; i >= 0; i--) {
        for (int j = i + 1; j < N; j++)
            b[i] -= a[i][j] * b[j];
        b[i] /= a[i][i];
    }
}
#endif

static void stiff_step(const double *p, const int *m, double t, const double *x,
                       const double *rate, double h, Step *s)
{
    double J[N][N + 1], W[N][N], u[8][N], slope[N];
    int pivot[N];
    jacobian(p, m, t, x, J);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            W[i][j] = (i == j ? 1.0 / (GAMMA * h) : 0.0) - J[i][j];
    memcpy(s->x, x, sizeof s->x);
    s->t = t, s->h = h, s->stiff = 1, s->stiffness = 0.0;
    if (!factor(W, pivot)) {
        for (int i = 0; i < N; i++)
            s->error[i] = s->x_end[i] = NAN;
        return;
    }
    memcpy(s->x_end, x, sizeof s->x_end);
    memcpy(slope, rate, sizeof slope);
    for (int stage = 0; stage < 8; stage++) {
        if (stage) {
            for (int i = 0; i < N; i++) {
                double sum = 0.0;
                for (int k = 0; k < stage; k++)
                    sum += R_A[stage][k] * u[k][i];
                s->x_end[i] = x[i] + sum;
            }
            rates(p, m, t + R_C[stage] * h, s->x_end, slope);
        }
        for (int i = 0; i < N; i++) {
            double sum = 0.0;
            for (int k = 0; k < stage; k++)
                sum += R_G[stage][k] * u[k][i];
            u[stage][i] = slope[i] + sum / h + h * R_D[stage] * J[i][N];
        }
        substitute(W, pivot, u[stage]);
    }
    for (int i = 0; i < N; i++) {
        s->error[i] = u[7][i];
        s->x_end[i] += u[7][i];
        for (int row = 0; row < 3; row++) {
            double sum = 0.0;
            for (int k = 0; k < 8; k++)
                sum += R_IN[row][k] * u[k][i];
            s->inner[row][i] = sum;
        }
    }
}

static inline void inside(const Step *s, double theta, double *out)
{
    double back = 1.0 - theta;
    for (int i = 0; i < N; i++) {
        if (s->stiff)
            out[i] = back * s->x[i] + theta * (s->x_end[i] + back * (s->inner[0][i]
                     + theta * (s->inner[1][i] + theta * s->inner[2][i])));
        else
            out[i] = s->x[i] + theta * (s->x_end[i] - s->x[i] + back * (s->inner[0][i]
                     + theta * (s->inner[1][i] + back * s->inner[2][i])));
    }
}
