"""Networks in ONNX files, loaded by onnxruntime; what is wrong with a file that it does not load."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, foreign, phrase
from linkwright.vision.detectors.devices import gpu_of
from linkwright.vision.detectors.library import load_onnxruntime

_CPU, _CUDA = "CPUExecutionProvider", "CUDAExecutionProvider"
_OF_THE_LIBRARY = re.compile(r"^.* failed:\s*|/onnxruntime_src/\S+ (?:.*?\) (?=[A-Z]))?")
"""Where in onnxruntime's own code something failed, which stands before the reason."""
_TOO_NEW = re.compile(r"IR version|[Oo]pset \d+")
_START = 512
_TEXT = frozenset(range(0x20, 0x7F)) | set(b"\t\r\n")


def load_session(file: Path, device: str) -> tuple[Any, list[Phrase]]:
    """An ``onnxruntime.InferenceSession``, and what its user should be told once.

    Args:
        file: the ONNX file.
        device: ``cpu``, ``cuda``, ``cuda:0``, ``0``; the CPU where onnxruntime has no CUDA.

    Raises:
        LinkwrightError: VISION101 onnxruntime is missing, VISION103 the file cannot be loaded, VISION109 there is no
            such device.
    """
    onnxruntime = load_onnxruntime()
    providers: list[Any] = [_CPU]
    notes: list[Phrase] = []
    gpu = gpu_of(device)
    if gpu is not None:
        if _CUDA in onnxruntime.get_available_providers():
            providers.insert(0, (_CUDA, {"device_id": gpu}))
        else:
            notes.append(phrase("onnxruntime has no '{device}' here; the network runs on the CPU", device=device))
    how = onnxruntime.SessionOptions()
    how.add_session_config_entry("session.intra_op.allow_spinning", "0")  # others need the processor, too
    try:
        return onnxruntime.InferenceSession(str(file), how, providers=providers), notes
    except Exception as error:  # noqa: BLE001 - of many classes, which onnxruntime does not document
        raise _unloadable(file, error) from None


def reason_of(error: Exception) -> Phrase:
    """Of what onnxruntime says the part that is the reason."""
    lines = str(error).strip().splitlines() or [type(error).__name__]
    said = _OF_THE_LIBRARY.sub("", lines[0].rpartition(" : ")[2]).strip()
    return foreign(said or type(error).__name__)


def _unloadable(file: Path, error: Exception) -> LinkwrightError:
    """The error for a file that is not loaded: VISION103."""
    try:
        with file.open("rb") as opened:
            start = opened.read(_START)
    except OSError as unread:
        return _error(file, foreign(unread.strerror or unread), None)
    export = phrase("the file is broken or not whole: export or fetch it anew")
    if not start:
        return _error(file, phrase("the file is empty"), export)
    if start.startswith(b"version https://git-lfs"):
        return _error(file, phrase("it is a pointer of Git LFS, not the file itself"), phrase("run `git lfs pull`"))
    if start.lstrip()[:1] == b"<":
        return _error(
            file, phrase("it is a web page"), phrase("the address that it was fetched from is not that of the file")
        )
    if set(start) <= _TEXT:
        return _error(file, phrase("it is a text, not an ONNX file"), export)
    reason = reason_of(error)
    if "Protobuf parsing failed" in str(reason):
        return _error(file, phrase("it is no ONNX file, or not whole"), export)
    if _TOO_NEW.search(str(reason)):
        newer = phrase("it is made for a newer onnxruntime: update onnxruntime, or export it with a lower opset")
        return _error(file, reason, newer)
    if "external" in str(reason):
        return _error(file, reason, phrase("its weights are in a second file, which has to stand beside it"))
    return _error(file, reason, export)


def _error(file: Path, reason: Phrase, hint: Phrase | None) -> LinkwrightError:
    message = phrase("cannot load the network in '{file}': {reason}", file=file, reason=reason)
    return LinkwrightError(Diagnostic("VISION103", message, hint=hint))
