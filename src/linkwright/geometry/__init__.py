"""Rotations, poses, shapes, meshes and mass properties, without robot descriptions.

`single` and `arrays` have the same operations: `single` for one rotation or pose in plain floats, `arrays` for many.
Some modules need numpy, so nothing is imported here.
"""
