"""Partial slip of two equal elastic half-spaces on square cells of uniform traction: a small solver of its own.

It shares no code with petsam. The influence of a cell is Love's and Cerruti's, as sums over its corners; the pressure
is found by Polonsky's and Keer's conjugate gradients, the shear by projected gradients with Barzilai's and Borwein's
step lengths on the set of all shears that Coulomb's law and the loads admit. In a load step the slip is opposite to the
shear at the step's end, which is of first order in the step: take many.
"""

import numpy as np

TOLERANCE = 1e-7  # of the shear, relative to its bound


class Grid:
    """Cells of a rectangle lx by ly about (x0, 0), n along x, and the compliance of both bodies together."""

    def __init__(self, n, lx, ly, young, poisson, x0=0.0):
        self.h = lx / n
        self.shape = round(ly / self.h), n
        self.x = x0 + (np.arange(n) + 0.5) * self.h - lx / 2
        self.y = ((np.arange(self.shape[0]) + 0.5) - self.shape[0] / 2) * self.h
        self.X, self.Y = np.meshgrid(self.x, self.y)
        self.area = self.h**2
        self.wide = tuple(2 * k for k in self.shape)
        one, xx, yy, xy = self._influence()
        c = 2 * 2 * (1 + poisson) / young / (2 * np.pi)  # two bodies, 1/G = 2 (1 + nu)/E
        self.zz = self._transform(c * (1 - poisson) * one)
        self.xx = self._transform(c * ((1 - poisson) * one + poisson * xx))
        self.yy = self._transform(c * ((1 - poisson) * one + poisson * yy))
        self.xy = self._transform(c * poisson * xy)

    def _influence(self):
        """Integrals of 1/r, x^2/r^3, y^2/r^3 and x y/r^3 over cells at all distances."""
        j, i = (np.fft.fftfreq(k, 1 / k) * self.h for k in self.wide)
        sums = [0.0] * 4
        for sx in (-1, 1):
            for sy in (-1, 1):
                u, v = np.meshgrid(i + sx * self.h / 2, j + sy * self.h / 2)
                along, across = v * np.arcsinh(u / abs(v)), u * np.arcsinh(v / abs(u))
                parts = (along + across, along, across, -np.hypot(u, v))
                sums = [s + sx * sy * part for s, part in zip(sums, parts)]
        return sums

    def _transform(self, kernel):
        return np.fft.rfft2(kernel)

    def convolve(self, kernels, fields):
        """Sums of kernels times fields, for each row of kernels."""
        ny, nx = self.shape
        f = [np.fft.rfft2(field, self.wide) for field in fields]
        return np.array([np.fft.irfft2(sum(k * g for k, g in zip(row, f)), self.wide)[:ny, :nx] for row in kernels])

    def normal(self, p):
        return self.convolve([[self.zz]], [p])[0]

    def tangential(self, q):
        return self.convolve([[self.xx, self.xy], [self.xy, self.yy]], q)


def pressure(grid, gap, force, moment_y=0.0, tolerance=1e-9):
    """Pressure, approach and rotation about y under a force and a moment about y: Polonsky and Keer (1999), whose rule
    for the force is used for the moment too: p is made to balance both by the field p (c + k x)."""
    base = np.array([np.ones_like(gap), grid.X])  # displacement by approach and rotation
    loads = np.array([force, moment_y]) / grid.area

    def balance(p):
        inside = p > 0
        for _ in range(50):
            b = base[:, inside]
            weights = p[inside]
            error = loads - b @ weights
            if (abs(error) <= 1e-13 * loads[0] * np.array([1.0, np.abs(grid.x).max()])).all():
                break
            p = p * np.maximum(0.0, 1 + np.tensordot(np.linalg.solve((b * weights) @ b.T, error), base, 1))
            inside = p > 0
        return p

    p = balance(np.where(gap <= np.quantile(gap, 0.6), 1.0, 0.0))
    direction, before, fresh = np.zeros_like(p), 1.0, True
    for _ in range(2000):
        inside = p > 0
        u = grid.normal(p) + gap
        b = base[:, inside]
        rigid = np.linalg.solve(b @ b.T, b @ u[inside])
        g = u - np.tensordot(rigid, base, 1)
        square = (g[inside] ** 2).sum()
        if square <= (tolerance * np.ptp(u)) ** 2 * inside.sum() and g[~inside].min() > -tolerance * np.ptp(u):
            break
        direction = np.where(inside, g + (0.0 if fresh else square / before) * direction, 0.0)
        before = square
        r = grid.normal(direction)
        r -= np.tensordot(np.linalg.solve(b @ b.T, b @ r[inside]), base, 1)
        step = (g[inside] @ direction[inside]) / (r[inside] @ direction[inside])
        p = np.maximum(0.0, p - step * direction)
        joined = (p == 0) & (g < 0)
        p[joined] -= step * g[joined]
        fresh = joined.any()
        p = balance(p)
    return p, rigid[0], rigid[1]


