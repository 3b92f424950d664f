"""A dataset of colored shapes, small enough for training in a test."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

NAMES = ("disc", "square")


def write_shapes(folder: Path, count: int, *, names: tuple[str, ...] = NAMES, size: int = 96, seed: int = 1) -> Path:
    """Write `count` images with labels, and return the folder.

    Both parts of the dataset use them.
    """
    rng = np.random.default_rng(seed)
    (folder / "images" / "train").mkdir(parents=True)
    (folder / "labels" / "train").mkdir(parents=True)
    listed = "".join(f"  {number}: {name}\n" for number, name in enumerate(names))
    (folder / "data.yaml").write_text(f"path: .\ntrain: images/train\nval: images/train\nnames:\n{listed}")
    rows, columns = np.mgrid[0:size, 0:size]
    for number in range(count):
        pixels = np.full((size, size, 3), rng.integers(60, 120, 3), np.uint8)
        lines = []
        for kind, half_size in enumerate((size // 6, size // 5)):
            x, y = (
                int(rng.integers(half_size, size // 2 - half_size + 1)) + kind * size // 2,
                int(rng.integers(half_size, size - half_size)),
            )
            inside = (columns - x) ** 2 + (rows - y) ** 2 <= half_size**2 if kind == 0 else (
                np.maximum(abs(columns - x), abs(rows - y)) <= half_size
            )  # fmt: skip
            pixels[inside] = (230, 40, 40) if kind == 0 else (40, 90, 230)
            box_size = (2 * half_size + 1) / size
            lines.append(f"{kind} {(x + 0.5) / size} {(y + 0.5) / size} {box_size} {box_size}")
        Image.fromarray(pixels).save(folder / "images" / "train" / f"{number:03}.png")
        (folder / "labels" / "train" / f"{number:03}.txt").write_text("\n".join(lines) + "\n")
    return folder
