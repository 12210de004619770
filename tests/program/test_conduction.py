"""petsam.conduction: closed forms of discs, ellipses, arrays and strips, films, gas, and the contact's stiffness."""

import numpy as np
import pytest

import petsam
from petsam.apps.conduction import Body, conduct, spots
from petsam.core.errors import Error
from support import SPHERE, bodies

pytestmark = pytest.mark.filterwarnings("ignore::petsam.contact.AdviceWarning")
# Conductance of a disc with a film r on it, over a/(rho1 + rho2), by rings
FILMS = {0.0: 4.0, 0.01: 3.912718, 0.1: 3.434689, 0.5: 2.353464, 1.0: 1.706719, 10.0: 0.289605}


def disc(n, room):
    """Cells with centres in a disc of radius 1, so many across; and the width of a cell that gives it its area."""
    width = 2.0 / n
    count = int(np.ceil(room * n / 2)) * 2
    x = (np.arange(count) - (count - 1) / 2) * width
    cells = np.hypot(x, x[:, None]) < 1
    return cells, width * np.sqrt(np.pi / (cells.sum() * width**2))


@pytest.mark.parametrize("n, error", [(16, 1.9e-2), (64, 4.5e-3)])
def test_a_disc_has_the_resistance_of_holm(n, error):
    """(rho1 + rho2)/(4a), and cells of constant flux 0.235/n too much, of first order."""
    cells, width = disc(n, 1.2)
    resistance = 1 / (conduct(cells, (width, width), 3.0).sum() * width**2)
    assert 0 < resistance / 0.75 - 1 < error
    assert resistance / 0.75 - 1 == pytest.approx(0.235 / n, rel=0.15)


@pytest.mark.parametrize("film", list(FILMS))
def test_a_film_on_a_disc(film):
    cells, width = disc(48, 1.1)
    found = conduct(cells, (width, width), 1.0, film).sum() * width**2
    assert found == pytest.approx(FILMS[film], rel=0.235 / 48 * 1.3)


def test_an_ellipse():
    """R = (rho1 + rho2) K(e)/(2 pi a); a = 2, b = 1: 0.3432201252 for a sum of 2."""
    count = 102
    x = (np.arange(count) - (count - 1) / 2) * 2 / 48
    cells = np.hypot(x / 2, x[:, None]) < 1
    width = (2 / 48) * np.sqrt(2 * np.pi / (cells.sum() * (2 / 48) ** 2))
    assert 1 / (conduct(cells, (width, width), 2.0).sum() * width**2) == pytest.approx(0.3432201252, rel=6e-3)


def test_an_array_of_discs():
    """R of a disc in each period L: (rho1 + rho2)(1/(4a) - 3.90026/(2 pi L) + 0.4792 a^2/L^3)."""
    n, a = 128, 0.1
    x = (np.arange(n) + 0.5) / n - 0.5
    cells = np.hypot(x, x[:, None]) < a
    a = np.sqrt(cells.mean() / np.pi)
    expected = 2 * (1 / (4 * a) - 3.90026 / (2 * np.pi) + 0.4792 * a**2)
    assert 1 / conduct(cells, (1 / n, 1 / n), 2.0, periodic=True).mean() == pytest.approx(
        expected, rel=0.235 / 25.6 * 5 / 3.7 * 1.2
    )


@pytest.mark.parametrize("part, exact", [(0.25, 1.635314), (0.5, 4.532360)])
def test_strips(part, exact):
    """h l = -pi/((rho1 + rho2) ln sin(pi a/l)), with an error of first order in the cells."""
    found = []
    for n in (64, 256):
        cells = np.zeros((4, n), bool)
        cells[:, : int(part * n)] = True
        found.append(conduct(cells, (1 / n, 1 / n), 2.0, periodic=True).mean() / exact - 1)
    assert abs(found[1]) < 1e-2 and found[0] / found[1] == pytest.approx(4, rel=0.1)


def test_a_film_alone_is_its_resistance():
    """All cells of a period touch: h = 1/r; of a gas of constant width, too."""
    cells = np.ones((8, 12), bool)
    assert conduct(cells, (1e-6, 2e-6), 0.04, 3e-5, periodic=True) == pytest.approx(1 / 3e-5, rel=1e-8)


