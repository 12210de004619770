"""examples/gradient/differentiable.py: functions of petsam.gradient in programs that jax or torch differentiate; chain
rules beside central differences."""

import sys

import numpy as np
import pytest

import petsam
from support import ROOT

sys.path.insert(0, str(ROOT / "examples" / "gradient"))
import differentiable  # noqa: E402

BALL = dict(
    body1="steel", body2="Ti-6Al-4V", gap_type="flat", grid_n=32, grid_size=2.4e-3, friction=0.4, slip_direction="end",
    allow_edge_contact=True, errors="none", normal_rtol=1e-12, tangential_rtol=1e-11,
)  # fmt: skip
HISTORY = {"time": np.arange(4.0), "load_n": np.full(4, 800.0), "load_tx": 200 * np.array([0, 1, 0, -1])}
SPHERE = np.add.outer(*2 * [((np.arange(32) + 0.5) / 32 - 0.5) ** 2]) * 2.4e-3**2 / (2 * 0.05)
WAVES = [np.tile(np.cos(2 * np.pi * k * (np.arange(32) + 0.5) / 32), (32, 1)) for k in (1, 2, 3)]
X = np.array([1.0, 2.0, 3.0])

pytestmark = pytest.mark.filterwarnings("ignore")


class Counted:
    """A function of petsam that counts its runs: friction and the heights (um) of three waves along x."""

    def __init__(self, objective):
        self.runs, scales = 0, [1, *3 * [1e-6]]
        self.evaluate = petsam.gradient.function(
            BALL, HISTORY, objective, ["friction", *WAVES], gap=SPHERE, scales=scales, rtol=1e-10
        )
        self.shape = self.evaluate.shape

    def __call__(self, x):
        self.runs += 1
        return self.evaluate(x)


def parameters(library, heights):
    """Of a profile by its heights (um) at 0, 1/3, 2/3 and 1 of the grid: its cosines, and friction that they change."""
    middle = library.sin(heights).sum() / 40 + 0.4
    turns = np.cos(np.pi * np.outer(np.arange(1, 4), np.arange(4) / 3)) / 4
    return middle, turns @ heights


def beside_differences(model, joined, find):
    """The derivative of joined(numbers) by heights, as find() has it in one run, beside differences of the model."""
    heights, step = np.array([0.3, -0.2, 0.1, 0.25]), 1e-6

    def alone(at):
        return joined(np.asarray(model(np.hstack(parameters(np, at)))[0]))

    value, slopes = find(heights)
    assert model.runs == 1
    by = [(alone(heights + step * one) - alone(heights - step * one)) / (2 * step) for one in np.eye(4)]
    assert value == pytest.approx(alone(heights), rel=1e-12)
    assert slopes == pytest.approx(by, rel=1e-6, abs=1e-6 * np.abs(by).max())


def joined(numbers):
    return numbers[0] / 1e-4 + (numbers[1] / 1e9) ** 2


def polynomials(x):
    """Two numbers of X, and their derivatives."""
    table = np.array([[0, 1, 2], [3, 4, 5]])
    return table @ x**2, 2 * table * x


# ---------------------------------------------------------------- jax


@pytest.fixture
def jax():
    """The library, in double precision as long as the test runs."""
    library = pytest.importorskip("jax", reason="jax is not installed: tests/requirements-optional.txt")
    library.config.update("jax_enable_x64", True)
    yield library
    library.config.update("jax_enable_x64", False)


@pytest.mark.parametrize("compiled", [False, True])
@pytest.mark.parametrize("several", [False, True])
def test_chain_rule_by_jax(jax, several, compiled):
    """Through the cosines of a profile, of one number and of a list, in one run."""
    model, one = Counted(["energy", "pressure_norm"] if several else "energy"), lambda number: number**2 / 1e-8
    evaluate, whole = differentiable.for_jax(model), joined if several else one
    find = jax.value_and_grad(lambda at: whole(evaluate(jax.numpy.hstack(parameters(jax.numpy, at)))))
    beside_differences(model, whole, jax.jit(find) if compiled else find)


