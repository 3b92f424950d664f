"""Stands in for ``launch.utilities.typing_file_path``."""

from linkwright.launch.class_checks import FilePath

__all__ = ["FilePath"]