@pytest.mark.parametrize("odd", [False, True], ids=["mirrored", "not quite"])
def test_a_mirrored_period_conducts_as_its_copy_that_is_shifted(odd):
    """A field that begins elsewhere has no mirror planes at its borders; the flux moves with it."""
    rng = np.random.default_rng(8)
    mirrored = lambda field: np.pad(field, [(0, n) for n in field.shape], mode="symmetric")  # noqa: E731
    touches, resistance = mirrored(rng.random((10, 14)) < 0.3), mirrored(10 ** rng.uniform(-6, -4, (10, 14)))
    if odd:
        touches[3, 4] = not touches[3, 4]
    resistance = np.where(touches, 0.0, resistance)
    cells = np.ones_like(touches)
    found = conduct(cells, (1e-6, 2e-6), 0.04, resistance, periodic=True)
    moved = conduct(cells, (1e-6, 2e-6), 0.04, np.roll(resistance, (3, 5), (0, 1)), periodic=True)
    assert np.array_equal(found, np.flip(found)) != odd
    assert np.roll(found, (3, 5), (0, 1)) == pytest.approx(moved, rel=1e-5)
    found, moved = (conduct(one, (1e-6, 2e-6), 0.04, periodic=True) for one in (touches, np.roll(touches, 5, 1)))
    assert np.roll(found, 5, 1) == pytest.approx(moved, rel=1e-6)


@pytest.mark.parametrize("jump", [1e-9, 0.37e-6], ids=["oil", "air"])
def test_gas_needs_few_products(jump, monkeypatch):
    """Of a wavy gap with spots, resistances of which differ by orders: 12; with one wave filter for all cells 30."""
    n = 192
    x, y = np.meshgrid(*(2 * np.pi * (np.arange(n) + 0.5) / n,) * 2)
    height = np.cos(x) * np.cos(y) + 0.5 * np.cos(7 * x) * np.cos(8 * y) + 0.3 * np.cos(23 * x) * np.cos(19 * y)
    gap = 1e-6 * np.maximum(height - np.quantile(height, 0.08), 0.0)
    resistance = np.where(gap > 0, (gap + jump) / 0.026, 0.0)
    given = dict(conducts=np.ones_like(gap), cell=(5e-6, 5e-6), resistivity=0.04, periodic=True)
    expected = conduct(**given, resistance=resistance).mean()
    monkeypatch.setattr(spots, "MOST", 12)
    for move in (0, 3):
        found = conduct(**given, resistance=np.roll(resistance, move, 0), rtol=3e-4).mean()
        assert found == pytest.approx(expected, rel=1e-6)


def test_a_cell_less_never_conducts_more():
    rng = np.random.default_rng(4)
    cells = rng.random((16, 16)) < 0.4
    whole = conduct(cells, (1.0, 1.0), 2.0).sum()
    for j, i in np.argwhere(cells)[::9]:
        part = cells.copy()
        part[j, i] = False
        assert conduct(part, (1.0, 1.0), 2.0).sum() <= whole * (1 + 1e-9)


def test_gas_of_resistances_that_differ_by_orders():
    """Against a dense matrix whose integrals of 1/R are sums over points of each cell."""
    rng = np.random.default_rng(5)
    n, m = 8, 60
    touches = rng.random((n, n)) < 0.2
    resistance = np.where(touches, 0.0, 10 ** rng.uniform(-7, -3, touches.shape))
    x, y = (np.ravel(part) for part in np.meshgrid(np.arange(n), 2 * np.arange(n)))
    part = (np.arange(m) + 0.5) / m - 0.5
    apart = [
        np.mean(1 / np.hypot((x - i)[:, None, None] + part[:, None], (y - j)[:, None, None] + 2 * part), axis=(1, 2))
        for i, j in zip(x, y)
    ]
    matrix = 1e-6 * 2 * np.array(apart) / (2 * np.pi)
    own = 1e-6 * 4 * (0.5 * np.arcsinh(2.0) + 1.0 * np.arcsinh(0.5)) / (2 * np.pi)  # cells of 1 by 2 um
    matrix[np.diag_indices(n * n)] = own
    expected = np.linalg.solve(0.04 * matrix + np.diag(resistance.ravel()), np.ones(n * n)).reshape(n, n)
    found = conduct(np.ones_like(touches), (1e-6, 2e-6), 0.04, resistance)
    assert np.abs(found - expected).max() < 2e-3 * expected.max()


# ---------------------------------------------------------------- layers


def array_of_discs(body, n=256):
    """Flux through a disc a/L = 0.1 in a period, a body on one of conductivity 1."""
    x = (np.arange(n) + 0.5) / n - 0.5
    return conduct(np.hypot(x, x[:, None]) < 0.1, (1 / n, 1 / n), [body, Body(1.0)], periodic=True).mean()


