"""``tricycle_steering_controller/TricycleSteeringController``: two driven wheels and one steered wheel."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.control.controllers.steering import SteeringController, SteeringParameters
from linkwright.kinematics.drives import CarDrive
from linkwright.nodes.parameter_tables import HUMBLE, JAZZY, parameter


@dataclass(frozen=True, kw_only=True)
class Parameters(SteeringParameters):
    """The parameters shared by all steered vehicles, and the dimensions of this vehicle."""

    traction_wheels_radius: float = parameter(0.0, description="of the wheels that drive, in m", only=JAZZY)
    traction_track_width: float = parameter(0.0, description="between the wheels that drive, in m", only=JAZZY)
    front_wheels_radius: float = parameter(0.0, description="of the wheels in front, in m", only=HUMBLE)
    rear_wheels_radius: float = parameter(0.0, description="of the wheels behind, in m", only=HUMBLE)
    wheel_track: float = parameter(0.0, description="between the wheels that drive, in m", only=HUMBLE)


class TricycleSteeringController(SteeringController[Parameters]):
    """A controller of a tricycle with two driven wheels and a steered wheel."""

    PARAMETERS = Parameters
    KIND = "Tricycle"
    JOINTS = (2, 1)

    def drive(self) -> CarDrive:
        """Return the drive with the dimensions from the parameters, which have different names in Humble and Jazzy."""
        parameters = self.parameters
        radius = parameters.traction_wheels_radius or parameters.select_traction(
            parameters.front_wheels_radius, parameters.rear_wheels_radius
        )
        return CarDrive(parameters.wheelbase, parameters.traction_track_width or parameters.wheel_track, 0.0, radius)
