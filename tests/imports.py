"""The modules that a program loads."""

from __future__ import annotations

import subprocess
import sys

_ALWAYS = "import importlib"
"""The modules that every program imports; Python 3.10 loads more than later versions."""


def loaded_by(code: str) -> set[str]:
    """Return the modules that a process loads for some code.

    The modules that `_ALWAYS` loads are left out.
    """
    return _modules(code) - _modules(_ALWAYS)


def rooms_of(loaded: set[str]) -> set[str]:
    """Return the rooms of Linkwright to which modules belong."""
    return {name.split(".")[1] for name in loaded if name.startswith("linkwright.") and name.count(".") > 1}


def _modules(code: str) -> set[str]:
    program = f"import sys; {code}; print(*sys.modules, file=sys.stderr)"
    result = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    return set(result.stderr.splitlines()[-1].split())
