"""The optimizer: Muon for kernels, AdamW for the rest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from torch import Tensor, nn

_DECAY = 0.05
_KERNEL_DECAY = 0.02
_KERNEL_RATE = 10.0  # the learning rate of kernels, as a multiple of the rate of all other weights
_MOMENTUM = 0.95
_LEAST = 8  # Muon is used for kernels with at least this many input and output channels
_POLYNOMIAL = 3.4445, -4.7750, 2.0315
_ROUNDS = 5


class Optimizer:
    """Muon (Jordan and others 2024) for the kernels of convolutions, AdamW for the rest.

    Muon makes each update of a kernel nearly orthogonal: all directions of its inputs and outputs change equally,
    including those with small gradients. In the same few steps, networks learn much more with Muon than with AdamW
    alone.

    Args:
        network: the network to train.
        rate: the highest learning rate.
    """

    def __init__(self, network: nn.Module, rate: float) -> None:
        every = list(network.parameters())
        self._kernels = [parameter for parameter in every if parameter.ndim == 4 and min(parameter.shape[:2]) >= _LEAST]
        self._momenta = [torch.zeros_like(kernel) for kernel in self._kernels]
        kernels = {id(kernel) for kernel in self._kernels}
        others = [parameter for parameter in every if id(parameter) not in kernels]
        groups = [
            {"params": [other for other in others if other.ndim > 1], "weight_decay": _DECAY},
            {"params": [other for other in others if other.ndim <= 1], "weight_decay": 0.0},
        ]
        self._network = network
        self._adamw = torch.optim.AdamW(groups, lr=rate, betas=(0.9, 0.98))

    def forget_gradients(self) -> None:
        """Reset the gradients before a step."""
        self._network.zero_grad(set_to_none=True)

    @torch.no_grad()
    def step(self, rate: float) -> None:
        """Update all weights from their gradients, at the given learning rate."""
        for group in self._adamw.param_groups:
            group["lr"] = rate
        self._adamw.step()
        for kernel, momentum in zip(self._kernels, self._momenta, strict=True):
            if kernel.grad is None:
                continue
            momentum.lerp_(kernel.grad, 1 - _MOMENTUM)
            inputs = kernel[0].numel()
            size = rate * _KERNEL_RATE * max(1.0, len(kernel) / inputs) ** 0.5
            kernel.mul_(1 - rate * _KERNEL_RATE * _KERNEL_DECAY)
            kernel.add_(orthogonal(kernel.grad.lerp(momentum, _MOMENTUM)), alpha=-size)

    def state_dict(self) -> dict[str, Any]:
        """Return the state to store in a checkpoint."""
        return {"adamw": self._adamw.state_dict(), "momenta": self._momenta}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Restore a state that `state_dict` returned."""
        self._adamw.load_state_dict(state["adamw"])
        for mine, other in zip(self._momenta, state["momenta"], strict=True):
            mine.copy_(other)


def orthogonal(gradient: Tensor) -> Tensor:
    """Return the matrix nearest to a kernel with all singular values about 1 (Newton-Schulz iteration).

    Args:
        gradient: shape (outputs, inputs, height, width); its rows are the outputs.

    Returns:
        The same shape.
    """
    matrix = gradient.flatten(1)
    upright = matrix.size(0) > matrix.size(1)
    if upright:
        matrix = matrix.T
    matrix = matrix / (matrix.norm() + 1e-7)
    first, second, third = _POLYNOMIAL
    for _ in range(_ROUNDS):
        square = matrix @ matrix.T
        matrix = first * matrix + (second * square + third * square @ square) @ matrix
    return (matrix.T if upright else matrix).reshape(gradient.shape)
