"""``bicycle_steering_controller/BicycleSteeringController``: one driven wheel and one steered wheel."""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.control.controllers.steering import SteeringController, SteeringParameters
from linkwright.kinematics.drives import CarDrive
from linkwright.nodes.parameter_tables import HUMBLE, JAZZY, parameter


@dataclass(frozen=True, kw_only=True)
class Parameters(SteeringParameters):
    """The parameters shared by all steered vehicles, and the dimensions of this vehicle."""

    traction_wheel_radius: float = parameter(0.0, description="of the wheel that drives, in m", only=JAZZY)
    front_wheel_radius: float = parameter(0.0, description="of the wheel in front, in m", only=HUMBLE)
    rear_wheel_radius: float = parameter(0.0, description="of the wheel behind, in m", only=HUMBLE)


class BicycleSteeringController(SteeringController[Parameters]):
    """A controller of a bicycle with a driven rear wheel and a steered front wheel."""

    PARAMETERS = Parameters
    KIND = "Bicycle"
    JOINTS = (1, 1)

    def drive(self) -> CarDrive:
        """Return the drive with the dimensions from the parameters, which have different names in Humble and Jazzy."""
        parameters = self.parameters
        radius = parameters.traction_wheel_radius or parameters.select_traction(
            parameters.front_wheel_radius, parameters.rear_wheel_radius
        )
        return CarDrive(parameters.wheelbase, 0.0, 0.0, radius)
