"""``tricycle_steering_controller/TricycleSteeringController``: a tricycle.

Two wheels are driven, and one wheel is steered.
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.control.controllers.steering import SteeringController, SteeringParameters
from linkwright.kinematics.drives import CarDrive
from linkwright.nodes.parameter_tables import HUMBLE, JAZZY, parameter


@dataclass(frozen=True, kw_only=True)
class Parameters(SteeringParameters):
    """The parameters shared by all steered vehicles, and the dimensions of this vehicle."""

    traction_wheels_radius: float = parameter(0.0, description="the radius of the driven wheels, in m", only=JAZZY)
    traction_track_width: float = parameter(0.0, description="the distance between the driven wheels, in m", only=JAZZY)
    front_wheels_radius: float = parameter(0.0, description="the radius of the front wheels, in m", only=HUMBLE)
    rear_wheels_radius: float = parameter(0.0, description="the radius of the rear wheels, in m", only=HUMBLE)
    wheel_track: float = parameter(0.0, description="the distance between the driven wheels, in m", only=HUMBLE)


class TricycleSteeringController(SteeringController[Parameters]):
    """A controller of a tricycle with two driven wheels and a steered wheel."""

    PARAMETERS = Parameters
    VEHICLE = "Tricycle"
    JOINT_COUNTS = (2, 1)

    def create_drive(self) -> CarDrive:
        """Return the drive with the dimensions from the parameters.

        The dimensions have different names in Humble and Jazzy.
        """
        parameters = self.parameters
        radius = parameters.traction_wheels_radius or parameters.select_traction(
            parameters.front_wheels_radius, parameters.rear_wheels_radius
        )
        return CarDrive(parameters.wheelbase, parameters.traction_track_width or parameters.wheel_track, 0.0, radius)
