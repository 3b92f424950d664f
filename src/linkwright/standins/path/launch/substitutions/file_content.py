"""Stands in for ``launch.substitutions.file_content``."""

from linkwright.launch.substitutions import FileContent

__all__ = ["FileContent"]
