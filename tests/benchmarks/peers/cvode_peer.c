/* Peer CVODE (SUNDIALS): BDF, Newton, dense analytic Jacobian. Equations and states as in equations.py.
 *
 * cvode_peer SCENE_FILE TOLERANCE [MINIMUM_SECONDS]
 * prints the CPU seconds of one solve (mean of the repetitions that fit in MINIMUM_SECONDS, at least one), then
 * y = h/h0 at the sampled times, one a line. */
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <time.h>

enum { POINTS = 24, ORDERS = 64 };

typedef struct {
   int film; /* 0, 1: published iso, piezo; 2, 3: Reynolds iso, piezo */
   double a, c, q, b0, steady;
   int periods, sampled, points;
   /* More than one cosine on one rigid flank: orders, ratios and phases of those above the first; 0: one flank, rigid */
   int changed, orders;
   double ratio[ORDERS + 1], phase[ORDERS + 1], backlash, compliance, coast_start;
} scene_t;

typedef struct {
   double a, slope, s, c, k;
} rupture_t;

static double node[POINTS], weight[POINTS];

static void gauss_points(void)
{
   for (int i = 0; i < POINTS; i++) {
      double x = cos(M_PI * (i + 0.75) / (POINTS + 0.5)), slope = 1;
      for (int pass = 0; pass < 8; pass++) {
         double before = 1, now = x;
         for (int n = 2; n <= POINTS; n++) {
            double next = ((2 * n - 1) * x * now - (n - 1) * before) / n;
            before = now;
            now = next;
         }
         slope = POINTS * (x * now - before) / (x * x - 1);
         x -= now / slope;
      }
      node[i] = 0.5 * (1 + x);
      weight[i] = 1 / ((1 - x * x) * slope * slope);
   }
}

static rupture_t rupture(double d)
{
   rupture_t r;
   double s = sin(d), c = cos(d), sc = s * c, quarter = 0.5 * sc * (1 - 2 * s * s), s2 = s * s;
   double j = 0.125 * d - 0.25 * quarter;
   r.k = 0.375 * d - 0.5 * sc + 0.25 * quarter;
   r.a = (s2 * j - c * c * r.k) / (0.25 * s2 * s2 * s2 - sc * r.k);
   r.slope = s2 * (0.25 * s2 * s2 * s - c * r.k) / (r.k * (2 * c - r.a * s));
   r.s = s;
   r.c = c;
   return r;
}

/* Psi(A, B) and, if asked for, its slopes. */
static double piezo_load(double d, const rupture_t *r, double b, double *by_a, double *by_b)
{
   double t = -r->c / r->s, t_sum = t + r->a, peak = atan2(1.0, t_sum);
   double s2 = sin(2 * peak), c2 = cos(2 * peak), k = 0.375 * peak - 0.25 * s2 + 0.0625 * s2 * c2;
   double top = 0.125 * peak - 0.0625 * s2 * c2 - t * t * k - r->a * (0.0625 * (1 - c2) * (1 - c2) + t * k);
   double width = sqrt((1 - b * top) * 4 / (b * (t + t_sum) * (1 - c2)));
   double low = asinh(-peak / width), span = asinh((d - peak) / width) - low, factor = 0.5 * width * span;
   double pull = (t + t_sum) * r->slope / (r->s * r->s), a = r->a;
   double load = 0, sum_a = 0, sum_b = 0, phi[POINTS], both[POINTS];
   for (int i = 0; i < POINTS; i++) {
      double grow = exp(low + span * node[i]), shrink = 1 / grow;
      phi[i] = peak + 0.5 * width * (grow - shrink);
      both[i] = weight[i] * (grow + shrink);
   }
   for (int i = 0; i < POINTS; i++) {
      double sine = sin(2 * phi[i]), cosine = cos(2 * phi[i]), down = 1 - cosine, fourth = 0.0625 * down * down;
      double kk = 0.375 * phi[i] - 0.25 * sine + 0.0625 * sine * cosine;
      double p = 0.125 * phi[i] - 0.0625 * sine * cosine - t * t * kk - a * (fourth + t * kk);
      double part = both[i] / (1 - b * p);
      load += part * 0.25 * sine * (1 + cosine - a * sine - t * t_sum * down);
      sum_a -= part / (0.5 * down) * (fourth + (t + pull) * kk);
      sum_b += part / (0.5 * down) * p;
   }
   load *= factor;
   if (by_a) {
      *by_a = factor * sum_a;
      *by_b = (factor * sum_b - load) / b;
   }
   return load;
}

