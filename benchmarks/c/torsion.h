/* Paper A, final model: the equations of systems/torsion.py, written by hand. */
#define N 4       /* phi1, v1, phi2, v2 */
#define MODES 5
#define MARGINS 8 /* at most */
#define KEYS 256
enum { COLUMN, DISK, SPRING, V1, V2 }; /* +1, -1; 0: no contact, or v1 held by dry friction */
enum { B1, B2, DRIVE, OMEGA, PHASE, KAPPA1_L, KAPPA1_R, KAPPA2_L, KAPPA2_R, T_V1_L, T_V1_R, T_B,
       T_S2_L, T_S2_R, T_02_L, T_02_R, ALPHA, BETA, K1, C1, K2, C2_L, C2_R, PHI1_S, PHI2_S };

static int key(const int *m)
{
    return ((((m[COLUMN] + 1) * 3 + m[DISK] + 1) * 3 + m[V1] + 1) * 2 + (m[SPRING] > 0)) * 2
           + (m[V2] > 0);
}

/* The torque on the column without its own friction, and on the disk. */
static inline void torques(const double *p, const int *m, double t, const double *x, double *on)
{
    int l = m[SPRING] > 0, plus = m[V2] > 0;
    double slack = p[DRIVE] * sin(p[OMEGA] * t + p[PHASE]) - x[0];
    double spring = slack * ((l ? p[KAPPA1_L] : p[KAPPA1_R])
                             + (l ? p[KAPPA2_L] : p[KAPPA2_R]) * slack * slack);
    double pin = m[COLUMN] ? p[K1] * (x[0] - m[COLUMN] * p[PHI1_S]) + p[C1] * x[1] : 0.0;
    double soft = m[DISK] ? p[K2] * (x[2] - m[DISK] * p[PHI2_S])
                            + (m[DISK] > 0 ? p[C2_L] : p[C2_R]) * x[3] : 0.0;
    double z = p[ALPHA] * x[3];
    double friction = (plus ? p[T_S2_L] : p[T_S2_R])
                      / (1.0 + (plus ? p[T_02_L] : p[T_02_R]) * m[V2] * x[3])
                      * (1.0 + p[BETA] / cosh(z)) * tanh(z);
    on[0] = spring - pin + soft + friction;
    on[1] = -soft - friction;
}

static inline void rates(const double *p, const int *m, double t, const double *x, double *dx)
{
    double on[2], a = 0.0;
    torques(p, m, t, x, on);
    if (m[V1])
        a = (on[0] - (m[V1] > 0 ? p[T_V1_L] : p[T_V1_R]) * x[1] - m[V1] * p[T_B]) / p[B1];
    dx[0] = x[1];
    dx[1] = a;
    dx[2] = x[3];
    dx[3] = on[1] / p[B2] - a;
}

/* The derivatives of both torques: by phi1, v1, phi2, v2, t. */
static void torque_slopes(const double *p, const int *m, double t, const double *x, double d[2][5])
{
    int l = m[SPRING] > 0, plus = m[V2] > 0;
    double angle = p[OMEGA] * t + p[PHASE], slack = p[DRIVE] * sin(angle) - x[0];
    double stiff = (l ? p[KAPPA1_L] : p[KAPPA1_R])
                   + 3.0 * (l ? p[KAPPA2_L] : p[KAPPA2_R]) * slack * slack;
    double z = p[ALPHA] * x[3], sech = 1.0 / cosh(z), th = tanh(z);
    double level = plus ? p[T_S2_L] : p[T_S2_R], decay = (plus ? p[T_02_L] : p[T_02_R]) * m[V2];
    double below = 1.0 + decay * x[3], bump = 1.0 + p[BETA] * sech;
    double slope = level / below * (-decay / below * bump * th
                   + p[ALPHA] * (-p[BETA] * sech * th * th + bump * sech * sech));
    double k2 = m[DISK] ? p[K2] : 0.0;
    double c2 = m[DISK] ? (m[DISK] > 0 ? p[C2_L] : p[C2_R]) : 0.0;
    d[0][0] = -stiff - (m[COLUMN] ? p[K1] : 0.0);
    d[0][1] = m[COLUMN] ? -p[C1] : 0.0;
    d[0][2] = k2;
    d[0][3] = c2 + slope;
    d[0][4] = stiff * p[DRIVE] * p[OMEGA] * cos(angle);
    d[1][0] = d[1][1] = d[1][4] = 0.0;
    d[1][2] = -k2;
    d[1][3] = -c2 - slope;
}

