"""``ackermann_steering_controller/AckermannSteeringController``: two driven wheels and two steered wheels."""

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
    steering_track_width: float = parameter(0.0, description="between those that steer; 0 for the same", only=JAZZY)
    front_wheels_radius: float = parameter(0.0, description="of the wheels in front, in m", only=HUMBLE)
    rear_wheels_radius: float = parameter(0.0, description="of the wheels behind, in m", only=HUMBLE)
    front_wheel_track: float = parameter(0.0, description="between the wheels in front, in m", only=HUMBLE)
    rear_wheel_track: float = parameter(0.0, description="between the wheels behind, in m", only=HUMBLE)


class AckermannSteeringController(SteeringController[Parameters]):
    """A controller of a car with two driven rear wheels and two steered front wheels."""

    PARAMETERS = Parameters
    KIND = "Ackermann"
    JOINTS = (2, 2)

    def drive(self) -> CarDrive:
        """Return the drive with the dimensions from the parameters, which have different names in Humble and Jazzy."""
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
