"""Infer the elements that a description lacks for simulation, with reasons; they are added on request."""

from linkwright.inference.infer import infer
from linkwright.inference.model import Drive, DriveKind, Finding, Inference, Wheel

__all__ = ["Drive", "DriveKind", "Finding", "Inference", "Wheel", "infer"]
