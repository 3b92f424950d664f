"""Stands in for ``launch.substitutions.file_content``."""

from linkwright.launch.substitutions import FileContent
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["FileContent"]