/* Load of a published film and its slopes in film and speed. */
static double film_load(const scene_t *p, double y, double v, double *by_y, double *by_v)
{
   double root = sqrt(y);
   if (p->film == 0) {
      *by_y = (1.5 * p->c * v / root - 1) / (y * y);
      *by_v = -p->c / (y * root);
      return (1 - p->c * v / root) / y;
   }
   double load = exp(-p->c * v) / (y * y * y * root);
   *by_y = -3.5 * load / y;
   *by_v = -p->c * load;
   return load;
}

/* Its speed under a load and the slopes in film and load. */
static double film_speed(const scene_t *p, double y, double w, double *by_y, double *by_w)
{
   double root = sqrt(y);
   if (p->film == 0) {
      *by_y = (0.5 / root - 1.5 * root * w) / p->c;
      *by_w = -y * root / p->c;
      return root * (1 - y * w) / p->c;
   }
   *by_y = -3.5 / (p->c * y);
   *by_w = -1 / (p->c * w);
   return -(log(w) + 3.5 * log(y)) / p->c;
}

/* The exact iso-viscous film between two rigid flanks: states y and both rupture angles (scenes.py). */
static int flanks_rates(const scene_t *p, double drive, const double *s, double *d)
{
   double y = s[0], gap = p->backlash - y;
   if (!(y > 0 && gap > 0 && s[1] > 0 && s[1] < M_PI && s[2] > 0 && s[2] < M_PI)) return 1;
   rupture_t one = rupture(s[1]), two = rupture(s[2]);
   double load = 0.25 * one.s * one.s - 0.125 * one.a * (s[1] - one.s * one.c);
   double coast = 0.25 * two.s * two.s - 0.125 * two.a * (s[2] - two.s * two.c);
   double v = one.a * sqrt(y) / p->c, change = p->a * (load / (p->steady * y) - coast / (p->steady * gap) - drive);
   d[0] = v;
   d[1] = one.slope * p->c / sqrt(y) * (change - 0.5 * v * v / y);
   d[2] = -two.slope * p->c / sqrt(gap) * (change + 0.5 * v * v / gap);
   return isfinite(d[1]) && isfinite(d[2]) ? 0 : 1;
}

/* Several orders, two flanks, elastic teeth: states y, v or y, z, v or y, z, coast film, v (scenes.py). */
static int changed_rates(realtype tau, N_Vector state, N_Vector slope, void *data)
{
   const scene_t *p = data;
   const double *s = NV_DATA_S(state);
   double *d = NV_DATA_S(slope), one, two, y = s[0], drive = 1 + p->q * cos(2 * M_PI * tau), net;
   for (int n = 2; n <= p->orders; n++) drive += p->ratio[n] * cos(2 * M_PI * n * tau + p->phase[n]);
   if (p->film == 2) return flanks_rates(p, drive, s, d);
   if (!(y > 0)) return 1;
   if (p->compliance > 0) {
      double w = (y - s[1]) / p->compliance, v = s[p->backlash > 0 ? 3 : 2];
      if (p->film == 1 && !(w > 0)) return 1;
      d[0] = film_speed(p, y, w, &one, &two);
      d[1] = v;
      net = w;
      if (p->backlash > 0) {
         double second = (s[2] - (p->backlash - s[1])) / p->compliance;
         if (!(s[2] > 0) || (p->film == 1 && !(second > 0))) return 1;
         d[2] = film_speed(p, s[2], second, &one, &two);
         net -= second;
      }
      d[p->backlash > 0 ? 3 : 2] = p->a * (net - drive);
      return 0;
   }
   d[0] = s[1];
   net = film_load(p, y, s[1], &one, &two);
   if (p->backlash > 0) {
      if (!(p->backlash - y > 0)) return 1;
      net -= film_load(p, p->backlash - y, -s[1], &one, &two);
   }
   d[1] = p->a * (net - drive);
   return isfinite(d[1]) ? 0 : 1;
}