def test_all_ways_of_jax(jax):
    """Jacobians both ways, of one point and of several; other precisions, and lists."""
    evaluate = differentiable.for_jax(polynomials, shape=(2,))
    exact = polynomials(X)[1]
    for way in (jax.jacrev, jax.jacfwd):
        assert np.allclose(way(evaluate)(X), exact) and np.allclose(jax.jit(way(evaluate))(X), exact)
        assert np.allclose(jax.vmap(way(evaluate))(np.array([X, 2 * X])), [exact, 2 * exact])
    change = jax.jvp(evaluate, (X,), (np.ones(3),))[1]
    assert np.allclose(change, exact.sum(axis=1)) and change.dtype == np.float64
    assert np.allclose(evaluate([1, 2, 3]), polynomials(X)[0])
    assert np.allclose(jax.jacrev(evaluate)(X.astype(np.float32)), exact)


def test_refusals_by_jax(jax):
    evaluate = differentiable.for_jax(polynomials, shape=(2,))
    with pytest.raises(petsam.Error, match="no second derivatives of a run"):
        jax.jacrev(jax.jacrev(evaluate))(X)
    with pytest.raises(Exception, match=r"numbers of the shape \(2,\): give shape=\(2,\)"):
        differentiable.for_jax(polynomials)(X)
    model = differentiable.for_jax(Counted("energy"))
    for x, words in (([0.4, 0, 0], r"x has the shape \(3,\): give 4 values"), ([0.1, 0, 0, 0], "gross slip")):
        with pytest.raises(Exception, match=words):
            model(x)
    jax.config.update("jax_enable_x64", False)
    with pytest.raises(petsam.Error, match='in single precision: use jax.config.update."jax_enable_x64", True'):
        evaluate(X)


# ---------------------------------------------------------------- torch


@pytest.fixture
def torch():
    return pytest.importorskip("torch", reason="torch is not installed")


@pytest.mark.parametrize("several", [False, True])
def test_chain_rule_by_torch(torch, several):
    """As by jax, by backward()."""
    model, one = Counted(["energy", "pressure_norm"] if several else "energy"), lambda number: number**2 / 1e-8
    evaluate, whole = differentiable.for_torch(model), joined if several else one

    def find(heights):
        at = torch.tensor(heights, requires_grad=True)
        middle = torch.sin(at).sum() / 40 + 0.4
        turns = torch.tensor(np.cos(np.pi * np.outer(np.arange(1, 4), np.arange(4) / 3)) / 4)
        value = whole(evaluate(torch.hstack([middle, turns @ at])))
        value.backward()
        return value.item(), at.grad.numpy()

    beside_differences(model, whole, find)


def test_all_ways_of_torch(torch):
    evaluate, x = differentiable.for_torch(polynomials), torch.tensor(X, requires_grad=True)
    assert torch.autograd.gradcheck(evaluate, (x,))
    assert torch.autograd.gradcheck(lambda at: (evaluate(torch.sin(at)) ** 2).sum(), (x,))
    exact = polynomials(X)[1]
    assert np.allclose(torch.func.jacrev(evaluate)(x).detach(), exact)
    assert np.allclose(torch.autograd.functional.jacobian(evaluate, x), exact)


def test_refusals_by_torch(torch):
    evaluate = differentiable.for_torch(polynomials)
    for x, words in (
        (X, "x is of float64: give a tensor"),
        (torch.ones(3), "give a tensor of torch.float64, x.double"),
    ):
        with pytest.raises(petsam.Error, match=words):
            evaluate(x)
    with pytest.raises(petsam.Error, match="no second derivatives of a run"):
        torch.autograd.functional.hessian(lambda at: evaluate(at).sum(), torch.tensor(X))
    with pytest.raises(petsam.Error, match="gross slip"):
        differentiable.for_torch(Counted("energy"))(torch.tensor([0.1, 0, 0, 0], dtype=torch.float64))


# ---------------------------------------------------------------- without them


@pytest.mark.parametrize("name", ["jax", "torch"])
def test_missing_library(name, monkeypatch):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(petsam.Error, match=f"{name} is not installed: .* -m pip install {name}"):
        getattr(differentiable, f"for_{name}")(polynomials)
