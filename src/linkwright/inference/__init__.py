"""Infer the elements that a description lacks to be driven in a simulated world, with reasons, and add them."""

from linkwright.inference.infer import infer
from linkwright.inference.model import Drive, DriveKind, Finding, Inference, Wheel

__all__ = ["Drive", "DriveKind", "Finding", "Inference", "Wheel", "infer"]
