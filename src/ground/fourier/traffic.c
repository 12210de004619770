/*
  What ranks send in a pass of transforms, if rows are exchanged for columns by messages.

  FFTW deals rows and columns in blocks, the last ranks having fewer or none. In each direction a rank sends to every
  other rank, in one message, the complex numbers where its own lines cross those of the other; it leaves out some of
  the empty messages to ranks without lines, which are counted here.
*/
#include "fourierimpl.h"

/* Returns the number of lines of a rank. */
static double LinesOf(PetscInt lines, PetscInt ranks, PetscInt rank)
{
  const PetscInt block = (lines + ranks - 1) / ranks;

  return (double)PetscMax(PetscMin(block, lines - rank * block), 0);
}

SamFourierTraffic SamFourierCountTraffic(const PetscInt n[2], SamFourierPeriod period, SamFourierMode mode, size_t real,
                                         PetscInt ranks, PetscInt rank)
{
  const PetscInt hx      = period == SAM_FOURIER_EXACT ? n[0] : SamFourierFastLength(n[0]);
  const PetscInt columns = mode == SAM_FOURIER_PADDED ? hx + 1 : hx / 2 + 1;
  const double   mine[2] = {LinesOf(n[1], ranks, rank), LinesOf(columns, ranks, rank)};
  const double   sent    = mine[0] * ((double)columns - mine[1]) + mine[1] * ((double)n[1] - mine[0]);

  return (SamFourierTraffic){.bytes = 2 * (double)real * sent, .messages = 2 * (double)(ranks - 1)};
}
