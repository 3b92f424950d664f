"""``bicycle_steering_controller/BicycleSteeringController``: a bicycle.

One wheel is driven, and one wheel is steered.
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.control.controllers.steering import SteeringController, SteeringParameters
from linkwright.kinematics.drives import CarDrive
from linkwright.nodes.parameter_tables import HUMBLE, JAZZY, parameter


@dataclass(frozen=True, kw_only=True)
class Parameters(SteeringParameters):
    """The parameters shared by all steered vehicles, and the dimensions of this vehicle."""

    traction_wheel_radius: float = parameter(0.0, description="the radius of the driven wheel, in m", only=JAZZY)
    front_wheel_radius: float = parameter(0.0, description="the radius of the front wheel, in m", only=HUMBLE)
    rear_wheel_radius: float = parameter(0.0, description="the radius of the rear wheel, in m", only=HUMBLE)


class BicycleSteeringController(SteeringController[Parameters]):
    """A controller of a bicycle with a driven rear wheel and a steered front wheel."""

    PARAMETERS = Parameters
    VEHICLE = "Bicycle"
    JOINT_COUNTS = (1, 1)

    def create_drive(self) -> CarDrive:
        """Return the drive with the dimensions from the parameters.

        The dimensions have different names in Humble and Jazzy.
        """
        parameters = self.parameters
        radius = parameters.traction_wheel_radius or parameters.select_traction(
            parameters.front_wheel_radius, parameters.rear_wheel_radius
        )
        return CarDrive(parameters.wheelbase, 0.0, 0.0, radius)
