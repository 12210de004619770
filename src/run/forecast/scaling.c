/*
  A model of the time of a step on other numbers of ranks and nodes.

    time = arithmetic / ranks + bytes through memory / bandwidth of a node + messages

  The arithmetic is what remains of the time of a step on the ranks of this run. Bytes and messages are those of the
  operator applications and preconditioners of a usual step, on the grid and on the nested grids, by the transforms'
  passes (ground/fourier). The bandwidth of a node's memory is the only number that was fitted: to steps of 2048 x 2048
  and 4096 x 4096 cells on 1 to 16 cores of one socket, which it meets within 15 %, and a history on 512 x 512 cells
  within 25 %; it then meets steps on two cores of another machine within 10 % (tests/unit/test_scaling.c). No run on
  several nodes was at hand: the network's numbers are usual ones. In a step on 1024 x 1024 cells on 2 and 5 ranks, MPI
  was asked to send 13 % fewer bytes and 6 % fewer messages than predicted.
*/
#include "scaling.h"
#include <math.h>

#define NODE_BANDWIDTH  70e9   /* bytes/s of the memory that the ranks of a node share; fitted */
#define NETWORK         10e9   /* bytes/s into and out of a node */
#define NETWORK_LATENCY 2e-6   /* s of a message between nodes */
#define NODE_LATENCY    0.5e-6 /* s of a message within a node */
#define COPIES          4      /* a message within a node is written to and read from a buffer, twice each */
#define COLLECTIVES     10 /* sums and barriers around an application; 10 to 11 were counted at 256 and 1024 cells */
#define REST            2  /* vectors and projections take as long as the applications, and move as many bytes */
#define COARSEST        16 /* cells along the shorter side of the coarsest grid */

/* Applications in a step: for the pressure and for the shear, on the grid and on each coarser one; as many
   preconditioners */
static const int applications[2][2] = {{12, 15}, {5, 6}};

/* What a pass moves: fields, size of a number, mode, and bytes of kernels per cell. */
typedef struct {
  int            fields;
  size_t         real;
  SamFourierMode mode;
  double         kernels;
} Pass;

/* [shear][preconditioner]; shear is refined after solves in single precision */
static const Pass passes[2][2] = {
  {{1, sizeof(double), SAM_FOURIER_PADDED, 8}, {1, sizeof(float), SAM_FOURIER_PERIODIC, 0}},
  {{2, sizeof(float), SAM_FOURIER_PADDED, 24}, {2, sizeof(float), SAM_FOURIER_PERIODIC, 0}}};

/* Returns the bytes per cell that a pass moves through memory: a field is read once and written once, which reads it,
   too; half spectra are written by rows, read and written by columns, and read by rows. */
static double BytesOf(const SamScaling *s, const Pass *pass)
{
  const double real     = (double)pass->real;
  const double spectrum = (pass->mode == SAM_FOURIER_PADDED && !s->periodic ? 2 : 1) * real;

  return pass->fields * (3 * real + 5 * spectrum) + pass->kernels;
}

/* Returns the largest share of a rank in the grid's rows. */
static double ShareOf(const SamScaling *s, int ranks)
{
  return ceil((double)s->n[1] / ranks) / (double)s->n[1];
}

/* The sums over grids, kinds of problems and passes: bytes through memory, and what a rank sends. */
typedef struct {
  double            moved, calls;
  SamFourierTraffic traffic;
} Sums;

static Sums SumsOf(const SamScaling *s, int ranks)
{
  const SamFourierPeriod period = s->periodic ? SAM_FOURIER_EXACT : SAM_FOURIER_FAST;
  PetscInt               n[2]   = {s->n[0], s->n[1]};
  Sums                   sums   = {0};

  for (int level = 0; level == 0 || PetscMin(n[0], n[1]) >= COARSEST; level++) {
    for (int k = 0; k < (s->friction ? 4 : 2); k++) {
      const Pass             *pass  = &passes[k / 2][k % 2];
      const double            times = applications[level > 0][k / 2];
      const SamFourierTraffic t =
        SamFourierCountTraffic(n, period, s->periodic ? SAM_FOURIER_PERIODIC : pass->mode, pass->real, ranks, 0);

      sums.calls += times;
      sums.moved += REST * times * BytesOf(s, pass) * (double)n[0] * (double)n[1];
      sums.traffic.bytes += times * pass->fields * t.bytes;
      sums.traffic.messages += times * pass->fields * t.messages;
    }
    for (int k = 0; k < 2; k++) n[k] = (n[k] + 1) / 2;
  }
  return sums;
}

/* Returns the times (s) of the bytes through memory and of the messages. */
static void TimesOf(const SamScaling *s, int ranks, int cores, double *memory, double *messages)
{
  const Sums   sums     = SumsOf(s, ranks);
  const int    on_node  = PetscMin(ranks, cores);
  const double beyond   = ranks > on_node ? (double)(ranks - on_node) / (double)(ranks - 1) : 0;
  const double latency  = beyond * NETWORK_LATENCY + (1 - beyond) * NODE_LATENCY;
  const double farthest = beyond > 0 ? NETWORK_LATENCY : NODE_LATENCY;

  *memory   = sums.moved * PetscMin(1, on_node * ShareOf(s, ranks)) / NODE_BANDWIDTH;
  *messages = sums.calls * COLLECTIVES * 2 * ceil(log2((double)ranks)) * farthest;
  if (ranks > 1 && (s->send || beyond > 0))
    *messages += sums.traffic.messages * latency +
                 on_node * sums.traffic.bytes * (beyond / NETWORK + (1 - beyond) * COPIES / NODE_BANDWIDTH);
}

SamScalingTime SamScalingPredict(const SamScaling *s, int ranks, int cores)
{
  double memory, messages, arithmetic;

  TimesOf(s, s->ranks, s->cores, &memory, &messages);
  arithmetic = PetscMax(s->seconds - memory - messages, 0.2 * s->seconds) / ShareOf(s, s->ranks);
  TimesOf(s, ranks, cores, &memory, &messages);
  return (SamScalingTime){.ranks    = ranks,
                          .nodes    = (ranks + cores - 1) / cores,
                          .seconds  = arithmetic * ShareOf(s, ranks) + memory + messages,
                          .messages = messages};
}
