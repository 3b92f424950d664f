"""Images of a camera of this machine, or of a video file, through OpenCV."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase
from linkwright.vision.detectors.library import load_opencv

Frame = NDArray[np.uint8]
"""An image, shape (height, width, 3), channels in the order BGR."""

DEVICE_FOLDER = "/dev/"
_MAX_MISSED_FRAMES = 100
_RETRY_PERIOD_S = 0.01
_JOIN_TIMEOUT_S = 5.0


def is_device(path: str) -> bool:
    """Return whether a path is that of a device; a video file can also be below ``/dev``, in ``/dev/shm``."""
    return Path(path).is_char_device()


class VideoSource:
    """An open camera or video file.

    Attributes:
        is_file: whether it is a video file.
        rate_hz: the frame rate that the file or device reports; 0 if it reports none.

    Args:
        path: a device such as ``/dev/video0``, or a video file.
        size: the requested width and height; a file keeps its own.
        pixel_format: the requested format of the device, such as ``YUYV``; empty for its own.
        rate_hz: the requested frame rate; 0 for the device's own.

    Raises:
        LinkwrightError: VISION101, OpenCV is missing; VISION115, the device or file cannot be opened.
    """

    def __init__(self, path: str, size: tuple[int, int], pixel_format: str = "", rate_hz: float = 0.0) -> None:
        self._cv2: Any = load_opencv()
        self._path = path
        self.is_file = not is_device(path)
        self._capture = self._open(size, pixel_format, rate_hz)
        self.rate_hz: float = self._capture.get(self._cv2.CAP_PROP_FPS)
        self._thread: threading.Thread | None = None
        self._is_closing = threading.Event()

    def set_controls(self, values: Mapping[str, float]) -> list[str]:
        """Set controls of the device by OpenCV's names, such as ``BRIGHTNESS``, and return those that it refuses."""
        properties = {name: getattr(self._cv2, f"CAP_PROP_{name}") for name in values}
        return [name for name, value in values.items() if not self._capture.set(properties[name], value)]

    def read(self) -> Frame | None:
        """Return the next image, or None if there is none. A file starts again at its end."""
        is_read, frame = self._capture.read()
        if not is_read and self.is_file:
            self._capture.set(self._cv2.CAP_PROP_POS_FRAMES, 0)
            is_read, frame = self._capture.read()
        return frame if is_read else None

    def start(self, on_frame: Callable[[Frame], None], on_end: Callable[[], None]) -> None:
        """Read the images of a device in a thread, which calls the functions: with each image, and when it is lost."""

        def run() -> None:
            missed_frames = 0
            while not self._is_closing.is_set():
                frame = self.read()
                missed_frames = 0 if frame is not None else missed_frames + 1
                if missed_frames > _MAX_MISSED_FRAMES:
                    on_end()
                    return
                if frame is None:
                    self._is_closing.wait(_RETRY_PERIOD_S)
                else:
                    on_frame(frame)

        self._thread = threading.Thread(target=run, name=f"camera {self._path}", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop reading, and close the device or file."""
        self._is_closing.set()
        if self._thread is not None:
            self._thread.join(_JOIN_TIMEOUT_S)
            if self._thread.is_alive():
                return  # closing a capture that another thread reads would crash
        self._capture.release()

    def _open(self, size: tuple[int, int], pixel_format: str, rate_hz: float) -> Any:
        cv2 = self._cv2
        if not Path(self._path).exists():
            raise self._error(phrase("there is no such file or device"))
        with _silenced(cv2):
            backend = cv2.CAP_ANY if self.is_file else cv2.CAP_V4L2
            capture = cv2.VideoCapture(self._path, backend)
        if not capture.isOpened():
            reason = phrase("it is not a camera, or another program uses it")
            raise self._error(phrase("it is not a video") if self.is_file else reason)
        if not self.is_file:
            if pixel_format:
                capture.set(cv2.CAP_PROP_FOURCC, cv2.VideoWriter_fourcc(*pixel_format))
            capture.set(cv2.CAP_PROP_FRAME_WIDTH, size[0])
            capture.set(cv2.CAP_PROP_FRAME_HEIGHT, size[1])
            if rate_hz:
                capture.set(cv2.CAP_PROP_FPS, rate_hz)
        return capture

    def _error(self, reason: Phrase) -> LinkwrightError:
        message = phrase("camera '{path}' cannot be opened: {reason}", path=self._path, reason=reason)
        devices = sorted(str(device) for device in Path(DEVICE_FOLDER).glob("video*"))
        hint = phrase("set video_device to {names}, or to a video file", names=", ".join(devices))
        if not devices:
            hint = phrase("this machine has no camera: set video_device to a video file")
        return LinkwrightError(Diagnostic("VISION115", message, hint=hint))


@contextlib.contextmanager
def _silenced(cv2: Any) -> Iterator[None]:
    """Suppress the messages of OpenCV, which do not tell more than the error of this module."""
    level = cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
    try:
        yield
    finally:
        cv2.utils.logging.setLogLevel(level)
