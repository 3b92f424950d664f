"""Stands in for ``xacro.substitution_args``."""

from linkwright.standins.xacro_api.substitutions import ArgException, SubstitutionException, resolve_args

__all__ = ["ArgException", "SubstitutionException", "resolve_args"]
