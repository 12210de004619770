"""petsam.conduction: closed forms of discs, ellipses, arrays and strips, films, gas, and the contact's stiffness."""

import numpy as np
import pytest

import petsam
from petsam.conduction import conduct
from petsam.core.errors import Error
from support import SPHERE, bodies

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


# ---------------------------------------------------------------- of a contact


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


def test_what_has_no_conductance_is_refused():
    with contact(grid_n=24) as one:
        for words, says in (
            (dict(lam1=0.0, lam2=1.0), "expected numbers > 0"),
            (dict(lam1=1.0, lam2=1.0, film=-1.0), "finite numbers >= 0"),
            (dict(lam1=1.0, lam2=1.0, gas=(0.0, 1e-6)), "a conductivity > 0"),
        ):
            with pytest.raises(Error, match=says):
                petsam.conduction.of(one, **words)
    with contact(grid_n=24, body2_layer_young=4e11, body2_layer_poisson=0.2, body2_layer_thickness=1e-4) as one:
        with pytest.raises(Error, match="body2_layer_young: the flux through layers"):
            petsam.conduction.of(one, 1.0, 1.0)
    with pytest.raises(Error, match="no cell conducts"):
        conduct(np.zeros((2, 2), bool), (1.0, 1.0), 1.0)
