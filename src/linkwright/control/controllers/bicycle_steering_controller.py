"""``bicycle_steering_controller/BicycleSteeringController``: one driven wheel, one steered."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.control.controllers.steering import SteeringController, SteeringParameters
from linkwright.kinematics.drives import CarDrive
from linkwright.nodes.parameter_tables import HUMBLE, JAZZY, parameter


@dataclass(frozen=True, kw_only=True)
class Parameters(SteeringParameters):
    """Parameters of the controller: those of all steered vehicles, and its sizes."""

    traction_wheel_radius: float = parameter(0.0, description="of the wheel that drives, in m", only=JAZZY)
    front_wheel_radius: float = parameter(0.0, description="of the wheel in front, in m", only=HUMBLE)
    rear_wheel_radius: float = parameter(0.0, description="of the wheel behind, in m", only=HUMBLE)


class BicycleSteeringController(SteeringController[Parameters]):
    """A bicycle: a driven wheel behind, a steered one in front."""

    PARAMETERS = Parameters
    KIND = "Bicycle"
    JOINTS = (1, 1)

    def drive(self) -> CarDrive:
        """The sizes from the parameters, by their names or the older ones."""
        parameters = self.parameters
        radius = parameters.traction_wheel_radius or parameters.of_traction(
            parameters.front_wheel_radius, parameters.rear_wheel_radius
        )
        return CarDrive(parameters.wheelbase, 0.0, 0.0, radius)
