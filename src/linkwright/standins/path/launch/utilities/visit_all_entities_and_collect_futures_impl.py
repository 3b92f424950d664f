"""Stands in for ``launch.utilities.visit_all_entities_and_collect_futures_impl``."""

from linkwright.launch.class_checks import visit_all_entities_and_collect_futures
from linkwright.standins.launch_names import imported_there as __getattr__

__all__ = ["visit_all_entities_and_collect_futures"]
