"""Stands in for ``launch.substitutions.python_expression``."""

from linkwright.launch.substitutions import PythonExpression

__all__ = ["PythonExpression"]
