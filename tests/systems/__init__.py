"""Tests of other systems that can run on this one.

They cover system-specific modules, and a limited Python.
"""
