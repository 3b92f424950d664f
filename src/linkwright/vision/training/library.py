"""The check for PyTorch, which the extra ``train`` installs."""

from __future__ import annotations

from importlib import import_module

from linkwright.diagnostics import missing_extra


def require_pytorch() -> None:
    """Check that PyTorch and its ONNX exporter are installed.

    Raises:
        LinkwrightError: VISION301, PyTorch or its ONNX exporter is not installed.
    """
    try:
        for name in ("torch", "onnx"):
            import_module(name)
    except ModuleNotFoundError as error:
        raise missing_extra("VISION301", error) from None