/* d rate/d x, and d rate/d t in the last column. */
static void jacobian(const double *p, const int *m, double t, const double *x, double J[N][N + 1])
{
    double d[2][5];
    torque_slopes(p, m, t, x, d);
    memset(J, 0, sizeof(double) * N * (N + 1));
    J[0][1] = J[2][3] = 1.0;
    for (int j = 0; j < 5; j++) {
        if (m[V1])
            J[1][j] = (d[0][j] - (j == 1 ? (m[V1] > 0 ? p[T_V1_L] : p[T_V1_R]) : 0.0)) / p[B1];
        J[3][j] = d[1][j] / p[B2] - J[1][j];
    }
}

/* What is positive while the modes hold; `about` names the mode, `after` its next value. */
static int margins(const double *p, const int *m, double t, const double *x, double *g, int *about,
                   int *after)
{
    int n = 0;
#define WATCH(mode, to, value) (about[n] = (mode), after[n] = (to), g[n++] = (value))
    if (m[COLUMN])
        WATCH(COLUMN, 0, m[COLUMN] * x[0] - p[PHI1_S]);
    else {
        WATCH(COLUMN, 1, p[PHI1_S] - x[0]);
        WATCH(COLUMN, -1, p[PHI1_S] + x[0]);
        WATCH(SPRING, -m[SPRING], m[SPRING] * x[0]);
    }
    if (m[DISK])
        WATCH(DISK, 0, m[DISK] * x[2] - p[PHI2_S]);
    else {
        WATCH(DISK, 1, p[PHI2_S] - x[2]);
        WATCH(DISK, -1, p[PHI2_S] + x[2]);
    }
    WATCH(V2, -m[V2], m[V2] * x[3]);
    if (m[V1])
        WATCH(V1, -m[V1], m[V1] * x[1]);
    else {
        double on[2];
        torques(p, m, t, x, on);
        WATCH(V1, 1, p[T_B] - on[0]);
        WATCH(V1, -1, p[T_B] + on[0]);
    }
#undef WATCH
    return n;
}

/* d margin/d t along the field. */
static double margin_rate(const double *p, const int *m, double t, const double *x, int mode,
                          int to)
{
    double dx[N], d[2][5];
    rates(p, m, t, x, dx);
    switch (mode) {
    case COLUMN: return (m[COLUMN] ? m[COLUMN] : -to) * dx[0];
    case SPRING: return m[SPRING] * dx[0];
    case DISK: return (m[DISK] ? m[DISK] : -to) * dx[2];
    case V2: return m[V2] * dx[3];
    }
    if (m[V1])
        return m[V1] * dx[1];
    torque_slopes(p, m, t, x, d);
    double turn = d[0][4];
    for (int j = 0; j < N; j++)
        turn += d[0][j] * dx[j];
    return -to * turn;
}

static int slip_sign(const double *p, const int *m, double t, const double *x)
{
    double on[2];
    torques(p, m, t, x, on);
    return fabs(on[0]) <= p[T_B] ? 0 : on[0] > 0.0 ? 1 : -1;
}

/* A margin has reached zero: the modes after it. The state is put exactly on the surface. */
static void happen(const double *p, int *m, double t, double *x, int mode, int to)
{
    double dx[N];
    int side = mode == COLUMN || mode == DISK ? (to ? to : m[mode]) : 0;
    switch (mode) {
    case COLUMN: x[0] = side * p[PHI1_S]; break;
    case DISK: x[2] = side * p[PHI2_S]; break;
    case SPRING: x[0] = 0.0; break;
    case V2:
        x[3] = 0.0;
        rates(p, m, t, x, dx);
        to = dx[3] > 0.0 ? 1 : dx[3] < 0.0 ? -1 : to;
        break;
    case V1:
        if (m[V1]) {
            x[1] = 0.0;
            to = slip_sign(p, m, t, x);
        }
    }
    m[mode] = to;
}

static void begin(const double *p, int *m, double *x)
{
    x[0] = -p[PHI1_S]; /* on the barrier, at rest: it leaves to the right */
    x[1] = x[2] = x[3] = 0.0;
    m[COLUMN] = m[DISK] = 0;
    m[SPRING] = -1;
    m[V1] = 1;
    m[V2] = -1;
}

static double due(const double *p, const int *m, double t) { return INFINITY; }

static void tick(const double *p, int *m, double t) { }
