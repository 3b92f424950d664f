"""Edit robots: find the smallest edit of the text for a requested change."""

from linkwright.descriptions.editing.errors import EditRefusedError
from linkwright.descriptions.editing.files import EditHistory, Workspace
from linkwright.descriptions.editing.planning import Allowed, EditPlan, plan_edit
from linkwright.descriptions.editing.request import WITHOUT_AXIS, EditRequest, Part
from linkwright.descriptions.editing.snapshot import read_again

__all__ = [
    "WITHOUT_AXIS",
    "Allowed",
    "EditHistory",
    "EditPlan",
    "EditRefusedError",
    "EditRequest",
    "Part",
    "Workspace",
    "plan_edit",
    "read_again",
]
