"""Inference of elements that a description lacks for a simulated world: with reasons, and added on request."""

from linkwright.inference.infer import infer
from linkwright.inference.model import Drive, DriveKind, Finding, Inference, Wheel

__all__ = ["Drive", "DriveKind", "Finding", "Inference", "Wheel", "infer"]