@pytest.mark.parametrize("lam, expected", [
    (0.01, [0.9004, 0.5304, 0.1170, 0.0252, 0.0198]), (0.1, [0.9874, 0.9032, 0.5666, 0.2189, 0.1818]),
    (10.0, [1.0118, 1.0803, 1.3752, 1.7745, 1.8182]),
])  # fmt: skip
def test_a_layer_on_an_array_of_discs(lam, expected):
    """Over bare, at thicknesses of 0.001 to 10 radii, from (1 + b exp(-2kt))/(1 - b exp(-2kt)) in another solver."""
    bare = array_of_discs(Body(1.0))
    found = [array_of_discs(Body(1.0, [(0.1 * t, lam)])) / bare for t in (1e-3, 1e-2, 0.1, 1.0, 10.0)]
    assert found == pytest.approx(expected, rel=3e-4, abs=6e-5)
    assert found[-1] == pytest.approx(2 * lam / (1 + lam), rel=1e-4)


@pytest.mark.parametrize("periodic", [False, True])
def test_limits_of_layers(periodic):
    """None, one of the body's own conductivity, one of no thickness, an endless one, one of two halves."""
    rng = np.random.default_rng(2)
    cells = rng.random((12, 10)) < 0.4

    def flux(*layers, lam=2.0):
        return conduct(cells, (1.0, 0.7), [Body(lam, layers), Body(5.0)], periodic=periodic)

    bare = flux()
    assert bare == pytest.approx(conduct(cells, (1.0, 0.7), 0.7, periodic=periodic), rel=1e-7)
    assert flux((0.3, 2.0), (1.0, 2.0)) == pytest.approx(bare, rel=1e-7)
    assert flux((1e-7, 30.0)) == pytest.approx(bare, rel=1e-4)
    assert flux((1e6, 30.0)) == pytest.approx(flux(lam=30.0), rel=1e-5)
    assert flux((0.4, 30.0), (0.6, 30.0), (2.0, 0.1)) == pytest.approx(flux((1.0, 30.0), (2.0, 0.1)), rel=2e-6)
    assert flux((0.4, 30.0)).sum() > flux((0.1, 30.0)).sum() > bare.sum() > flux((0.1, 0.3)).sum()


def summed_factor(k, bodies):
    """The sum of F(k) of bodies by the reflection of each interface."""
    found = 0.0
    for body in bodies:
        factor = 1 / body.lam
        for thickness, lam in reversed(body.layers):
            back = (lam - 1 / factor) / (lam + 1 / factor) * np.exp(-2 * k * thickness)
            factor = (1 + back) / (1 - back) / lam
        found += factor
    return found


def test_bodies_with_names_of_materials_have_waves_and_images():
    """Of the body, of a layer, and of both: those of the conductivities in the table."""
    steel, copper = (petsam.materials.conductivity(one) for one in ("steel", "copper"))
    k = np.array([0.0, 3.0, np.inf])
    for named, plain in [
        (Body("steel"), Body(steel)), (Body(2.0, [(0.1, "copper")]), Body(2.0, [(0.1, copper)])),
        (Body("steel", [(0.1, "copper"), ("0.2", 5)]), Body(steel, [(0.1, copper), (0.2, 5.0)])),
    ]:  # fmt: skip
        assert np.array_equal(named.resistivity(k), plain.resistivity(k)) and named.images() == plain.images()
    with pytest.raises(Error, match="conductivity 0: expected finite numbers > 0"):
        Body(0.0).resistivity(k)
    for wrong in (None, [1.0, 2.0], np.ones(2)):
        with pytest.raises(Error, match="give a number > 0, or the name of a material"):
            Body(wrong).checked()


def random_period(rng):
    """Cells, their widths, bodies and films of a small period, mirrored or not."""
    shape, mirrored = rng.integers(2, 7, 2), rng.random() < 0.5

    def fold(field):
        return np.pad(field, [(0, n) for n in field.shape], mode="symmetric") if mirrored else field

    cells, film = rng.random(shape) < rng.uniform(0.2, 1), 10 ** rng.uniform(-4, 3, shape)
    cells[0, 0] = True
    film[rng.random(shape) < 0.3] = 0.0
    film[0, 0] = 1.0
    layers = [10 ** rng.uniform(-2, 2, (rng.integers(0, 3), 2)) for _ in "12"]
    bodies = [Body(10 ** rng.uniform(-1, 1), one.tolist()) for one in layers]
    return fold(cells), tuple(10 ** rng.uniform(-1, 1, 2)), bodies, fold(film)


