"""The optimizer: Muon for kernels, AdamW for the rest."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from torch import Tensor, nn

_WEIGHT_DECAY = 0.05
_KERNEL_WEIGHT_DECAY = 0.02
_KERNEL_RATE_FACTOR = 10.0  # the learning rate of kernels, as a multiple of the rate of all other weights
_MOMENTUM = 0.95
_MIN_KERNEL_CHANNELS = 8  # Muon is used for kernels with at least this many input and output channels
_NEWTON_SCHULZ_COEFFICIENTS = 3.4445, -4.7750, 2.0315
_NEWTON_SCHULZ_STEPS = 5


class Optimizer:
    """An optimizer that updates convolution kernels with Muon, and other weights with AdamW.

    Muon (Jordan and others 2024) makes each update of a kernel nearly orthogonal: all directions of its inputs and
    outputs change equally, even those with small gradients. In the same number of steps, a network learns much more
    than with AdamW alone.

    Args:
        network: the network to train.
        rate: the maximum learning rate.
    """

    def __init__(self, network: nn.Module, rate: float) -> None:
        parameters = list(network.parameters())
        self._kernels = [
            parameter
            for parameter in parameters
            if parameter.ndim == 4 and min(parameter.shape[:2]) >= _MIN_KERNEL_CHANNELS
        ]
        self._momenta = [torch.zeros_like(kernel) for kernel in self._kernels]
        kernel_ids = {id(kernel) for kernel in self._kernels}
        other_parameters = [parameter for parameter in parameters if id(parameter) not in kernel_ids]
        groups = [
            {
                "params": [parameter for parameter in other_parameters if parameter.ndim > 1],
                "weight_decay": _WEIGHT_DECAY,
            },
            {"params": [other for other in other_parameters if other.ndim <= 1], "weight_decay": 0.0},
        ]
        self._network = network
        self._adamw = torch.optim.AdamW(groups, lr=rate, betas=(0.9, 0.98))

    def reset_gradients(self) -> None:
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
            step_size = rate * _KERNEL_RATE_FACTOR * max(1.0, len(kernel) / inputs) ** 0.5
            kernel.mul_(1 - rate * _KERNEL_RATE_FACTOR * _KERNEL_WEIGHT_DECAY)
            kernel.add_(orthogonalize(kernel.grad.lerp(momentum, _MOMENTUM)), alpha=-step_size)

    def state_dict(self) -> dict[str, Any]:
        """Return the state to store in a checkpoint."""
        return {"adamw": self._adamw.state_dict(), "momenta": self._momenta}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Restore a state that `state_dict` has returned."""
        self._adamw.load_state_dict(state["adamw"])
        for momentum, saved in zip(self._momenta, state["momenta"], strict=True):
            momentum.copy_(saved)


def orthogonalize(gradient: Tensor) -> Tensor:
    """Return a matrix near a gradient, with all singular values about 1 (Newton-Schulz).

    Args:
        gradient: the gradient of a kernel, shape (outputs, inputs, height, width). Each row of the matrix is an output.

    Returns:
        The matrix, in the shape of `gradient`.
    """
    matrix = gradient.flatten(1)
    is_tall = matrix.size(0) > matrix.size(1)
    if is_tall:
        matrix = matrix.T
    matrix = matrix / (matrix.norm() + 1e-7)
    first, second, third = _NEWTON_SCHULZ_COEFFICIENTS
    for _ in range(_NEWTON_SCHULZ_STEPS):
        gram = matrix @ matrix.T
        matrix = first * matrix + (second * gram + third * gram @ gram) @ matrix
    return (matrix.T if is_tall else matrix).reshape(gradient.shape)
