"""Sessions of onnxruntime for ONNX files, and explanations of load errors.

Speech and vision share them, and report errors with their own findings.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Phrase, foreign, phrase

CPU, CUDA = "CPUExecutionProvider", "CUDAExecutionProvider"

_LOG_ERRORS_ONLY = 3
_SOURCE_LOCATION_PATTERN = re.compile(r"^.* failed:\s*|/onnxruntime_src/\S+ (?:.*?\) (?=[A-Z]))?")
"""The location in onnxruntime's code that precedes the reason in its messages."""
_MISSING_WEIGHTS_PATTERN = re.compile(r"\bexternal\b|cannot get file size", re.IGNORECASE)
"""onnxruntime's messages about a missing weights file. The second is of 1.23 or older, as on Python 3.10."""

_TOO_NEW_PATTERN = re.compile(r"IR version|[Oo]pset \d+")
_HEADER_BYTES = 512
_TEXT_BYTES = frozenset(range(0x20, 0x7F)) | set(b"\t\r\n")


class UnloadableNetworkError(Exception):
    """Raised when a file cannot be loaded.

    Attributes:
        reason: the reason.
        hint: a hint, or None.
    """

    def __init__(self, reason: Phrase, hint: Phrase | None) -> None:
        super().__init__(str(reason))
        self.reason, self.hint = reason, hint


def load_onnxruntime() -> Any:
    """Import and return the untyped module ``onnxruntime``.

    Raises:
        ModuleNotFoundError: if onnxruntime is not installed.
    """
    import onnxruntime  # type: ignore[import-untyped, import-not-found, unused-ignore]

    onnxruntime.set_default_logger_severity(_LOG_ERRORS_ONLY)  # It warns about all hardware that it does not use.
    return onnxruntime


def load_session(file: Path, gpu: str | None = None, threads: int = 0) -> Any:
    """Return an ``onnxruntime.InferenceSession`` for an ONNX file.

    Args:
        file: the ONNX file.
        gpu: the CUDA number of a GPU, if `has_cuda`; None for the CPU.
        threads: CPU threads; 0 for one per core.

    Raises:
        ModuleNotFoundError: onnxruntime is not installed.
        UnloadableNetworkError: the file cannot be loaded.
    """
    onnxruntime = load_onnxruntime()
    providers: list[Any] = [CPU] if gpu is None else [(CUDA, {"device_id": gpu}), CPU]
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = threads
    options.log_severity_level = _LOG_ERRORS_ONLY
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")  # spinning would slow down other processes
    try:
        return onnxruntime.InferenceSession(str(file), options, providers=providers)
    except Exception as error:  # noqa: BLE001 - onnxruntime raises many undocumented classes
        raise _load_error(file, error) from None


def has_cuda() -> bool:
    """Return whether the installed onnxruntime was built for CUDA.

    A GPU may still be missing.

    Raises:
        ModuleNotFoundError: onnxruntime is not installed.
    """
    return CUDA in load_onnxruntime().get_available_providers()


def describe_error(error: Exception) -> Phrase:
    """Return the reason contained in an error message of onnxruntime."""
    lines = str(error).strip().splitlines() or [type(error).__name__]
    reason = _SOURCE_LOCATION_PATTERN.sub("", lines[0].rpartition(" : ")[2]).strip()
    return foreign(reason or type(error).__name__)


def _load_error(file: Path, error: Exception) -> UnloadableNetworkError:
    try:
        with file.open("rb") as stream:
            header = stream.read(_HEADER_BYTES)
    except OSError as read_error:
        return UnloadableNetworkError(foreign(read_error.strerror or read_error), None)
    export_hint = phrase("the file is damaged or incomplete: export or download it again")
    if not header:
        return UnloadableNetworkError(phrase("the file is empty"), export_hint)
    if header.startswith(b"version https://git-lfs"):
        pull_hint = phrase("run `git lfs pull`")
        return UnloadableNetworkError(phrase("it is a Git LFS pointer, not the file itself"), pull_hint)
    if header.lstrip()[:1] == b"<":
        address_hint = phrase("the address is not the download address of the file")
        return UnloadableNetworkError(phrase("it is a web page"), address_hint)
    if set(header) <= _TEXT_BYTES:
        return UnloadableNetworkError(phrase("it is a text file, not an ONNX file"), export_hint)
    reason = describe_error(error)
    if "Protobuf parsing failed" in str(reason):
        return UnloadableNetworkError(phrase("it is not an ONNX file, or it is incomplete"), export_hint)
    if _TOO_NEW_PATTERN.search(str(reason)):
        update_hint = phrase("it requires a newer onnxruntime: update onnxruntime, or export it with a lower opset")
        return UnloadableNetworkError(reason, update_hint)
    if _MISSING_WEIGHTS_PATTERN.search(str(reason)):
        weights_hint = phrase("its weights are in a second file, which must be in the same folder")
        return UnloadableNetworkError(reason, weights_hint)
    return UnloadableNetworkError(reason, export_hint)
