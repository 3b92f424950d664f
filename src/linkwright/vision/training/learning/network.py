"""The network: a small anchor-free detector that two CPU cores train in an hour.

A backbone of half-stages (as in CSPNet, Wang and others 2019) computes features for cells of 8, 16 and 32 pixels. A
pyramid passes coarse features to the fine ones and back (PANet, Liu and others 2018). One head per scale predicts for
each cell the class, and the distances of the four sides of a box from the cell's center (FCOS, Tian and others 2019).
Depthwise convolutions would have fewer weights, but a CPU computes dense convolutions with few channels in the same
time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import torch
from torch import Tensor, nn
from torch.nn import functional

STRIDES = (8, 16, 32)
"""The size of a cell in pixels of the image, for each level of the pyramid."""

_CPU = torch.device("cpu")
_INITIAL_SCORE = 0.01  # the initial score of all cells: low, so that the many empty ones do not dominate the loss
_MAX_LOG_DISTANCE = 4.0  # a side is at most e ** this many strides from its cell


@dataclass(frozen=True, slots=True)
class Shape:
    """The dimensions of a network, as stored in a checkpoint.

    Attributes:
        classes: the number of classes.
        channels: the channels of the first convolution; the other layers have multiples of it.
    """

    classes: int
    channels: int


class Convolution(nn.Module):
    """A convolution with normalization and SiLU."""

    def __init__(self, inputs: int, outputs: int, size: int = 1, stride: int = 1) -> None:
        super().__init__()
        self.convolution = nn.Conv2d(inputs, outputs, size, stride, size // 2, bias=False)
        self.norm = nn.BatchNorm2d(outputs, eps=1e-3, momentum=0.03)

    def forward(self, features: Tensor) -> Tensor:
        """Apply the convolution, the normalization and SiLU.

        The shape (batch, inputs, height, width) becomes (batch, outputs, height / stride, width / stride).
        """
        return functional.silu(self.norm(self.convolution(features)), inplace=True)


class HalfStage(nn.Module):
    """Residual blocks that process one half of the channels; the other half bypasses them."""

    def __init__(self, inputs: int, outputs: int, blocks: int, *, residual: bool = True) -> None:
        super().__init__()
        half = outputs // 2
        self.split = Convolution(inputs, 2 * half)
        self.blocks = nn.ModuleList(
            nn.Sequential(Convolution(half, half, 3), Convolution(half, half, 3)) for _ in range(blocks)
        )
        self.join = Convolution(2 * half, outputs)
        self.residual = residual

    def forward(self, features: Tensor) -> Tensor:
        """Return features of the same height and width, with `outputs` channels."""
        bypassed, processed = self.split(features).chunk(2, 1)
        for block in self.blocks:
            processed = processed + block(processed) if self.residual else block(processed)
        return self.join(torch.cat((bypassed, processed), 1))


class Pooling(nn.Module):
    """Spatial pyramid pooling (SPPF), which concatenates zero to three chained poolings."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.narrow = Convolution(channels, channels // 2)
        self.pool = nn.MaxPool2d(5, 1, 2)
        self.join = Convolution(channels * 2, channels)

    def forward(self, features: Tensor) -> Tensor:
        """Return pooled features of the same shape."""
        features_by_scale = [self.narrow(features)]
        for _ in range(3):
            features_by_scale.append(self.pool(features_by_scale[-1]))
        return self.join(torch.cat(features_by_scale, 1))


