/* Paper B, triple pendulum under a square-wave torque: the equations of systems/triple.py. */
#define N 6 /* psi1..3, rates 1..3 */
#define MODES 1
#define MARGINS 1
#define KEYS 2
enum { B1, B2, B3, N12, N13, N23, M1, M2, M3, C1, C2, C3, TORQUE, FREQUENCY };

static int key(const int *m) { return m[0] & 1; }

/* m[0] counts half periods: the torque is -q in the first, +q in the second. */
static inline double torque(const double *p, const int *m)
{
    return m[0] & 1 ? p[TORQUE] : -p[TORQUE];
}

static inline void rates(const double *p, const int *m, double t, const double *x, double *dx)
{
    const double *w = x + 3;
    double c12 = cos(x[0] - x[1]), c13 = cos(x[0] - x[2]), c23 = cos(x[1] - x[2]);
    double s12 = sin(x[0] - x[1]), s13 = sin(x[0] - x[2]), s23 = sin(x[1] - x[2]);
    double a = p[B1], b = p[N12] * c12, c = p[N13] * c13, d = p[B2], e = p[N23] * c23, f = p[B3];
    double q1 = w[0] * w[0], q2 = w[1] * w[1], q3 = w[2] * w[2];
    double r1 = torque(p, m) - p[N12] * s12 * q2 - p[N13] * s13 * q3
                - (p[C1] + p[C2]) * w[0] + p[C2] * w[1] - p[M1] * sin(x[0]);
    double r2 = p[N12] * s12 * q1 - p[N23] * s23 * q3
                + p[C2] * w[0] - (p[C2] + p[C3]) * w[1] + p[C3] * w[2] - p[M2] * sin(x[1]);
    double r3 = p[N13] * s13 * q1 + p[N23] * s23 * q2
                + p[C3] * w[1] - p[C3] * w[2] - p[M3] * sin(x[2]);
    double A = d * f - e * e, B = c * e - b * f, C = b * e - c * d;
    double D = a * f - c * c, E = b * c - a * e, F = a * d - b * b;
    double determinant = a * A + b * B + c * C;
    dx[0] = w[0];
    dx[1] = w[1];
    dx[2] = w[2];
    dx[3] = (A * r1 + B * r2 + C * r3) / determinant;
    dx[4] = (B * r1 + D * r2 + E * r3) / determinant;
    dx[5] = (C * r1 + E * r2 + F * r3) / determinant;
}

/* Central differences: this system is not stiff, and the method that asks is not taken. */
static void jacobian(const double *p, const int *m, double t, const double *x, double J[N][N + 1])
{
    double at[N], low[N], high[N];
    for (int j = 0; j < N; j++) {
        double step = 1e-6 * (1.0 + fabs(x[j]));
        memcpy(at, x, sizeof at);
        at[j] = x[j] + step;
        rates(p, m, t, at, high);
        at[j] = x[j] - step;
        rates(p, m, t, at, low);
        for (int i = 0; i < N; i++)
            J[i][j] = (high[i] - low[i]) / (2.0 * step);
    }
    for (int i = 0; i < N; i++)
        J[i][N] = 0.0;
}

static int margins(const double *p, const int *m, double t, const double *x, double *g, int *about,
                   int *after)
{
    return 0;
}

static double margin_rate(const double *p, const int *m, double t, const double *x, int mode,
                          int to)
{
    return 0.0;
}

static void happen(const double *p, int *m, double t, double *x, int mode, int to) { }

static void begin(const double *p, int *m, double *x)
{
    m[0] = 0;
    memset(x, 0, sizeof(double) * N);
}

static double due(const double *p, const int *m, double t)
{
    return (m[0] + 1) / (2.0 * p[FREQUENCY]);
}

static void tick(const double *p, int *m, double t) { m[0]++; }
