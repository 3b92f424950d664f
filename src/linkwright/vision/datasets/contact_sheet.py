"""A contact sheet of small images with their boxes."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO

from linkwright.vision.datasets.rendering import LabeledImage

_COLUMNS, _THUMBNAIL_WIDTH = 5, 320
MAX_SHEET_IMAGES = 30
"""The maximum number of images on a sheet."""
_COLORS = ("#ffdc00", "#00d5ff", "#ff5ec4", "#7dff5c", "#ff8a3c", "#b09bff", "#ffffff", "#4affc0")
_IGNORED_COLOR = "#808080"


def make_contact_sheet(images: Sequence[LabeledImage], classes: Sequence[str]) -> bytes:
    """Return a JPEG of the first `MAX_SHEET_IMAGES` images, with each object's class and box.

    Objects that are ignored, because they are too small or too hidden, have gray boxes.
    """
    from PIL import Image, ImageDraw

    samples = sorted(images, key=lambda sample: sample.index)[:MAX_SHEET_IMAGES]
    thumbnails = []
    for sample in samples:
        image = Image.open(BytesIO(sample.data)).convert("RGB")
        scale = _THUMBNAIL_WIDTH / image.width
        image = image.resize((_THUMBNAIL_WIDTH, max(round(image.height * scale), 1)))
        draw = ImageDraw.Draw(image)
        for label in sample.labels:
            left, top, right, bottom = (scale * edge for edge in label.box)
            color = _IGNORED_COLOR if label.is_ignored else _COLORS[label.label % len(_COLORS)]
            draw.rectangle((left, top, max(right - 1, left), max(bottom - 1, top)), outline=color)
            if not label.is_ignored:
                caption = f"{classes[label.label]} {label.visibility:.0%}"
                text_box = draw.textbbox((left + 1, max(top - 11, 0)), caption)
                draw.rectangle(text_box, fill="#000000")
                draw.text((left + 1, max(top - 11, 0)), caption, fill=color)
        draw.text((3, image.height - 13), f"{sample.index:06d} {sample.split}", fill="#ffffff", stroke_width=1,
                  stroke_fill="#000000")  # fmt: skip
        thumbnails.append(image)
    height = max((image.height for image in thumbnails), default=1)
    columns = max(min(_COLUMNS, len(thumbnails)), 1)
    sheet = Image.new("RGB", (columns * _THUMBNAIL_WIDTH, max(-(-len(thumbnails) // columns), 1) * height))
    for index, image in enumerate(thumbnails):
        sheet.paste(image, (index % columns * _THUMBNAIL_WIDTH, index // columns * height))
    file = BytesIO()
    sheet.save(file, "JPEG", quality=88)
    return file.getvalue()
