"""Encode animations as files."""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO

from linkwright.diagnostics import Diagnostic, LinkwrightError, missing_extra, phrase
from linkwright.images.png import apng
from linkwright.picture.rendering import Image

_WEBP_QUALITY = 88


def require_webp() -> None:
    """Raise an error if the installed Pillow cannot write WebP files.

    Raises:
        LinkwrightError: PIC120, Pillow is not installed, or has no WebP.
    """
    try:
        from PIL import features
    except ModuleNotFoundError as error:
        raise missing_extra("PIC120", error) from None
    if not features.check("webp"):
        message = phrase("cannot write WebP: the installed Pillow has no WebP")
        raise LinkwrightError(Diagnostic("PIC120", message, hint=phrase("write a .png file")))


def encode_animation(images: Sequence[Image], frame_seconds: float, ending: str) -> bytes:
    """Encode images as an endlessly repeated animation.

    Args:
        images: the images, all of the same size.
        frame_seconds: the time in s for which each image is shown.
        ending: the format, ``.png`` or ``.webp``.

    Raises:
        LinkwrightError: PIC120, WebP cannot be written.
    """
    if ending == ".png":
        return apng(images, frame_seconds)
    require_webp()
    from PIL import Image as PillowImage

    first, *other_frames = map(PillowImage.fromarray, images)
    file = BytesIO()
    first.save(
        file,
        "WEBP",
        save_all=True,
        append_images=other_frames,
        duration=round(frame_seconds * 1000),
        loop=0,
        quality=_WEBP_QUALITY,
    )
    return file.getvalue()
