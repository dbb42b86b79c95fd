"""Smooth stand-ins for a minimum and a maximum, and what their gradients do."""

from jaxtyping import Float
from torch import Tensor


def soft_minimum(values: Float[Tensor, "*batch k z"], temperature: float) -> Float[Tensor, "*batch z"]:
    r"""Give a smooth lower envelope of positive values, (sum_k v_k^(-1/T))^(-T).

    It scales as its values do, never exceeds their minimum, and reaches it as T goes to 0; the ratio is at least k^(-T). At
    T = 1 and with squared errors for values it is inverse-variance fusion. Its gradient is shared among the values in
    proportion to v_k^(-1/T - 1): at a tie of m values each gets the same share, at a value of 0 the gradient is 0 and finite.

    Args:
        values: >= 0, any unit.
        temperature: T, > 0, without unit.

    Returns:
        The envelope, in the unit of the values.
    """
    tiny = 1e-30 if values.dtype.itemsize < 8 else 1e-200
    return ((values + tiny).log() / -temperature).logsumexp(-2).mul(-temperature).exp()


def soft_maximum(values: Float[Tensor, "*batch m"], width: float) -> Float[Tensor, "*batch"]:
    """Give a smooth maximum of values of any sign, w log sum_m exp(v_m / w).

    It is never below the maximum and at most w log(m) above it. Its gradient is a softmax: shares of one that go to the
    largest values, equal at a tie.

    Args:
        values: any unit.
        width: w, > 0, in the same unit.

    Returns:
        The smooth maximum, in the unit of the values.
    """
    return (values / width).logsumexp(-1) * width
