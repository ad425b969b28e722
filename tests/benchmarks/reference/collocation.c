/* Reference motion of one scaled scene in long double, second way: states (y, v) for the published films and (y, d)
 * for the Reynolds films (../peers/equations.py); Gauss collocation of order 16 with fixed steps, the stages by
 * fixed-point iteration; Psi integrated by parts with plain Gauss points.
 *
 * collocation FILM a c q B0 STEADY_LOAD PERIODS SAMPLED POINTS STEPS_A_POINT
 * prints y at the sampled times. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef long double real;
enum { STAGES = 8, POINTS = 120 };
static const real PI = 3.14159265358979323846264338327950288L, STEADY_TANGENT = 0.475129920093056312L;

static int film;
static real a_scale, c_scale, ratio, b_scale, steady;
static real node[POINTS], weight[POINTS], stage[STAGES], matrix[STAGES][STAGES], quadrature[STAGES];
static real extend[STAGES][STAGES]; /* stage slopes of a step from those of the step before */

static void gauss_points(int count, real *x_of, real *w_of)
{
   for (int i = 0; i < count; i++) {
      real x = -cosl(PI * (i + 0.75L) / (count + 0.5L)), slope = 1;
      for (int pass = 0; pass < 8; pass++) {
         real before = 1, now = x;
         for (int n = 2; n <= count; n++) {
            real next = ((2 * n - 1) * x * now - (n - 1) * before) / n;
            before = now;
            now = next;
         }
         slope = count * (x * now - before) / (x * x - 1);
         x -= now / slope;
      }
      x_of[i] = (1 + x) / 2;
      w_of[i] = 1 / ((1 - x * x) * slope * slope);
   }
}

static real lagrange(int j, real x)
{
   real product = 1;
   for (int m = 0; m < STAGES; m++)
      if (m != j) product *= (x - stage[m]) / (stage[j] - stage[m]);
   return product;
}

static void collocation_tables(void)
{
   gauss_points(STAGES, stage, quadrature);
   for (int i = 0; i < STAGES; i++)
      for (int j = 0; j < STAGES; j++) {
         matrix[i][j] = 0;
         for (int m = 0; m < STAGES; m++)
            matrix[i][j] += stage[i] * quadrature[m] * lagrange(j, stage[i] * stage[m]);
         extend[i][j] = lagrange(j, 1 + stage[i]);
      }
}

static real piezo_load(real d, real a, real t, real b)
{
   real sum = 0;
   for (int i = 0; i < POINTS; i++) {
      real phi = d * node[i], s = sinl(phi), c = cosl(phi), sc = s * c, s4 = 4 * sc * (c * c - s * s);
      real k = 3 * phi / 8 - sc / 2 + s4 / 32;
      real p = phi / 8 - s4 / 32 - t * t * k - a * (s * s * s * s / 4 + t * k);
      sum += weight[i] * sc * (c + t * s) * (c - (t + a) * s) / (1 - b * p);
   }
   return d * sum;
}

static void rates(real tau, const real u[2], real du[2])
{
   real y = u[0], root = sqrtl(y), drive = 1 + ratio * cosl(2 * PI * (tau - floorl(tau)));
   if (film < 2) {
      real load = film == 0 ? (1 - c_scale * u[1] / root) / y : expl(-c_scale * u[1]) / (y * y * y * root);
      du[0] = u[1];
      du[1] = a_scale * (load - drive);
      return;
   }
   real d = u[1], s = sinl(d), c = cosl(d), sc = s * c, s4 = 4 * sc * (c * c - s * s);
   real j = d / 8 - s4 / 32, k = 3 * d / 8 - sc / 2 + s4 / 32, t = -c / s, moment = s * s * s * s / 4 + t * k;
   real a = (j - t * t * k) / moment, turn = -s * s * moment / (k * (2 * t + a));
   real load = film == 2 ? s * s / 4 - a / 8 * (d - sc) : piezo_load(d, a, t, b_scale / (y * root));
   real v = a * root / c_scale, force = a_scale * (load / (steady * y) - drive);
   du[0] = v;
   du[1] = turn * c_scale * (force / root - v * v / (2 * y * root));
}

int main(int count, char **word)
{
   if (count != 11) return 2;
   film = atoi(word[1]);
   a_scale = strtod(word[2], NULL), c_scale = strtod(word[3], NULL), ratio = strtod(word[4], NULL);
   b_scale = strtod(word[5], NULL), steady = strtod(word[6], NULL);
   long periods = atol(word[7]), sampled = atol(word[8]), points = atol(word[9]), steps = atol(word[10]);
   gauss_points(POINTS, node, weight);
   collocation_tables();
   real u[2] = {1, film < 2 ? 0 : PI / 2 + atanl(STEADY_TANGENT)}, slope[STAGES][2], h = 1.0L / (points * steps);
   for (int i = 0; i < STAGES; i++) rates(0, u, slope[i]);
   for (long n = 0; n < periods * points * steps; n++) {
      if (n > 0) {
         real next[STAGES][2];
         for (int i = 0; i < STAGES; i++)
            for (int k = 0; k < 2; k++) {
               next[i][k] = 0;
               for (int j = 0; j < STAGES; j++) next[i][k] += extend[i][j] * slope[j][k];
            }
         for (int i = 0; i < STAGES; i++) slope[i][0] = next[i][0], slope[i][1] = next[i][1];
      }
      real change = 1, before;
      int pass = 0;
      do {
         before = change;
         change = 0;
         for (int i = 0; i < STAGES; i++) {
            real at[2] = {u[0], u[1]}, du[2];
            for (int j = 0; j < STAGES; j++)
               for (int k = 0; k < 2; k++) at[k] += h * matrix[i][j] * slope[j][k];
            rates((n + stage[i]) * h, at, du);
            for (int k = 0; k < 2; k++) {
               real moved = h * fabsl(du[k] - slope[i][k]) / (fabsl(at[k]) + (k ? 1 : 0));
               if (moved > change || moved != moved) change = moved;
               slope[i][k] = du[k];
            }
         }
      } while (change > 1e-19L && (change < before || change > 1e-17L) && ++pass < 100 && change == change);
      if (!(change < 1e-16L)) {
         fprintf(stderr, "no convergence at tau = %Lg: %Lg\n", n * h, change);
         return 1;
      }
      for (int j = 0; j < STAGES; j++)
         for (int k = 0; k < 2; k++) u[k] += h * quadrature[j] * slope[j][k];
      if ((n + 1) % steps == 0 && (n + 1) / steps > (periods - sampled) * points) printf("%.19Le\n", u[0]);
   }
   return 0;
}
