/* Solves a scene with SUNDIALS through its C interface: Debian's serial vector, sparse matrix and KLU. Residual and Jacobian
 * are slcbeam's own, from libpeers (benches/peers/src/abi.rs).
 *
 * Reads lines `SCENE METHOD RTOL` with METHOD ida2 or ida5 (highest order), and answers `seconds steps tip.. pressure..`. */
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_math.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <time.h>

typedef struct Scene Scene;
Scene *scene_open(const char *name);
void scene_close(Scene *);
int scene_unknowns(const Scene *);
int scene_entries(const Scene *);
void scene_pattern(const Scene *, int64_t *starts, int64_t *rows);
void scene_start(const Scene *, double *y, double *yp);
int scene_outputs(const Scene *);
double scene_output(const Scene *, int k);
void scene_read(const Scene *, const double *y, double out[2]);
int scene_residual(Scene *, double t, const double *y, const double *yp, double *r);
int scene_jacobian(Scene *, double t, double cj, const double *y, const double *yp, double *values);

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

static void check(int failed, const char *what) {
  if (failed) {
    fprintf(stderr, "%s failed\n", what);
    exit(1);
  }
}

static int residual(realtype t, N_Vector y, N_Vector yp, N_Vector r, void *scene) {
  return scene_residual(scene, t, N_VGetArrayPointer(y), N_VGetArrayPointer(yp), N_VGetArrayPointer(r));
}

static int jacobian(realtype t, realtype cj, N_Vector y, N_Vector yp, N_Vector r, SUNMatrix J, void *scene, N_Vector a,
                    N_Vector b, N_Vector c) {
  (void)r, (void)a, (void)b, (void)c;
  /* the matrix was zeroed with its pattern */
  scene_pattern(scene, SUNSparseMatrix_IndexPointers(J), SUNSparseMatrix_IndexValues(J));
  return scene_jacobian(scene, t, cj, N_VGetArrayPointer(y), N_VGetArrayPointer(yp), SUNSparseMatrix_Data(J));
}

static void run(Scene *scene, int order, double rtol) {
  int n = scene_unknowns(scene), outputs = scene_outputs(scene);
  double *read = malloc(2 * outputs * sizeof *read);
  double begin = now();
  SUNContext context;
  check(SUNContext_Create(NULL, &context), "SUNContext_Create");
  N_Vector y = N_VNew_Serial(n, context), yp = N_VNew_Serial(n, context);
  scene_start(scene, N_VGetArrayPointer(y), N_VGetArrayPointer(yp));
  SUNMatrix J = SUNSparseMatrix(n, n, scene_entries(scene), CSC_MAT, context);
  SUNLinearSolver solver = SUNLinSol_KLU(y, J, context);
  check(!J || !solver, "SUNLinSol_KLU");
  void *ida = IDACreate(context);
  check(!ida, "IDACreate");
  check(IDAInit(ida, residual, 0, y, yp), "IDAInit");
  check(IDASStolerances(ida, rtol, rtol), "IDASStolerances");
  check(IDASetUserData(ida, scene), "IDASetUserData");
  check(IDASetLinearSolver(ida, solver, J), "IDASetLinearSolver");
  check(IDASetJacFn(ida, jacobian), "IDASetJacFn");
  check(IDASetMaxOrd(ida, order), "IDASetMaxOrd");
  check(IDASetMaxNumSteps(ida, 10000000), "IDASetMaxNumSteps");
  check(IDASetStopTime(ida, scene_output(scene, outputs - 1)), "IDASetStopTime");
  int status = 0;
  for (int k = 0; k < outputs && status >= 0; k++) {
    realtype t;
    status = IDASolve(ida, scene_output(scene, k), &t, y, yp, IDA_NORMAL);
    scene_read(scene, N_VGetArrayPointer(y), read + 2 * k);
  }
  long steps = 0;
  IDAGetNumSteps(ida, &steps);
  double seconds = now() - begin;
  if (status < 0) {
    printf("failed IDASolve %d\n", status);
  } else {
    printf("%.6e %ld", seconds, steps);
    for (int what = 0; what < 2; what++)
      for (int k = 0; k < outputs; k++) printf(" %.17g", read[2 * k + what]);
    printf("\n");
  }
  fflush(stdout);
  IDAFree(&ida);
  SUNLinSolFree(solver);
  SUNMatDestroy(J);
  N_VDestroy(y);
  N_VDestroy(yp);
  SUNContext_Free(&context);
  free(read);
}

int main(void) {
  char line[512], name[128], method[64], open[128] = "";
  double rtol;
  Scene *scene = NULL;
  while (fgets(line, sizeof line, stdin)) {
    if (sscanf(line, "%127s %63s %lf", name, method, &rtol) != 3) continue;
    if (strcmp(open, name)) {
      if (scene) scene_close(scene);
      scene = scene_open(name);
      strcpy(open, name);
    }
    if (!strcmp(method, "ida2") || !strcmp(method, "ida5")) {
      run(scene, method[3] - '0', rtol);
    } else {
      printf("failed no method %s\n", method);
      fflush(stdout);
    }
  }
  if (scene) scene_close(scene);
  return 0;
}
