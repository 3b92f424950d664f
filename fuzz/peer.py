"""Expands with PyPI's xacro, for comparison; runs in an environment of its own, on line-wise JSON requests.

A request is ``{"path": ..., "arguments": {...}, "packages": {...}}``, and with ``"folder"`` the path is one in that
folder; the answer is ``{"text": ...}`` or ``{"error": ...}``.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import signal
import sys
import types

SECONDS = 5.0
"""Of the processor, for one file: other programs on the machine make nothing fail."""


def install_packages(packages: dict[str, str]) -> None:
    """Install a stand-in for ``ament_index_python`` that knows some packages."""
    module = types.ModuleType("ament_index_python")
    inner = types.ModuleType("ament_index_python.packages")

    class PackageNotFoundError(KeyError):
        """No such package."""

    def get_package_share_directory(name: str) -> str:
        if name not in packages:
            raise PackageNotFoundError(name)
        return packages[name]

    inner.PackageNotFoundError = PackageNotFoundError  # type: ignore[attr-defined]
    inner.get_package_share_directory = get_package_share_directory  # type: ignore[attr-defined]
    module.packages = inner  # type: ignore[attr-defined]
    sys.modules["ament_index_python"] = module
    sys.modules["ament_index_python.packages"] = inner


def answer(request: dict[str, object]) -> dict[str, str]:
    """Return the expansion of one file, or the error."""
    import xacro  # type: ignore[import-not-found]  # that of ROS, in an environment of its own

    install_packages(request["packages"])  # type: ignore[arg-type]  # JSON from differential.py
    os.chdir(request.get("folder", "."))  # type: ignore[arg-type]  # JSON too
    with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        try:
            document = xacro.process_file(request["path"], mappings=dict(request["arguments"]))  # type: ignore[call-overload]
            return {"text": document.toprettyxml(indent="  ")}
        except BaseException as error:  # noqa: BLE001 - it raises anything
            return {"error": f"{type(error).__name__}: {error}"[:500]}
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)


def main() -> None:
    """Answer requests until there are no more."""

    def stop(*_: object) -> None:
        raise TimeoutError("too slow")

    signal.signal(signal.SIGPROF, stop)
    output = sys.stdout
    for line in sys.stdin:
        output.write(json.dumps(answer(json.loads(line))) + "\n")
        output.flush()


if __name__ == "__main__":
    main()
