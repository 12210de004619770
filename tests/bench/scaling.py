"""Strong and weak scaling on paper: a small model of compute, memory traffic and the all-to-all, from measured times.

One convolution of n x n cells on P ranks takes

    t(n, P) = c n^2 log2(2n) / P + m n^2 / (P b) + exchange(n, P)

c      arithmetic, from the time on one rank less its memory traffic
m      bytes a cell that pass through memory: 88 on one node, whose ranks share it (rows 8 + 16, columns 16 + 16 + 8
       with the kernel, rows 16 + 8), 152 on more (the two transposes read and write 16 more each)
b      bandwidth of a rank: alone that of the triad, beside others what the time on two ranks implies
exchange   between nodes two transposes, each of 16 n^2 / P bytes a rank: the share for ranks of the same node at the
       rate that the time on two ranks by messages implies, the rest at the rank's share of its node's network, and
       P - 1 messages of the latency

A solve is its measured numbers of applications (two components: twice a convolution) and preconditionings (half of one)
on the finest grid; as many on every coarser grid down to 64 cells, on all ranks that have rows; the rest of its time on
one rank, vectors above all, as traffic through memory; and six reductions an application, log2(P) latencies each.
The numbers do not depend on n (the solvers' measured property).
"""

from math import log2
from typing import NamedTuple

BYTES_NODE, BYTES_NODES, BYTES_TRANSPOSED = 88, 152, 16
REDUCTIONS, COARSEST = 6, 64


class Assumptions(NamedTuple):
    """Of the cluster; everything else is measured."""

    cores: int = 64  # ranks of a node
    network: float = 25e9  # bytes/s of a node
    latency: float = 2e-6  # of a message, s


class Convolution(NamedTuple):
    """Fitted to times of n x n cells on one and two ranks."""

    compute: float  # c, s
    alone: float  # bandwidth of one rank alone, bytes/s
    bandwidth: float  # b beside others, bytes/s
    node: float  # rate of the exchange between ranks of a node, bytes/s
    cluster: Assumptions

    def seconds(self, n, ranks):
        """One convolution; ranks beyond the rows have nothing to do but take part in the exchange."""
        busy = min(ranks, n)
        arithmetic = self.compute * n * n * log2(2 * n) / busy
        if ranks == 1:
            return arithmetic + BYTES_NODE * n * n / self.alone
        if ranks <= self.cluster.cores:
            return arithmetic + BYTES_NODE * n * n / (busy * self.bandwidth)
        return arithmetic + BYTES_NODES * n * n / (busy * self.bandwidth) + self.exchange(n, ranks)

    def exchange(self, n, ranks):
        busy = min(ranks, n)
        mine = BYTES_TRANSPOSED * n * n / busy
        near = (min(ranks, self.cluster.cores) - 1) / ranks
        far = max(0, ranks - self.cluster.cores) / ranks
        return 2 * (
            mine * near / self.node
            + mine * far * self.cluster.cores / self.cluster.network
            + (busy - 1) * self.cluster.latency
        )


def fit(n, alone, two, messages, bandwidth, cluster):
    """The convolution's model.

    From its seconds on one rank (alone) and on two, by shared memory (two) and by messages, and one rank's bandwidth
    (bytes/s).
    """
    compute = max(0.0, alone - BYTES_NODE * n * n / bandwidth) / (n * n * log2(2 * n))
    half = compute * n * n * log2(2 * n) / 2
    # two ranks are never more than twice as fast as one
    beside = min(bandwidth, BYTES_NODE * n * n / 2 / max(two - half, 1e-12))
    left = messages - half - BYTES_NODES * n * n / 2 / beside - 2 * cluster.latency
    # two transposes of 16 n^2/2 bytes, half of which change the rank; never faster than a copy through memory
    node = min(BYTES_TRANSPOSED * n * n / 2 / left if left > 0 else float("inf"), beside / 2)
    return Convolution(compute, bandwidth, beside, node, cluster)


class Solve(NamedTuple):
    """A solve measured on one rank with n x n cells."""

    n: int
    applications: float  # convolutions' worth of products on the finest grid
    preconditionings: float
    rest: float  # seconds of everything else, on one rank

    def transforms(self):
        return self.applications + 0.5 * self.preconditionings

    def parts(self, convolution, n, ranks):
        """Seconds of (finest transforms, coarse grids, the rest)."""
        finest = self.transforms() * convolution.seconds(n, ranks)
        coarse = sum(self.transforms() * convolution.seconds(k, ranks) for k in coarser(n))
        per_rank = convolution.alone if ranks == 1 else convolution.bandwidth
        rest = self.rest * (n / self.n) ** 2 / ranks * convolution.alone / per_rank
        if ranks > 1:
            rest += REDUCTIONS * self.applications * 2 * log2(ranks) * convolution.cluster.latency
        return finest, coarse, rest

    def seconds(self, convolution, n, ranks):
        return sum(self.parts(convolution, n, ranks))


def coarser(n):
    """Cells of the grids below n."""
    sizes = []
    while n // 2 >= COARSEST:
        n //= 2
        sizes.append(n)
    return sizes


def measured_solve(n, seconds, applications, preconditionings, convolution):
    """The rest is what the transforms of all grids leave of the seconds on one rank, at least nothing."""
    bare = Solve(n, applications, preconditionings, 0.0)
    return bare._replace(rest=max(0.0, seconds - bare.seconds(convolution, n, 1)))
