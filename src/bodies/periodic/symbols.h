/*
  Products of one column of spectra with the symbols of periodic.c, in one precision. The file is included with:
    Real       double or float
    Root(x)    square root
    Name(x)    name of a function of this precision
*/

/* Multiplies by gain/|k|, and by 0 for the mean. */
SAM_VECTORIZED static void Name(MultiplyNormal)(const SamSymbol *s, SamWaves at)
{
  const Real gain = (Real)s->gain, step = (Real)s->step[1], kx = (Real)at.kx;
  Real(*restrict column)[2] = (Real(*)[2])at.x;

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const Real ky = step * (Real)(m - at.origin), k2 = kx * kx + ky * ky, some = k2 > 0 ? k2 : 1,
               g = k2 > 0 ? gain / Root(some) : 0;

    column[m][0] *= g;
    column[m][1] *= g;
  }
}

/* Multiplies by (gain/|k|)(I - nu kk'/|k|^2), and by 0 for the mean; the cross term is multiplied by `cross`. */
SAM_VECTORIZED static void Name(MultiplyTangential)(const SamSymbol *s, SamWaves at)
{
  const Real gain = (Real)s->gain, nu = (Real)s->nu, step = (Real)s->step[1], kx = (Real)at.kx, cross = (Real)at.cross;
  Real(*restrict x)[2] = (Real(*)[2])at.x, (*restrict y)[2] = (Real(*)[2])at.y;

#pragma omp simd
  for (PetscInt m = at.first; m < at.last; m++) {
    const Real ky = step * (Real)(m - at.origin), k2 = kx * kx + ky * ky, some = k2 > 0 ? k2 : 1,
               g = k2 > 0 ? gain / Root(some) : 0, part = -nu * g / some;
    const Real xx = g + part * kx * kx, xy = cross * part * kx * ky, yy = g + part * ky * ky;
    const Real x0 = x[m][0], x1 = x[m][1], y0 = y[m][0], y1 = y[m][1];

    x[m][0] = xx * x0 + xy * y0;
    x[m][1] = xx * x1 + xy * y1;
    y[m][0] = xy * x0 + yy * y0;
    y[m][1] = xy * x1 + yy * y1;
  }
}
