"""Linkwright: a ROS 2 workbench for a robot, without installing ROS.

The names below are the entry points for programs. Each is loaded when a program first uses it.
"""

from linkwright._version import __version__

TYPE_CHECKING = False  # type checkers assume True; importing typing would load more before Ctrl-C is handled
if TYPE_CHECKING:
    from linkwright.bag.reading import open_recording
    from linkwright.descriptions.service import load
    from linkwright.kinematics.tree import KinematicTree
    from linkwright.lint.engine import check
    from linkwright.testing.scenes import read_world
    from linkwright.testing.simulated import SteppedSimulation
    from linkwright.viewer.notebook import show
    from linkwright.vision.datasets.dataset import make_dataset
    from linkwright.xacro.expansion import expand

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

_MODULES = {
    "bag.reading": ("open_recording",),
    "descriptions.service": ("load",),
    "kinematics.tree": ("KinematicTree",),
    "lint.engine": ("check",),
    "testing.scenes": ("read_world",),
    "testing.simulated": ("SteppedSimulation",),
    "viewer.notebook": ("show",),
    "vision.datasets.dataset": ("make_dataset",),
    "xacro.expansion": ("expand",),
}


def __getattr__(name: str) -> object:
    if name not in __all__:  # raised for, among others, a submodule that is about to be imported
        raise AttributeError(f"module 'linkwright' has no attribute '{name}'")
    from linkwright.loading.deferred import deferred

    try:
        return deferred(__name__, _MODULES)(name)
    except ModuleNotFoundError as error:
        if (error.name or "").startswith("linkwright."):
            raise ImportError(f"'{name}' needs linkwright; only linkwright-core is installed") from None
        raise


def __dir__() -> list[str]:
    return __all__