static int changed_jacobian(realtype tau, N_Vector state, N_Vector slope, SUNMatrix matrix, void *data, N_Vector first,
                            N_Vector second, N_Vector third)
{
   (void)tau, (void)slope, (void)first, (void)second, (void)third;
   const scene_t *p = data;
   const double *s = NV_DATA_S(state);
   double e = p->compliance, b = p->backlash, y = s[0], by_y, by_x;
   SUNMatZero(matrix);
   if (e > 0) {
      int v = b > 0 ? 3 : 2;
      film_speed(p, y, (y - s[1]) / e, &by_y, &by_x);
      SM_ELEMENT_D(matrix, 0, 0) = by_y + by_x / e;
      SM_ELEMENT_D(matrix, 0, 1) = -by_x / e;
      SM_ELEMENT_D(matrix, 1, v) = 1;
      SM_ELEMENT_D(matrix, v, 0) = p->a / e;
      SM_ELEMENT_D(matrix, v, 1) = -p->a / e;
      if (b > 0) {
         film_speed(p, s[2], (s[2] - (b - s[1])) / e, &by_y, &by_x);
         SM_ELEMENT_D(matrix, 2, 2) = by_y + by_x / e;
         SM_ELEMENT_D(matrix, 2, 1) = by_x / e;
         SM_ELEMENT_D(matrix, v, 2) = -p->a / e;
         SM_ELEMENT_D(matrix, v, 1) = -2 * p->a / e;
      }
      return 0;
   }
   film_load(p, y, s[1], &by_y, &by_x);
   SM_ELEMENT_D(matrix, 0, 1) = 1;
   SM_ELEMENT_D(matrix, 1, 0) = p->a * by_y;
   SM_ELEMENT_D(matrix, 1, 1) = p->a * by_x;
   if (b > 0) {
      film_load(p, b - y, -s[1], &by_y, &by_x);
      SM_ELEMENT_D(matrix, 1, 0) += p->a * by_y;
      SM_ELEMENT_D(matrix, 1, 1) += p->a * by_x;
   }
   return 0;
}

static int rates(realtype tau, N_Vector state, N_Vector slope, void *data)
{
   const scene_t *p = data;
   double y = NV_Ith_S(state, 0), v = NV_Ith_S(state, 1), load;
   if (!(y > 0)) return 1;
   double root = sqrt(y), drive = 1 + p->q * cos(2 * M_PI * tau);
   if (p->film < 2) {
      load = p->film == 0 ? (1 - p->c * v / root) / y : exp(-p->c * v) / (y * y * y * root);
      NV_Ith_S(slope, 0) = v;
      NV_Ith_S(slope, 1) = p->a * (load - drive);
      return 0;
   }
   if (!(v > 0 && v < M_PI)) return 1;
   rupture_t r = rupture(v);
   load = p->film == 2 ? 0.25 * r.s * r.s - 0.125 * r.a * (v - r.s * r.c)
                       : piezo_load(v, &r, p->b0 / (y * root), NULL, NULL);
   double squeeze = r.a / p->c;
   NV_Ith_S(slope, 0) = squeeze * root;
   NV_Ith_S(slope, 1) = r.slope * p->c / root * (p->a * (load / (p->steady * y) - drive) - 0.5 * squeeze * squeeze);
   return isfinite(NV_Ith_S(slope, 1)) ? 0 : 1;
}

