"""Stands in for ``launch.substitutions.python_expression``."""

from linkwright.launch.substitutions import PythonExpression
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["PythonExpression"]
