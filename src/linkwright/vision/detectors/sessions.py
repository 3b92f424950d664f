"""Sessions of onnxruntime on a device."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, missing_extra, phrase
from linkwright.model_files.onnx_sessions import CUDA, UnloadableNetworkError, has_cuda, load_session
from linkwright.vision.detectors.devices import parse_gpu


def create_session(file: Path, device: str) -> tuple[Any, list[Phrase]]:
    """Return an ``onnxruntime.InferenceSession``, and remarks for the user.

    Args:
        file: the ONNX file.
        device: ``cpu``, ``cuda``, ``cuda:0``, ``0``; without such a GPU the CPU is used.

    Raises:
        LinkwrightError: VISION101 onnxruntime is missing, VISION103 the file cannot be loaded, VISION109 the device has
            a wrong form.
    """
    gpu = parse_gpu(device)
    try:
        uses_cuda = gpu is not None and has_cuda()
        session = load_session(file, gpu if uses_cuda else None)
    except ModuleNotFoundError as error:
        raise missing_extra("VISION101", error) from None
    except UnloadableNetworkError as error:
        message = phrase("cannot load the network in '{file}': {reason}", file=file, reason=error.reason)
        raise LinkwrightError(Diagnostic("VISION103", message, hint=error.hint)) from None
    if gpu is None or (uses_cuda and CUDA in session.get_providers()):
        return session, []
    if uses_cuda:
        note = phrase("CUDA does not work with '{device}' on this machine; the network runs on the CPU", device=device)
    else:
        note = phrase(
            "this installation of onnxruntime does not support '{device}'; the network runs on the CPU", device=device
        )
    return session, [note]
