"""The resistance of water to a boat: ``libSimpleHydrodynamics.so``.

Each axis has an added mass, a linear drag and a quadratic drag, which are positive here. Added mass is computed
implicitly, as for ``gz-sim-hydrodynamics-system``.

Source: VRX (parameters, defaults; as there, no Coriolis forces act).
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.simulation.plugins.fluids.hydrodynamics import Hydrodynamics
from linkwright.simulation.plugins.parameters import parameter

_AXES = ("xU", "yV", "zW", "kP", "mQ", "nR")
"""Each axis as a force and the velocity along it, in the letters of SNAME."""
_DEFAULT_ADDED_MASSES = (5.0, 5.0, 0.1, 0.1, 0.1, 1.0)
_DEFAULT_LINEAR_DRAG = 20.0


def _list_derivative_names(axis: str) -> tuple[str, str, str]:
    """Return the names of the added mass, the linear drag and the quadratic drag of an axis."""
    force, velocity = axis[0], axis[1]
    return f"{force}Dot{velocity}", axis, f"{axis}{velocity}"


@dataclass(frozen=True, kw_only=True)
class SimpleHydrodynamicsParameters:
    """Parameters of ``libSimpleHydrodynamics.so``."""

    link_name: str = parameter()


class SimpleHydrodynamics(Hydrodynamics[SimpleHydrodynamicsParameters]):
    """The substitute for ``libSimpleHydrodynamics.so``."""

    PARAMETERS = SimpleHydrodynamicsParameters
    IGNORED = tuple(name for axis in _AXES for name in _list_derivative_names(axis))  # read by read_derivatives

    def start(self) -> None:
        """Find the link, and read the derivatives.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a derivative is not a number.
        """
        self.start_forces(self.parameters.link_name)

    def read_derivatives(self) -> None:
        """Read the entries of the added mass and of the damping on the diagonals."""
        element, body = self.context.element, self.body
        body.has_coriolis = False
        for index, axis in enumerate(_AXES):
            added_mass, linear, quadratic = _list_derivative_names(axis)
            body.added_mass[index, index] = self.number_in(element, added_mass, _DEFAULT_ADDED_MASSES[index])
            body.linear[index, index] = self.number_in(element, linear, _DEFAULT_LINEAR_DRAG)
            body.absolute[index, index, index] = self.number_in(element, quadratic, 0.0)