class Head(nn.Module):
    """The layers that predict boxes and classes for each cell of one scale."""

    def __init__(self, channels: int, classes: int) -> None:
        super().__init__()
        self.shared = Convolution(channels, channels, 3)
        self.box = nn.Sequential(Convolution(channels, channels // 2, 3), nn.Conv2d(channels // 2, 4, 1))
        self.scores = nn.Sequential(Convolution(channels, channels // 2, 3), nn.Conv2d(channels // 2, classes, 1))
        nn.init.constant_(self.scores[-1].bias, -math.log((1 - _INITIAL_SCORE) / _INITIAL_SCORE))
        nn.init.constant_(self.box[-1].bias, 1.0)

    def forward(self, features: Tensor) -> Tensor:
        """Return the log distances of the four sides, and the class logits.

        The shape is (batch, 4 + classes, cells).
        """
        shared = self.shared(features)
        boxes, scores = self.box[0](shared), self.scores[0](shared)
        # bfloat16 has 8 significant bits, so the side distances would be off by up to 1 %.
        with torch.autocast(features.device.type, enabled=False):
            return torch.cat((self.box[1](boxes.float()), self.scores[1](scores.float())), 1).flatten(2)


class Network(nn.Module):
    """The whole network, from images to predictions for each cell."""

    def __init__(self, shape: Shape) -> None:
        super().__init__()
        self.shape = shape
        c = shape.channels
        self.stem = nn.Sequential(Convolution(3, c, 3, 2), Convolution(c, 2 * c, 3, 2), HalfStage(2 * c, 2 * c, 1))
        self.fine = nn.Sequential(Convolution(2 * c, 4 * c, 3, 2), HalfStage(4 * c, 4 * c, 2))
        self.middle = nn.Sequential(Convolution(4 * c, 8 * c, 3, 2), HalfStage(8 * c, 8 * c, 2))
        self.coarse = nn.Sequential(
            Convolution(8 * c, 12 * c, 3, 2), HalfStage(12 * c, 12 * c, 1), Pooling(12 * c), Convolution(12 * c, 8 * c)
        )
        self.down_middle = HalfStage(16 * c, 8 * c, 1, residual=False)
        self.narrow = Convolution(8 * c, 4 * c)
        self.down_fine = HalfStage(8 * c, 4 * c, 1, residual=False)
        self.halve_fine = Convolution(4 * c, 4 * c, 3, 2)
        self.up_middle = HalfStage(8 * c, 8 * c, 1, residual=False)
        self.halve_middle = Convolution(8 * c, 8 * c, 3, 2)
        self.up_coarse = HalfStage(16 * c, 8 * c, 1, residual=False)
        self.heads = nn.ModuleList(Head(width * c, shape.classes) for width in (4, 8, 8))

    def forward(self, images: Tensor) -> tuple[Tensor, Tensor]:
        """Return the predictions for a batch of images.

        Args:
            images: shape (batch, 3, height, width), red, green, blue between 0 and 1; both sides are multiples of 32.

        Returns:
            Boxes, shape (batch, cells, 4), left, top, right, bottom in pixels; and logits of the classes, shape
            (batch, cells, classes).
        """
        fine = self.fine(self.stem(images))
        middle = self.middle(fine)
        coarse = self.coarse(middle)
        middle = self.down_middle(torch.cat((_upsample(coarse), middle), 1))
        narrow = self.narrow(middle)
        fine = self.down_fine(torch.cat((_upsample(narrow), fine), 1))
        middle = self.up_middle(torch.cat((self.halve_fine(fine), narrow), 1))
        coarse = self.up_coarse(torch.cat((self.halve_middle(middle), coarse), 1))
        levels = [head(level) for head, level in zip(self.heads, (fine, middle, coarse), strict=True)]
        outputs = torch.cat(levels, 2).transpose(1, 2)
        centers, strides = make_cells(images.shape[3], images.shape[2], images.device)
        distances = outputs[..., :4].clamp(max=_MAX_LOG_DISTANCE).exp() * strides
        boxes = torch.cat((centers - distances[..., :2], centers + distances[..., 2:]), 2)
        return boxes, outputs[..., 4:]


def _upsample(features: Tensor) -> Tensor:
    return functional.interpolate(features, scale_factor=2.0, mode="nearest")


@cache
def make_cells(width: int, height: int, device: torch.device = _CPU) -> tuple[Tensor, Tensor]:
    """Return the centers and strides of the cells of all scales, for an image size in pixels.

    Returns:
        The centers in pixels, shape (cells, 2), and the strides in pixels, shape (cells, 1).
    """
    centers, strides = [], []
    for stride in STRIDES:
        rows, columns = height // stride, width // stride
        y, x = torch.meshgrid(torch.arange(rows), torch.arange(columns), indexing="ij")
        centers.append((torch.stack((x, y), 2).reshape(-1, 2) + 0.5) * stride)
        strides.append(torch.full((rows * columns, 1), float(stride)))
    return torch.cat(centers).to(device), torch.cat(strides).to(device)
