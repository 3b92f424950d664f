"""Stands in for ``launch.utilities.typing_file_path``."""

from linkwright.launch.class_checks import FilePath
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["FilePath"]
