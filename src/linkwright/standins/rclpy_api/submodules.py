"""Submodules that programs use after ``import rclpy`` alone: the real package imports most of its own."""

from __future__ import annotations

import importlib
import pkgutil
import sys
from types import ModuleType


def submodule(name: str) -> ModuleType:
    """The module of this name in the package ``rclpy``, as its ``__getattr__``.

    Raises:
        AttributeError: there is none.
    """
    if any(module.name == name for module in pkgutil.iter_modules(sys.modules["rclpy"].__path__)):
        return importlib.import_module(f"rclpy.{name}")
    raise AttributeError(f"module 'rclpy' has no attribute '{name}'")
