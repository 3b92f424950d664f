"""Linkwright: a ROS 2 workbench for a robot, without installing ROS.

The names below are the way in for programs. Each is loaded when a program first uses it.
"""

from linkwright._version import __version__
from linkwright.deferred import deferred
from linkwright.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.bag.reading import open_recording
    from linkwright.descriptions.service import load
    from linkwright.kinematics.tree import KinematicTree
    from linkwright.lint.engine import check
    from linkwright.testing.scenes import read_world
    from linkwright.testing.simulated import SteppedSimulation
    from linkwright.viewer.notebook import show
    from linkwright.vision.datasets.dataset import make_dataset
    from linkwright.xacro.engine import expand

__all__ = [
    "KinematicTree",
    "SteppedSimulation",
    "__version__",
    "check",
    "expand",
    "load",
    "make_dataset",
    "open_recording",
    "read_world",
    "show",
]

__getattr__ = deferred(
    __name__,
    {
        "bag.reading": ("open_recording",),
        "descriptions.service": ("load",),
        "kinematics.tree": ("KinematicTree",),
        "lint.engine": ("check",),
        "testing.scenes": ("read_world",),
        "testing.simulated": ("SteppedSimulation",),
        "viewer.notebook": ("show",),
        "vision.datasets.dataset": ("make_dataset",),
        "xacro.engine": ("expand",),
    },
)


def __dir__() -> list[str]:
    return __all__
