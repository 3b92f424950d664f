"""Tests of other systems that can run on this one: system-specific modules, and a limited Python."""