static int jacobian(realtype tau, N_Vector state, N_Vector slope, SUNMatrix matrix, void *data, N_Vector one,
                    N_Vector two, N_Vector three)
{
   (void)slope, (void)one, (void)two, (void)three;
   const scene_t *p = data;
   double y = NV_Ith_S(state, 0), v = NV_Ith_S(state, 1), root = sqrt(y), load;
   double j00 = 0, j01 = 1, j10, j11;
   if (p->film == 0) {
      j10 = p->a * (1.5 * p->c * v / root - 1) / (y * y);
      j11 = -p->a * p->c / (y * root);
   } else if (p->film == 1) {
      load = p->a * exp(-p->c * v) / (y * y * y * root);
      j10 = -3.5 * load / y;
      j11 = -p->c * load;
   } else {
      rupture_t r = rupture(v);
      double s = r.s, c = r.c, s2 = s * s, by_a, by_b, by_y = 0;
      if (p->film == 2) {
         double moment = 0.25 * s2 * s2;
         load = 0.25 * s2 - 0.125 * r.a * (v - s * c);
         by_a = -0.125 * (v - s * c) + moment * (moment - c / s * r.k) / r.k;
      } else {
         double b = p->b0 / (y * root);
         load = piezo_load(v, &r, b, &by_a, &by_b);
         by_y = -1.5 * b / y * by_b;
      }
      double inner = 0.25 * s2 * s2 * s - c * r.k, bottom = r.k * (2 * c - r.a * s);
      double top_by_d = 2 * s * c * inner + s2 * (0.25 * s2 * s2 * c + s * r.k);
      double bottom_by_d = s2 * s2 * (2 * c - r.a * s) - r.k * (2 * s + s / r.slope + r.a * c);
      double slope_by_d = (top_by_d - r.slope * bottom_by_d) / bottom, gain = r.slope * p->c / root;
      double squeeze = r.a / p->c, drive = 1 + p->q * cos(2 * M_PI * tau);
      double force = p->a * (load / (p->steady * y) - drive) - 0.5 * squeeze * squeeze;
      j00 = 0.5 * squeeze / root;
      j01 = root / (p->c * r.slope);
      j10 = gain * (p->a * (by_y - load / y) / (p->steady * y) - 0.5 * force / y);
      j11 = slope_by_d * gain / r.slope * force + gain / r.slope * (p->a * by_a / (p->steady * y) - squeeze / p->c);
   }
   SM_ELEMENT_D(matrix, 0, 0) = j00;
   SM_ELEMENT_D(matrix, 0, 1) = j01;
   SM_ELEMENT_D(matrix, 1, 0) = j10;
   SM_ELEMENT_D(matrix, 1, 1) = j11;
   return 0;
}

static int solve(scene_t *scene, double tolerance, double *film)
{
   SUNContext context;
   if (SUNContext_Create(NULL, &context)) return 1;
   int exact_flanks = scene->changed && scene->film == 2;
   int size = scene->compliance > 0 ? (scene->backlash > 0 ? 4 : 3) : 2 + exact_flanks;
   N_Vector state = N_VNew_Serial(size, context);
   N_VConst(0, state);
   NV_Ith_S(state, 0) = 1;
   if (scene->film > 1) NV_Ith_S(state, 1) = 0.5 * M_PI + atan(0.4751299200930563);
   if (exact_flanks) {
      double b = scene->backlash;
      NV_Ith_S(state, 0) = 2 * b / (b + 2 + hypot(b, 2));
      NV_Ith_S(state, 2) = NV_Ith_S(state, 1);
   }
   if (scene->compliance > 0) NV_Ith_S(state, 1) = 1 - scene->compliance;
   if (size > 3) NV_Ith_S(state, 2) = scene->coast_start;
   SUNMatrix matrix = SUNDenseMatrix(size, size, context);
   SUNLinearSolver solver = SUNLinSol_Dense(state, matrix, context);
   void *memory = CVodeCreate(CV_BDF, context);
   int flag = CVodeInit(memory, scene->changed ? changed_rates : rates, 0, state) || CVodeSStolerances(memory, tolerance, tolerance) ||
              CVodeSetUserData(memory, scene) || CVodeSetLinearSolver(memory, solver, matrix) ||
              
              /* Between two exact flanks by differences */
              CVodeSetJacFn(memory, exact_flanks ? NULL : scene->changed ? changed_jacobian : jacobian) ||
              CVodeSetMaxNumSteps(memory, 2000000) || CVodeSetErrFile(memory, NULL);
   int first = (scene->periods - scene->sampled) * scene->points;
   for (int i = 0; !flag && i < scene->sampled * scene->points; i++) {
      realtype reached;
      flag = CVode(memory, (double)(first + i + 1) / scene->points, state, &reached, CV_NORMAL) < 0;
      film[i] = NV_Ith_S(state, 0);
   }
   CVodeFree(&memory);
   SUNLinSolFree(solver);
   SUNMatDestroy(matrix);
   N_VDestroy(state);
   SUNContext_Free(&context);
   return flag;
}

