/* The same system with SUNDIALS' CVODE: roots end a segment, and it starts anew behind them.
 *
 *     cc -O2 -shared -fPIC -DCASE='"torsion.h"' cvode.c -lsundials_cvode ... -lm
 */
#include <math.h>
#include <string.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include CASE

typedef struct {
    const double *p;
    int m[MODES];
} Data;

static int field(double t, N_Vector x, N_Vector dx, void *data)
{
    Data *d = data;
    rates(d->p, d->m, t, N_VGetArrayPointer(x), N_VGetArrayPointer(dx));
    return 0;
}

static int slopes(double t, N_Vector x, N_Vector dx, SUNMatrix out, void *data, N_Vector a,
                  N_Vector b, N_Vector c)
{
    Data *d = data;
    double J[N][N + 1];
    jacobian(d->p, d->m, t, N_VGetArrayPointer(x), J);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++)
            SM_ELEMENT_D(out, i, j) = J[i][j];
    return 0;
}

static int roots(double t, N_Vector x, double *g, void *data)
{
    Data *d = data;
    int about[MARGINS], after[MARGINS];
    margins(d->p, d->m, t, N_VGetArrayPointer(x), g, about, after);
    return 0;
}

/* From the case's own start to the last of `times`; out[samples][N]. 0 is success. */
int run(const double *p, double rtol, double atol, const double *times, int samples, double *out,
        long *counts, int adams)
{
    SUNContext context;
    Data d = {.p = p};
    double t = times[0], end = times[samples - 1];
    int filled = 0, about[MARGINS], after[MARGINS], hit[MARGINS], falling[MARGINS], status = 0;
    double g[MARGINS];
    for (int i = 0; i < MARGINS; i++)
        falling[i] = -1;
    if (SUNContext_Create(0, &context))
        return 1;
    N_Vector x = N_VNew_Serial(N, context);
    SUNMatrix matrix = SUNDenseMatrix(N, N, context);
    SUNLinearSolver linear = SUNLinSol_Dense(x, matrix, context);
    double *state = N_VGetArrayPointer(x);
    begin(p, d.m, state);
    void *cvode = CVodeCreate(adams ? CV_ADAMS : CV_BDF, context);
    CVodeInit(cvode, field, t, x);
    CVodeSStolerances(cvode, rtol, atol);
    CVodeSetUserData(cvode, &d);
    CVodeSetMaxNumSteps(cvode, 1000000);
    CVodeSetLinearSolver(cvode, linear, matrix);
    CVodeSetJacFn(cvode, slopes);
    while (t < end && !status) {
        double soon = fmin(due(p, d.m, t), end);
        int count = margins(p, d.m, t, state, g, about, after), which = -1;
        if (count) {
            CVodeRootInit(cvode, count, roots);
            CVodeSetRootDirection(cvode, falling);
            CVodeSetNoInactiveRootWarn(cvode);
        }
        CVodeSetStopTime(cvode, soon);
        while (t < soon && which < 0 && !status) {
            int sampling = filled < samples && times[filled] < soon;
            double to = sampling ? times[filled] : soon;
            int how = to > t ? CVode(cvode, to, x, &t, CV_NORMAL) : CV_SUCCESS;
            if (how < 0)
                status = -how;
            else if (how == CV_ROOT_RETURN) {
                CVodeGetRootInfo(cvode, hit);
                for (int i = 0; i < count && which < 0; i++)
                    which = hit[i] ? i : -1;
            } else if (sampling)
                memcpy(out + N * filled++, state, sizeof(double) * N);
        }
        if (which >= 0)
            happen(p, d.m, t, state, about[which], after[which]);
        else if (t < end)
            tick(p, d.m, t);
        counts[2]++;
        CVodeReInit(cvode, t, x);
    }
    for (; filled < samples; filled++)
        memcpy(out + N * filled, state, sizeof(double) * N);
    CVodeFree(&cvode);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(x);
    SUNContext_Free(&context);
    return status;
}
