/*
  Products of one column of spectra with the symbols of layered bodies, in one precision. The file is included with:
    Real       double or float
    Name(x)    name of a function of this precision
*/

void Name(SamLayeredMultiplyNormal)(const SamSymbol *s, SamWaves at)
{
  Real(*restrict column)[2] = (Real(*)[2])at.x;
  Waves w;

  for (PetscInt first = at.first; first < at.last; first += CHUNK) {
    const PetscInt n = Gains(s, &at, first, SAM_WAVE_ZZ, w.k2, w.along);

    for (PetscInt m = 0; m < n; m++)
      for (int part = 0; part < 2; part++) column[first + m][part] *= (Real)w.along[m];
  }
}

/* Multiplies by across I + (along - across) kk'/|k|^2; the cross term is multiplied by `cross`. */
void Name(SamLayeredMultiplyTangential)(const SamSymbol *s, SamWaves at)
{
  Real(*restrict x)[2] = (Real(*)[2])at.x, (*restrict y)[2] = (Real(*)[2])at.y;
  Waves w;

  for (PetscInt first = at.first; first < at.last; first += CHUNK) {
    const PetscInt n = Gains(s, &at, first, SAM_WAVE_RR, w.k2, w.along);

    (void)Gains(s, &at, first, SAM_WAVE_TT, w.k2, w.across);
    for (PetscInt m = 0; m < n; m++) {
      const double ky = s->step[1] * (double)(first + m - at.origin), part = (w.along[m] - w.across[m]) / w.k2[m];
      const Real   xx = (Real)(w.across[m] + part * at.kx * at.kx), xy = (Real)(at.cross * part * at.kx * ky),
                 yy = (Real)(w.across[m] + part * ky * ky);
      Real *const a = x[first + m], *const b = y[first + m];

      for (int c = 0; c < 2; c++) {
        const Real a0 = a[c], b0 = b[c];

        a[c] = xx * a0 + xy * b0;
        b[c] = xy * a0 + yy * b0;
      }
    }
  }
}
