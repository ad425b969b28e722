/* Reference motion of one scaled scene in quadruple precision, first way: states (y, v), extrapolated midpoint
 * rule (Gragg, Bulirsch, Stoer) with step and order control; the rupture condition (18) solved by Newton's method;
 * Psi from its definition with the logarithm, by Gauss points after the substitution phi = peak + e sinh s.
 *
 * extrapolation FILM a c q B0 STEADY_LOAD PERIODS SAMPLED POINTS   (FILM 0 ... 3 as FILMS in ../peers/equations.py)
 * prints y at the sampled times. */
#include <quadmath.h>
#include <stdio.h>
#include <stdlib.h>

typedef __float128 real;
enum { ROWS = 16, POINTS = 48 };
static const real TOLERANCE = 1e-21Q;

static int film;
static real a_scale, c_scale, ratio, b_scale, steady;
static real node[POINTS], weight[POINTS];
static real angle = 2.0144Q; /* last rupture angle from -pi/2, the next starting value */

static void gauss_points(void)
{
   for (int i = 0; i < POINTS; i++) {
      real x = cosq(M_PIq * (i + 0.75Q) / (POINTS + 0.5Q)), slope = 1;
      for (int pass = 0; pass < 8; pass++) {
         real before = 1, now = x;
         for (int n = 2; n <= POINTS; n++) {
            real next = ((2 * n - 1) * x * now - (n - 1) * before) / n;
            before = now;
            now = next;
         }
         slope = POINTS * (x * now - before) / (x * x - 1);
         x -= now / slope;
      }
      node[i] = x;
      weight[i] = 2 / ((1 - x * x) * slope * slope);
   }
}

/* p*(d), K(d) and sin^2 d from one sine and cosine of 2 d. */
static real pressure(real d, real a, real t, real *k, real *square)
{
   real s2, c2;
   sincosq(2 * d, &s2, &c2);
   *square = (1 - c2) / 2;
   *k = 3 * d / 8 - s2 / 4 + s2 * c2 / 16;
   return d / 8 - s2 * c2 / 16 - t * t * *k - a * (*square * *square / 4 + t * *k);
}

/* Root d of p*(d) = 0 with t_e = -cot d: Newton, the slope of p* at its own end point is -K (2 t_e + A)/sin^2 d.
 * The physical root lies beyond t_e = -A/2, where p* falls from positive to negative: a bracket. */
static real rupture(real a)
{
   real low = M_PI_2q + atanq(-a / 2), high = M_PIq, d = angle;
   for (int pass = 0; pass < 200; pass++) {
      if (!(d > low && d < high)) d = (low + high) / 2;
      real s, c, k, square;
      sincosq(d, &s, &c);
      real t = -c / s, p = pressure(d, a, t, &k, &square), step = p * square / (k * (2 * t + a));
      if (p > 0) low = d;
      else high = d;
      d += step;
      if (fabsq(step) < 1e-31Q) break;
   }
   angle = d;
   return d;
}

static real load_group(real y, real v)
{
   real a = c_scale * v / sqrtq(y), d = rupture(a), s = sinq(d), c = cosq(d), t = -c / s;
   if (film == 2) return s * s / 4 - a / 8 * (d - s * c);
   real b = b_scale / (y * sqrtq(y)), peak = M_PI_2q + atanq(-t - a), k, square, top = pressure(peak, a, t, &k, &square);
   if (!(b * top < 1)) return nanq(""); /* no piezo-viscous film */
   real e = sqrtq(2 * (1 - b * top) / (b * (2 * t + a))) / sqrtq(square);
   real low = asinhq(-peak / e), half = (asinhq((d - peak) / e) - low) / 2, sum = 0;
   for (int i = 0; i < POINTS; i++) {
      real grow = expq(low + half * (1 + node[i])), shrink = 1 / grow, phi = peak + e * (grow - shrink) / 2;
      real p = pressure(phi, a, t, &k, &square);
      sum -= weight[i] * (grow + shrink) / 2 * logq(1 - b * p) / square;
   }
   return sum * half * e / b;
}

static void rates(real tau, const real u[2], real du[2])
{
   real y = u[0], v = u[1], load;
   if (film == 0) load = (1 - c_scale * v / sqrtq(y)) / y;
   else if (film == 1) load = expq(-c_scale * v) / (y * y * y * sqrtq(y));
   else load = load_group(y, v) / (steady * y);
   du[0] = v;
   du[1] = a_scale * (load - 1 - ratio * cosq(2 * M_PIq * tau));
}

/* One extrapolated step; 1 if it met the tolerance. */
static int step(real tau, real h, real u[2])
{
   real above[ROWS][2], slope[2];
   rates(tau, u, slope);
   for (int row = 0; row < ROWS; row++) {
      int n = 2 * (row + 1);
      real g = h / n, old[2] = {u[0], u[1]}, now[2] = {u[0] + g * slope[0], u[1] + g * slope[1]}, du[2];
      for (int i = 1; i < n; i++) {
         if (!(now[0] > 0)) return 0;
         rates(tau + i * g, now, du);
         for (int k = 0; k < 2; k++) {
            real next = old[k] + 2 * g * du[k];
            old[k] = now[k];
            now[k] = next;
         }
      }
      real error = row > 0 ? 0 : 1, best[2];
      for (int k = 0; k < 2; k++) {
         real value = now[k];
         for (int j = 0; j < row; j++) {
            real q = (real)n / (2 * (row - j)), better = value + (value - above[j][k]) / (q * q - 1);
            above[j][k] = value;
            value = better;
         }
         if (row > 0) {
            real change = fabsq(value - above[row - 1][k]) / (fabsq(value) + (k ? 1 : 0));
            if (change > error || change != change) error = change;
         }
         above[row][k] = best[k] = value;
      }
      if (error != error) return 0; /* a rough try left the range of the film */
      if (error < TOLERANCE) {
         u[0] = best[0];
         u[1] = best[1];
         return 1;
      }
   }
   return 0;
}

int main(int count, char **word)
{
   if (count != 10) return 2;
   film = atoi(word[1]);
   a_scale = strtod(word[2], NULL), c_scale = strtod(word[3], NULL), ratio = strtod(word[4], NULL);
   b_scale = strtod(word[5], NULL), steady = strtod(word[6], NULL);
   long periods = atol(word[7]), sampled = atol(word[8]), points = atol(word[9]);
   gauss_points();
   real u[2] = {1, 0};
   int level = 0;
   for (long i = 0; i < periods * points; i++) {
      if (level > 0) level--;
      long done = 0;
      /* Position within the interval in units of 2^-30 of it. */
      const long unit = 1L << 30;
      while (done < unit) {
         while (done % (unit >> level)) level++;
         real h = (real)1 / points / (1L << level), tau = ((real)i + (real)done / unit) / points;
         if (step(tau, h, u)) {
            done += unit >> level;
            if (level > 0 && done % (unit >> (level - 1)) == 0) level--;
         } else if (++level > 24) {
            fprintf(stderr, "no convergence at tau = %g\n", (double)tau);
            return 1;
         }
      }
      if (i + 1 > (periods - sampled) * points) {
         char text[64];
         quadmath_snprintf(text, sizeof text, "%.22Qe", u[0]);
         puts(text);
      }
   }
   return 0;
}
