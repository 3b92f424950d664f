"""The repository's tools as modules: they are scripts, in no package."""

from __future__ import annotations

import importlib.util
import sys
from types import ModuleType

from tests.places import REPOSITORY

TOOLS = REPOSITORY / "tools"


def load_tool(name: str) -> ModuleType:
    """Return the module of ``tools/NAME.py``."""
    specification = importlib.util.spec_from_file_location(name, TOOLS / f"{name}.py")
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module  # dataclasses look up their module there
    specification.loader.exec_module(module)
    return module