class Shear:
    """Shear and slip of a contact under a pressure that stays, while T_x, T_y and M_z change."""

    def __init__(self, grid, bound, torsion=False):
        self.grid, self.bound = grid, bound
        self.inside = bound > 0
        one, zero = np.ones(grid.shape), np.zeros(grid.shape)
        base = [[one, zero], [zero, one]] + ([[-grid.Y, grid.X]] if torsion else [])
        self.base = np.array(base)[:, :, self.inside]
        self.b = bound[self.inside]
        self.q = np.zeros((2, self.b.size))
        self.u = np.zeros_like(self.q)
        self.slip = np.zeros_like(self.q)
        self.change = np.zeros_like(self.q)  # of the last step
        self.rigid = np.zeros(len(base))
        self.motion = np.zeros(len(base))
        self.scale = np.abs(self.base).max((1, 2))
        self.iterations = 0

    def displacement(self, q):
        full = np.zeros((2, *self.grid.shape))
        full[:, self.inside] = q
        return self.grid.tangential(full)[:, self.inside]

    def project(self, v, loads, c):
        """The nearest shear within the bounds that balances the loads: v plus a rigid field, cut to the bounds."""
        allowed = 1e-13 * self.scale * self.b.sum()

        def cut(c):
            w = v + np.tensordot(c, self.base, 1)
            size = np.sqrt(w[0] ** 2 + w[1] ** 2)
            part = self.b / np.maximum(size, self.b)
            return w, size, part, loads - np.tensordot(self.base, w * part, 2)

        w, size, part, error = cut(c)
        for _ in range(30):
            if (abs(error) <= allowed).all():
                break
            # derivative of the cut: 1 inside, b/|w| across the direction of w outside
            along = (self.base * (w / np.maximum(size, 1e-300))).sum(1) * np.where(size > self.b, np.sqrt(part), 0.0)
            m = (self.base * part).reshape(len(c), -1) @ self.base.reshape(len(c), -1).T - along @ along.T
            move, t = np.linalg.solve(m + 1e-9 * np.diag(np.diag(m)), error), 1.0
            tried = cut(c + move)
            while abs(tried[3] / self.scale).max() > abs(error / self.scale).max() and t > 1e-3:
                t /= 2
                tried = cut(c + t * move)
            if t <= 1e-3:
                break
            c, (w, size, part, error) = c + t * move, tried
        return w * part, c

    def step(self, loads, most=3000):
        """One load step; returns the frictional work in it."""
        loads = np.asarray(loads, float) / self.grid.area
        before, slip = self.u.copy(), self.slip.copy()
        unit = self.displacement(np.ones_like(self.q) * [[1.0], [0.0]])[0].max()
        length = 3 / unit
        q, _ = self.project(self.q + self.change, loads, np.zeros(len(self.base)))
        c = self.motion * length
        g = self.displacement(q) - before
        for count in range(most):
            new, c = self.project(q - length * g, loads, c)
            change = new - q
            if np.abs(change).max() <= TOLERANCE * self.b.max() * max(1.0, length * unit):
                break
            moved = self.displacement(change)
            # exact length along the line, at most the whole way
            down, curve = ((g - np.tensordot(c / length, self.base, 1)) * change).sum(), (change * moved).sum()
            t = min(1.0, max(0.0, -down / curve))
            q, g = q + t * change, g + t * moved
            last, length = length, (change * change).sum() / curve if count % 2 else curve / (moved * moved).sum()
            c = c * (length / last)
        self.iterations += count
        # c is that of the last projection: q = cut(q - length g + c)
        motion = c / length
        self.rigid = self.rigid + motion
        self.motion, self.change = motion, q - self.q
        self.q, self.u = q, before + g
        ds = g - np.tensordot(motion, self.base, 1)
        stick = np.sqrt((q**2).sum(0)) < self.b * (1 - 1e-6)
        ds[:, stick] = 0.0
        self.slip = slip + ds
        self.stick = stick
        return (self.b * np.sqrt((ds**2).sum(0))).sum() * self.grid.area

    def field(self, values):
        full = np.zeros(self.grid.shape)
        full[self.inside] = values
        return full

    def stick_area(self):
        """Area in stick. Next to it the slip grows with the distance to the power 3/2, so the edge lies where
        slip^(2/3), continued from two cells along a row or a column, vanishes; the mean of rows and columns."""
        slip, stuck = self.field(np.cbrt((self.slip**2).sum(0))), self.field(self.stick) > 0
        slips, cells = self.inside & ~stuck, 0.0
        for one, two, three in ((slip, stuck, slips), (slip.T, stuck.T, slips.T)):
            cells += two.sum()
            for way in (1, -1):
                near, far = np.roll(one, -way, 1), np.roll(one, -2 * way, 1)
                edge = two & np.roll(three, -way, 1) & np.roll(three, -2 * way, 1) & (far > near)
                cells += (0.5 - np.minimum(1.5, near[edge] / (far[edge] - near[edge]))).sum()
        return cells / 2 * self.grid.area

    def smooth_stick_area(self, modes, part):
        """Area in stick. Next to it the slip grows with the distance to the power 3/2, so r = b + c s + d s^2 with
        s = slip^(2/3), and b, c, d are Fourier series of the angle, fitted to the cells with s below a part
        of its maximum."""
        x, y = self.grid.X[self.inside], self.grid.Y[self.inside]
        x, y = x - x[self.stick].mean(), y - y[self.stick].mean()
        s = np.cbrt((self.slip**2).sum(0))
        near = ~self.stick & (s < part * s.max())
        s, r, angle = s[near] / s.max(), np.hypot(x, y)[near], np.arctan2(y, x)[near]

        def series(angle):
            return np.array([f(k * angle) for k in modes for f in ((np.cos, np.sin) if k else (np.cos,))])

        waves = series(angle)
        basis = np.vstack([waves, s * waves, s**2 * waves])
        found = np.linalg.lstsq(basis.T, r, rcond=None)[0][: len(waves)]
        return np.pi * np.mean((found @ series(np.linspace(0, 2 * np.pi, 256, endpoint=False))) ** 2)


def hertz_means(grid, a, p0, parts=16):
    """Means of Hertz's pressure over the cells."""
    offsets = ((np.arange(parts) + 0.5) / parts - 0.5) * grid.h
    total = np.zeros(grid.shape)
    for ox in offsets:
        for oy in offsets:
            total += np.sqrt(np.maximum(0.0, 1 - ((grid.X + ox) ** 2 + (grid.Y + oy) ** 2) / a**2))
    return p0 * total / parts**2


def sphere(cells, a, force, friction, young, poisson):
    """The shear, still 0, of spheres in Hertz's circle of contact of radius a, which is `cells` - 2 cells wide."""
    size = 2 * a * cells / (cells - 2)
    grid = Grid(cells, size, size, young, poisson)
    p = hertz_means(grid, a, 1.5 * force / (np.pi * a**2))
    return Shear(grid, friction * p * (force / (p.sum() * grid.area)))
