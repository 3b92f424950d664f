"""Rotations, poses, shapes, meshes and mass properties, independent of robot descriptions.

`single` and `arrays` hold the same operations, for one rotation or pose in plain floats and for many in arrays; all but
`shapes` and `single` need numpy, which is why nothing is imported here.
"""