static int read_scene(const char *name, scene_t *scene)
{
   FILE *file = fopen(name, "r");
   if (!file) return 1;
   char key[64], value[64];
   int reynolds = 0, piezo = 0;
   while (fscanf(file, "%63s %63s", key, value) == 2) {
      double number = strtod(value, NULL);
      if (!strcmp(key, "model")) reynolds = !strcmp(value, "reynolds");
      if (!strcmp(key, "law")) piezo = !strcmp(value, "piezo_viscous");
      if (!strcmp(key, "acceleration_scale")) scene->a = number;
      if (!strcmp(key, "squeeze_scale")) scene->c = number;
      if (!strcmp(key, "force_ratio")) scene->q = number;
      if (!strcmp(key, "pressure_scale")) scene->b0 = number;
      if (!strcmp(key, "steady_load")) scene->steady = number;
      if (!strcmp(key, "backlash")) scene->changed = 1, scene->backlash = number;
      if (!strcmp(key, "compliance")) scene->compliance = number;
      if (!strcmp(key, "coast_start")) scene->coast_start = number;
      int order;
      if (sscanf(key, "ratio_%d", &order) == 1 && order > 1 && order <= ORDERS) {
         scene->ratio[order] = number;
         if (order > scene->orders) scene->orders = order;
      }
      if (sscanf(key, "phase_%d", &order) == 1 && order > 1 && order <= ORDERS) scene->phase[order] = number;
      if (!strcmp(key, "periods")) scene->periods = (int)number;
      if (!strcmp(key, "sampled_periods")) scene->sampled = (int)number;
      if (!strcmp(key, "points_a_period")) scene->points = (int)number;
   }
   fclose(file);
   scene->film = 2 * reynolds + piezo;
   return 0;
}

static double cpu_seconds(void)
{
   struct timespec now;
   clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
   return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(int count, char **word)
{
   if (count == 2 && !strcmp(word[1], "--version")) {
      printf("%s\n", SUNDIALS_VERSION);
      return 0;
   }
   scene_t scene = {0};
   if (count < 3 || read_scene(word[1], &scene)) return 2;
   double tolerance = strtod(word[2], NULL), least = count > 3 ? strtod(word[3], NULL) : 0, spent = 0;
   int samples = scene.sampled * scene.points, runs = 0;
   double *film = malloc(sizeof *film * (size_t)samples), begin = cpu_seconds();
   gauss_points();
   do {
      if (solve(&scene, tolerance, film)) {
         fprintf(stderr, "CVODE failed\n");
         return 1;
      }
      runs++;
      spent = cpu_seconds() - begin;
   } while (spent < least);
   printf("%.9e\n", spent / runs);
   for (int i = 0; i < samples; i++) printf("%.17g\n", film[i]);
   free(film);
   return 0;
}
