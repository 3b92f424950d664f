"""The inference of the elements that a description lacks for simulation, with reasons."""

from linkwright.inference.infer import infer
from linkwright.inference.results import Drive, DriveKind, Inference, InferredFact, Wheel

__all__ = ["Drive", "DriveKind", "Inference", "InferredFact", "Wheel", "infer"]
