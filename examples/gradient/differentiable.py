"""Functions of petsam.gradient in programs that jax or torch differentiate: for_jax(), for_torch().

import petsam
from differentiable import for_jax  # with examples/gradient on the PYTHONPATH
energy = for_jax(petsam.gradient.function(options, history, "energy", ["friction", "load_tx"]))
jax.grad(lambda logarithms: energy(jax.numpy.exp(logarithms)))
"""

from typing import Any, Callable, Optional

import numpy as np
from numpy.typing import ArrayLike

import petsam
from petsam.core.errors import library

NO_SECOND = "there are no second derivatives of a run"


def for_jax(
    evaluate: Callable[[ArrayLike], tuple[Any, np.ndarray]], shape: Optional[tuple[int, ...]] = None
) -> Callable[[Any], Any]:
    """A function that jax differentiates, of one that returns a number, or several, and the derivatives.

    jax.grad, jax.value_and_grad, jax.jit, jax.jvp, jax.jacfwd, jax.jacrev and, one after the other, jax.vmap take it.
    Value and derivatives come from one call of evaluate: a run, and a pass back for each number. There are no second
    derivatives.

    Parameters
    ----------
    evaluate : callable
        x -> (number, derivatives), as petsam.gradient.function() returns it.
    shape : tuple of int, optional
        Of its numbers, () if it is one; None: as petsam.gradient.function() made it, otherwise one.

    Returns
    -------
    callable
        x (parameters,) -> number, or numbers, of double precision.

    Raises
    ------
    Error
        If jax, of which 0.4.35 is enough, is not installed; by a call, if it computes in single precision. An error of
        a run reaches the caller as one of jax, which has its message.
    """
    jax = library("jax")
    shape = getattr(evaluate, "shape", ()) if shape is None else tuple(shape)

    def of_shape(x):
        found = _doubles(evaluate)(x)
        if found[0].shape != shape:
            raise petsam.Error(
                f"the function returns numbers of the shape {found[0].shape}: give shape={found[0].shape}"
            )
        return found

    @jax.custom_jvp
    def run(x):
        outcome = [jax.ShapeDtypeStruct(both, np.float64) for both in (shape, (*shape, *x.shape))]
        return jax.pure_callback(of_shape, outcome, x, vmap_method="sequential")

    @run.defjvp
    def rejected(point, change):
        raise petsam.Error(NO_SECOND)

    @jax.custom_jvp
    def value(x):
        return run(x)[0]

    @value.defjvp
    def value_and_change(point, change):
        number, slopes = run(*point)
        return number, slopes @ change[0]

    def differentiable(x):
        if not jax.config.jax_enable_x64:
            raise petsam.Error('jax computes in single precision: use jax.config.update("jax_enable_x64", True)')
        return value(jax.numpy.asarray(x, np.float64))

    return differentiable


def for_torch(evaluate: Callable[[ArrayLike], tuple[Any, np.ndarray]]) -> Callable[[Any], Any]:
    """A function that torch differentiates, of one that returns a number, or several, and the derivatives.

    Value and derivatives come from one call of evaluate: a run, and a pass back for each number. There are no second
    derivatives.

    Parameters
    ----------
    evaluate : callable
        x -> (number, derivatives), as petsam.gradient.function() returns it.

    Returns
    -------
    callable
        x, a tensor (parameters,) of torch.float64 -> a tensor of the number, or of the numbers.

    Raises
    ------
    Error
        If torch, of which 2.0 is enough, is not installed; by a call, if x has another precision.
    """
    torch = library("torch")

    class Slopes(torch.autograd.Function):
        generate_vmap_rule = True

        @staticmethod
        def forward(x, slopes):
            return slopes.clone()

        @staticmethod
        def setup_context(ctx, inputs, output):
            pass

        @staticmethod
        def backward(ctx, weight):
            raise petsam.Error(NO_SECOND)

    class Run(torch.autograd.Function):
        @staticmethod
        def forward(x):
            return tuple(x.new_tensor(part) for part in _doubles(evaluate)(x.detach().cpu()))

        @staticmethod
        def setup_context(ctx, inputs, output):
            ctx.mark_non_differentiable(output[1])
            ctx.save_for_backward(*inputs, output[1])

        @staticmethod
        def backward(ctx, weight, _):
            return torch.tensordot(weight, Slopes.apply(*ctx.saved_tensors), dims=weight.dim())

    def differentiable(x):
        if getattr(x, "dtype", None) is not torch.float64:
            raise petsam.Error(
                f"x is of {getattr(x, 'dtype', type(x).__name__)}: give a tensor of torch.float64, x.double()"
            )
        return Run.apply(x)[0]

    return differentiable


def _doubles(evaluate):
    """The function with arrays of doubles, whatever array x is."""
    return lambda x: tuple(np.asarray(part, dtype=float) for part in evaluate(np.asarray(x, dtype=float)))
