"""A contact sheet of small images with their boxes."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO

from linkwright.vision.datasets.making import LabelledImage

_COLUMNS, _WIDTH = 5, 320
MOST = 30
"""The number of images on a sheet."""
_COLOURS = ("#ffdc00", "#00d5ff", "#ff5ec4", "#7dff5c", "#ff8a3c", "#b09bff", "#ffffff", "#4affc0")
_IGNORED = "#808080"


def contact_sheet(images: Sequence[LabelledImage], classes: Sequence[str]) -> bytes:
    """Return a JPEG of the first `MOST` images, with the class and the visible box of each object.

    Objects of which too little is visible for a label have grey boxes.
    """
    from PIL import Image, ImageDraw

    shown = sorted(images, key=lambda taken: taken.index)[:MOST]
    small = []
    for taken in shown:
        image = Image.open(BytesIO(taken.data)).convert("RGB")
        scale = _WIDTH / image.width
        image = image.resize((_WIDTH, max(round(image.height * scale), 1)))
        draw = ImageDraw.Draw(image)
        for label in taken.labels:
            left, top, right, bottom = (scale * side for side in label.box)
            colour = _IGNORED if label.ignored else _COLOURS[label.label % len(_COLOURS)]
            draw.rectangle((left, top, max(right - 1, left), max(bottom - 1, top)), outline=colour)
            if not label.ignored:
                words = f"{classes[label.label]} {label.visibility:.0%}"
                box = draw.textbbox((left + 1, max(top - 11, 0)), words)
                draw.rectangle(box, fill="#000000")
                draw.text((left + 1, max(top - 11, 0)), words, fill=colour)
        draw.text((3, image.height - 13), f"{taken.index:06d} {taken.split}", fill="#ffffff", stroke_width=1,
                  stroke_fill="#000000")  # fmt: skip
        small.append(image)
    height = max((image.height for image in small), default=1)
    columns = max(min(_COLUMNS, len(small)), 1)
    sheet = Image.new("RGB", (columns * _WIDTH, max(-(-len(small) // columns), 1) * height))
    for place, image in enumerate(small):
        sheet.paste(image, (place % columns * _WIDTH, place // columns * height))
    file = BytesIO()
    sheet.save(file, "JPEG", quality=88)
    return file.getvalue()