def test_random_periods_against_dense_matrices():
    """100 periods with layers, films that differ by orders and mirror planes or not."""
    rng = np.random.default_rng(0)
    for _ in range(100):
        cells, cell, bodies, film = random_period(rng)
        k = np.hypot(*np.meshgrid(*(2 * np.pi * np.fft.fftfreq(n, w) for n, w in zip(cells.shape[::-1], cell))))
        k[0, 0] = np.inf
        units = np.eye(cells.size).reshape(-1, *cells.shape)
        spread = np.fft.ifft2(np.fft.fft2(units) * summed_factor(k, bodies) / k).real.reshape(cells.size, -1)
        on = cells.ravel()
        matrix = (spread + np.diag(film.ravel()))[np.ix_(on, on)]
        expected = np.linalg.solve(matrix, np.ones(on.sum()))
        found = conduct(cells, cell, bodies, film, periodic=True)
        assert found[cells].sum() == pytest.approx(expected.sum(), rel=1e-9)
        assert found[cells] == pytest.approx(expected, rel=1e-4, abs=1e-6 * expected.max())


def potential_of_a_wave(k, body):
    """F(k) of a flux cos(kx), by the continuity of potential and flux; A e^(-kz) + B e^(kz) in each layer."""
    lams, depths = [lam for _, lam in body.layers] + [body.lam], np.cumsum([t for t, _ in body.layers])
    n = 2 * len(depths) + 1  # B of the half-space is 0
    matrix, right = np.zeros((n, n)), np.zeros(n)
    matrix[0, :2], right[0] = (lams[0], -lams[0]), 1.0
    for j, z in enumerate(depths):
        ways = [(2 * j, -1), (2 * j + 1, 1), (2 * j + 2, -1), (2 * j + 3, 1)]
        for (column, way), lam, side in zip(ways, np.repeat(lams[j : j + 2], 2), (1, 1, -1, -1)):
            if column < n:
                # each scaled at its own interface: decaying ones from the upper, rising ones from the lower
                upper = depths[column // 2 - 1] if column >= 2 else 0.0
                far = np.exp(-k * (z - upper)) if way < 0 else np.exp(-k * (depths[column // 2] - z))
                matrix[2 * j + 1, column] = side * far
                matrix[2 * j + 2, column] = side * lam * way * far
    matrix[0, 1] *= np.exp(-k * depths[0])
    found = np.linalg.solve(matrix, right)
    return found[0] + found[1] * np.exp(-k * depths[0])


@pytest.mark.parametrize("layers", [[(0.7, 15.0)], [(0.4, 0.05)], [(0.5, 12.0), (0.8, 0.1)]], ids=str)
def test_layers_on_half_spaces_by_hankel_transforms(layers):
    """Against a dense matrix: the potential of a point by quadrature over its waves, and over the cell by Gauss."""
    special = pytest.importorskip("scipy.special")
    cell, body, other = (1.0, 0.6), Body(2.0, layers), 5.0
    x, y = (np.ravel(part) for part in np.meshgrid(np.arange(5) * cell[0], np.arange(4) * cell[1]))
    points, shares = np.polynomial.legendre.leggauss(24)
    px, py = (np.ravel(part) for part in np.meshgrid(points * cell[0] / 2, points * cell[1] / 2))
    weights = np.outer(shares, shares).ravel() * cell[0] * cell[1] / 4
    far = np.hypot((x[:, None] - x)[..., None] + px, (y[:, None] - y)[..., None] + py)
    plain = (1 / far) @ weights / (2 * np.pi)
    plain[np.diag_indices(20)] = 4 * (0.5 * np.arcsinh(0.6) + 0.3 * np.arcsinh(1 / 0.6)) / (2 * np.pi)
    # waves beyond those that pass the first layer and return are those of its conductivity
    shortest = 36 / (2 * layers[0][0])
    k, step = np.polynomial.legendre.leggauss(300)
    k, step = shortest * (k + 1) / 2, shortest * step / 2
    beyond = np.array([potential_of_a_wave(one, body) for one in k]) - 1 / layers[0][1]
    radii, back = np.unique(np.round(far, 9), return_inverse=True)
    smooth = special.j0(radii[:, None] * k) @ (beyond * step) / (2 * np.pi)
    matrix = smooth[back].reshape(far.shape) @ weights + (1 / layers[0][1] + 1 / other) * plain
    expected = np.linalg.solve(matrix, np.ones(20)).reshape(4, 5)
    assert conduct(np.ones((4, 5)), cell, [body, Body(other)]) == pytest.approx(expected, rel=2e-5)


# ---------------------------------------------------------------- of a contact

LAYER = dict(body2_layer_young=4e11, body2_layer_poisson=0.2, body2_layer_thickness=1e-4)


def contact(**more):
    case = {name: value for name, value in {**SPHERE, **more}.items() if value is not None and name != "load_n"}
    found = petsam.Contact(**case)
    found.try_step(load_n=SPHERE["load_n"])
    found.commit()
    return found


def test_conductance_is_the_stiffness_of_the_contact():
    """G = K_zz 2/(E* (rho1 + rho2)) without a film: Barber; equal cell for cell, as both are the same operator."""
    with contact(grid_n=48) as one:
        stiffness = one.stiffness(reversal=True)[0, 0]
        modulus = petsam.closed.effective_modulus(
            *(SPHERE[f"body{k}_{w}"] for k in (1, 2) for w in ("young", "poisson"))
        )
        found = petsam.conduction.of(one, 50.0, 20.0)
        assert found.total == pytest.approx(2 * stiffness / (modulus * (1 / 50 + 1 / 20)), rel=1e-6)
        assert found.resistance == 1 / found.total and abs(found.gap) < 1e-9 * found.per_area
        assert petsam.conduction.of(one, 20.0, 50.0).total == pytest.approx(found.total, rel=1e-9)
        film = petsam.conduction.of(one, 50.0, 20.0, film=1e-5)
        area = one.number("contact_area")
        series = found.resistance + 1e-5 / area
        assert series * (1 - 1e-6) <= film.resistance <= 1.045 * series
        gas = petsam.conduction.of(one, 50.0, 20.0, gas=(0.026, 0.37e-6))
        assert gas.per_area > found.per_area and gas.gap > 0 and gas.contact < found.contact


def test_a_period_is_an_interface():
    """h is per area, and the mean wave is not part of it."""
    rng = np.random.default_rng(3)
    heights = np.cumsum(np.cumsum(rng.normal(size=(32, 32)), 0), 1)
    heights = 1e-6 * (heights - heights.min()) / np.ptp(heights)
    case = dict(bodies(), elasticity="periodic", gap_type="flat", grid_n=32, grid_size=1e-3, friction=0.0)
    with petsam.Contact(**case) as one:
        one.set_field("gap", heights)
        one.try_step(load_n=50.0)
        one.commit()
        found = petsam.conduction.of(one, 50.0, 50.0)
        stiffness = one.stiffness(reversal=True)[0, 0] / 1e-6
        young, poisson = (bodies()[f"body1_{name}"] for name in ("young", "poisson"))
        modulus = petsam.closed.effective_modulus(young, poisson, young, poisson)
        assert found.per_area == pytest.approx(2 * stiffness / (modulus * 0.04), rel=1e-5)


def test_conducting_layers_are_independent_of_elastic_ones():
    with contact(grid_n=32) as plain, contact(grid_n=32, **LAYER) as layered:
        bare = petsam.conduction.of(plain, 50.0, 20.0)
        gold = petsam.conduction.of(plain, 50.0, 20.0, layers2=[(1e-4, 300.0)])
        assert petsam.conduction.of(plain, 20.0, 50.0, layers1=[(1e-4, 300.0)]).total == pytest.approx(gold.total)
        assert bare.total < gold.total < petsam.conduction.of(plain, 50.0, 300.0).total
        own = petsam.conduction.of(layered, 50.0, 20.0, layers2=[(1e-4, 20.0)])
        assert petsam.conduction.of(layered, 50.0, 20.0, layers2=()).total == pytest.approx(own.total, rel=1e-9)
        area = [one.number("contact_area") for one in (plain, layered)]
        assert area[1] < 0.99 * area[0] and own.total < 0.995 * bare.total


def test_what_has_no_conductance_is_refused():
    with contact(grid_n=24) as one:
        for words, says in (
            (dict(lam1=0.0, lam2=1.0), "expected finite numbers > 0"),
            (dict(lam1=1.0, lam2=1.0, film=-1.0), "finite numbers >= 0"),
            (dict(lam1=1.0, lam2=1.0, gas=(0.0, 1e-6)), "a conductivity > 0"),
            (dict(lam1=1.0, lam2=1.0, layers1=[1e-6]), r"expected pairs \(thickness, conductivity\)"),
            (dict(lam1=1.0, lam2=1.0, layers1=[(1e-6, -1.0)]), "expected finite numbers > 0"),
        ):
            with pytest.raises(Error, match=says):
                petsam.conduction.of(one, **words)
    with contact(grid_n=24, **LAYER) as one:
        with pytest.raises(Error, match=r"body2_layer_\w+: give also how the layers conduct: layers2="):
            petsam.conduction.of(one, 1.0, 1.0, layers1=())
    with pytest.raises(Error, match="no cell conducts"):
        conduct(np.zeros((2, 2), bool), (1.0, 1.0), 1.0)
