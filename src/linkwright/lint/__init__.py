"""Lint rules for robot descriptions and the packages that contain them."""

from linkwright.lint.engine import Checked, check, examine
from linkwright.lint.finding import Finding
from linkwright.lint.fix import Edit, Fix
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule, Scope
from linkwright.lint.settings import Settings
from linkwright.lint.subject import Subject

__all__ = ["Checked", "Edit", "Finding", "Fix", "Option", "Rule", "Scope", "Settings", "Subject", "check", "examine"]
