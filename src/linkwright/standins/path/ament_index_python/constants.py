"""Stands in for ``ament_index_python.constants``."""

from linkwright.workspace.ament_resources import INDEX

AMENT_PREFIX_PATH_ENV_VAR = "AMENT_PREFIX_PATH"
RESOURCE_INDEX_SUBFOLDER = str(INDEX)

__all__ = ["AMENT_PREFIX_PATH_ENV_VAR", "RESOURCE_INDEX_SUBFOLDER"]
