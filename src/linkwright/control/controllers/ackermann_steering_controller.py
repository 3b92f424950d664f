"""``ackermann_steering_controller/AckermannSteeringController``: a car-like vehicle.

Two wheels are driven, and two wheels are steered.
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
    steering_track_width: float = parameter(
        0.0, description="the distance between the steered wheels, in m; 0 for traction_track_width", only=JAZZY
    )
    front_wheels_radius: float = parameter(0.0, description="the radius of the front wheels, in m", only=HUMBLE)
    rear_wheels_radius: float = parameter(0.0, description="the radius of the rear wheels, in m", only=HUMBLE)
    front_wheel_track: float = parameter(0.0, description="the distance between the front wheels, in m", only=HUMBLE)
    rear_wheel_track: float = parameter(0.0, description="the distance between the rear wheels, in m", only=HUMBLE)


class AckermannSteeringController(SteeringController[Parameters]):
    """A controller of a car with two driven rear wheels and two steered front wheels."""

    PARAMETERS = Parameters
    VEHICLE = "Ackermann"
    JOINT_COUNTS = (2, 2)

    def create_drive(self) -> CarDrive:
        """Return the drive with the dimensions from the parameters.

        The dimensions have different names in Humble and Jazzy.
        """
        parameters = self.parameters
        traction_track_width = parameters.traction_track_width or parameters.select_traction(
            parameters.front_wheel_track, parameters.rear_wheel_track
        )
        steering_track_width = parameters.steering_track_width or parameters.select_traction(
            parameters.rear_wheel_track, parameters.front_wheel_track
        )
        radius = parameters.traction_wheels_radius or parameters.select_traction(
            parameters.front_wheels_radius, parameters.rear_wheels_radius
        )
        return CarDrive(
            parameters.wheelbase, traction_track_width, steering_track_width or traction_track_width, radius
        )
