"""Third-party trained models, downloaded on request: the table, locations and checksums."""

from linkwright.model_files.installation import install
from linkwright.model_files.installed import find_model, is_installed, models_folder, remove, verify
from linkwright.model_files.table import ModelEntry, model_entry, model_table

__all__ = [
    "ModelEntry",
    "find_model",
    "install",
    "is_installed",
    "model_entry",
    "model_table",
    "models_folder",
    "remove",
    "verify",
]
